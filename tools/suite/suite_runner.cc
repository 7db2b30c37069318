#include "tools/suite/suite_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "compiler/base/json.h"
#include "compiler/base/sha256.h"
#include "compiler/base/shown_text.h"
#include "harness/config/scenario.h"
#include "tools/suite/case_process.h"
#include "tools/suite/expectation.h"
#include "tools/suite/footprint.h"
#include "tools/suite/since_last_pass.h"
#include "tools/suite/suite_history.h"
#include "tools/suite/trace_case.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

void add_limit(const harness::Expectation& expect, const RunnerOptions& options,
               std::vector<std::string>& words) {
  const auto limit = expect.time_limit_s ? expect.time_limit_s : options.time_limit_s;
  if (limit) words.insert(words.end(), {"--time-limit", fmt::format("{}", *limit)});
}

void run_rates(const SuiteCase& one, const harness::Expectation& expect,
               const RunnerOptions& options, Footprint& footprint, const std::atomic<bool>& stop,
               CaseResult& result) {
  const auto& rate = *expect.rate;
  std::vector<std::string> words = {"rates",   "--json",
                                    "--seed",  std::to_string(options.seed),
                                    "--trace", std::to_string(rate.trace),
                                    "--runs",  std::to_string(rate.runs),
                                    "--quiet", "--color=never"};
  if (!rate.fixed_runs) {
    const auto until = [&](const char* option, double bound) {
      if (bound > 0.0 && bound < 1.0) {
        words.insert(words.end(), {option, fmt::format("{}", bound)});
      }
    };
    until("--until-above", rate.lower);
    until("--until-below", rate.upper);
    words.insert(words.end(), {"--confidence", fmt::format("{}", *rate.confidence)});
  }
  if (rate.cause && !rate.cause->kind.empty()) words.emplace_back("--cause-kinds");
  add_permissions(options, true, words);
  words.insert(words.end(), options.elsewhere.begin(), options.elsewhere.end());
  add_limit(expect, options, words);
  const auto child = run_this_program({std::move(words), {one.file}}, footprint, stop);
  result.messages += child.err;
  // All runs were made and are inconclusive: that is an answer to the expectation.
  const auto answer = base::parse_json(child.out);
  const auto* complete = base::json_member(answer, "complete");
  const bool all_made = child.code == 4 && complete != nullptr && *complete == true;
  if (child.code != 0 && !all_made) return report_no_answer(child, result);
  for (auto& problem : unmet(rate, child.out)) result.problems.push_back(std::move(problem));
  if (!result.problems.empty()) {
    if (auto causes = frequent_causes(child.out); !causes.empty()) {
      result.problems.push_back(std::move(causes));
    }
  }
  note_rates(child.out, result);
  if (options.ledger != nullptr) options.ledger->judge(one, shown_rates(child.out), result);
}

std::string explanation_of_run(const fs::path& folder, const harness::Expectation& expect,
                               bool with_runs, const RunnerOptions& options, Footprint& footprint,
                               const std::atomic<bool>& stop) {
  CommandWords words{{}, {folder.string()}};
  if (!with_runs) words.options = {"--runs", "0"};
  if (options.allow_commands) words.options.emplace_back("--allow-commands");
  return explanation_of(std::move(words), expect.time_limit_s.value_or(kBlameLimitS), options,
                        footprint, stop);
}

/// Repetitions of a confirmation with other seeds, and with half the step.
constexpr const char* kRepeats = "5";

/// Asks `parallax confirm` about the first discrepancy of a run. Its start stays as it is, so that
/// only its repetitions are simulated.
ToldStanding confirmation_of_run(const fs::path& folder, const harness::Expectation& expect,
                                 const RunnerOptions& options, Footprint& footprint,
                                 const std::atomic<bool>& stop) {
  const auto limit = expect.time_limit_s ? expect.time_limit_s : options.time_limit_s;
  CommandWords words{{"confirm", "--json", "--runs", "1", "--repeats", kRepeats, "--time-limit",
                      fmt::format("{}", limit.value_or(kBlameLimitS)), "--quiet", "--color=never"},
                     {folder.string()}};
  if (options.allow_commands) words.options.emplace_back("--allow-commands");
  if (options.allow_outside) words.options.emplace_back("--allow-outside");
  return standing_of_confirmation(run_this_program(words, footprint, stop).out);
}

