#include <algorithm>
#include <cstdlib>
#include <memory>
#include <set>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/whole_number.h"
#include "harness/config/quarantine.h"
#include "tools/app/version.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/mutate_suite.h"
#include "tools/cli/shared_options.h"
#include "tools/history/change_points.h"
#include "tools/history/git.h"
#include "tools/suite/input_hashes.h"
#include "tools/suite/result_cache.h"
#include "tools/suite/suite_case.h"
#include "tools/suite/suite_history.h"
#include "tools/suite/suite_loop.h"
#include "tools/suite/suite_merge.h"
#include "tools/suite/suite_record.h"
#include "tools/suite/suite_summary.h"

namespace parallax::tools {
namespace {

struct SuiteOptions {
  std::vector<std::string> paths, merge;
  std::string only;
  std::string out = "out/suite";
  std::string junit, markdown, annotations, quarantine, cache, verify_cache, ledger;
  std::string history, revision;
  std::string shard = "1/1";
  std::uint64_t seed = 1;
  std::int64_t jobs = 1, memory_mb = 0, retries = 0;
  bool update_goldens = false;
  bool force = false;
  bool rerun_failed = false, resume = false;
  bool no_cache = false;
  bool fast = false;
  CommandPermission commands;
  MutateOptions mutants;
};

std::string environment(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  return value == nullptr ? "" : value;
}

/// Expectations of models bring a limit of their own; scenarios say that they are fast.
bool is_fast(const SuiteCase& one) {
  const auto* scenario = std::get_if<harness::Expectation>(&one.check);
  return scenario == nullptr || scenario->fast;
}

/// The cases that are asked for; those that passed last time leave under --rerun-failed.
base::Result<std::vector<SuiteCase>> wanted_cases(const SuiteOptions& options,
                                                  const StoredCases& earlier,
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
      if (at == earlier.end()) return true;
      const auto outcome = at->second.result.outcome;
      return outcome == Outcome::kPassed || outcome == Outcome::kSkipped;
    });
  }
  return cases;
}

/// A JUnit report, as far as one can see.
bool is_junit(std::string_view text) {
  constexpr std::size_t kHead = 4096;
  return text.starts_with("<") &&
         text.substr(0, kHead).find("<testsuite") != std::string_view::npos;
}

/// May `file` be replaced: is it new, empty, or something that `is_ours`?
bool may_replace(const std::string& file, const std::string& option,
                 bool (*is_ours)(std::string_view), Invocation& invocation) {
  if (file.empty()) return true;
  auto& sink = invocation.sink();
  if (!base::check_output(file, invocation.files(), sink)) return false;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return true;
  const auto text = base::read_file(file, sink);
  if (!text) return false;
  if (text->empty() || is_ours(*text)) return true;
  sink.error_about(
      base::DiagnosticCode::kUsage, file,
      fmt::format("this file is there already and is no report that {} could replace", option));
  return false;
}

bool is_markdown(std::string_view text) { return text.starts_with(kMarkdownMark); }

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
  return may_replace(options.junit, "--junit", is_junit, invocation) &&
         may_replace(options.markdown, "--markdown", is_markdown, invocation);
}

/// Prints and writes what came out; the exit code.
int conclude(SuiteRecord& record, const SuiteOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  bool saved = record.save(sink).has_value();
  if (!options.markdown.empty()) {
    saved =
        base::write_file_atomically(options.markdown, summary_markdown(record), sink).has_value() &&
        saved;
  }
  if (options.annotations == "github") write_error(github_annotations(record));
  if (invocation.options().json) {
    invocation.document(summary_document(record));
  } else {
    invocation.result(summary_text(record));
  }
  if (record.count(Outcome::kFailed) + record.count(Outcome::kError) > 0) return 1;
  return saved && record.count(Outcome::kNotFinished) > 0 ? 4 : 0;
}

