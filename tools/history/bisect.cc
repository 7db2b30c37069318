// The revision that changed the verdict of a scenario, by bisection.
//
// Both ends are run first; only if their verdicts differ is there something to look for. Then
// `git bisect` chooses revisions and is told good, bad or skip for each; revisions without a
// verdict are skipped, and if only such are left between the verdicts all of them are named. It
// works in a temporary repository that borrows the user's objects, so that the user's checkout,
// refs and settings are never touched, and each revision runs in a process of its own. Cost:
// about log2 of the revisions in runs of the scenario.

#include "tools/history/bisect.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/temporary_folder.h"
#include "harness/config/suite_manifest.h"
#include "harness/report/run_report.h"
#include "tools/history/borrowed_repository.h"
#include "tools/history/git.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::json;

/// The user's repository, and the scenario's place in it.
struct Place {
  std::string folder;    // of the checkout in which git is asked
  std::string scenario;  // from the top of the checkout
};

base::Reported refuse(const std::string& subject, const std::string& why,
                      base::DiagnosticSink& sink) {
  return sink.error_about(codes::kUsage, subject, why);
}

base::Result<Place> place_of(const std::string& scenario, base::DiagnosticSink& sink) {
  std::error_code error;
  auto folder = fs::absolute(scenario, error).lexically_normal().parent_path();
  fs::path rest = fs::path(scenario).filename();
  // The file may have been removed from the checkout since, with its folder.
  while (!fs::is_directory(folder, error) && folder.has_relative_path()) {
    rest = folder.filename() / rest;
    folder = folder.parent_path();
  }
  const auto top = ask_git(folder.string(), {"rev-parse", "--show-toplevel"});
  if (!top || top->empty()) {
    return refuse(scenario, "it lies in no checkout of a git repository that may be read", sink);
  }
  const auto inside = (base::real_path(folder) / rest).lexically_relative(base::real_path(*top));
  if (inside.empty() || *inside.begin() == "..") {
    return refuse(scenario, "it lies outside of the checkout", sink);
  }
  return Place{folder.string(), inside.generic_string()};
}

std::string text_in(const Json& object, const char* name) {
  const auto* value = base::json_member(object, name);
  return value == nullptr ? "" : base::json_as<std::string>(*value).value_or("");
}

class Bisection {
 public:
  Bisection(const BisectOptions& options, const std::function<void(const RevisionVerdict&)>& tell,
            const std::atomic<bool>& stop, base::DiagnosticSink& sink)
      : options_(options), tell_(tell), stop_(stop), sink_(sink) {}

  base::Result<BisectResult> run() {
    const auto place = place_of(options_.scenario, sink_);
    if (!place) return sink_.already_reported();
    scenario_ = place->scenario;
    const auto before = commit_of(place->folder, options_.old_revision, sink_);
    const auto after = commit_of(place->folder, options_.new_revision, sink_);
    if (!before || !after) return sink_.already_reported();
    if (scratch_.path().empty()) return refuse("", "no temporary folder can be made", sink_);
    repository_.emplace(scratch_.path() / "repository");
    if (!repository_->make(place->folder, *before, sink_)) return sink_.already_reported();
    if (!try_end(*before, out_.old_end) || !try_end(*after, out_.new_end)) {
      return sink_.already_reported();
    }
    const bool changed =
        out_.ends_have_verdicts() && out_.old_end.verdict != out_.new_end.verdict && !stopped();
    if (changed && !search(*before, *after)) return sink_.already_reported();
    if (out_.changed_by.size() == 1 && !stopped()) compare(out_.changed_by.front().revision);
    out_.stopped = stopped();
    return std::move(out_);
  }

 private:
  bool stopped() const { return stop_.load(); }

  base::Status try_end(const std::string& revision, RevisionVerdict& end) {
    if (!repository_->check_out(revision, sink_)) return sink_.already_reported();
    end = try_here(revision);
    if (!stopped()) tell_(end);
    return base::Unit{};
  }