/// The first line of a problem with a clause behind it.
void add_clause(const std::string& clause, std::string& problem) {
  problem.insert(std::min(problem.find('\n'), problem.size()), "; the discrepancy is " + clause);
}

/// "x/y_z.yaml" -> "x_y_z.yaml"
std::string run_folder_name(std::string file) {
  std::replace(file.begin(), file.end(), '/', '_');
  return file;
}

/// Makes room for a new run. Removes only files that a run has left there.
bool clear_run_folder(const fs::path& folder) {
  std::error_code error;
  const auto status = fs::symlink_status(folder, error);
  if (!fs::exists(status)) return true;
  if (!fs::is_directory(status)) return false;
  if (fs::is_empty(folder, error)) return true;
  if (!fs::exists(fs::symlink_status(folder / "journal.ndjson", error))) return false;
  fs::remove_all(folder, error);
  return !error;
}

/// Did the run come to no verdict, and is nothing else wrong? Then the case neither passes nor
/// fails, unless `inconclusive` is what it expects. `before`: problems that are not of the run.
bool is_undecided(const harness::Expectation& expect, std::string_view run_document,
                  const CaseResult& result, std::size_t before) {
  constexpr std::string_view kUndecided = "inconclusive";
  if (result.verdict != kUndecided || expect.verdict == kUndecided) return false;
  auto others = expect;  // a discrepancy could not be looked at
  others.verdict.reset();
  others.cause.reset();
  others.fluents.clear();
  const auto wrong = unmet(others, run_document, "").size();
  const auto missing = unmet(expect, run_document, "").size();
  return before == 0 && wrong == 0 && result.problems.size() == missing;
}

void run_scenario(const SuiteCase& one, const harness::Expectation& expect,
                  const RunnerOptions& options, Footprint& footprint, const std::atomic<bool>& stop,
                  CaseResult& result) {
  if (expect.rate) run_rates(one, expect, options, footprint, stop, result);
  if (expect.rate && (!expect.of_run() || result.outcome == Outcome::kError)) return;
  if (options.ends_early && !result.problems.empty()) return;
  auto name = run_folder_name(one.file);
  if (options.shared_folders.contains(name)) {
    name += '-' + base::sha256_hex(one.file).substr(0, 8);
  }
  const auto folder = options.out / name;
  if (!clear_run_folder(folder)) {
    result.outcome = Outcome::kError;
    result.problems = {
        fmt::format("{} holds something else than an earlier run; name another folder with --out",
                    folder.string())};
    return;
  }
  std::vector<std::string> words = {
      "run",   "--json",        "--seed",  std::to_string(options.seed),
      "--out", folder.string(), "--quiet", "--color=never"};
  if (options.ends_early && expect.iterations) {
    words.insert(words.end(), {"--max-traces", std::to_string(*expect.iterations + 1)});
  }
  add_permissions(options, true, words);
  words.insert(words.end(), options.elsewhere.begin(), options.elsewhere.end());
  add_limit(expect, options, words);
  const auto child = run_this_program({std::move(words), {one.file}}, footprint, stop);
  result.messages += child.err;
  // Exit code 1 is a finding and 4 a verdict that may be the expected one; both give a document.
  const bool answered = child.code == 0 || child.code == 1 || child.code == 4;
  if (!answered || has_failed(child.out) || lacked_workers(child)) {
    return report_no_answer(child, result);
  }
  note_verdict(child.out, result);
  const bool wants_kind = expect.cause && !expect.cause->kind.empty();
  auto discrepancy = first_discrepancy(child.out);
  std::string explanation;
  if (wants_kind && !discrepancy.empty()) {
    explanation = explanation_of_run(folder, expect, true, options, footprint, stop);
  }
  const auto before = result.problems.size();
  const auto problems = unmet(expect, child.out, explanation);
  result.problems.insert(result.problems.end(), problems.begin(), problems.end());
  std::optional<std::size_t> told_at;  // the problem that tells the discrepancy
  if (!problems.empty() && !discrepancy.empty()) {
    told_at = result.problems.size();
    result.problems.push_back(std::move(discrepancy));
    if (!wants_kind && !options.ends_early) {
      explanation = explanation_of_run(folder, expect, false, options, footprint, stop);
    }
    if (auto why = blame(explanation); !why.empty()) result.problems.push_back(std::move(why));
  }
  if (options.ledger != nullptr) options.ledger->judge(one, shown_run(child.out), result);
  auto standing = standing_of_run(child.out);
  if (!standing.is.empty() && result.problems.size() > before) {
    if (options.confirms) {
      auto told = confirmation_of_run(folder, expect, options, footprint, stop);
      if (!told.is.empty()) standing = std::move(told);
    }
    // The headline, where that is about the discrepancy; else what tells it, here or by the ledger.
    const bool is_verdict = expect.verdict && *expect.verdict != result.verdict;
    add_clause(standing.words, result.problems[is_verdict ? before : told_at.value_or(before)]);
  }
  result.standing = standing.is;
  if (is_undecided(expect, child.out, result, before)) {
    result.outcome = Outcome::kInconclusive;
    if (result.problems.empty()) {
      result.problems = {"the run is inconclusive, and `expect` has no `verdict`"};
    }
  }
  if (result.problems.empty()) return;
  result.problems.push_back("report: " + base::printable((folder / "report.txt").string()));
}

