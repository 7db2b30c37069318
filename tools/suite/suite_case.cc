#include "tools/suite/suite_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/file_io.h"
#include "compiler/base/path_gate.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

bool is_yaml(const fs::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
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

/// Has the text a key `expect` at its outermost level?
bool says_what_it_expects(std::string_view text) {
  return text.starts_with("expect:") || text.find("\nexpect:") != std::string_view::npos;
}

/// Says what was read, or will be by the processes of the cases.
void note_inputs(const std::vector<std::string>& inputs, base::SourceFiles& files) {
  for (const auto& input : inputs) files.note_input(input);
}

void add_scenario(const std::string& file, std::string_view text, bool allow_outside,
                  std::vector<SuiteCase>& cases, base::SourceFiles& files) {
  base::SourceFiles own;
  base::DiagnosticSink unread;  // the run of the case will say it
  const auto scenario = harness::load_scenario(file, own, unread, allow_outside);
  note_inputs(own.inputs(), files);
  const auto folder = fs::path(file).parent_path();
  const auto group = folder.empty() ? std::string(".") : folder.generic_string();
  if (scenario && scenario->expect) {
    cases.push_back({file, file, group, *scenario->expect, scenario->simulator.command});
  } else if (!scenario &&
             (says_what_it_expects(text) || harness::may_be_case(file, allow_outside))) {
    cases.push_back({file, file, group, harness::Expectation{}});
  }
}

void add_manifest(const std::string& file, bool allow_outside, std::vector<SuiteCase>& cases,
                  base::SourceFiles& files, base::DiagnosticSink& sink) {
  auto manifest = harness::load_manifest(file, files, sink, allow_outside);
  if (!manifest) return;
  for (auto& one : manifest->cases) {
    for (const auto& model : one.models) files.note_input(model.text);
    if (one.expect.golden) files.note_input(one.expect.golden->text);
    auto id = one.id;
    cases.push_back({file, std::move(id), file, std::move(one)});
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
    case Outcome::kNotFinished:
      return "not finished";
    case Outcome::kSkipped:
      return "skipped";
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
  for (const auto& file : YamlFinder(allow_outside, sink).find(paths)) {
    base::DiagnosticSink unread;
    const auto text = base::read_file(file, unread);
    if (!text) {
      unreadable(file, first_message(unread));
    } else if (text->size() > harness::kMaxScenarioBytes) {
      if (!harness::looks_like_manifest(*text) && !says_what_it_expects(*text)) continue;
      unreadable(file, fmt::format("it is larger than {} bytes", harness::kMaxScenarioBytes));
    } else if (harness::looks_like_manifest(*text)) {
      add_manifest(file, allow_outside, cases, files, sink);
    } else {
      add_scenario(file, *text, allow_outside, cases, files);
    }
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  std::sort(cases.begin(), cases.end(), [](const SuiteCase& a, const SuiteCase& b) {
    return std::tie(a.group, a.id) < std::tie(b.group, b.id);
  });
  return cases;
}

}  // namespace parallax::tools
