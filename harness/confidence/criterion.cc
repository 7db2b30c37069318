#include "harness/confidence/criterion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "compiler/base/contract.h"
#include "compiler/base/words.h"
#include "harness/confidence/clean_runs.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/confidence/rounding.h"

namespace parallax::harness {
namespace {

std::string runs_text(const Tally& tally) {
  const auto clean = base::counted(tally.clean(), "clean run", "clean runs");
  if (tally.lost() == 0) return fmt::format("{} of {}", clean, tally.runs());
  return fmt::format("{} of {}, {} counted as {}", clean, tally.runs(),
                     base::counted(tally.lost(), "lost run", "lost runs"),
                     base::agreed(tally.lost(), "a failure", "failures"));
}

std::string rejected_text(const Tally& tally) {
  const std::int64_t drawn = tally.rejected() + tally.runs();
  const double share = static_cast<double>(tally.rejected()) / static_cast<double>(drawn);
  return fmt::format(
      "the claim is about start states that are valid: {} of {} drawn were rejected ({})",
      tally.rejected(), drawn, percent_about(share));
}

/// The criterion that a spec describes.
class SpecCriterion final : public ConfidenceCriterion {
 public:
  explicit SpecCriterion(const CriterionSpec& spec)
      : spec_(spec),
        level_(spec.trace_level()),
        planned_(spec.kind == CriterionKind::kAnytime ? 0 : planned_runs(spec)) {}

  CriterionKind kind() const override { return spec_.kind; }

  Decision decide(const Tally& tally) const override {
    Decision decision;
    const bool looks_once = spec_.kind == CriterionKind::kClopperPearson;
    if (looks_once) decision.runs_needed = planned_;
    if (tally.mismatch() > 0) {
      decision.why = "a run gave a discrepancy";
      return decision;
    }
    if (spec_.kind == CriterionKind::kPaper) return by_paper(tally);
    // All-clean runs have their own bound, which is shorter but does not survive a failure.
    const bool all_clean = spec_.kind == CriterionKind::kCleanRuns && tally.lost() == 0;
    const auto needed = all_clean || looks_once
                            ? planned_
                            : mixture_runs_needed(tally.lost(), level_, spec_.epsilon);
    decision.runs_needed = needed;
    decision.stop = looks_once
                        ? tally.runs() == needed &&
                              clopper_pearson_upper(tally.lost(), needed, level_) <= spec_.epsilon
                        : tally.runs() >= needed;
    decision.why = fmt::format("{} of {} runs{}", tally.runs(), needed,
                               all_clean ? "" : fmt::format(", {} lost", tally.lost()));
    return decision;
  }

 private:
  Decision by_paper(const Tally& tally) const {
    Decision decision;
    if (tally.lost() > 0) {
      // The rule has no place for a run without a result; leaving it out would favour the model.
      decision.why = "a run was lost";
      return decision;
    }
    decision.paper = paper_rule(tally, spec_.paper, spec_.confidence_level);
    decision.stop = decision.paper->stop;
    decision.why =
        decision.stop ? "every final interval lies in its cell" : decision.paper->why_not;
    return decision;
  }