  /// Runs the scenario as it is checked out.
  RevisionVerdict try_here(const std::string& revision) {
    RevisionVerdict out{revision, repository_->subject(revision), {}, {}, false};
    std::error_code error;
    if (!fs::is_regular_file(fs::path(repository_->path()) / scenario_, error)) {
      out.words = "the scenario is missing";
      out.input_is_wrong = true;
      return out;
    }
    const auto folder = scratch_.path() / "run";
    fs::remove_all(folder, error);
    const bool is_case = !options_.case_id.empty();
    std::vector<std::string> words = {
        "parallax", is_case ? "suite" : "run", "--json",       "--quiet",
        "--out",    folder.string(),           "--color=never"};
    if (is_case) words.insert(words.end(), {"--no-cache", "--only", case_name()});
    if (options_.allow_commands) words.emplace_back("--allow-commands");
    if (!options_.allow_commands && !is_case) words.emplace_back("--no-commands");
    if (options_.allow_outside) words.emplace_back("--allow-outside");
    words.insert(words.end(), options_.run_options.begin(), options_.run_options.end());
    words.insert(words.end(), {"--", scenario_});
    const auto child = this_program(words, repository_->path());
    if (is_case) {
      judge_case(child, out);
    } else {
      judge(child, out);
    }
    return out;
  }

  std::string case_name() const { return scenario_ + ':' + options_.case_id; }

  void judge_case(const base::Captured& suite, RevisionVerdict& out) const {
    const auto document = base::parse_json(suite.out);
    const auto* cases = base::json_member(document, "cases");
    for (const auto& one : cases != nullptr && cases->is_array() ? *cases : Json::array()) {
      if (text_in(one, "case") != case_name()) continue;
      const auto outcome = text_in(one, "outcome");
      const auto* problems = base::json_member(one, "problems");
      const bool has_words = problems != nullptr && problems->is_array() && !problems->empty();
      if (has_words) out.words = base::json_as<std::string>(problems->front()).value_or("");
      out.words = out.words.substr(0, out.words.find('\n'));
      const bool answered = outcome == "passed" || outcome == "failed";
      if (answered) out.verdict = outcome;
      if (!answered && out.words.empty()) out.words = outcome;
      return;
    }
    judge(suite, out);
    if (out.words.empty() || suite.code == 2) {
      out.words = "the case is missing";
      out.input_is_wrong = true;
    }
  }

  base::Captured this_program(const std::vector<std::string>& words, const std::string& folder) {
    base::CaptureOptions how;
    how.program = "/proc/self/exe";
    how.folder = folder;
    how.ends_with_us = true;
    how.without_input = true;
    how.signal_when = [this, told = false]() mutable {
      if (told || !stopped()) return 0;
      told = true;
      return SIGTERM;
    };
    return base::capture(words, how);
  }

  static void judge(const base::Captured& run, RevisionVerdict& out) {
    const auto report = harness::read_run_report(run.out);
    const bool answered = (run.code == 0 || run.code == 1) && report && report->status == "ok";
    if (answered && (report->verdict == "discrepancy" || report->verdict == "no-discrepancy")) {
      out.verdict = report->verdict;
      if (report->discrepancies && !report->discrepancies->empty()) {
        out.words = report->discrepancies->front().words;
      }
      return;
    }
    const auto document = base::parse_json(run.out);
    out.input_is_wrong = run.code == 2 || run.code == 3;
    const auto* diagnostics = base::json_member(document, "diagnostics");
    for (const auto& one :
         diagnostics != nullptr && diagnostics->is_array() ? *diagnostics : Json::array()) {
      if (text_in(one, "severity") != "error") continue;
      out.words = fmt::format("{}: {}", text_in(one, "code"), text_in(one, "message"));
      return;
    }
    out.words =
        run.code == 4 ? "inconclusive" : fmt::format("the run ended with exit code {}", run.code);
  }

  /// `git bisect`, given the verdicts one revision after the other.
  base::Status search(const std::string& before, const std::string& after) {
    std::vector<std::string> start = {"bisect", "start"};
    if (options_.first_parent) start.emplace_back("--first-parent");
    start.insert(start.end(), {after, before});
    auto answer = run_git(repository_->path(), start);
    // Each revision is given once, so this ends.
    while (answer.code == 0 && !stopped()) {
      // Subjects of commits stand in other lines, and may say anything.
      const auto line = answer.out.substr(0, answer.out.find('\n'));
      const auto hash = line.substr(0, line.find(' '));
      if (is_git_hash(hash) && line == hash + " is the first bad commit") return found({hash});
      const auto here = ask_git(repository_->path(), {"rev-parse", "--verify", "HEAD"});
      if (!here) break;
      auto one = try_here(*here);
      if (stopped()) return base::Unit{};
      tell_(one);
      const auto* word = one.verdict.empty()                   ? "skip"
                         : one.verdict == out_.new_end.verdict ? "bad"
                                                               : "good";
      out_.tried.push_back(std::move(one));
      answer = run_git(repository_->path(), {"bisect", word});
    }
    if (stopped()) return base::Unit{};
    constexpr int kOnlySkipped = 2;
    if (answer.code == kOnlySkipped) return found(hashes_in(answer.out));
    return refuse("", git_complaint(answer), sink_);
  }

