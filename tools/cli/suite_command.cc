#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>
#include <tuple>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/folder_lock.h"
#include "compiler/base/sha256.h"
#include "compiler/base/words.h"
#include "compiler/base/write_gate.h"
#include "tools/app/own_identity.h"
#include "tools/app/version.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/merge_shards.h"
#include "tools/cli/shared_options.h"
#include "tools/cli/suite_history_option.h"
#include "tools/cli/suite_options.h"
#include "tools/cli/suite_output.h"
#include "tools/suite/collected_cases.h"
#include "tools/suite/input_hashes.h"
#include "tools/suite/result_cache.h"
#include "tools/suite/suite_case.h"
#include "tools/suite/suite_loop.h"
#include "tools/suite/suite_record.h"
#include "tools/suite/suite_summary.h"
#include "tools/suite/unused_goldens.h"

namespace parallax::tools {
namespace {

std::string environment(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  return value == nullptr ? "" : value;
}

/// Cases with models have a limit of their own; scenarios are marked as fast.
bool is_fast(const SuiteCase& one) {
  const auto* scenario = std::get_if<harness::Expectation>(&one.check);
  // Nobody knows what a scenario that cannot be read would have said.
  return scenario == nullptr || scenario->fast || one.is_broken;
}

struct Collected {
  std::vector<SuiteCase> cases;  // those that are gone stand among them
  std::vector<std::string> unused_goldens;
};

/// The selected cases; under --rerun-failed without those that passed last time.
base::Result<Collected> wanted_cases(const SuiteOptions& options, const StoredResults& earlier,
                                     const Shard& shard, Invocation& invocation) {
  auto cases = find_cases(options.paths, invocation.form().allow_outside, invocation.files(),
                          invocation.sink());
  if (!cases) return invocation.sink().already_reported();
  Collected out;
  out.unused_goldens = unused_goldens(options.paths, *cases, options.out);
  for (const auto& file : out.unused_goldens) {
    invocation.remark(fmt::format("{} is a golden file of no case", file));
  }
  std::set<std::string> names;
  for (const auto& one : *cases) names.insert(one.name());
  std::erase_if(*cases, [&](const SuiteCase& one) {
    return one.name().find(options.only) == std::string::npos || (options.fast && !is_fast(one));
  });
  // A suite that looked at fewer cases does not know what is gone.
  const auto last = last_names(earlier, options.history, [&](const SuiteSelection& suite) {
    return normal_paths(suite.paths) == normal_paths(options.paths) &&
           (suite.only.empty() || suite.only == options.only) && (!suite.fast || options.fast);
  });
  auto removed = removed_cases(names, last, options.only, shard);
  if (cases->empty() && removed.empty()) {
    return invocation.sink().error_about(codes::kNoCases, options.paths.front());
  }
  if (options.rerun_failed) {
    std::erase_if(*cases, [&](const SuiteCase& one) {
      const auto at = earlier.cases.find(one.name());
      if (at == earlier.cases.end()) return true;
      const auto outcome = at->second.result.outcome;
      return outcome == Outcome::kPassed || outcome == Outcome::kSkipped;
    });
  }
  for (auto& one : removed) cases->push_back(std::move(one));
  std::stable_sort(cases->begin(), cases->end(), [](const SuiteCase& a, const SuiteCase& b) {
    return std::tie(a.group, a.id) < std::tie(b.group, b.id);
  });
  out.cases = *std::move(cases);
  return out;
}

/// Lists what would be run. Nothing is run or written.
int list_cases(const SuiteOptions& options, const Shard& shard, Invocation& invocation) {
  base::DiagnosticSink unread;
  auto earlier = read_results(options.out, options.rerun_failed ? invocation.sink() : unread);
  if (!earlier && options.rerun_failed) return 0;
  auto collected =
      wanted_cases(options, earlier ? *std::move(earlier) : StoredResults{}, shard, invocation);
  if (!collected) return 0;
  std::erase_if(collected->cases, [&](const SuiteCase& one) { return !in_shard(one.id, shard); });
  std::size_t removed = 0;
  for (const auto& one : collected->cases) {
    if (!one.is_removed) continue;
    ++removed;
    invocation.remark(fmt::format("{} is gone: the last suite had it", one.name()));
  }
  if (invocation.options().json) {
    invocation.document(collected_document(collected->cases, collected->unused_goldens));
  } else {
    invocation.result(collected_text(collected->cases));
  }
  invocation.remark(base::counted(collected->cases.size() - removed, "case"));
  return 0;
}

/// The ledger, if one was named.
base::Result<std::optional<SuiteLedger>> ledger_of(const SuiteOptions& options,
                                                   Invocation& invocation) {
  if (options.ledger.empty()) return std::optional<SuiteLedger>();
  auto ledger = harness::load_ledger(options.ledger, invocation.files(), invocation.sink());
  if (!ledger) return invocation.sink().already_reported();
  return std::optional(SuiteLedger{*std::move(ledger), options.ledger});
}

/// Is the folder there, or can it be made?
bool is_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  return std::filesystem::is_directory(path, error);
}

/// Refuses a default output folder that a link leads elsewhere.
base::Status check_suite_folder(const SuiteOptions& options, base::DiagnosticSink& sink) {
  if (options.out_given) return base::Unit{};
  return base::check_unnamed_output(options.out, ".", "--out", sink);
}

int usage_error(const std::string& message, Invocation& invocation) {
  invocation.sink().error_about(codes::kUsage, "", message);
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
  out.runner.confirms = options.confirm;
  out.runner.allow_commands = options.commands.allow;
  out.runner.allow_outside = invocation.form().allow_outside;
  out.runner.elsewhere = launcher_words(options.launcher);
  out.spread = !options.launcher.hosts.empty();
  out.jobs = options.jobs;
  out.memory_mb = options.memory_mb;
  out.keep_passes = keep_passes;
  return out;
}

/// Reads the results in --out. Reports missing ones where the options need them, and those of
/// another suite where they are to be resumed.
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
  return sink.error_about(codes::kUsage,
                          (std::filesystem::path(options.out) / kResultsFile).string(),
                          fmt::format("--resume: that suite and this one are different: {}", what));
}

