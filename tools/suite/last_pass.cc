#include "tools/suite/last_pass.h"

#include <algorithm>
#include <system_error>

#include "compiler/base/file_io.h"
#include "compiler/base/file_names.h"
#include "compiler/base/json.h"
#include "compiler/base/sha256.h"
#include "compiler/base/utf8.h"
#include "tools/suite/input_hashes.h"
#include "tools/suite/result_cache.h"
#include "tools/suite/sealed_text.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxBytes = std::size_t{4} << 20U;  // of all files of a case
constexpr std::size_t kMaxStoredBytes = 8 * kMaxBytes;    // with what JSON escapes

/// The files as they were read; none if one has changed since, is not text, or is too large.
/// Folders and missing files have no text.
std::optional<Json> texts_of(const std::vector<InputFile>& inputs) {
  auto out = Json::object();
  std::size_t bytes = 0;
  for (const auto& input : inputs) {
    std::error_code error;
    if (input.sha256.empty() || fs::is_directory(input.path, error)) continue;
    base::DiagnosticSink unread;
    auto text = base::read_file(input.path, unread, kMaxBytes);
    if (!text || !input.sha256.starts_with(base::sha256_hex(*text))) return std::nullopt;
    if (base::first_invalid_utf8(*text) != text->size()) return std::nullopt;
    bytes += text->size();
    if (bytes > kMaxBytes) return std::nullopt;
    out[input.path] = *std::move(text);
  }
  return out;
}

}  // namespace

std::string files_hash(const std::vector<InputFile>& inputs) {
  std::vector<std::string> contents;
  for (const auto& input : inputs) contents.push_back(input.sha256);
  std::sort(contents.begin(), contents.end());
  std::string all;
  for (const auto& content : contents) all += content + '\n';
  return all.empty() ? all : base::sha256_hex(all);
}

std::string LastPasses::definition_of(const SuiteCase& one) {
  return case_definition(one, CaseKey{});  // whatever the program and the seed
}

fs::path LastPasses::folder_of(const SuiteCase& one) const {
  return folder_ / name_ / base::sha256_hex(one.name()).substr(0, 32);
}

void LastPasses::keep(const SuiteCase& one, const CaseResult& result) const {
  if (result.outcome == Outcome::kPassed) keep_any(one, result);
}

void LastPasses::keep_any(const SuiteCase& one, const CaseResult& result) const {
  if (result.inputs.empty()) return;
  auto inputs = program_hash() + definition_of(one);
  for (const auto& input : result.inputs) inputs += '\0' + input.path + '\0' + input.sha256;
  const auto folder = folder_of(one);
  const auto file = folder / (base::sha256_hex(inputs).substr(0, 32) + ".json");
  std::error_code error;
  if (fs::exists(file, error)) return;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    if (at->path().extension() == ".json") fs::remove(at->path(), ignored);
  }
  auto texts = texts_of(result.inputs);
  if (!texts) return;
  const Json json = {{"case", one.name()},
                     {"program", program_hash()},
                     {"definition", definition_of(one)},
                     {"files", files_hash(result.inputs)},
                     {"texts", *texts}};
  base::DiagnosticSink unread;  // a cache that cannot be kept harms no suite
  fs::create_directories(folder, error);
  (void)base::write_file_atomically(file, sealed(base::json_text(json)), unread);
}

std::optional<LastPass> LastPasses::find(const SuiteCase& one) const {
  std::error_code error;
  for (fs::directory_iterator at(folder_of(one), error), end; !error && at != end;
       at.increment(error)) {
    base::DiagnosticSink unread;
    if (at->path().extension() != ".json") continue;
    const auto text = base::read_file(at->path(), unread, kMaxStoredBytes);
    const auto inner = text ? unsealed(*text) : std::nullopt;
    const auto json = inner ? base::parse_json(*inner) : Json();
    const auto* program = base::json_member(json, "program");
    const auto* definition = base::json_member(json, "definition");
    const auto* texts = base::json_member(json, "texts");
    const auto is_text = [](const Json* member) {
      return member != nullptr && member->is_string();
    };
    if (!is_text(program) || !is_text(definition) || texts == nullptr || !texts->is_object()) {
      continue;
    }
    const auto* files = base::json_member(json, "files");
    LastPass out{program->get<std::string>(),
                 definition->get<std::string>(),
                 is_text(files) ? files->get<std::string>() : std::string(),
                 {}};
    for (const auto& [path, content] : texts->items()) {
      if (!content.is_string()) return std::nullopt;
      out.texts.emplace(base::absolute_name(path), content.get<std::string>());
    }
    return out;
  }
  return std::nullopt;
}

}  // namespace parallax::tools