base::Result<harness::Quarantine> quarantine_of(const SuiteOptions& options,
                                                Invocation& invocation) {
  if (options.quarantine.empty()) return harness::Quarantine{};
  return harness::load_quarantine(options.quarantine, invocation.files(), invocation.sink());
}

/// Why the suite can have no line in a history; empty: it can.
std::string unfit_for_history(const SuiteOptions& options) {
  if (options.history.empty()) return {};
  if (options.rerun_failed) return "--history is of whole suites, without --rerun-failed";
  if (options.merge.empty() && options.shard != "1/1") {
    return "--history is of whole suites: merge the shards, and append with --merge";
  }
  return {};
}

/// Appends the suite to its history, and says what changed since the line before it.
void append_to_history(const SuiteRecord& record, const SuiteIdentity& suite,
                       const SuiteOptions& options, Invocation& invocation) {
  if (options.history.empty()) return;
  if (record.count(Outcome::kNotFinished) > 0) {
    return invocation.remark("the suite was ended, so nothing is appended to " + options.history);
  }
  auto& sink = invocation.sink();
  std::error_code error;
  auto revision = options.revision;
  if (revision.empty() && !suite.paths.empty()) {
    revision = revision_at(suite.paths.front()).value_or("");
  }
  if (!append_history(options.history, history_line(record, suite, revision), sink)) return;
  const auto history = read_history(options.history, sink);
  if (!history || history->lines.empty()) return;
  for (const auto& remark : remarks_on(*history, options.history)) invocation.remark(remark);
  for (const auto& lines : suites_of(*history)) {
    if (!history->lines[lines.front()].is_same_suite(history->lines.back())) continue;
    const auto changes = find_changes(*history, lines, kHistoryConfidence);
    for (const auto& point : changes.points) {
      if (point.line + 1 != lines.size()) continue;
      invocation.remark(base::printable(change_text(point, *history, lines)));
    }
    for (const auto& slower : slower_cases(*history, lines)) {
      invocation.remark(base::printable(slower));
    }
  }
}

/// May the history be appended to? Asked before the first case.
bool may_append(const SuiteOptions& options, Invocation& invocation) {
  if (options.history.empty()) return true;
  std::error_code error;
  const auto status = std::filesystem::symlink_status(options.history, error);
  if (std::filesystem::is_symlink(status)) {
    invocation.sink().error_about(base::DiagnosticCode::kFileNotWritable, options.history,
                                  "it is a link; name the file itself");
    return false;
  }
  if (!std::filesystem::exists(status)) return true;
  if (!base::check_output(options.history, invocation.files(), invocation.sink())) return false;
  return read_history(options.history, invocation.sink()).has_value();
}

/// The ledger, if one was named.
base::Result<std::optional<SuiteLedger>> ledger_of(const SuiteOptions& options,
                                                   Invocation& invocation) {
  if (options.ledger.empty()) return std::optional<SuiteLedger>();
  auto ledger = harness::load_ledger(options.ledger, invocation.files(), invocation.sink());
  if (!ledger) return invocation.sink().already_reported();
  return std::optional(SuiteLedger{*std::move(ledger), options.ledger});
}

/// A list of known failures must not outlive them.
void speak_of_quarantine(const SuiteRecord& record, bool whole, const Invocation& invocation) {
  std::set<std::string> known;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    const auto name = record.cases()[i].name();
    known.insert(name);
    if (!record.quarantine().contains(name)) continue;
    const auto& result = record.results()[i];
    if (result.outcome == Outcome::kPassed && !result.flaky()) {
      invocation.remark(fmt::format("{} passes: take it from the quarantine list", name));
    }
  }
  if (!whole) return;
  for (const auto& [name, reason] : record.quarantine()) {
    if (!known.contains(name)) {
      invocation.remark(fmt::format("the quarantine list names {}, which is no case", name));
    }
  }
}