/// The first option that says something about a suite that is run, not about its mutants.
std::string foreign_to_mutants(const SuiteOptions& options) {
  if (!options.merge.empty()) return "--merge";
  if (options.shard != "1/1") return "--shard";
  if (options.rerun_failed) return "--rerun-failed";
  if (options.collect_only) return "--collect-only";
  if (options.update_goldens) return "--update-goldens";
  if (options.confirm) return "--confirm";
  if (!options.junit.empty()) return "--junit";
  if (!options.markdown.empty()) return "--markdown";
  if (!options.annotations.empty()) return "--annotations";
  if (!options.quarantine.empty()) return "--quarantine";
  if (!options.ledger.empty()) return "--ledger";
  if (!options.history.empty()) return "--history";
  if (!options.verify_cache.empty()) return "--verify-cache";
  if (options.memory_mb > 0) return "--memory";
  if (!options.launcher.launcher.empty()) return "--launcher";
  if (!options.launcher.hosts.empty()) return "--hosts";
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
  const auto collected = wanted_cases(options, {}, Shard{}, invocation);
  if (!collected) return 0;
  if (!check_suite_folder(options, invocation.sink())) return 0;
  if (!is_folder(options.out)) {
    invocation.sink().error_about(codes::kUsage, options.out,
                                  "--out: this is no folder, and none can be made here");
    return 0;
  }
  const auto lock = base::FolderLock::claim(options.out, invocation.sink());
  if (!lock) return 0;
  const ResultCache cache(cache_folder(options),
                          {program_hash(), options.seed, invocation.form().allow_outside});
  MutationOptions score;
  score.out = options.out;
  score.runner = loop_options(options, false, nullptr, invocation).runner;
  score.jobs = options.jobs;
  score.resume = options.resume;
  if (!options.no_cache) score.cache = &cache;
  return mutate_suite(collected->cases, options.mutants, std::move(score), invocation);
}

