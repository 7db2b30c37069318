#include "tools/suite/suite_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <tuple>

#include "compiler/artifact/artifact_reader.h"
#include "compiler/artifact/artifact_writer.h"
#include "compiler/base/ascii.h"
#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/file_io.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/sha256.h"
#include "compiler/base/utf8.h"
#include "tools/suite/input_hashes.h"
#include "tools/suite/result_cache.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

bool is_yaml(const fs::path& path) {
  auto ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), base::to_lower);
  return ending == ".yaml" || ending == ".yml";
}

/// The YAML files below the paths. Links to files are followed, unless they lead out of the folder
/// that was named; links to folders are not.
class YamlFinder {
 public:
  YamlFinder(bool allow_outside, base::DiagnosticSink& sink)
      : allow_outside_(allow_outside), sink_(sink) {}

  /// Sorted, each once.
  std::vector<std::string> find(const std::vector<std::string>& paths) {
    for (const auto& path : paths) look_at(path);
    std::sort(files_.begin(), files_.end());
    files_.erase(std::unique(files_.begin(), files_.end()), files_.end());
    return std::move(files_);
  }

 private:
  /// A path of the command line.
  void look_at(const std::string& path) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (fs::is_directory(status)) {
      gate_ = base::PathGate(allow_outside_);
      gate_.admit_from(path);
      search(path);
    } else if (fs::is_regular_file(status)) {
      add(path);
    } else {
      sink_.error_about(codes::kFileNotFound, path,
                        error ? error.message() : "it is neither a file nor a folder");
    }
  }

  void search(const fs::path& top) {
    std::vector<fs::path> open = {top};
    while (!open.empty()) {
      const auto folder = std::move(open.back());
      open.pop_back();
      std::error_code error;
      fs::directory_iterator entry(folder, error);
      for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        if (entry->symlink_status(error).type() == fs::file_type::directory) {
          open.push_back(entry->path());
        } else if (is_yaml(entry->path())) {
          look_at_entry(entry->path());
        }
        error.clear();
      }
      if (error) unreadable(folder, error.message());
    }
  }

  void look_at_entry(const fs::path& path) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (fs::is_directory(status)) return;  // by a link
    if (!fs::exists(status)) return unreadable(path, error ? error.message() : "it leads nowhere");
    if (!fs::is_regular_file(status)) return unreadable(path, "it is no regular file");
    if (!gate_.admits(path)) {
      sink_.error_about(codes::kLoadOutside, path.string(), base::real_path(path).string());
      return;
    }
    add(path);
  }

  void add(const fs::path& path) { files_.push_back(path.lexically_normal().string()); }
  void unreadable(const fs::path& path, const std::string& why) {
    sink_.error_about(codes::kCaseUnreadable, path.lexically_normal().string(), why);
  }

  bool allow_outside_;
  base::DiagnosticSink& sink_;
  base::PathGate gate_;
  std::vector<std::string> files_;
};

/// Can a text that is too large for a parser contain a case, in any notation? A backslash may hide
/// a key, `include` may bring one.
bool may_hold_case(std::string_view text) {
  constexpr std::array<std::string_view, 5> kSigns = {"cases", "expect", "model", "include", "\\"};
  return std::any_of(kSigns.begin(), kSigns.end(), [&](std::string_view sign) {
    return text.find(sign) != std::string_view::npos;
  });
}

/// Why the bytes are no text; empty: they are one.
std::string_view no_text(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    return "it is UTF-16 or UTF-32, not UTF-8";
  }
  const bool is_text =
      bytes.find('\0') == std::string_view::npos && base::first_invalid_utf8(bytes) == bytes.size();
  return is_text ? "" : "it is no text in UTF-8";
}

/// Records the files that were read, or will be by the processes of the cases.
void note_inputs(const std::vector<std::string>& inputs, base::SourceFiles& files) {
  for (const auto& input : inputs) files.note_input(input);
}

/// Hash of a case's definition and the contents of files, wherever the checkout lies.
std::string revision_of(const SuiteCase& one, const std::vector<std::string>& paths,
                        InputHashes& hashes) {
  std::vector<std::string> contents;
  for (const auto& path : paths) {
    const bool is_marker = fs::path(path).filename() == base::kRootMarker;
    if (!is_marker) contents.push_back(hashes.of(path));
  }
  std::sort(contents.begin(), contents.end());
  contents.erase(std::unique(contents.begin(), contents.end()), contents.end());
  auto all = case_definition(one, CaseKey{});
  for (const auto& content : contents) all += content + '\n';
  return base::sha256_hex(all);
}

/// The line of a case in its file; 0 if an included file has it.
std::uint32_t line_of(const base::SourceRange& range, const std::string& file,
                      const base::SourceFiles& files) {
  const auto& source = files[range.file];
  if (fs::path(source.name()).lexically_normal() != fs::path(file).lexically_normal()) return 0;
  return source.position(range.begin).line;
}