int merge_suite(const SuiteOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto quarantine = quarantine_of(options, invocation);
  auto merged = merge_suites(options.merge, sink);
  if (!quarantine || !merged || !may_write(options, invocation) ||
      !may_append(options, invocation)) {
    return 0;
  }
  for (const auto& folder : options.merge) {
    std::error_code error;
    if (!std::filesystem::equivalent(folder, options.out, error)) continue;
    sink.error_about(base::DiagnosticCode::kUsage, options.out,
                     "--out: the merged results would replace those of a shard");
    return 0;
  }
  const auto suite = merged->identity;
  StoredResults stored{suite, {}};
  const std::vector<bool> none(merged->cases.size(), false);
  SuiteRecord record(std::move(merged->cases), none, options.out, options.junit, std::move(stored),
                     *quarantine);
  for (std::size_t i = 0; i < merged->results.size(); ++i) {
    const auto& result = merged->results[i];
    if (result.outcome != Outcome::kPassed) {
      invocation.remark(line_of(record.cases()[i], result));
    }
    record.finish(i, std::move(merged->results[i]));
  }
  for (const auto& shard : merged->missing) {
    invocation.remark(fmt::format("shard {0} is missing: run it with --shard {0} and merge again",
                                  to_string(shard)));
  }
  speak_of_quarantine(record, true, invocation);
  append_to_history(record, suite, options, invocation);
  return conclude(record, options, invocation);
}

/// Is the folder there, or can it be made?
bool is_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  return std::filesystem::is_directory(path, error);
}

int usage_error(const std::string& message, Invocation& invocation) {
  invocation.sink().error_about(base::DiagnosticCode::kUsage, "", message);
  return 0;
}

LoopOptions loop_options(const SuiteOptions& options, bool keep_passes, const SuiteLedger* ledger,
                         const Invocation& invocation) {
  LoopOptions out;
  out.runner.ledger = ledger;
  out.runner.out = options.out;
  out.runner.seed = options.seed;
  out.runner.retries = options.retries;
  out.runner.update_goldens = options.update_goldens;
  out.runner.allow_commands = options.commands.allow;
  out.runner.allow_outside = invocation.form().allow_outside;
  out.jobs = options.jobs;
  out.memory_mb = options.memory_mb;
  out.keep_passes = keep_passes;
  return out;
}

/// What stands in --out. Reported are none where the options ask for some, and those of another
/// suite where they are to be gone on with.
base::Result<StoredResults> earlier_results(const SuiteOptions& options,
                                            const SuiteIdentity& identity,
                                            base::DiagnosticSink& sink) {
  if (!options.rerun_failed && !options.resume) {
    base::DiagnosticSink unread;  // their times and needs are of use all the same
    auto read = read_results(options.out, unread);
    return read ? *std::move(read) : StoredResults{};
  }
  auto earlier = read_results(options.out, sink);
  if (!earlier || !options.resume) return earlier;
  auto settled = earlier->identity;
  if (identity.permits_more_than(settled)) {
    settled.allow_commands = identity.allow_commands;
    settled.allow_outside = identity.allow_outside;
  }
  auto what = difference(settled, identity);
  if (what.empty() && !(earlier->identity.shard == identity.shard)) {
    what = fmt::format("shard {} and {}", to_string(earlier->identity.shard),
                       to_string(identity.shard));
  }
  if (what.empty()) return earlier;
  return sink.error_about(base::DiagnosticCode::kUsage,
                          (std::filesystem::path(options.out) / kResultsFile).string(),
                          fmt::format("--resume: that suite and this one are different: {}", what));
}

/// The first option that says something about a suite that is run, not about its mutants.
std::string foreign_to_mutants(const SuiteOptions& options) {
  if (!options.merge.empty()) return "--merge";
  if (options.shard != "1/1") return "--shard";
  if (options.rerun_failed) return "--rerun-failed";
  if (options.update_goldens) return "--update-goldens";
  if (!options.junit.empty()) return "--junit";
  if (!options.markdown.empty()) return "--markdown";
  if (!options.annotations.empty()) return "--annotations";
  if (!options.quarantine.empty()) return "--quarantine";
  if (!options.ledger.empty()) return "--ledger";
  if (!options.history.empty()) return "--history";
  if (!options.verify_cache.empty()) return "--verify-cache";
  if (options.memory_mb > 0) return "--memory";
  return options.retries > 0 ? "--retry" : "";
}