int run_suite(const SuiteOptions& given, Invocation& invocation) {
  auto options = given;
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
    if (options.collect_only) {
      return usage_error("--collect-only lists the cases below a PATH, not those of --merge",
                         invocation);
    }
    return merge_shards(options, invocation);
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
    sink.error_about(codes::kGoldenUpdateRefused, "--update-goldens");
    return 0;
  }
  // Each case starts workers of its own; what is wrong with their places is told once.
  if (!fleet_of(options.launcher, options.jobs, invocation)) return 0;
  const auto shard = chosen_shard(options.shard, environment, sink);
  if (!shard) return 0;
  if (!parse_shard(options.shard)) {
    invocation.remark(
        fmt::format("--shard {}: this is shard {}", options.shard, to_string(*shard)));
  }
  if (options.collect_only) return list_cases(options, *shard, invocation);
  if (!check_suite_folder(options, sink)) return 0;
  const auto lock = base::FolderLock::claim(options.out, sink);
  if (!lock) return 0;
  SuiteIdentity identity{kVersion,
                         program_hash(),
                         own_arithmetic(),
                         options.seed,
                         *shard,
                         options.paths,
                         options.only,
                         options.fast,
                         options.commands.allow,
                         invocation.form().allow_outside};
  if (!options.ledger.empty()) {
    base::DiagnosticSink unread;  // a ledger that cannot be read is refused below
    const auto text = base::read_file(options.ledger, unread);
    if (text) identity.ledger = base::sha256_hex(*text);
  }
  const auto earlier = earlier_results(options, identity, sink);
  if (!earlier) return 0;
  const auto quarantine = quarantine_of(options, invocation);
  auto collected = wanted_cases(options, *earlier, *shard, invocation);
  const auto ledger = ledger_of(options, invocation);
  if (!quarantine || !collected || !ledger || !may_write(options, invocation) ||
      !may_append(options, invocation)) {
    return 0;
  }
  const auto* known = *ledger ? &**ledger : nullptr;
  std::vector<bool> skipped;
  for (const auto& one : collected->cases) skipped.push_back(!in_shard(one.id, *shard));
  StoredResults stored{identity, options.rerun_failed ? earlier->cases : StoredCases{},
                       known_names(*earlier, identity)};
  SuiteRecord record(std::move(collected->cases), skipped, options.out, options.junit,
                     std::move(stored), *quarantine);
  record.note_unused_goldens(std::move(collected->unused_goldens));
  const auto folder = cache_folder(options);
  if (!options.no_cache && !options.cache.empty() && !is_folder(folder)) {
    sink.error_about(codes::kUsage, options.cache,
                     "--cache: this is no folder, and none can be made here");
    return 0;
  }
  const ResultCache cache(folder,
                          {program_hash(), options.seed, invocation.form().allow_outside, known});
  const auto voice = suite_voice(invocation);
  const bool caches = !options.no_cache && !options.update_goldens;
  const LastPasses passes(folder);
  Reuse reuse(record, cache, passes, voice);
  if (options.resume) {
    reuse.resume(earlier->cases, identity.permits_more_than(earlier->identity),
                 identity.allow_commands);
  }
  if (caches) reuse.look_up(*verified);
  if (!record.save(sink)) return 0;
  auto loop = loop_options(options, caches, known, invocation);
  if (caches) loop.runner.last_passes = &passes;
  loop.runner.shared_folders = shared_run_folders(record.cases());
  run_open_cases(record, loop, earlier->cases, reuse, cache, passes, voice, stop_flag());
  tell_removed(record, voice);
  speak_of_quarantine(record, options.only.empty() && !options.fast && !options.rerun_failed,
                      invocation);
  if (known != nullptr) {
    for (const auto& text : known->stale(record.results())) {
      invocation.remark("ledger: " + text);
    }
  }
  const LastPasses told(folder, "told");
  append_to_history(record, identity, options, invocation,
                    {caches ? &told : nullptr, &loop.runner});
  return conclude(record, options, invocation);
}

}  // namespace

