#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/subprocess.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/shared_options.h"
#include "tools/suite/suite_case.h"
#include "tools/suite/suite_record.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {
namespace {

struct SuiteOptions {
  std::vector<std::string> paths;
  std::string only;
  std::string out = "out/suite";
  std::string junit;
  std::string shard = "1/1";
  std::uint64_t seed = 1;
  std::int64_t jobs = 1;
  bool update_goldens = false;
  bool force = false;
  bool rerun_failed = false;
  bool fast = false;
  CommandPermission commands;
};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// `slurm` stands for the task of a job array, whose tasks count from 1.
base::Result<Shard> shard_of(const SuiteOptions& options, base::DiagnosticSink& sink) {
  auto text = options.shard;
  if (text == "slurm") {
    text = environment("SLURM_ARRAY_TASK_ID") + '/' + environment("SLURM_ARRAY_TASK_COUNT");
  }
  if (const auto shard = parse_shard(text)) return *shard;
  return sink.error_about(
      base::DiagnosticCode::kUsage, "",
      fmt::format("--shard: `{}` is not of the form I/N with 1 <= I <= N <= {}", text, kMaxShards));
}

/// Expectations of models bring a limit of their own; scenarios say that they are fast.
bool is_fast(const SuiteCase& one) {
  const auto* scenario = std::get_if<harness::Expectation>(&one.check);
  return scenario == nullptr || scenario->fast;
}

/// The cases that are asked for; those that passed last time leave under --rerun-failed.
base::Result<std::vector<SuiteCase>> wanted_cases(const SuiteOptions& options,
                                                  const EarlierResults& earlier,
                                                  Invocation& invocation) {
  auto cases = find_cases(options.paths, invocation.form().allow_outside, invocation.files(),
                          invocation.sink());
  if (!cases) return invocation.sink().already_reported();
  std::erase_if(*cases, [&](const SuiteCase& one) {
    return one.name().find(options.only) == std::string::npos || (options.fast && !is_fast(one));
  });
  if (cases->empty()) {
    return invocation.sink().error_about(base::DiagnosticCode::kNoCases, options.paths.front());
  }
  if (options.rerun_failed) {
    std::erase_if(*cases, [&](const SuiteCase& one) {
      const auto at = earlier.find(one.name());
      return at == earlier.end() || at->second == "passed";
    });
  }
  return cases;
}

std::string line_of(const SuiteCase& one, const CaseResult& result) {
  const auto* mark = result.outcome == Outcome::kPassed   ? "ok   "
                     : result.outcome == Outcome::kFailed ? "FAIL "
                                                          : "ERROR";
  auto line = fmt::format("{} {} ({:.1f} s)", mark, one.name(), result.wall_s);
  if (!result.golden_written.empty()) {
    line += "\n       golden file written: " + result.golden_written;
  }
  std::string details;
  for (const auto& problem : result.problems) details += problem + '\n';
  // Of a case without an answer, what the program said of it is the answer.
  if (result.outcome == Outcome::kError) details += result.messages;
  while (details.ends_with('\n')) details.pop_back();
  if (details.empty()) return line;
  line += "\n       ";
  for (const char c : details) line += c == '\n' ? "\n       " : std::string(1, c);
  return line;
}

void run_all(SuiteRecord& record, const SuiteOptions& options, Invocation& invocation) {
  const RunnerOptions runner{options.out, options.seed, options.update_goldens,
                             options.commands.allow, invocation.form().allow_outside};
  std::vector<std::size_t> queue;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    if (record.results()[i].outcome != Outcome::kSkipped) queue.push_back(i);
  }
  std::atomic<std::size_t> next{0};
  std::mutex printing;
  const auto work = [&] {
    for (std::size_t i = next++; i < queue.size() && !stop_flag().load(); i = next++) {
      const auto& one = record.cases()[queue[i]];
      if (!one.command.empty() && options.commands.allow) {
        const std::lock_guard lock(printing);
        invocation.remark(
            fmt::format("{} starts `{}`", one.name(), base::command_text(one.command)));
      }
      auto result = run_case(one, runner, stop_flag());
      if (result.outcome != Outcome::kNotFinished) {
        const std::lock_guard lock(printing);
        invocation.remark(line_of(one, result));
      }
      record.finish(queue[i], std::move(result));
    }
  };
  std::vector<std::thread> threads;
  for (std::int64_t i = 0; i < options.jobs; ++i) threads.emplace_back(work);
  for (auto& thread : threads) thread.join();
}

std::string summary_text(const SuiteRecord& record) {
  auto text = fmt::format("{} passed, {} failed", record.count(Outcome::kPassed),
                          record.count(Outcome::kFailed));
  const auto append = [&](Outcome outcome, std::string_view words) {
    const auto count = record.count(outcome);
    if (count > 0) text += fmt::format(", {} {}", count, words);
  };
  append(Outcome::kError, "without an answer");
  append(Outcome::kNotFinished, "not run");
  append(Outcome::kSkipped, "in other shards");
  return text + '\n';
}

