// The texts of a run, so that it can be explained when the project's files have changed.
//
// One JSON file holds them: names relative to a root, contents as text, or as hexadecimal digits
// where they are no UTF-8. To be read they are unpacked into a temporary folder of their own and
// loaded as any scenario; the hash over all texts then says whether they are those of the run.

#include "tools/app/kept_inputs.h"

#include <cstdint>
#include <set>
#include <system_error>
#include <vector>

#include "compiler/base/file_io.h"
#include "compiler/base/file_names.h"
#include "compiler/base/json.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/sha256.h"
#include "compiler/base/utf8.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::int64_t kFormat = 1;
constexpr std::size_t kMaxBytes = std::size_t{16} << 20U;  // of all files
constexpr std::size_t kMaxFiles = 10'000;
constexpr std::size_t kMaxPackedBytes = 8 * kMaxBytes;  // with what JSON escapes

/// The folder below which a scenario may name files.
fs::path root_of(const fs::path& scenario) {
  const auto folder = scenario.parent_path();
  for (auto at = folder; at.has_relative_path(); at = at.parent_path()) {
    if (base::is_marked_root(at)) return at;
  }
  return folder;
}

std::optional<std::string> from_hex(std::string_view digits) {
  const auto value = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
  };
  if (digits.size() % 2 != 0) return std::nullopt;
  std::string out;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const int high = value(digits[i]), low = value(digits[i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    out += static_cast<char>(16 * high + low);
  }
  return out;
}

const std::string* text_in(const Json& object, const char* name) {
  const auto* member = base::json_member(object, name);
  return member != nullptr && member->is_string() ? member->get_ptr<const std::string*>() : nullptr;
}

/// Is it a name of a file below a folder, by itself?
bool is_plain_name(const fs::path& name) {
  if (name.empty() || name.is_absolute() || name != name.lexically_normal()) return false;
  return name.has_filename() && *name.begin() != ".." && *name.begin() != ".";
}

/// The content of an entry, if it is what was kept.
std::optional<std::string> content_of(const Json& entry) {
  const auto* sha256 = text_in(entry, "sha256");
  const auto* text = text_in(entry, "text");
  const auto* hex = text_in(entry, "hex");
  if (sha256 == nullptr || (text == nullptr) == (hex == nullptr)) return std::nullopt;
  auto content = text != nullptr ? std::optional(*text) : from_hex(*hex);
  if (!content || base::sha256_hex(*content) != *sha256) return std::nullopt;
  return content;
}

bool write_new(const fs::path& file, std::string_view content) {
  std::error_code error;
  base::DiagnosticSink unread;
  fs::create_directories(file.parent_path(), error);
  return !error && base::write_file_atomically(file, content, unread, base::TextForm::kExact);
}

/// The name of a folder that is as many folders above the file as `below` has.
std::string named_root(const fs::path& file, const fs::path& below) {
  auto out = file.parent_path();
  for (auto at = below.parent_path(); !at.empty(); at = at.parent_path()) out /= "..";
  auto text = out.lexically_normal().generic_string();
  while (text.size() > 1 && text.ends_with('/')) text.pop_back();
  return text == "." ? "" : text;
}

}  // namespace

std::string packed_inputs(const fs::path& scenario, const std::string& scenario_hash,
                          const std::vector<std::string>& inputs) {
  const fs::path file = base::absolute_name(scenario.string());
  const auto root = root_of(file);
  std::set<fs::path> names;
  for (const auto& input : inputs) {
    const fs::path name = base::absolute_name(input);
    std::error_code error;
    if (!fs::is_regular_file(name, error)) continue;
    auto below = name.lexically_relative(root);
    if (is_plain_name(below)) names.insert(std::move(below));
  }
  auto files = Json::object();
  std::size_t bytes = 0;
  for (const auto& name : names) {
    base::DiagnosticSink unread;
    const auto content = base::read_file(root / name, unread, kMaxBytes);
    if (!content) return {};
    bytes += content->size();
    if (bytes > kMaxBytes || names.size() > kMaxFiles) return {};
    auto& entry = files[name.generic_string()];
    entry["sha256"] = base::sha256_hex(*content);
    const bool is_text = base::first_invalid_utf8(*content) == content->size();
    entry[is_text ? "text" : "hex"] =
        is_text ? *content
                : base::hex_digits(std::vector<std::uint8_t>(content->begin(), content->end()));
  }
  const Json json = {{"inputs", kFormat},
                     {"scenario", file.lexically_relative(root).generic_string()},
                     {"scenario_hash", scenario_hash},
                     {"files", std::move(files)}};
  return base::json_text(json, 1) + '\n';
}

std::optional<UnpackedInputs> unpack_inputs(const fs::path& run_folder,
                                            const std::string& scenario_hash,
                                            const std::string& named_scenario,
                                            const fs::path& folder) {
  base::DiagnosticSink unread;
  const auto text = base::read_file_of(run_folder, kInputsName, unread, kMaxPackedBytes);
  const auto json = text ? base::parse_json(*text) : Json();
  const auto* hash = text_in(json, "scenario_hash");
  const auto* scenario = text_in(json, "scenario");
  const auto* files = base::json_member(json, "files");
  if (hash == nullptr || scenario == nullptr) return std::nullopt;
  if (!scenario_hash.empty() && *hash != scenario_hash) return std::nullopt;
  if (!is_plain_name(*scenario) || files == nullptr || !files->is_object()) return std::nullopt;
  if (files->size() > kMaxFiles || !write_new(folder / base::kRootMarker, "")) return std::nullopt;
  for (const auto& [name, entry] : files->items()) {
    const auto content = content_of(entry);
    if (!content || !is_plain_name(name)) return std::nullopt;
    if (!write_new(folder / name, *content)) return std::nullopt;
  }
  return UnpackedInputs{folder / *scenario, named_root(named_scenario, *scenario)};
}

}  // namespace parallax::tools
