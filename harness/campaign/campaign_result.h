#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/campaign/cover_watch.h"
#include "harness/campaign/sample_record.h"
#include "harness/campaign/search_result.h"
#include "harness/campaign/start_law.h"
#include "harness/campaign/start_result.h"
#include "harness/campaign/trace_input.h"
#include "harness/confidence/comparison.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/confidence/spending.h"
#include "harness/region/start_share.h"
#include "harness/region/state_mapping.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

struct SecondOpinion;  // second_opinion.h

enum class CampaignVerdict : std::uint8_t { kNoDiscrepancy, kDiscrepancy, kInconclusive };
inline constexpr auto kCampaignVerdictWords =
    base::word_table<CampaignVerdict>("no-discrepancy", "discrepancy", "inconclusive");
constexpr std::string_view to_string(CampaignVerdict verdict) {
  return kCampaignVerdictWords.of(verdict);
}

/// A fluent on which the trace and the observation disagree.
struct DivergingFluent {
  std::string fluent;
  std::int64_t timepoint = 0;
  bool predicted = false;
  bool observed = false;
  std::string measured = {};  // "robot.x = 0.313 m, 87 mm below [0.4, 0.8]"; may be empty
};

/// The reason why a simulation left its trace: the action that failed there, or else the fluents
/// that changed.
struct Cause {
  std::string text;  // "Go(bTable): navigation-pose-unreachable", "Go(bTable): not Holding(left,m)"
  std::string reason = {};                // in the simulator's words; empty where no action failed
  std::string event = {};                 // after which it left; empty: at the start
  std::vector<std::string> fluents = {};  // fluents that differed there
};

/// How often one cause was the first to lead a simulation away from what was predicted.
struct CauseRate {
  std::string cause;  // "Go(bTable): navigation-pose-unreachable"
  std::int64_t count = 0;
  double rate = 0.0, lower = 0.0, upper = 0.0;  // Clopper and Pearson 1934
  std::int64_t example = 0;                     // number of the first such sample
  std::string reason;                           // what that one said
  State start;                                  // how that one began
  std::string event = {};
  std::vector<std::string> fluents = {};  // that differed there in each of these samples
  std::string kind = {};                  // of the cause, where it was asked for
};

/// The result of repeating a discrepancy once before it was accepted.
enum class RepeatResult : std::uint8_t { kBitEqual, kDiffers, kLost };

/// Does the simulation end otherwise than its trace, or did it just differ on the way?
enum class DiscrepancyKind : std::uint8_t { kLasting, kTransient };
inline constexpr auto kDiscrepancyKindWords =
    base::word_table<DiscrepancyKind>("lasting", "transient");
constexpr std::string_view to_string(DiscrepancyKind kind) {
  return kDiscrepancyKindWords.of(kind);
}

/// The point where an executed plan left the paths of the model.
struct PathDivergence {
  std::int64_t event = 0;   // number of the last one of the shortest prefix that cannot go on
  bool impossible = false;  // the model has no such event there
  bool outcome = false;     // it lets the event end otherwise only
  /// None of the fluents is impossible by itself: no state has these values together.
  bool together = false;
};

/// Runs that went the same way: the same events with the same outcomes.
struct PathCount {
  std::vector<std::string> events;    // "Detect(cup)=cup1"
  std::vector<std::string> outcomes;  // "ok", or the condition
  PathEnd end = PathEnd::kDone;
  std::string detail;
  std::int64_t runs = 0;
  std::int64_t example = 0;  // the first such sample
};

/// The result of executing a plan, in addition to that of any stream of samples.
struct LoopResult {
  std::int64_t initial_states = 0;
  bool has_weights = false;  // they are drawn by weights, else each is equally likely
  /// Runs that began where the start was chosen, not drawn: no claim is about them. None: all were
  /// to be drawn.
  std::optional<std::int64_t> guided;
  std::int64_t unfinished = 0;   // runs that a limit ended, or the end of the unrolling
  std::string why_unfinished;    // of the first
  std::vector<PathCount> paths;  // in the order in which they came
  /// With --keep-going: how often each cause ended what the model admits, most frequent first.
  std::vector<CauseRate> causes;
  double causes_level = 0.0;         // confidence of their intervals
  std::int64_t causes_runs = 0;      // the first ones with a drawn start, which they are counted in
  std::int64_t causes_unseen = 0;    // of these, what was not seen to its end, or not made
  std::optional<CoverResult> cover;  // where a run goes on until everything was shown
};

struct Discrepancy {
  DiscrepancyKind kind = DiscrepancyKind::kLasting;
  std::int64_t trace = 0;
  std::int64_t sample = 0;
  std::uint64_t seed = 0;                // handed to the simulator at reset
  std::int64_t first_divergence = 0;     // first timepoint at which some mapped fluent differs
  std::vector<DivergingFluent> first;    // what differs there
  std::vector<DivergingFluent> fluents;  // what differs at the last timepoint; empty if transient
  Cause cause;
  RepeatResult confirmation = RepeatResult::kBitEqual;
  std::optional<PathDivergence> path;  // of an executed plan
  SampleRecord record;
  State end;  // the variables that were compared, as last observed
};

/// The outcome of repeating a clean simulation with the same start and seed.
struct Repetition {
  enum class Outcome : std::uint8_t {
    kSame,       // to the last bit
    kOtherBits,  // clean, but not the same
    kNotClean,
    kLost,
    kRefused,  // its start, or a request
  };
  bool is_fresh = false;  // in a simulator that was started for it; else after the others
  Outcome outcome = Outcome::kSame;
  std::string detail;  // where it differs, or why it was lost
};
inline constexpr auto kRepetitionWords =
    base::word_table<Repetition::Outcome>("same", "other-bits", "not-clean", "lost", "refused");