void add_scenario(const std::string& file, harness::SuiteFileKind kind, bool allow_outside,
                  std::vector<SuiteCase>& cases, InputHashes& hashes, base::SourceFiles& files) {
  base::SourceFiles own;
  base::DiagnosticSink unread;  // the run of the case will say it
  const auto scenario = harness::load_scenario(file, own, unread, allow_outside);
  note_inputs(own.inputs(), files);
  const auto folder = fs::path(file).parent_path();
  const auto group = folder.empty() ? std::string(".") : folder.generic_string();
  SuiteCase out{file, file, group, harness::Expectation{}};
  if (scenario) {
    if (!scenario->expect) return;
    out.check = *scenario->expect;
    out.line = line_of(scenario->expect->source, file, own);
    out.command = scenario->simulator.command;
  } else {
    if (kind == harness::SuiteFileKind::kOther) return;
    out.is_broken = true;
  }
  out.revision = revision_of(out, own.inputs(), hashes);
  cases.push_back(std::move(out));
}

/// Warns of compiled models that are older than their texts: the processes of the cases are silent.
void tell_stale_models(const harness::SuiteManifest& manifest, base::SourceFiles& files,
                       base::DiagnosticSink& sink) {
  std::set<std::string> compiled;
  for (const auto& one : manifest.cases) {
    for (const auto& model : one.models) {
      if (compiler::is_artifact_name(model.text)) compiled.insert(model.text);
    }
  }
  for (const auto& path : compiled) {
    base::SourceFiles own;
    base::DiagnosticSink found;
    // Other faults are reported by its case.
    const bool reads_well = compiler::load_artifact(path, own, found).has_value();
    if (reads_well && found.warning_count() > 0) (void)compiler::load_artifact(path, files, sink);
  }
}

void add_manifest(const std::string& file, bool allow_outside, std::vector<SuiteCase>& cases,
                  InputHashes& hashes, base::SourceFiles& files, base::DiagnosticSink& sink) {
  auto manifest = harness::load_manifest(file, files, sink, allow_outside);
  if (!manifest) return;
  tell_stale_models(*manifest, files, sink);
  for (auto& one : manifest->cases) {
    std::vector<std::string> named;
    for (const auto& model : one.models) named.push_back(model.text);
    if (one.expect.golden) named.push_back(one.expect.golden->text);
    note_inputs(named, files);
    auto id = one.id;
    const auto line = line_of(one.source, file, files);
    cases.push_back({file, std::move(id), file, std::move(one)});
    cases.back().line = line;
    cases.back().revision = revision_of(cases.back(), named, hashes);
  }
}

/// Why the text of a file could not be read.
std::string first_message(const base::DiagnosticSink& sink) {
  const auto reports = sink.sorted();
  return reports.empty() ? std::string() : reports.front().message;
}

}  // namespace

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kPassed:
      return "passed";
    case Outcome::kFailed:
      return "failed";
    case Outcome::kError:
      return "error";
    case Outcome::kInconclusive:
      return "inconclusive";
    case Outcome::kNotFinished:
      return "not finished";
    case Outcome::kSkipped:
      return "skipped";
    case Outcome::kRemoved:
      return "removed";
  }
  return "";
}

base::Result<std::vector<SuiteCase>> find_cases(const std::vector<std::string>& paths,
                                                bool allow_outside, base::SourceFiles& files,
                                                base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  const auto unreadable = [&](const std::string& file, const std::string& why) {
    sink.error_about(codes::kCaseUnreadable, file, why);
  };
  std::vector<SuiteCase> cases;
  InputHashes hashes;
  for (const auto& file : YamlFinder(allow_outside, sink).find(paths)) {
    base::DiagnosticSink unread;
    const auto text = base::read_file(file, unread);
    if (!text) {
      unreadable(file, first_message(unread));
    } else if (const auto why = no_text(*text); !why.empty()) {
      unreadable(file, std::string(why));
    } else if (text->size() > harness::kMaxScenarioBytes) {
      if (!may_hold_case(*text)) continue;
      unreadable(file, fmt::format("it is larger than {} bytes", harness::kMaxScenarioBytes));
    } else {
      const auto kind = harness::suite_file_kind(file, allow_outside);
      const bool broken_manifest =
          kind == harness::SuiteFileKind::kBroken && text->find("cases") != std::string::npos;
      if (kind == harness::SuiteFileKind::kManifest || broken_manifest) {
        add_manifest(file, allow_outside, cases, hashes, files, sink);
      } else {
        add_scenario(file, kind, allow_outside, cases, hashes, files);
      }
    }
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  std::sort(cases.begin(), cases.end(), [](const SuiteCase& a, const SuiteCase& b) {
    return std::tie(a.group, a.id) < std::tie(b.group, b.id);
  });
  return cases;
}

}  // namespace parallax::tools
