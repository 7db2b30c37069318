#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/campaign/campaign_result.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/report/run_report.h"

namespace parallax::harness {
struct Recording;
}  // namespace parallax::harness

namespace parallax::tools {

/// Verdict on a simulation, as far as the run folder tells.
enum class PageVerdict : std::uint8_t { kClean, kDiscrepancy, kLost, kNotJudged };

/// Origin of a simulation's start. Claims are about drawn starts alone.
enum class SampleOrigin : std::uint8_t {
  kDrawn,
  kChosen,   // for what it leads to
  kSearch,   // of the search before the claim
  kFurther,  // made by `explain`, after the run
};

/// An axiom or a line of the plan, as a text has it.
struct PagePlace {
  std::string place;  // "domain.e:12"; empty for what no text says
  std::string text;   // on one line; may be empty
};

/// An event of a trace or a perform of an executed plan; of a simulation with its outcome.
struct PageStep {
  std::string event;
  std::string source;   // "fetch.lisp:4"
  std::string outcome;  // "ok", "failed", ...; empty where nothing was simulated
  std::string reason;
  std::optional<double> sim_time_s;
};

/// One fluent over the timepoints of a simulation. A character for each timepoint: '1' holds, '0'
/// does not, 'n' neither, '-' not known or not compared.
struct TimelineRow {
  enum class Role : std::uint8_t { kAgrees, kFirst, kFollows };
  std::string fluent;
  std::string predicted, observed;
  Role role = Role::kAgrees;
  bool changes = false;
};

struct PageTimeline {
  std::int64_t trace = 0, sample = 0;
  PageVerdict verdict = PageVerdict::kClean;
  std::vector<PageStep> steps;
  std::vector<TimelineRow> rows;       // those that differ first
  std::optional<std::size_t> parting;  // timepoint of the first difference
};

/// How often one cause ended simulations; rates with their interval.
struct PageCause {
  std::string cause;
  std::int64_t count = 0;
  double rate = 0.0, lower = 0.0, upper = 0.0;
};

/// A way that executions of the plan went.
struct PagePath {
  std::string steps, end;  // "Go(r2) ok, Grasp(milk) failed"
  std::int64_t simulations = 0, example = 0;
};

/// The results of the runs from one initial state of a trace.
struct PageState {
  std::int64_t number = 0;
  std::string holds;
  std::int64_t clean = 0, lost = 0, discrepancies = 0;
};

struct PageTrace {
  std::int64_t number = 0;
  std::vector<PageState> states;  // where it has several initial states
  std::string all_states;         // how many those are; "more than 10000"
  std::string verdict;  // "no-discrepancy", "discrepancy", "inconclusive"; empty: not known
  std::string claim;
  std::vector<std::string> initial_state;  // what holds at the start
  std::vector<std::string> caveats;
  std::int64_t simulations = 0, clean = 0, lost = 0;
  std::vector<harness::LossCount> losses;  // the lost ones by reason
  double certified_confidence = 0.0, certified_epsilon = 1.0;
  double error_share = 1.0;  // of 1-C that its bound may spend
  std::optional<std::int64_t> paper_stopped_at;
  std::string paper_variant;
  std::vector<std::string> not_covered;
  std::vector<PageStep> steps;
  std::vector<PageCause> causes;
  // For executions of the plan.
  std::int64_t chosen_starts = 0, unfinished = 0;
  std::string covered;  // the result of running until everything was shown
  std::vector<PagePath> paths;
};

/// Where a body was at each timepoint; empty where it is not known.
using BodyWay = std::vector<std::array<float, 2>>;

struct PageSample {
  std::int64_t trace = 0, sample = 0;
  std::int64_t start_state = 0;  // number of the trace's initial state; 0: the only one
  std::uint64_t seed = 0;
  PageVerdict verdict = PageVerdict::kNotJudged;
  SampleOrigin origin = SampleOrigin::kDrawn;
  bool unfinished = false;  // a limit ended it: nothing is said of it
  std::string cause;
  std::int64_t events = 0, retries = 0;
  double sim_time_s = 0.0;
  std::vector<double> start;  // by PageData::variables; NaN where there is none
  std::vector<BodyWay> ways;  // by PageData::bodies