Command suite_command() {
  auto options = std::make_shared<SuiteOptions>();
  OptionTable command(
      "suite", "Run every scenario and model expectation below a path (docs/reference/suites.md)");
  command.footer(
      "Examples:\n"
      "  parallax suite scenarios --jobs 2\n"
      "  parallax suite scenarios --fast              without the long simulations\n"
      "  parallax suite scenarios/classics --only zoo\n"
      "  parallax suite scenarios --collect-only      which cases are there?\n"
      "  parallax suite scenarios --shard 2/5 --junit suite.xml\n"
      "  parallax suite scenarios --launcher 'srun -n1 -c1' --jobs 32\n"
      "  parallax suite scenarios --resume            goes on where a suite was ended\n"
      "  parallax suite scenarios/classics --mutate   which mistakes would it not notice?\n"
      "  parallax suite --merge out/1 out/2 --out out/all --junit suite.xml");
  command.option("paths", options->paths, "Scenarios, manifests, or folders that hold some")
      .file({"yaml"});
  command.heading("Which cases");
  command.option("--only", options->only, "Only cases whose name (file:id) contains this");
  command.flag("--fast", options->fast,
               "Only expectations of models, and scenarios that say `fast: true`");
  command.flag("--collect-only", options->collect_only, "List the selected cases; run nothing");
  command.heading("Results");
  command.option("--out", options->out, "Folder of the runs, made anew, and the results")
      .given(options->out_given)
      .show_default()
      .folder();
  command.option("--junit", options->junit, "Write a JUnit report to this file").file();
  command.option("--markdown", options->markdown, "Write a summary in Markdown to this file")
      .file();
  command
      .option("--annotations", options->annotations,
              "Say on standard error what is wrong, as the runners of `github` read it")
      .check(OneOf{{"github"}});
  command.heading("Parts of a suite, and suites that go on");
  command
      .option("--shard", options->shard,
              "Part I of N, as I/N; `env`: from a job array, a matrix or a parallel job")
      .show_default();
  command
      .option("--merge", options->merge,
              "Put the results of shards (their --out folders) together; nothing is run")
      .folder();
  command.flag("--resume", options->resume,
               "Go on with the suite in --out: cases that finished, with the same files, stay");
  command.flag("--rerun-failed", options->rerun_failed,
               "Only cases that did not pass in the last suite with this --out");
  command.heading("Cases that may fail");
  command.option("--retry", options->retries, "More attempts where a case does not pass")
      .check(WholeNumber{0, 100})
      .show_default();
  command.flag("--confirm", options->confirm,
               "Repeat the discrepancy of a case that fails, as `parallax confirm` does");
  command
      .option("--quarantine", options->quarantine,
              "A list of cases that may fail for now, each with its reason")
      .file({"yaml"});
  command
      .option("--ledger", options->ledger,
              "Known discrepancies: one that it does not know fails its case "
              "(docs/reference/suites.md)")
      .file({"yaml"});
  command.heading("History");
  command
      .option("--history", options->history,
              "Append outcomes, rates and times to this file; tell changes "
              "(docs/reference/suites.md)")
      .file();
  command
      .option("--revision", options->revision,
              "What the line of the history is of; else the commit that git has checked out")
      .needs("--history");
  command.heading("Cached passes");
  command
      .option("--cache", options->cache,
              "Folder of passes that need not be run again; without it `cache` in --out")
      .folder();
  command.flag("--no-cache", options->no_cache, "Run every case, and keep no result");
  command.option("--verify-cache", options->verify_cache,
                 "Run this share of the cached passes all the same (5%) and compare");
  command.heading("Golden files");
  command.flag("--update-goldens", options->update_goldens,
               "Write the golden files of cases that are otherwise as expected");
  command.flag("--force", options->force, "Write golden files even where `CI` is set");
  add_command_options(command, options->commands, false);
  command.heading("How they run");
  command.option("--seed", options->seed, "Seed of every run")
      .check(WholeNumber{0, kMaxSeed})
      .show_default();
  command.option("-j,--jobs", options->jobs, "Cases at the same time")
      .check(WholeNumber{1, harness::kMostSlots})
      .show_default()
      .given(options->launcher.jobs_given);
  add_launcher_options(command, options->launcher);
  add_mixed_option(command, options->launcher);
  command
      .option("--memory", options->memory_mb,
              "MB that the cases at the same time may need together, by what they took before")
      .check(WholeNumber{16, 10'000'000});
  add_mutate_options(command, options->mutants);
  return command_of(std::move(command), options, run_suite);
}

}  // namespace parallax::tools
