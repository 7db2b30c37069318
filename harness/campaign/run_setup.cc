#include "harness/campaign/run_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/words.h"
#include "harness/campaign/judge.h"
#include "harness/confidence/clean_runs.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/quantiles.h"
#include "harness/world/chain_arm.h"

namespace parallax::harness {

namespace {

constexpr std::int64_t kLeastRunLimit = 300;

}  // namespace

RunLimit run_limit(const Scenario& scenario, double share) {
  auto criterion = scenario.criterion;
  criterion.share = share;
  RunLimit limit{scenario.limits.max_runs, planned_runs(criterion)};
  if (limit.max_runs == 0) limit.max_runs = std::max(kLeastRunLimit, 2 * limit.needed);
  limit.most = limit.max_runs;
  // It looks once: what came later would have no part in its answer.
  const bool looks_once = criterion.kind == CriterionKind::kClopperPearson;
  if (looks_once) limit.max_runs = std::min(limit.max_runs, limit.needed);
  return limit;
}

base::Result<ClaimedRun> claim_run(const Scenario& scenario, const CampaignOptions& options,
                                   base::SourceFiles& files, base::DiagnosticSink& sink) {
  // Before any worker starts: a folder that is in use must cost nothing, and nobody its report.
  auto folder = RunFolder::claim(options.run_dir, options.resume, sink);
  if (!folder) return sink.already_reported();
  // A continuation of another run must not start anything either; the simulator is compared later.
  auto recorded =
      read_for_continuation(*folder, journal_header(scenario, options, {}), files, sink);
  if (!recorded) return sink.already_reported();
  warn_of_low_limit(scenario, files, sink);
  return ClaimedRun{std::move(*folder), std::move(*recorded)};
}

void describe_run(const Scenario& scenario, const CampaignOptions& options,
                  const std::vector<GroundFluent>& fluents, CampaignResult& result) {
  result.scenario = scenario.name;
  result.title = scenario.title;
  result.seed = options.seed;
  result.criterion = scenario.criterion;
  result.comparison = scenario.comparison();
  result.compared = compared_fluents(*scenario.mapping, fluents, result.comparison);
  if (scenario.simulator.is_built_in()) result.arms = arms_text(scenario.world);
  result.tool_version = options.tool_version;
  result.replay_folder = options.run_dir.string();
}

base::Status check_written(const Journal& journal, const CampaignOptions& options,
                           base::DiagnosticSink& sink) {
  const auto error = journal.write_error();
  if (error.empty()) return base::Unit{};
  const auto path = options.run_dir / kJournalName;
  return sink.error_about(codes::kFileNotWritable, path.string(), error);
}

RepeatResult confirmation_of(const SampleRecord& record, const SampleRecord& again) {
  if (again.status == SampleStatus::kLost) return RepeatResult::kLost;
  return first_difference(record, again) ? RepeatResult::kDiffers : RepeatResult::kBitEqual;
}

void note_timing(const SimulatorBench& bench, std::chrono::steady_clock::time_point started,
                 CampaignResult& result) {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
  result.timing.wall_s = wall.count();
  result.timing.runs_made = bench.runs_made();
  result.timing.simulated_s = bench.simulated_s();
}

void set_interval(CauseRate& rate, std::int64_t runs, std::int64_t unseen, double confidence) {
  const auto all = static_cast<double>(runs + unseen);
  const auto least = static_cast<double>(rate.count);
  const auto most = static_cast<double>(rate.count + unseen);
  const double tail = 0.5 * (1.0 - confidence);
  rate.rate = runs == 0 ? 0.0 : least / static_cast<double>(runs);
  rate.lower = rate.count == 0 ? 0.0 : beta_quantile(tail, least, all - least + 1.0);
  rate.upper = rate.count == runs ? 1.0 : beta_quantile(1.0 - tail, most + 1.0, all - most);
}

void set_anytime_interval(CauseRate& rate, std::int64_t runs, std::int64_t unseen,
                          double confidence) {
  const std::int64_t all = runs + unseen;
  const double level = 0.5 * (1.0 + confidence);
  rate.rate = runs == 0 ? 0.0 : static_cast<double>(rate.count) / static_cast<double>(runs);
  rate.lower = all == 0 ? 0.0 : 1.0 - mixture_upper(all - rate.count, all, level);
  rate.upper = all == 0 ? 1.0 : mixture_upper(rate.count + unseen, all, level);
}

std::string unseen_text(std::int64_t unseen) {
  return fmt::format("{} not seen to {} end: the intervals allow for whatever {} would have shown",
                     base::counted(unseen, "run was", "runs were"),
                     base::agreed(unseen, "its", "their"), base::agreed(unseen, "it", "they"));
}

void count_loss(const SampleRecord& record, TraceResult& result) {
  ++result.lost;
  const auto kind = loss_kind(record.reason);
  auto known = std::find_if(result.losses.begin(), result.losses.end(),
                            [&](const LossCount& one) { return one.kind == kind; });
  if (known == result.losses.end()) {
    // Texts of a foreign simulator may all differ.
    constexpr std::size_t kMostKinds = 8;
    if (result.losses.size() >= kMostKinds) {
      known = std::prev(result.losses.end());
      known->kind = "other reasons";
    } else {
      known = result.losses.insert(result.losses.end(), LossCount{kind, 0, record.sample});
    }
  }
  ++known->count;
  if (!is_of_the_solver(record)) return;
  if (result.of_the_solver++ == 0) {
    result.first_of_the_solver =
        fmt::format("{}.{} {}", record.trace, record.sample, record.reason);
  }
}

void add_loss_caveats(TraceResult& result) {
  if (result.of_the_solver > 0) {
    result.caveats.push_back(fmt::format(
        "{} not counted as a discrepancy but as lost, because the solver made up what it showed: "
        "{}",
        base::counted(result.of_the_solver, "run is", "runs are"), result.first_of_the_solver));
  }
  if (result.retried > 0) {
    result.caveats.push_back(
        fmt::format("{} lost at first and observed when repeated with the same start and seed",
                    base::counted(result.retried, "run was", "runs were")));
  }
  if (result.strayed > 0) {
    result.caveats.push_back(fmt::format(
        "{} of the clean runs left the trace on the way and ended as predicted; `--compare "
        "every-step` shows where",
        result.strayed));
  }
}

void add_simulator_caveats(const SimulatorInfo& simulator, const Discrepancy* found,
                           TraceResult& result) {
  if (!simulator.seeds) {
    result.caveats.push_back(
        "the simulator takes no seed, so its own randomness is not under control");
  }
  if (found != nullptr && found->confirmation == RepeatResult::kDiffers) {
    result.caveats.push_back(
        "the simulator is not deterministic: the same start and seed gave another result");
  }
  if (found != nullptr && found->confirmation == RepeatResult::kLost) {
    result.caveats.push_back("the simulator was lost when the discrepancy was repeated");
  }
}

bool warn_of_low_limit(const Scenario& scenario, const base::SourceFiles& files,
                       base::DiagnosticSink& sink, double share) {
  const auto limit = run_limit(scenario, share);
  if (limit.max_runs >= limit.needed) return false;
  const auto& source = scenario.limits.max_runs_source;
  const bool written = source && files.text(*source) == std::to_string(limit.max_runs);
  auto warning = sink.warning(codes::kRunLimitTooLow,
                              written ? *source : base::SourceRange{scenario.source, 0, 0},
                              limit.max_runs, limit.needed);
  const auto alone = run_limit(scenario).needed;
  if (alone < limit.needed) {
    warning.note(fmt::format(
        "traces share the error, so that the claim is about all of them together; with `family: "
        "per-trace` each needs {}",
        alone));
  }
  return true;
}

}  // namespace parallax::harness
