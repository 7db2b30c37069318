#include "tools/suite/suite_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "compiler/base/file_io.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/subprocess.h"
#include "compiler/base/whole_number.h"
#include "harness/config/scenario.h"
#include "tools/suite/expectation.h"
#include "tools/suite/footprint.h"
#include "tools/suite/suite_history.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

/// Why a command that ended with this code gave no answer.
std::string no_answer(int code) {
  if (code < 0) return "the program could not be started";
  if (code == 2 || code == 3) return "the input was refused";
  if (code == 4) return "inconclusive: a limit ended it first";
  if (code == 128 + SIGXCPU) return "inconclusive: it took more processor time than it may";
  if (code > 128) return fmt::format("the program was ended by signal {}", code - 128);
  return fmt::format("the program ended with exit code {}", code);
}

constexpr std::size_t kMaxMessageBytes = std::size_t{64} << 10U;

/// What this program is run with. Files are named by others: one of the name `--certify=m.e` is a
/// file all the same.
struct CommandWords {
  std::vector<std::string> options;  // behind the command's name
  std::vector<std::string> files;
};

/// Runs this program again with other arguments. When `stop` is raised it is asked to end and
/// waited for all the same.
base::Captured run_this_program(const CommandWords& words, Footprint& footprint,
                                const std::atomic<bool>& stop,
                                std::optional<std::uint64_t> cpu_limit_s = {}) {
  std::vector<std::string> command = {"parallax"};
  command.insert(command.end(), words.options.begin(), words.options.end());
  command.insert(command.end(), {"--footprint", footprint.file()});
  command.emplace_back("--");
  command.insert(command.end(), words.files.begin(), words.files.end());
  base::CaptureOptions options;
  options.program = "/proc/self/exe";
  options.max_errors = kMaxMessageBytes;
  options.ends_with_us = true;
  options.cpu_limit_s = cpu_limit_s;
  options.signal_when = [&stop, told = false]() mutable {
    if (told || !stop.load()) return 0;
    told = true;
    return SIGTERM;
  };
  auto child = base::capture(command, options);
  footprint.add(child);
  return child;
}

void report_no_answer(const base::Captured& child, CaseResult& result) {
  result.outcome = Outcome::kError;
  result.problems = {no_answer(child.code)};
  if (auto error = first_error(child.out); !error.empty()) {
    result.problems.push_back(std::move(error));
  }
}

/// What the process of a case may do is what the suite may.
void add_permissions(const RunnerOptions& options, bool simulates,
                     std::vector<std::string>& words) {
  if (simulates) words.emplace_back(options.allow_commands ? "--allow-commands" : "--no-commands");
  if (options.allow_outside) words.emplace_back("--allow-outside");
}

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
  if (rate.cause && !rate.cause->kind.empty()) words.emplace_back("--cause-kinds");
  add_permissions(options, true, words);
  add_limit(expect, options, words);
  const auto child = run_this_program({std::move(words), {one.file}}, footprint, stop);
  result.messages += child.err;
  if (child.code != 0) return report_no_answer(child, result);
  for (auto& problem : unmet(rate, child.out)) result.problems.push_back(std::move(problem));
  if (!result.problems.empty()) {
    if (auto causes = frequent_causes(child.out); !causes.empty()) {
      result.problems.push_back(std::move(causes));
    }
  }
  note_rates(child.out, result);
  if (options.ledger != nullptr) options.ledger->judge(one, shown_rates(child.out), result);
}

constexpr double kBlameLimitS = 60.0;