std::filesystem::path cache_folder(const SuiteOptions& options) {
  return options.cache.empty() ? std::filesystem::path(options.out) / "cache"
                               : std::filesystem::path(options.cache);
}

int score_mutants(const SuiteOptions& options, Invocation& invocation) {
  const auto foreign = foreign_to_mutants(options);
  if (!foreign.empty()) {
    return usage_error(fmt::format("--mutate and {} exclude each other", foreign), invocation);
  }
  const auto cases = wanted_cases(options, {}, invocation);
  if (!cases) return 0;
  if (!is_folder(options.out)) {
    invocation.sink().error_about(base::DiagnosticCode::kUsage, options.out,
                                  "--out: this is no folder, and none can be made here");
    return 0;
  }
  const ResultCache cache(cache_folder(options),
                          {program_hash(), options.seed, invocation.form().allow_outside});
  MutationOptions score;
  score.out = options.out;
  score.runner = loop_options(options, false, nullptr, invocation).runner;
  score.jobs = options.jobs;
  score.resume = options.resume;
  if (!options.no_cache) score.cache = &cache;
  return mutate_suite(*cases, options.mutants, std::move(score), invocation);
}

int run_suite(const SuiteOptions& options, Invocation& invocation) {
  if (options.mutants.mutate && !options.paths.empty()) return score_mutants(options, invocation);
  auto& sink = invocation.sink();
  if (const auto why = unfit_for_history(options); !why.empty()) {
    return usage_error(why, invocation);
  }
  if (!options.merge.empty()) {
    if (!options.paths.empty()) {
      return usage_error("--merge takes the folders of shards and no PATH", invocation);
    }
    if (!options.ledger.empty()) {
      return usage_error("--ledger belongs to the suites whose results are merged", invocation);
    }
    return merge_suite(options, invocation);
  }
  if (options.paths.empty()) {
    return usage_error("name a scenario, a manifest or a folder, or folders with --merge",
                       invocation);
  }
  if (options.resume && options.rerun_failed) {
    return usage_error("--resume and --rerun-failed exclude each other", invocation);
  }
  const auto verified = share_of(options.verify_cache.empty() ? "0" : options.verify_cache);
  if (!verified) {
    return usage_error(
        fmt::format("--verify-cache: `{}` is no share from 0% to 100%", options.verify_cache),
        invocation);
  }
  if (options.update_goldens && !options.force && !environment("CI").empty()) {
    sink.error_about(base::DiagnosticCode::kGoldenUpdateRefused, "--update-goldens");
    return 0;
  }
  const auto shard = chosen_shard(options.shard, environment, sink);
  if (!shard) return 0;
  const SuiteIdentity identity{
      kVersion,     program_hash(),         options.seed,
      *shard,       options.paths,          options.only,
      options.fast, options.commands.allow, invocation.form().allow_outside};
  const auto earlier = earlier_results(options, identity, sink);
  if (!earlier) return 0;
  const auto quarantine = quarantine_of(options, invocation);
  auto cases = wanted_cases(options, earlier->cases, invocation);
  const auto ledger = ledger_of(options, invocation);
  if (!quarantine || !cases || !ledger || !may_write(options, invocation) ||
      !may_append(options, invocation)) {
    return 0;
  }
  const auto* known = *ledger ? &**ledger : nullptr;
  std::vector<bool> skipped;
  for (const auto& one : *cases) skipped.push_back(!in_shard(one.id, *shard));
  StoredResults stored{identity, options.rerun_failed ? earlier->cases : StoredCases{}};
  SuiteRecord record(*std::move(cases), skipped, options.out, options.junit, std::move(stored),
                     *quarantine);
  const auto folder = cache_folder(options);
  if (!options.no_cache && !options.cache.empty() && !is_folder(folder)) {
    sink.error_about(base::DiagnosticCode::kUsage, options.cache,
                     "--cache: this is no folder, and none can be made here");
    return 0;
  }
  const ResultCache cache(folder,
                          {program_hash(), options.seed, invocation.form().allow_outside, known});
  const auto remark = [&](const std::string& text) { invocation.remark(text); };
  const bool caches = !options.no_cache && !options.update_goldens;
  Reuse reuse(record, cache, remark);
  if (options.resume) {
    reuse.resume(earlier->cases, identity.permits_more_than(earlier->identity));
  }
  if (caches) reuse.look_up(*verified);
  if (!record.save(sink)) return 0;
  run_open_cases(record, loop_options(options, caches, known, invocation), earlier->cases, reuse,
                 cache, remark, stop_flag());
  speak_of_quarantine(record, options.only.empty() && !options.fast && !options.rerun_failed,
                      invocation);
  if (known != nullptr) {
    for (const auto& text : known->stale(record.results())) {
      invocation.remark("ledger: " + text);
    }
  }
  append_to_history(record, identity, options, invocation);
  return conclude(record, options, invocation);
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
      "  parallax suite scenarios --shard 2/5 --junit suite.xml\n"
      "  parallax suite scenarios --resume            goes on where a suite was ended\n"
      "  parallax suite scenarios/classics --mutate   which mistakes would it not notice?\n"
      "  parallax suite --merge out/1 out/2 --out out/all --junit suite.xml");
  command.option("paths", options->paths, "Scenarios, manifests, or folders that hold some");
  command.option("--only", options->only, "Only cases whose name (file:id) contains this");
  command.flag("--fast", options->fast,
               "Only expectations of models, and scenarios that say `fast: true`");
  command.option("--out", options->out, "Folder of the runs, made anew, and the results")
      .show_default();
  command.option("--junit", options->junit, "Write a JUnit report to this file");
  command.option("--markdown", options->markdown, "Write a summary in Markdown to this file");
  command
      .option("--annotations", options->annotations,
              "Say on standard error what is wrong, as the runners of `github` read it")
      .check(OneOf{{"github"}});
  command
      .option("--shard", options->shard,
              "Part I of N, as I/N; `env`: from a job array, a matrix or a parallel job")
      .show_default();
  command.option("--merge", options->merge,
                 "Put the results of shards (their --out folders) together; nothing is run");
  command.flag("--resume", options->resume,
               "Go on with the suite in --out: cases that finished, with the same files, stay");
  command.flag("--rerun-failed", options->rerun_failed,
               "Only cases that did not pass in the last suite with this --out");
  command.option("--retry", options->retries, "More attempts where a case does not pass")
      .check(WholeNumber{0, 100})
      .show_default();
  command.option("--quarantine", options->quarantine,
                 "A list of cases that may fail for now, each with its reason");
  command.option("--ledger", options->ledger,
                 "Known discrepancies: one that it does not know fails its case (docs/ledger.md)");
  command.option("--history", options->history,
                 "Append outcomes, rates and times to this file, and say what changed "
                 "(docs/history.md)");
  command
      .option("--revision", options->revision,
              "What the line of the history is of; else the commit that git has checked out")
      .needs("--history");
  command.option("--cache", options->cache,
                 "Folder of passes that need not be run again; without it `cache` in --out");
  command.flag("--no-cache", options->no_cache, "Run every case, and keep no result");
  command.option("--verify-cache", options->verify_cache,
                 "Run this share of the cached passes all the same (5%) and compare");
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
  command
      .option("--memory", options->memory_mb,
              "MB that the cases at the same time may need together, by what they took before")
      .check(WholeNumber{16, 10'000'000});
  add_mutate_options(command, options->mutants);
  return {std::move(command),
          [options](Invocation& invocation) { return run_suite(*options, invocation); }};
}

}  // namespace parallax::tools