  /// Did it begin in the initial state of this number? 0 is the first one.
  bool began_in(std::int64_t state) const {
    return start_state == state || (start_state <= 1 && state <= 1);
  }
};

struct PageRegion {
  std::string name;
  std::optional<std::array<double, 2>> x, y;  // none: not bounded there
  bool moves = false;  // it is one of a body's frame, drawn where that starts
  std::optional<std::array<double, 2>> z;
  std::string frame;  // that body
  std::array<double, 3> frame_start{};
};

/// The recorded motion of one simulation.
struct PageMotion {
  std::int64_t trace = 0, sample = 0;
  PageVerdict verdict = PageVerdict::kNotJudged;
  std::string cause;
  std::optional<std::size_t> parting;  // timepoint of the first difference
  std::shared_ptr<const harness::Recording> recording;
};

/// A border of the rule that tells failing simulations.
struct PageBorder {
  std::string variable;
  double value = 0.0;
  bool above = true;
};

/// Where in the start region simulations fail like the first discrepancy.
struct PageRule {
  std::vector<PageBorder> borders;
  std::int64_t failures_inside = 0, failures = 0, clean_inside = 0, clean = 0;
};

/// Why the model cannot follow, as `explain` tells it.
struct PageBlame {
  std::string words, more;
  std::vector<PagePlace> axioms;
  std::string where;         // the initial states that it fails in
  std::string cause;         // the kind of cause in words, by the runs on record
  bool cause_first = false;  // runs from one start contradict each other
};

/// Finding of `confirm` or `threshold` about one simulation.
struct PageFinding {
  std::string sample;  // "2.4"
  std::vector<std::string> sentences;
};

struct PageProposal {
  std::string words, patch;
  std::vector<std::string> facts;  // sentences
  std::vector<std::size_t> tied;   // numbers of those that nothing tells from it
  bool precaution = false;
  std::string changes;  // "model", "plan", ...
};

struct PageSource {
  std::string name, text;
};

/// The ledger's entries for the run, and the properties of its scenario that rest on them.
struct PageLedger {
  struct Row {
    std::string id, is, words;  // the entry; how it stands; what the run showed
    bool is_wrong = false;      // not known, or repaired and back
  };
  std::string file;
  std::vector<Row> rows;
  std::vector<std::string> gone;  // sentences
  struct Property {
    std::string formula, answer;
    bool holds = false, asks_for_review = false;  // it rests on an open discrepancy
    std::vector<std::string> rests_on;            // sentences
  };
  std::vector<Property> properties;
};

/// A cell in the plane of two variables of the start, with the shares of the volume above it.
struct PageProofPart {
  std::array<double, 2> x{}, y{};
  double safe = 0.0, refuted = 0.0;  // the rest is open
};

/// Map of where a test passes and where it refuses, over the two variables that it depends on most.
struct PageProofMap {
  std::string x_name, y_name;
  std::array<double, 2> x{}, y{};
  bool is_exact = false;  // parts are boxes of the proof, which no other variable divides
  std::vector<PageProofPart> parts;
};

/// Proof of one test of a controller, from a certificate.
struct PageProofTest {
  std::string function, source, asks;
  std::vector<std::string> assumed;
  double safe = 0.0, refuted = 0.0, open = 0.0;
  std::optional<PageProofMap> map;
  /// Simulations of drawn starts by the box that they began in: safe, refuted, open.
  struct Began {
    std::int64_t simulations = 0, not_clean = 0;
  };
  std::array<Began, 3> began{};
};

struct PageProofAction {
  std::string event;
  std::string left_to_simulation;  // why
  std::vector<PageProofTest> tests;
};

/// A certificate of `prove` that lies in the run folder.
struct PageProof {
  std::string file, check;  // its name; the command that confirms it
  std::int64_t trace = 0;
  std::int64_t initial_state = 0;  // number of the trace's initial state; 0: the only one
  std::string holds;               // what tells that one from the others
  bool stopped = false;            // before it was done
  std::vector<PageProofAction> actions;
};

/// Everything that the page of one run folder shows.
struct PageData {
  std::string folder;  // as the user named it
  std::string scenario, verdict, exploration, simulator, criterion, tool_version;
  std::uint64_t seed = 0;
  std::int64_t simulations = 0;
  bool interrupted = false, closed_loop = false;
  bool running = false;  // there is no report yet
  double confidence = 0.99, epsilon = 0.05;
  std::string claim;                 // of all traces together; empty: there is none
  std::vector<std::string> bounds;   // what was left out, a sentence each
  std::vector<std::string> ignored;  // fluents that are not compared
  harness::CriterionSpec asked;      // the criterion, of a trace by itself
  bool is_paper = false;             // the criterion that ends a trace is the paper's
  std::vector<std::string> banners;  // what is missing or wrong, one sentence each
  std::vector<PageTrace> traces;
  std::vector<harness::ReportedDiscrepancy> discrepancies;
  std::vector<std::array<std::string, 3>> coverage;  // group, covered, all
  std::vector<PageTimeline> timelines;
  std::size_t timelines_left_out = 0;
  std::vector<std::string> variables;  // of the starts, those that differ between simulations
  std::vector<std::string> bodies;     // that starts place
  std::vector<PageSample> samples;
  std::vector<PageRegion> regions;
  std::vector<std::array<std::array<double, 2>, 4>> furniture;  // seen from above [m]
  std::vector<PageSource> sources;
  /// By event symbol, the axioms that speak of it.
  std::vector<std::pair<std::string, std::vector<PagePlace>>> axioms;
  std::vector<PageMotion> motion;  // of some simulations
  std::size_t motion_left_out = 0;
  std::optional<std::pair<std::int64_t, std::int64_t>> not_recorded;  // that one would want to see
  std::optional<PageLedger> ledger;
  std::optional<PageBlame> blame;
  std::vector<PageFinding> findings;
  std::string opinion_of;                      // another simulator: "mujoco 2.2.2"
  std::vector<std::string> opinion_sentences;  // what that said
  std::vector<PageProof> proofs;
  std::optional<PageRule> rule;
  std::vector<PageProposal> proposals;
  bool repair_was_asked = false;
  std::string repair_words;               // where there are no proposals
  std::vector<std::string> repair_notes;  // what runs refuted, and what they leave open
  /// None: the folder has nothing that could be shown.
  bool empty() const { return traces.empty() && samples.empty() && verdict.empty(); }
};

/// "2.4"
std::string sample_name(std::int64_t trace, std::int64_t sample);
inline constexpr auto kPageVerdictWords =
    base::word_table<PageVerdict>("clean", "discrepancy", "lost", "not judged");
constexpr std::string_view to_string(PageVerdict verdict) { return kPageVerdictWords.of(verdict); }
inline constexpr auto kSampleOriginWords =
    base::word_table<SampleOrigin>("drawn", "chosen start", "search", "made afterwards");
constexpr std::string_view to_string(SampleOrigin origin) { return kSampleOriginWords.of(origin); }

}  // namespace parallax::tools