/// The document of `parallax explain --json` about models, or a run folder, for whose kind of cause
/// it may make `runs` simulations more. Empty where it gives none: then it is not known what to
/// blame, which changes no outcome.
std::string explanation_of(CommandWords words, double limit_s, const RunnerOptions& options,
                           Footprint& footprint, const std::atomic<bool>& stop) {
  words.options.insert(words.options.begin(), {"explain", "--json"});
  words.options.insert(words.options.end(),
                       {"--time-limit", fmt::format("{}", limit_s), "--quiet", "--color=never"});
  if (options.allow_outside) words.options.emplace_back("--allow-outside");
  const auto child = run_this_program(words, footprint, stop);
  return child.code == 0 || child.code == 1 ? child.out : "";
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

/// Makes room for a new run. Removes nothing but what a run has left there.
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

void run_scenario(const SuiteCase& one, const harness::Expectation& expect,
                  const RunnerOptions& options, Footprint& footprint, const std::atomic<bool>& stop,
                  CaseResult& result) {
  if (expect.rate) run_rates(one, expect, options, footprint, stop, result);
  if (expect.rate && (!expect.of_run() || result.outcome == Outcome::kError)) return;
  if (options.ends_early && !result.problems.empty()) return;
  auto name = one.file;
  std::replace(name.begin(), name.end(), '/', '_');
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
  add_limit(expect, options, words);
  const auto child = run_this_program({std::move(words), {one.file}}, footprint, stop);
  result.messages += child.err;
  // Exit code 1 is a finding and 4 a verdict that may be the expected one; both give a document.
  const bool answered = child.code == 0 || child.code == 1 || child.code == 4;
  if (!answered || has_failed(child.out)) return report_no_answer(child, result);
  note_verdict(child.out, result);
  const bool wants_kind = expect.cause && !expect.cause->kind.empty();
  auto discrepancy = first_discrepancy(child.out);
  std::string explanation;
  if (wants_kind && !discrepancy.empty()) {
    explanation = explanation_of_run(folder, expect, true, options, footprint, stop);
  }
  const auto problems = unmet(expect, child.out, explanation);
  result.problems.insert(result.problems.end(), problems.begin(), problems.end());
  if (!problems.empty() && !discrepancy.empty()) {
    result.problems.push_back(std::move(discrepancy));
    if (!wants_kind && !options.ends_early) {
      explanation = explanation_of_run(folder, expect, false, options, footprint, stop);
    }
    if (auto why = blame(explanation); !why.empty()) result.problems.push_back(std::move(why));
  }
  if (options.ledger != nullptr) options.ledger->judge(one, shown_run(child.out), result);
  if (result.problems.empty()) return;
  result.problems.push_back("report: " + (folder / "report.txt").string());
}

/// The number that the last line of a list of traces begins with, "4 traces, complete ...".
std::optional<std::int64_t> listed_traces(std::string_view text) {
  const auto end = text.find_last_not_of('\n');
  if (end == std::string_view::npos) return std::nullopt;
  text = text.substr(0, end + 1);
  const auto newline = text.rfind('\n');
  if (newline != std::string_view::npos) text.remove_prefix(newline + 1);
  const auto digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const auto rest = text.substr(digits);
  if (!rest.starts_with(" trace, ") && !rest.starts_with(" traces, ")) return std::nullopt;
  return base::whole_number<std::int64_t>(text.substr(0, digits));
}

/// One trace more than all that are expected; 0, for all, where nobody knows how many these are.
std::int64_t one_too_many(const harness::TraceExpectation& expect) {
  if (expect.traces) return *expect.traces + 1;
  base::DiagnosticSink unread;
  const auto golden = base::read_file(expect.golden->text, unread);
  const auto listed = golden ? listed_traces(*golden) : std::nullopt;
  return listed ? *listed + 1 : 0;
}

CommandWords traces_command(const harness::ManifestCase& one, const RunnerOptions& options) {
  std::vector<std::string> words = {"traces"};
  for (const auto& constraint : one.constraints) {
    words.push_back("--until=" + constraint.text);  // also one that begins with `-`
  }
  if (one.horizon) words.insert(words.end(), {"--horizon", std::to_string(*one.horizon)});
  auto limit = one.expect.complete ? 0 : one.expect.traces.value_or(0);
  if (options.ends_early && one.expect.complete) limit = one_too_many(one.expect);
  words.insert(words.end(), {"--limit", std::to_string(limit)});
  if (!options.ends_early) {
    words.insert(words.end(), {"--time-limit", fmt::format("{}", one.time_limit_s)});
  }
  if (one.memory_limit_mb) {
    words.insert(words.end(), {"--memory-limit", std::to_string(*one.memory_limit_mb)});
  }
  words.insert(words.end(), {"--quiet", "--color=never"});
  add_permissions(options, false, words);
  CommandWords command{std::move(words), {}};
  for (const auto& model : one.models) command.files.push_back(model.text);
  return command;
}

/// What the document of `parallax traces --json` says against the expected number.
void compare_count(const harness::TraceExpectation& expect, const std::string& document,
                   CaseResult& result) {
  const auto found = nlohmann::json::parse(document, nullptr, false);
  if (found.is_discarded() || !found.is_object() || found.value("status", "") != "ok") {
    result.problems.push_back("the program printed no result");
    return;
  }
  const auto traces = found.value("traces", std::int64_t{-1});
  // Complete up to the horizon is all that a case asks for.
  const bool complete = found.value("exploration", "stopped") != "stopped";
  if (traces == *expect.traces && complete == expect.complete) return;
  const auto phrase = [](std::int64_t count, bool all) {
    return fmt::format("{} trace{}{}", count, count == 1 ? "" : "s", all ? "" : " and more");
  };
  result.problems.push_back(fmt::format("{}, expected {}", phrase(traces, complete),
                                        phrase(*expect.traces, expect.complete)));
}

/// Of a model that has lost all its traces: the axioms that contradict each other.
void add_blame(const harness::ManifestCase& one, const std::string& document,
               const RunnerOptions& options, Footprint& footprint, const std::atomic<bool>& stop,
               CaseResult& result) {
  const auto found = nlohmann::json::parse(document, nullptr, false);
  if (!found.is_object() || found.value("traces", std::int64_t{-1}) != 0) return;
  CommandWords words;
  if (one.horizon) words.options = {"--horizon", std::to_string(*one.horizon)};
  for (const auto& model : one.models) words.files.push_back(model.text);
  auto why = blame(explanation_of(std::move(words), one.time_limit_s, options, footprint, stop));
  if (!why.empty()) result.problems.push_back("these contradict each other:\n" + why);
}

/// Is this what `parallax traces` has printed, so that a newer list may take its place?
bool is_list_of_traces(std::string_view text) {
  return text.find_last_not_of('\n') == std::string_view::npos || listed_traces(text);
}

/// Why the golden file must not be written; empty: it may. Manifests come from others: theirs must
/// replace no model, no manifest and no file that other programs read.
std::string unfit_for_golden(const std::string& path, const fs::path& folder,
                             const base::Result<std::string>& text) {
  if (!base::lies_below(path, folder)) return "does not lie below the manifest's folder";
  const auto inside = base::real_path(path).lexically_relative(base::real_path(folder));
  for (const auto& part : inside) {
    if (part.string().starts_with('.')) return "is hidden, or lies in a hidden folder";
  }
  if (!text) return "cannot be read";
  if (!is_list_of_traces(*text)) return "is there already and holds no list of traces";
  return {};
}

void compare_golden(const std::string& path, const std::string& text, const fs::path& manifest,
                    bool update, CaseResult& result) {
  base::DiagnosticSink sink;
  std::error_code error;
  const bool exists = fs::exists(path, error);
  const auto expected = exists ? base::read_file(path, sink) : base::Result<std::string>("");
  if (exists && expected && *expected == text) return;
  if (update && result.problems.empty()) {
    const auto unfit = unfit_for_golden(path, manifest.parent_path(), expected);
    if (!unfit.empty()) {
      result.problems.push_back(fmt::format("{} {}, so it is not written", path, unfit));
      return;
    }
    fs::create_directories(fs::path(path).parent_path(), error);
    if (base::write_file_atomically(path, text, sink)) {
      result.golden_written = path;
    } else {
      result.problems.push_back(fmt::format("cannot write {}", path));
    }
    return;
  }
  if (!exists) {
    result.problems.push_back(
        fmt::format("there is no golden file {}; --update-goldens writes it", path));
  } else if (!expected) {
    result.problems.push_back(fmt::format("cannot read {}", path));
  } else {
    result.problems.push_back(
        fmt::format("the traces are not those of {}\n{}", path, text_difference(*expected, text)));
  }
}

void run_traces(const harness::ManifestCase& one, const fs::path& manifest,
                const RunnerOptions& options, Footprint& footprint, const std::atomic<bool>& stop,
                CaseResult& result) {
  const auto command = traces_command(one, options);
  std::optional<std::uint64_t> cpu_limit_s;
  if (options.ends_early) cpu_limit_s = static_cast<std::uint64_t>(std::ceil(one.time_limit_s));
  // A whole list that is the golden one has its number of traces.
  const bool listed = options.ends_early && one.expect.golden && one.expect.complete;
  if (one.expect.traces && !listed) {
    auto words = command;
    words.options.emplace_back("--json");
    // Counting goes on to the end, so it answers only whether these are all.
    if (one.expect.complete && !options.ends_early) words.options.emplace_back("--count");
    const auto child = run_this_program(words, footprint, stop, cpu_limit_s);
    result.messages = child.err;
    if (child.code != 0) return report_no_answer(child, result);
    compare_count(one.expect, child.out, result);
    if (!result.problems.empty() && !options.ends_early) {
      add_blame(one, child.out, options, footprint, stop, result);
    }
  }
  if (one.expect.golden) {
    const auto child = run_this_program(command, footprint, stop, cpu_limit_s);
    result.messages = child.err;
    if (child.code != 0) return report_no_answer(child, result);
    footprint.add_input(one.expect.golden->text);
    compare_golden(one.expect.golden->text, child.out, manifest, options.update_goldens, result);
  }
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
  // A process that was cut off says nothing about the case.
  if (stop.load()) return {};
  footprint.into(result);
  result.ledger = ledger_digest_of(options.ledger, one);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  result.wall_s = wall.count();
  return result;
}

}  // namespace

CaseResult run_case(const SuiteCase& one, const RunnerOptions& options,
                    const std::atomic<bool>& stop) {
  auto result = try_case(one, options, stop);
  for (std::int64_t i = 0; i < options.retries; ++i) {
    if (result.outcome != Outcome::kFailed && result.outcome != Outcome::kError) break;
    auto again = try_case(one, options, stop);
    again.attempts = result.attempts + 1;
    again.wall_s += result.wall_s;
    // What went wrong before is what makes it flaky, so it stays to be read.
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