  CriterionSpec spec_;
  double level_;
  std::int64_t planned_;  // kAnytime: 0
};

}  // namespace

std::string_view source_of(CriterionKind kind) {
  switch (kind) {
    case CriterionKind::kCleanRuns:
      return "Hanley and Lippman-Hand 1983, If nothing goes wrong, is everything all right?";
    case CriterionKind::kPaper:
      return "Meywerk et al., Simulation-Based Debugging of Formal Environment Models, III-C";
    case CriterionKind::kAnytime:
      return "Ville 1939; Howard, Ramdas, McAuliffe, Sekhon 2021, Time-uniform confidence "
             "sequences";
    case CriterionKind::kClopperPearson:
      return "Clopper and Pearson 1934, The use of confidence or fiducial limits";
  }
  return {};
}

bool may_be_watched(CriterionKind kind) {
  return kind == CriterionKind::kCleanRuns || kind == CriterionKind::kAnytime;
}

CertifiedBound certified_bound(const Tally& tally, double confidence_level, double share) {
  CriterionSpec spec;
  spec.confidence_level = confidence_level;
  spec.share = share;
  const double own = spec.trace_level();
  const std::int64_t failures = tally.lost() + tally.mismatch();
  if (failures == 0) return {confidence_level, bound_after(tally.clean(), own)};
  return {std::max(0.0, 1.0 - 2.0 * (1.0 - confidence_level)),
          mixture_upper(failures, tally.runs(), own)};
}

CertifiedBound stated_bound(const Tally& tally, const CriterionSpec& spec) {
  const double level = spec.confidence_level, own = spec.trace_level();
  const std::int64_t failures = tally.lost() + tally.mismatch();
  if (spec.kind == CriterionKind::kAnytime && tally.runs() > 0) {
    return {level, mixture_upper(failures, tally.runs(), own)};
  }
  if (spec.kind == CriterionKind::kClopperPearson && tally.runs() == planned_runs(spec)) {
    return {level, clopper_pearson_upper(failures, tally.runs(), own)};
  }
  return certified_bound(tally, level, spec.share);
}

std::int64_t planned_runs(const CriterionSpec& spec) {
  const double level = spec.trace_level();
  switch (spec.kind) {
    case CriterionKind::kCleanRuns:
      return runs_needed(level, spec.epsilon);
    case CriterionKind::kAnytime:
      return mixture_runs_needed(0, level, spec.epsilon);
    case CriterionKind::kClopperPearson:
      return spec.runs > 0 ? spec.runs : runs_needed(level, spec.epsilon);
    case CriterionKind::kPaper:
      break;
  }
  return 0;
}

std::unique_ptr<ConfidenceCriterion> make_criterion(const CriterionSpec& spec) {
  PARALLAX_REQUIRE(spec.confidence_level > 0.0 && spec.confidence_level < 1.0,
                   "a confidence in (0, 1)");
  return std::make_unique<SpecCriterion>(spec);
}

PaperRuleSpec paper_literal() { return {}; }

PaperRuleSpec paper_repaired() {
  PaperRuleSpec spec;
  spec.sigma = SigmaKind::kResidualSd;
  spec.root = RootKind::kFinal;
  spec.intercept = InterceptKind::kFree;
  spec.interval = IntervalKind::kPrediction;
  spec.extra_runs = 2;
  spec.exempt_inherited = true;
  spec.tolerance_m = 0.01;
  spec.preset = "paper-repaired";
  return spec;
}

namespace {

/// `what` gives a discrepancy with a small probability, or what else can be said.
std::string claim_about(const Tally& tally, const CriterionSpec& spec, std::string_view what,
                        std::string_view does, const DrawnStates& states = {}) {
  if (tally.mismatch() > 0) {
    return fmt::format("{} of {} gave a discrepancy", tally.mismatch(),
                       base::counted(tally.runs(), "run", "runs"));
  }
  const auto bound = stated_bound(tally, spec);
  if (tally.clean() == 0 || bound.epsilon >= 1.0 || bound.confidence_level <= 0.0) {
    return fmt::format("nothing is claimed ({})", runs_text(tally));
  }
  // Runs that were planned for an epsilon support that one; the bound itself is a little smaller.
  const bool as_planned = spec.kind != CriterionKind::kPaper && bound.epsilon <= spec.epsilon;
  const double epsilon = as_planned ? spec.epsilon : bound.epsilon;
  return fmt::format("with {} confidence, fewer than {} of {} {}{} ({}){}",
                     level_text(bound.confidence_level), percent_up(epsilon), what, does,
                     single_state_text(states, epsilon), runs_text(tally), kSupposition);
}

std::string_view when(Comparison comparison) {
  return comparison == Comparison::kFinal ? "in the last state" : "at any step";
}

}  // namespace

std::string drawn_from(std::string_view region, const DrawnStarts& drawn) {
  const auto from = drawn.left_out.empty() ? std::string(region)
                                           : fmt::format("{} without {}", region, drawn.left_out);
  if (drawn.law.empty()) return fmt::format("drawn uniformly from {}", from);
  return fmt::format("drawn from {} by the scenario's law ({})", from, drawn.law);
}

std::string single_state_text(const DrawnStates& states, double epsilon) {
  if (states.law != Initial::kAll || states.differ || !states.all || *states.all <= 1) return {};
  const double single = epsilon * static_cast<double>(*states.all);
  if (single >= 1.0) return {};
  return fmt::format("; in each single initial state fewer than {}", percent_up(single));
}

namespace {

std::string_view likely_text(bool by_weights) {
  return by_weights ? "each as likely as its weight in `start_weights`" : "each equally likely";
}

/// "each tried", "5 of 6 tried"
std::string tried_text(const DrawnStates& states) {
  if (states.all && states.tried >= *states.all) return "each tried";
  if (states.differ) return "not each tried";
  return states.all ? fmt::format("{} of {} tried", states.tried, *states.all)
                    : fmt::format("{} tried", states.tried);
}

/// "6 ", "more than 10000 "; empty where it differs from trace to trace.
std::string number_text(const DrawnStates& states) {
  if (states.differ) return {};
  return states.all ? fmt::format("{} ", *states.all)
                    : fmt::format("more than {} ", kMostInitialStates);
}

}  // namespace

std::string starts_text(std::string_view region, const DrawnStarts& drawn, bool valid) {
  const std::string_view only_valid = valid ? "valid " : "";
  const auto& states = drawn.initial;
  if (!states.differ && states.all == 1 && states.unrealisable == 0) {
    return fmt::format("{}start states {}", only_valid, drawn_from(region, drawn));
  }
  if (states.law == Initial::kFirst) {
    return fmt::format("{}start states {}", only_valid,
                       drawn_from(fmt::format("{} of the first of its {}initial states", region,
                                              number_text(states)),
                                  drawn));
  }
  return fmt::format(
      "{}starts (one of {}{}initial states that lead to its events{}, {} and {}; then {})",
      only_valid, states.all ? "the " : "", number_text(states),
      states.unrealisable > 0 ? " and that a start can have" : "",
      likely_text(states.law == Initial::kWeights), tried_text(states),
      drawn_from("its region", drawn));
}

std::string claim(const Tally& tally, const CriterionSpec& spec, Comparison comparison,
                  const DrawnStarts& drawn) {
  return claim_about(tally, spec, starts_text("the start region", drawn, tally.rejected() > 0),
                     fmt::format("give a discrepancy {}", when(comparison)), drawn.initial);
}

std::string loop_claim(const Tally& tally, const CriterionSpec& spec, Comparison comparison,
                       const StartLaw& starts) {
  const std::string_view valid = tally.rejected() > 0 ? "the valid part of " : "";
  const auto drawn = drawn_from(fmt::format("{}its region", valid), starts.drawn);
  const std::string_view real = starts.without_start > 0 ? " that a start can have" : "";
  const auto from =
      starts.initial_states == 1
          ? fmt::format("the only initial state{}{}, {},", real,
                        starts.has_weights ? " with a weight in `start_weights`" : "", drawn)
          : fmt::format("{} initial states{}, {} and {}, then {},", starts.initial_states, real,
                        likely_text(starts.has_weights),
                        tried_text({.all = starts.initial_states, .tried = starts.tried}), drawn);
  return claim_about(tally, spec, fmt::format("executions of the plan from {}", from),
                     fmt::format("leave what the model admits {}", when(comparison)));
}

namespace {

/// Names a few fluents, counts many by their symbols.
std::string not_covered_text(const std::vector<std::string>& fluents) {
  constexpr std::size_t kFew = 6;
  if (fluents.size() <= kFew) {
    return fmt::format("the paper's rule says nothing of {}", fmt::join(fluents, ", "));
  }
  std::map<std::string, std::size_t> counts;
  for (const auto& fluent : fluents) ++counts[fluent.substr(0, fluent.find('('))];
  std::vector<std::string> parts;
  for (const auto& [symbol, count] : counts) parts.push_back(fmt::format("{} {}", count, symbol));
  return fmt::format("the paper's rule says nothing of {} fluents: {}", fluents.size(),
                     fmt::join(parts, ", "));
}

}  // namespace

std::vector<std::string> caveats(const Tally& tally, const CriterionSpec& spec,
                                 std::optional<std::int64_t> paper_stopped_at) {
  std::vector<std::string> result;
  if (tally.rejected() > 0) result.push_back(rejected_text(tally));
  if (tally.lost() > 0) {
    const auto bound = stated_bound(tally, spec);
    auto text = fmt::format("{} (crash, hang or invalid numbers), counted as discrepancies",
                            base::counted(tally.lost(), "run was lost", "runs were lost"));
    if (bound.confidence_level < spec.confidence_level) {
      text += fmt::format(
          "; the stated confidence is {} instead of {}, as the runs may end with either of two "
          "bounds",
          level_text(bound.confidence_level), level_text(spec.confidence_level));
    }
    result.push_back(std::move(text));
  }
  if (spec.kind == CriterionKind::kPaper && paper_stopped_at &&
      !tally.frame().not_covered.empty()) {
    result.push_back(not_covered_text(tally.frame().not_covered));
  }
  return result;
}

std::string paper_variant(const Tally& tally, const PaperRuleSpec& spec) {
  const auto& ranges = tally.frame().x_range;
  const auto varying = std::count_if(ranges.begin(), ranges.end(),
                                     [](const Interval& range) { return range.width() > 0.0; });
  return fmt::format("{}, n = {}", spec.preset, varying);
}

}  // namespace parallax::harness
