#include "harness/cluster/program_identity.h"

#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <vector>

#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/sha256.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kBuildDigits = 16, kObjectDigits = 8;
constexpr const char* kKey = "parallax_worker";

std::size_t aligned(std::size_t size) { return (size + 3) / 4 * 4; }

/// The number that the linker gave a program or library; empty if it gave none.
std::string build_id(const dl_phdr_info& info) {
  for (std::size_t i = 0; i < info.dlpi_phnum; ++i) {
    const auto& header = info.dlpi_phdr[i];
    if (header.p_type != PT_NOTE) continue;
    // NOLINTNEXTLINE: the loader says so
    const auto* at = reinterpret_cast<const char*>(info.dlpi_addr + header.p_vaddr);
    const auto* end = at + header.p_memsz;
    while (static_cast<std::size_t>(end - at) > sizeof(ElfW(Nhdr))) {
      ElfW(Nhdr) note;
      std::memcpy(&note, at, sizeof note);
      const auto* name = at + sizeof note;
      const auto* bytes = name + aligned(note.n_namesz);
      if (bytes + note.n_descsz > end) break;
      if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 &&
          std::memcmp(name, "GNU", 4) == 0) {
        return {bytes, note.n_descsz};
      }
      at = bytes + aligned(note.n_descsz);
    }
  }
  return {};
}

int add_object(dl_phdr_info* info, std::size_t /*size*/, void* objects) {
  // The program itself has no name, and the kernel's page no file.
  const std::string path = info->dlpi_name == nullptr ? "" : info->dlpi_name;
  if (!path.empty() && !path.starts_with('/')) return 0;
  auto id = build_id(*info);
  if (id.empty()) {
    base::DiagnosticSink unread;
    const auto text = base::read_file(path.empty() ? "/proc/self/exe" : path, unread);
    id = text ? base::sha256_hex(*text) : "?";
  }
  const auto name = std::filesystem::path(path).filename().string();
  static_cast<std::vector<std::string>*>(objects)->push_back(name + '\0' + id);
  return 0;
}

std::map<std::string, std::string> digits_by_name(const std::vector<std::string>& objects) {
  std::map<std::string, std::string> out;
  for (const auto& object : objects) {
    const auto end = object.find('\0');
    out.emplace(object.substr(0, end),
                base::sha256_hex(object.substr(end + 1)).substr(0, kObjectDigits));
  }
  return out;
}

}  // namespace

ProgramIdentity this_program(std::string version, std::string arithmetic) {
  std::vector<std::string> objects;
  ::dl_iterate_phdr(add_object, &objects);
  std::sort(objects.begin(), objects.end());
  std::string all;
  for (const auto& object : objects) all += object + '\0';
  return {std::move(version), base::sha256_hex(all).substr(0, kBuildDigits), std::move(arithmetic),
          digits_by_name(objects)};
}

std::vector<std::string> differing_objects(const ProgramIdentity& there,
                                           const ProgramIdentity& here) {
  std::vector<std::string> out;
  if (there.objects.empty() || here.objects.empty()) return out;
  const auto shown = [](const std::string& name) { return name.empty() ? "parallax" : name; };
  for (const auto& [name, digits] : there.objects) {
    const auto own = here.objects.find(name);
    if (own == here.objects.end()) {
      out.push_back(shown(name) + " (there only)");
    } else if (own->second != digits) {
      out.push_back(shown(name));
    }
  }
  for (const auto& [name, digits] : here.objects) {
    if (!there.objects.contains(name)) out.push_back(shown(name) + " (here only)");
  }
  return out;
}

std::string to_string(const ProgramIdentity& identity) {
  return fmt::format("{} (build {}, arithmetic {})", identity.version, identity.build,
                     identity.arithmetic.empty() ? "not said" : identity.arithmetic);
}

std::string greeting_line(const ProgramIdentity& identity) {
  return base::json_text(nlohmann::ordered_json{{kKey, 1},
                                                {"version", identity.version},
                                                {"build", identity.build},
                                                {"arithmetic", identity.arithmetic},
                                                {"objects", identity.objects}});
}

std::optional<ProgramIdentity> parse_greeting(std::string_view line) {
  if (line.find(kKey) == std::string_view::npos) return std::nullopt;
  const auto json = base::parse_json(line);
  const auto* version = base::json_member(json, "version");
  const auto* build = base::json_member(json, "build");
  if (base::json_member(json, kKey) == nullptr || version == nullptr || build == nullptr) {
    return std::nullopt;
  }
  auto is = base::json_as<std::string>(*version);
  auto built = base::json_as<std::string>(*build);
  if (!is || !built) return std::nullopt;
  const auto* digits = base::json_member(json, "arithmetic");
  auto arithmetic = digits == nullptr ? std::nullopt : base::json_as<std::string>(*digits);
  ProgramIdentity out{*std::move(is), *std::move(built), arithmetic.value_or(""), {}};
  // For words alone, so that what is not as expected is left out.
  const auto* objects = base::json_member(json, "objects");
  if (objects == nullptr || !objects->is_object()) return out;
  for (const auto& [name, number] : objects->items()) {
    if (number.is_string()) out.objects.emplace(name, number.get<std::string>());
  }
  return out;
}

}  // namespace parallax::harness
