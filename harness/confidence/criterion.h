#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/confidence/comparison.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/confidence/paper_rule.h"
#include "harness/confidence/spending.h"
#include "harness/confidence/tally.h"

namespace parallax::harness {

/// The decision of a criterion after the runs so far.
struct Decision {
  bool stop = false;                        // enough clean runs: no discrepancy found
  std::string why;                          // "90 clean runs of 90 needed", "paper's rule: ..."
  std::optional<std::int64_t> runs_needed;  // total, as far as it is known without new failures
  std::optional<PaperVerdict> paper;        // of the criterion `paper`
};

/// When to stop simulating one trace. Looked at after every run, in order of the sample index.
class ConfidenceCriterion {
 public:
  virtual ~ConfidenceCriterion() = default;
  virtual Decision decide(const Tally& tally) const = 0;
  /// May one look after every run without spoiling what is stated? If not, the stated level is
  /// not the probability of a false stop.
  bool is_anytime_valid() const { return may_be_watched(kind()); }
  virtual CriterionKind kind() const = 0;
};

/// `confidence_level` and `epsilon` of the spec in (0, 1). Of one trace: by the error it may spend.
/// None goes on after a mismatch; lost runs count as failures.
/// clean-runs: stop after ceil(ln(1-C) / ln(1-eps)) runs if all were clean, after lost ones when
/// the mixture bound reaches eps.
/// anytime: stop when the mixture bound (Ville 1939; log_mixture_wealth) reaches eps, with any
/// number of lost runs. One procedure with one bound, so its level stays C after a loss.
/// clopper-pearson: make a number of runs that is fixed in advance and look once: stop if the bound
/// of Clopper and Pearson (1934) is at most eps.
/// paper: stop when the paper's rule holds for the clean runs; never after a lost run.
std::unique_ptr<ConfidenceCriterion> make_criterion(const CriterionSpec& spec);

/// The bound that holds beside any criterion. Without failures: bound_after(clean) at C. With
/// failures (lost runs and mismatches): mixture_upper at C, stated with 1 - 2(1-C), as a procedure
/// that may end with either bound errs with at most the sum of both chances. With a `share` of the
/// error the bound is that of 1 - (1-C) share, and what is stated is the confidence in the bounds
/// of all traces together.
CertifiedBound certified_bound(const Tally& tally, double confidence_level, double share = 1.0);

/// The bound that the criterion itself states for these runs: for `anytime` the mixture's bound at
/// C, for `clopper-pearson` its bound at C once all its runs were made. Otherwise the certified
/// bound.
CertifiedBound stated_bound(const Tally& tally, const CriterionSpec& spec);

/// The initial states of the model that starts begin in.
struct DrawnStates {
  Initial law = Initial::kAll;
  std::optional<std::int64_t> all = 1;  // none: more than can be listed
  std::int64_t tried = 1;
  std::int64_t unrealisable = 0;  // besides: those that no start of the world can be
  /// They are those of several traces, each of which has a number of its own: `all` is 1, and
  /// `tried` is 1 if each was tried, else 0.
  bool differ = false;
};

/// The law by which starts are drawn, in words.
struct DrawnStarts {
  DrawnStarts() = default;
  DrawnStarts(std::string the_law, std::string the_rest)
      : law(std::move(the_law)), left_out(std::move(the_rest)) {}

  std::string law{};  // where they are not drawn uniformly
  /// The part of the region that is never drawn: "its rim (`inset_m`: 0.05)". Empty: none.
  std::string left_out{};
  DrawnStates initial{};
};

/// Exactly what the runs of one trace support, as one sentence without a full stop: "with 99 %
/// confidence, fewer than 5 % of start states drawn uniformly from the start region give a
/// discrepancy (90 clean runs of 90), supposing that no run affects another". Figures are rounded
/// up, so never beyond the evidence.
std::string claim(const Tally& tally, const CriterionSpec& spec, Comparison comparison,
                  const DrawnStarts& drawn = {});
/// "start states drawn uniformly from the start region", or "starts (one of the 6 initial states
/// that lead to its events, each equally likely and each tried; then drawn uniformly from its
/// region)". Without the numbers where they differ. `valid`: only of valid ones.
std::string starts_text(std::string_view region, const DrawnStarts& drawn, bool valid);
/// "; in each single initial state fewer than 30 %", where `epsilon` bounds the mean of them;
/// empty where nothing follows for a single one.
std::string single_state_text(const DrawnStates& states, double epsilon);
/// "drawn uniformly from the start region", or the law and the drawn part of the region.
std::string drawn_from(std::string_view region, const DrawnStarts& drawn);
/// The supposition of every claim about how often runs go wrong, which ends its sentence.
inline constexpr std::string_view kSupposition = ", supposing that no run affects another";

/// The initial states that executions begin in, how many of them were tried, and whether they are
/// drawn by weights.
struct StartLaw {
  std::int64_t initial_states = 0, tried = 0;
  bool has_weights = false;
  DrawnStarts drawn{};
  std::int64_t without_start = 0;  // besides: initial states that no start can be
};
/// The same of executions of a plan from any of the model's initial states: "with 99 % confidence,
/// fewer than 5 % of executions of the plan from 3 initial states, each equally likely and each
/// tried, then drawn uniformly from its region, leave what the model admits at any step (90 clean
/// runs of 90)".
std::string loop_claim(const Tally& tally, const CriterionSpec& spec, Comparison comparison,
                       const StartLaw& starts);

/// The caveats of the claim, one sentence each: rejected starts, lost runs, and fluents without
/// regression evidence if the paper's rule was satisfied after `paper_stopped_at` runs.
std::vector<std::string> caveats(const Tally& tally, const CriterionSpec& spec,
                                 std::optional<std::int64_t> paper_stopped_at);

/// "paper-literal, n = 2": the reading of the paper's rule and its number of varying initial
/// parameters.
std::string paper_variant(const Tally& tally, const PaperRuleSpec& spec);

}  // namespace parallax::harness
