#include <algorithm>

#include "harness/calibration/calibration.h"
#include "harness/confidence/criterion.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr std::int64_t kLeastRuns = 300;  // as campaigns have where nothing is said

/// Runs of one trace, as a campaign takes them.
struct TraceLoop {
  const CalibratedCriterion& criterion;
  const CalibratedWorld& world;
  double p;
  std::uint64_t campaign_seed;
  int trace;
  std::int64_t runs = 0;

  bool is_lost_instead() const {
    return world.kind == SyntheticKind::kLosing || world.kind == SyntheticKind::kCrashFirst;
  }

  /// Does it end with "no discrepancy"?
  bool is_claimed(const CriterionSpec& spec) {
    const auto rule = criterion.make ? criterion.make(spec) : make_criterion(spec);
    const auto planned = planned_runs(spec);
    const auto most =
        spec.kind == CriterionKind::kClopperPearson ? planned : std::max(kLeastRuns, 2 * planned);
    const Interval cell{kSyntheticStart_m, kSyntheticStart_m + 1.0};
    Tally tally(
        {{"box.x"}, {cell}, {"box.x"}, {Interval{kSyntheticGoal_m, kSyntheticGoal_m + 1.0}}, {}});
    for (runs = 0; runs < most;) {
      // One number decides whether the run goes wrong; both traces share it where there are two.
      const CounterRng rng({.campaign_seed = campaign_seed,
                            .trace_key = static_cast<std::uint64_t>(world.kind),
                            .sample = static_cast<std::uint64_t>(++runs)});
      for (std::uint64_t attempt = 2;
           world.kind == SyntheticKind::kRefusing && rng.uniform(attempt) < 0.5; ++attempt) {
        tally.add_rejected();
      }
      const double draw = rng.uniform(0), x = rng.uniform(1);
      if (trace == 2 ? draw >= 1.0 - p : draw < p) {
        if (!is_lost_instead()) return false;
        tally.add_lost();
      } else {
        tally.add_clean(std::vector<double>{kSyntheticStart_m + x},
                        std::vector<double>{synthetic_end_m(x)});
      }
      if (rule->decide(tally).stop) return true;
    }
    return false;
  }
};

}  // namespace

CalibrationCell in_process_cell(const CalibratedCriterion& criterion, const CalibratedWorld& world,
                                const CalibrationOptions& options, std::int64_t loops) {
  CalibrationCell cell{world.name, criterion.name, 0, 0, 0.0, allowed_share(criterion, world)};
  const int traces = world.family ? 2 : 1;
  const SpendingRule rule(world.is_counted ? std::optional<std::int64_t>(traces) : std::nullopt);
  std::int64_t runs = 0;
  while (cell.loops < loops && (options.stop == nullptr || !options.stop->load())) {
    bool is_false = false;
    for (int trace = 1; trace <= traces; ++trace) {
      auto spec = criterion.spec;
      if (world.family == Family::kAllTraces) spec.share = rule.share(trace);
      const auto seed = options.seed * 1'000'003U + static_cast<std::uint64_t>(cell.loops);
      TraceLoop loop{criterion, world, criterion.spec.epsilon, seed, trace};
      is_false = loop.is_claimed(spec) || is_false;
      runs += loop.runs;
    }
    ++cell.loops;
    cell.false_claims += is_false ? 1 : 0;
  }
  if (cell.loops > 0) cell.mean_runs = static_cast<double>(runs) / static_cast<double>(cell.loops);
  return cell;
}

}  // namespace parallax::harness