std::string summary_document(const SuiteRecord& record) {
  auto list = nlohmann::json::array();
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    const auto& result = record.results()[i];
    list.push_back({{"case", record.cases()[i].name()},
                    {"outcome", to_string(result.outcome)},
                    {"problems", result.problems},
                    {"timing", {{"wall_s", result.wall_s}}}});
    if (!result.golden_written.empty()) list.back()["golden_written"] = result.golden_written;
  }
  const nlohmann::json document = {{"status", "ok"},
                                   {"passed", record.count(Outcome::kPassed)},
                                   {"failed", record.count(Outcome::kFailed)},
                                   {"errors", record.count(Outcome::kError)},
                                   {"not_run", record.count(Outcome::kNotFinished)},
                                   {"skipped", record.count(Outcome::kSkipped)},
                                   {"cases", list}};
  return base::json_text(document) + '\n';
}

/// A JUnit report, as far as one can see.
bool is_junit(std::string_view text) {
  constexpr std::size_t kHead = 4096;
  return text.starts_with("<") &&
         text.substr(0, kHead).find("<testsuite") != std::string_view::npos;
}

/// Results replace earlier results, a report replaces an earlier report, or an empty file, and no
/// file that the suite reads.
bool may_write(const SuiteOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto results = std::filesystem::path(options.out) / kResultsFile;
  if (!base::check_output(results, invocation.files(), sink)) return false;
  std::error_code error;
  base::DiagnosticSink unread;
  if (std::filesystem::exists(results, error) && !std::filesystem::is_empty(results, error) &&
      !read_results(options.out, unread)) {
    sink.error_about(base::DiagnosticCode::kUsage, results.string(),
                     "this file is there already and holds no results that --out could replace");
    return false;
  }
  if (options.junit.empty()) return true;
  if (!base::check_output(options.junit, invocation.files(), sink)) return false;
  if (!std::filesystem::is_regular_file(options.junit, error)) return true;
  const auto text = base::read_file(options.junit, sink);
  if (!text) return false;
  if (text->empty() || is_junit(*text)) return true;
  sink.error_about(base::DiagnosticCode::kUsage, options.junit,
                   "this file is there already and is no report that --junit could replace");
  return false;
}

int run_suite(const SuiteOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  if (options.update_goldens && !options.force && !environment("CI").empty()) {
    sink.error_about(base::DiagnosticCode::kGoldenUpdateRefused, "--update-goldens");
    return 0;
  }
  const auto shard = shard_of(options, sink);
  EarlierResults earlier;
  if (options.rerun_failed) {
    auto read = read_results(options.out, sink);
    if (!read) return 0;
    earlier = *std::move(read);
  }
  auto cases = wanted_cases(options, earlier, invocation);
  if (!shard || !cases || !may_write(options, invocation)) return 0;
  std::vector<bool> skipped;
  for (const auto& one : *cases) skipped.push_back(!in_shard(one.id, *shard));
  SuiteRecord record(*std::move(cases), skipped, options.out, options.junit, std::move(earlier));
  if (!record.save(sink)) return 0;
  run_all(record, options, invocation);
  const bool saved = record.save(sink).has_value();
  if (invocation.options().json) {
    invocation.document(summary_document(record));
  } else {
    invocation.result(summary_text(record));
  }
  if (record.count(Outcome::kFailed) + record.count(Outcome::kError) > 0) return 1;
  return saved && record.count(Outcome::kNotFinished) > 0 ? 4 : 0;
}

}  // namespace

Command suite_command() {
  auto options = std::make_shared<SuiteOptions>();
  OptionTable command(
      "suite", "Run every scenario and model expectation below a path (docs/suite_format.md)");
  command.footer(
      "Examples:\n"
      "  parallax suite scenarios --jobs 2\n"
      "  parallax suite scenarios --fast              without the long simulations\n"
      "  parallax suite scenarios/classics --only zoo\n"
      "  parallax suite scenarios --shard 2/5 --junit suite.xml");
  command.option("paths", options->paths, "Scenarios, manifests, or folders that hold some")
      .required();
  command.option("--only", options->only, "Only cases whose name (file:id) contains this");
  command.flag("--fast", options->fast,
               "Only expectations of models, and scenarios that say `fast: true`");
  command.option("--out", options->out, "Folder of the runs, made anew, and the results")
      .show_default();
  command.option("--junit", options->junit, "Write a JUnit report to this file");
  command.option("--shard", options->shard, "Part I of N, as I/N; `slurm`: from a job array")
      .show_default();
  command.flag("--rerun-failed", options->rerun_failed,
               "Only cases that did not pass in the last suite with this --out");
  command.flag("--update-goldens", options->update_goldens,
               "Write the golden files of cases that are otherwise as expected");
  command.flag("--force", options->force, "Write golden files even where `CI` is set");
  add_command_options(command, options->commands, false);
  command.option("--seed", options->seed, "Seed of every run")
      .check(WholeNumber{0, kMaxSeed})
      .show_default();
  command.option("-j,--jobs", options->jobs, "Cases at the same time")
      .check(WholeNumber{1, 256})
      .show_default();
  return {std::move(command),
          [options](Invocation& invocation) { return run_suite(*options, invocation); }};
}

}  // namespace parallax::tools
