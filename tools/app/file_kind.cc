#include "tools/app/file_kind.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "compiler/base/codes/files.h"
#include "compiler/base/word_table.h"
#include "harness/campaign/journal.h"
#include "harness/config/suite_manifest.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

struct NameEnding {
  std::string_view text;
  FileKind kind;
};
constexpr std::array<NameEnding, 10> kEndings = {{{".e", FileKind::kModel},
                                                  {".yaml", FileKind::kScenario},
                                                  {".yml", FileKind::kScenario},
                                                  {".lisp", FileKind::kPlan},
                                                  {".bind", FileKind::kBinding},
                                                  {".cnf", FileKind::kCompiled},
                                                  {".jsonl", FileKind::kTraces},
                                                  {".ndjson", FileKind::kTraces},
                                                  {".itf.json", FileKind::kTraces},
                                                  {".drat", FileKind::kProof}}};

/// Formats that are no text have zeros in their signature or right behind it: ELF, PNG, ZIP and the
/// like within 16 bytes. A zero farther behind is an accident in a text, which its reader locates.
bool is_binary(std::string_view begin) {
  constexpr std::size_t kSignature = 16;
  return begin.substr(0, kSignature).find('\0') != std::string_view::npos;
}

/// The first bytes of a regular file; a FIFO would wait for somebody to write.
std::string beginning_of(const std::string& path) {
  constexpr std::streamsize kBytes = 8192;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  std::string text(kBytes, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(text.data(), kBytes);
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return text;
}

constexpr auto kFileKindWords = base::word_table<FileKind>(
    "a file", "a model", "a scenario", "a manifest of cases", "a plan", "a binding table",
    "a compiled model", "a list of traces", "a proof", "the folder of a run", "binary data");

/// The command that takes files of this kind.
std::string what_takes(FileKind kind, const std::string& path) {
  const auto with = [&](const char* pattern) {
    return "Try " + fmt::format(fmt::runtime(pattern), path) + '.';
  };
  switch (kind) {
    case FileKind::kModel:
      return with("`parallax traces {0}` or `parallax check {0}`");
    case FileKind::kScenario:
      return with("`parallax run {0}`, `parallax traces {0}` or `parallax check {0}`") +
             " A scenario stands alone.";
    case FileKind::kManifest:
      return with("`parallax suite {}`");
    case FileKind::kPlan:
      return with("`parallax traces MODEL.e --plan {} --bind TABLE.bind`") +
             " A scenario names its plan with `plan:`.";
    case FileKind::kBinding:
      return with("`parallax traces MODEL.e --plan PLAN.lisp --bind {}`") +
             " A scenario names its table with `bind:`.";
    case FileKind::kCompiled:
      return with("`parallax traces {0}` or `parallax explain {0}`");
    case FileKind::kTraces:
      return with("`parallax traces MODEL.e --replay {}`");
    case FileKind::kProof:
      return "It belongs to the list of traces that `parallax traces --certify` printed with it.";
    case FileKind::kRun:
      return with("`parallax replay {0}`, `parallax explain {0}` or `parallax draw {0}`");
    case FileKind::kUnknown:
    case FileKind::kBinary:
      break;
  }
  return "No command reads it; name the text that it was made from.";
}

}  // namespace

FileKind file_kind(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    const bool has_journal = fs::exists(fs::path(path) / harness::kJournalName, error);
    return has_journal ? FileKind::kRun : FileKind::kUnknown;
  }
  const auto begin = beginning_of(path);
  if (is_binary(begin)) return FileKind::kBinary;
  const auto found = std::find_if(kEndings.begin(), kEndings.end(), [&](const NameEnding& ending) {
    return path.ends_with(ending.text);
  });
  if (found == kEndings.end()) return FileKind::kUnknown;
  if (found->kind != FileKind::kScenario) return found->kind;
  const bool is_manifest =
      harness::suite_file_kind(path, false) == harness::SuiteFileKind::kManifest;
  return is_manifest ? FileKind::kManifest : found->kind;
}

base::Status expect_kind(const std::string& path, std::initializer_list<FileKind> kinds,
                         std::string_view wanted, Context& context) {
  const auto kind = file_kind(path);
  const bool fits =
      kind == FileKind::kUnknown || std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  if (fits) return base::Unit{};
  return context.sink()
      .error_about(codes::kWrongKindOfFile, path, kFileKindWords.of(kind), wanted)
      .help(what_takes(kind, path));
}

}  // namespace parallax::tools