/// One attempt.
CaseResult try_case(const SuiteCase& one, const RunnerOptions& options,
                    const std::atomic<bool>& stop) {
  const auto begin = std::chrono::steady_clock::now();
  Footprint footprint(one, options.out);
  CaseResult result;
  result.outcome = Outcome::kPassed;
  if (const auto* scenario = std::get_if<harness::Expectation>(&one.check)) {
    run_scenario(one, *scenario, options, footprint, stop, result);
  } else {
    run_traces(std::get<harness::ManifestCase>(one.check), one.file, options, footprint, stop,
               result);
  }
  if (result.outcome == Outcome::kPassed && !result.problems.empty()) {
    result.outcome = Outcome::kFailed;
  }
  if (!result.problems.empty() && !stop.load()) {
    auto since = since_last_pass(one, options, footprint, stop);
    if (!since.empty()) result.problems.push_back(std::move(since));
  }
  // A process that was cut off tells nothing about the case.
  if (stop.load()) return {};
  footprint.into(result);
  result.ledger = ledger_digest_of(options.ledger, one);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  result.wall_s = wall.count();
  return result;
}

/// Does one attempt decide? Expected rates, and the verdict `no-discrepancy`, are statistical tests
/// with a stated error: repeated until it passes, a test errs more often. Whether an attempt gives
/// an answer may depend on the result, so a missing answer decides as well.
bool one_attempt_decides(const SuiteCase& one) {
  const auto* expect = std::get_if<harness::Expectation>(&one.check);
  return expect != nullptr && (expect->rate.has_value() ||
                               expect->verdict == std::optional<std::string>("no-discrepancy"));
}

bool is_open(const CaseResult& result) {
  return result.outcome == Outcome::kFailed || result.outcome == Outcome::kError ||
         result.outcome == Outcome::kInconclusive;
}

}  // namespace

std::set<std::string> shared_run_folders(const std::vector<SuiteCase>& cases) {
  std::set<std::string> seen, shared;
  for (const auto& one : cases) {
    const bool is_scenario = std::holds_alternative<harness::Expectation>(one.check);
    auto name = run_folder_name(one.file);
    if (is_scenario && !seen.insert(name).second) shared.insert(std::move(name));
  }
  return shared;
}

CaseResult run_case(const SuiteCase& one, const RunnerOptions& options,
                    const std::atomic<bool>& stop) {
  auto result = try_case(one, options, stop);
  if (one_attempt_decides(one)) {
    if (options.retries > 0 && is_open(result)) {
      result.problems.emplace_back(
          "not repeated (--retry): it is a statistical test, of which one attempt decides");
    }
    return result;
  }
  for (std::int64_t i = 0; i < options.retries; ++i) {
    if (!is_open(result)) break;
    auto again = try_case(one, options, stop);
    again.attempts = result.attempts + 1;
    again.wall_s += result.wall_s;
    // The problems of failed attempts make the case flaky, so they are kept as messages.
    if (again.outcome == Outcome::kPassed) {
      for (const auto& problem : result.problems) {
        again.messages += fmt::format("attempt {}: {}\n", result.attempts, problem);
      }
    }
    result = std::move(again);
  }
  return result;
}

}  // namespace parallax::tools