  /// The lines that are a hash and nothing else.
  static std::vector<std::string> hashes_in(std::string_view text) {
    std::vector<std::string> out;
    for (std::size_t at = 0; at < text.size();) {
      const auto end = std::min(text.find('\n', at), text.size());
      const auto line = text.substr(at, end - at);
      if (is_git_hash(line)) out.emplace_back(line);
      at = end + 1;
    }
    return out;
  }

  base::Status found(const std::vector<std::string>& hashes) {
    for (const auto& hash : hashes) {
      const auto is_it = [&](const RevisionVerdict& one) { return one.revision == hash; };
      const auto at = std::find_if(out_.tried.begin(), out_.tried.end(), is_it);
      out_.changed_by.push_back(at != out_.tried.end() ? *at : out_.new_end);
      if (at == out_.tried.end() && out_.new_end.revision != hash) {
        out_.changed_by.back() = {hash, repository_->subject(hash), {}, "not tried", false};
      }
    }
    return base::Unit{};
  }

  /// Compares the scenario before and after the revision.
  void compare(const std::string& revision) {
    const std::vector<std::pair<std::string, std::string>> sides = {{"before", revision + "^1"},
                                                                    {"after", revision}};
    for (const auto& [name, commit] : sides) {
      const bool made = repository_->add_tree(scratch_.path() / name, commit);
      std::error_code error;
      if (!made || !fs::is_regular_file(scratch_.path() / name / scenario_, error)) {
        out_.difference =
            fmt::format("nothing to compare: {} it there is no such scenario\n", name);
        return;
      }
    }
    if (!options_.case_id.empty()) return compare_models_of_case();
    compare_files({}, "before/" + scenario_, "after/" + scenario_);
  }

  void compare_files(std::vector<std::string> options, const std::string& before,
                     const std::string& after) {
    options.insert(options.begin(), {"parallax", "diff", "--quiet", "--color=never"});
    options.insert(options.end(), {"--", before, after});
    const auto child = this_program(options, scratch_.path().string());
    if (child.code != 0) out_.difference += child.out;
    if (child.code > 1) {
      out_.difference += fmt::format("{} and {} cannot be compared: {}\n", before, after,
                                     child.err.substr(0, child.err.find('\n')));
    }
  }

  /// The case as one side has it.
  std::optional<harness::ManifestCase> case_in(const std::string& side) {
    base::SourceFiles files;
    base::DiagnosticSink unread;
    auto manifest = harness::load_manifest(scratch_.path() / side / scenario_, files, unread,
                                           options_.allow_outside);
    if (!manifest) return std::nullopt;
    for (auto& one : manifest->cases) {
      if (one.id == options_.case_id) return std::move(one);
    }
    return std::nullopt;
  }

  /// Compares the models that stand at the same place of the case on both sides.
  void compare_models_of_case() {
    const auto before = case_in("before"), after = case_in("after");
    if (!before || !after) {
      out_.difference = "the case is not on both sides\n";
      return;
    }
    std::vector<std::string> options;
    if (before->horizon) options = {"--horizon", std::to_string(*before->horizon)};
    const auto name = [&](const harness::LocatedText& model) {
      return fs::path(model.text).lexically_relative(scratch_.path()).generic_string();
    };
    for (std::size_t i = 0; i < before->models.size() && i < after->models.size(); ++i) {
      compare_files(options, name(before->models[i]), name(after->models[i]));
    }
    if (before->models.size() != after->models.size()) out_.difference += "models of the case\n";
    if (out_.difference.empty()) {
      out_.difference =
          "its models are the same; its expectation, golden file and limits were not compared\n";
    }
  }

  const BisectOptions& options_;
  const std::function<void(const RevisionVerdict&)>& tell_;
  const std::atomic<bool>& stop_;
  base::DiagnosticSink& sink_;
  base::TemporaryFolder scratch_{"bisect"};
  std::optional<BorrowedRepository> repository_;
  std::string scenario_;  // from the top of the checkout
  BisectResult out_;
};

}  // namespace

base::Result<BisectResult> bisect_verdict(const BisectOptions& options,
                                          const std::function<void(const RevisionVerdict&)>& tell,
                                          const std::atomic<bool>& stop,
                                          base::DiagnosticSink& sink) {
  return Bisection(options, tell, stop, sink).run();
}

}  // namespace parallax::tools