constexpr std::string_view to_string(Repetition::Outcome outcome) {
  return kRepetitionWords.of(outcome);
}

/// The repetitions of a run's first clean simulation at its end (harness/campaign/repetition.h).
struct RepetitionResult {
  std::int64_t trace = 0, sample = 0;
  std::vector<Repetition> repetitions;  // that were made

  bool holds() const {
    for (const auto& one : repetitions) {
      if (one.outcome != Repetition::Outcome::kSame &&
          one.outcome != Repetition::Outcome::kOtherBits) {
        return false;
      }
    }
    return true;
  }
};

/// How many simulations were lost for reasons of one kind.
struct LossCount {
  std::string kind;  // loss_kind
  std::int64_t count = 0;
  std::int64_t example = 0;  // number of the first such sample
};

struct TraceResult {
  std::shared_ptr<const CampaignTrace> trace;
  CampaignVerdict verdict = CampaignVerdict::kInconclusive;
  StartResult starts;            // the initial states that were simulated
  bool is_decided = false;       // the criterion was met, whatever the verdict waits for besides
  bool began_elsewhere = false;  // not where starts were drawn (start_echo.h)
  std::vector<SampledDimension> start_region;  // the continuous states that the first stands for
  std::vector<StartShare> start_shares;        // how much of their cells is drawn from
  std::string left_out;          // the part of the region that is never drawn; empty: none
  std::optional<LawResult> law;  // none: starts are uniform
  std::int64_t simulations = 0;  // run and not rejected before they began; lost ones included
  /// The sum over all its simulations, with those that count for no claim and repetitions.
  double simulated_s = 0.0;
  double wall_s = 0.0;  // depends on the clock
  std::int64_t clean = 0;
  std::int64_t admitted = 0;  // of the clean ones: went otherwise, as the model admits
  std::int64_t lost = 0;
  std::vector<LossCount> losses;    // the lost ones by kind, in the order in which they came
  std::int64_t of_the_solver = 0;   // of the lost ones: taken back by the simulator (kOfTheSolver)
  std::string first_of_the_solver;  // why the first of them was
  std::int64_t retried = 0;         // lost at first and observed at the second attempt
  std::int64_t rejected = 0;        // invalid starts that were drawn again
  /// Clean runs that differed on the way, where only the end is compared.
  std::int64_t strayed = 0;
  double certified_level = 0.0;    // C
  double certified_epsilon = 1.0;  // with confidence C, p is below this
  double error_share = 1.0;        // of 1-C that the bound may spend
  CertifiedBound stated;           // by the criterion itself
  CertifiedBound shared;           // the same with the trace's share of the error
  std::optional<std::int64_t> paper_stopped_at;
  std::string paper_variant;                  // "paper-literal, n = 2"
  std::optional<PaperFigures> paper_figures;  // with the criterion `paper`, after the last run
  std::vector<std::string> not_covered;       // fluents without regression evidence
  std::optional<SearchResult> search;         // before the simulations above, which are all draws
  std::optional<LoopResult> loop;             // of executed plans, which have no trace
  std::string claim;                          // exactly what is claimed, one sentence
  std::vector<std::string> caveats;           // what weakens the claim, one sentence each
};

/// Coverage of one kind of thing in plan or model by the simulations.
struct CoverageShare {
  std::string group;  // "performs", "branches", "axioms", ...
  std::int64_t covered = 0;
  std::int64_t all = 0;
};

/// Everything a report needs. Only `timing`, and `wall_s` of traces, depend on the clock.
struct CampaignResult {
  std::string scenario;  // as the user wrote it
  std::string title;     // what the scenario calls itself; may be empty
  std::uint64_t seed = 0;
  CampaignVerdict verdict = CampaignVerdict::kInconclusive;
  /// "all traces explored", "complete up to bound", "stopped"; where a plan is executed until
  /// everything was shown, "all shown".
  std::string exploration;
  std::vector<std::string> bounds;  // what was not followed, if complete up to a bound
  bool interrupted = false;         // the stop flag was raised, or an error ended it
  bool failed = false;              // an error ended it, after the traces that are here
  bool journal_open = false;  // if not, the run folder is not this run's, or holds nothing of it
  CriterionSpec criterion;
  /// How the traces share the error. None: each is claimed by itself, or the run ended before that
  /// was of interest.
  std::optional<SpendingRule> spending;
  std::string claim;  // of all traces together, one sentence; empty: there is none
  Comparison comparison = Comparison::kEveryStep;
  Execution execution = Execution::kOpenLoop;
  std::vector<ComparedFluents> compared;  // by symbol
  SimulatorInfo simulator;
  /// The construction of the built-in mobile robot: its arms and its base. Empty: there is no such
  /// robot.
  std::string arms;
  std::string tool_version;
  std::string replay_folder;  // run folder as the user wrote it
  std::vector<TraceResult> traces;
  std::vector<Discrepancy> discrepancies;
  RepetitionResult repetition;   // of the first clean simulation
  std::vector<KindCount> kinds;  // of workers, where they may be several
  std::shared_ptr<const SecondOpinion>
      second_opinion;                   // of another simulator; null: none was asked
  std::vector<CoverageShare> coverage;  // shares of the items that exist; none: not measured
  std::int64_t simulations = 0;
  double simulated_s = 0.0;  // of all traces, whether simulated now or read from a journal
  struct Timing {
    double wall_s = 0.0;
    double simulated_s = 0.0;    // by runs made now, not by those read from a journal
    std::int64_t runs_made = 0;  // the same
  } timing;
};

}  // namespace parallax::harness
