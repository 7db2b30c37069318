#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/sampling/sampler.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// How one simulation ended. The last two are no results: no draw of this sample was a valid start;
/// the simulator does not know what it was asked for.
enum class SampleStatus : std::uint8_t { kOk, kLost, kRejected, kRefused };
inline constexpr auto kSampleStatusWords =
    base::word_table<SampleStatus>("ok", "lost", "rejected", "refused");
constexpr std::string_view to_string(SampleStatus status) { return kSampleStatusWords.of(status); }

/// A call of a controller; `arguments` after the plan was laid over the binding.
struct ActionCall {
  std::string controller;
  State arguments;
  double time_limit_s = 0.0;
  friend bool operator==(const ActionCall&, const ActionCall&) = default;
};

/// The outcome of one act.
struct ActionOutcome {
  SimStatus status = SimStatus::kOk;
  std::string reason;
  double sim_time_s = 0.0;
  std::string object = {};  // what it found; kept of executed plans only
  State margins = {};       // by how much it went well or failed, as the simulator names them
  friend bool operator==(const ActionOutcome&, const ActionOutcome&) = default;
};

/// A simulator's words as records hold them, one line without what steers a display: they become
/// part of many sentences. Applied to its own result it changes nothing.
std::string recorded_words(std::string_view words);

/// The word by which a binding table knows why an action failed: what stands in front of the first
/// colon of the reason; without a reason the status, as for an action that its time limit ended;
/// "failed" where the simulator says nothing of a failure and the formula of success does not hold.
std::string reason_word(const ActionOutcome& outcome);

/// How the execution of a plan ended. The last two are no results but errors: the plan knows no
/// condition for a failure's reason, or was not told what a perform found.
enum class PathEnd : std::uint8_t {
  kDone,
  kFailed,        // a condition that nothing handled
  kPerformLimit,  // it would go on
  kTimeLimit,     // likewise
  kCut,           // it came to where its unrolling ended
  kUnboundReason,
  kUnnamedObject,
};
inline constexpr auto kPathEndWords = base::word_table<PathEnd>(
    "done", "failed", "perform-limit", "time-limit", "cut", "unbound-reason", "unnamed-object");
constexpr std::string_view to_string(PathEnd end) { return kPathEndWords.of(end); }

/// One perform of an executed plan, and what the plan was told of it.
struct PathStep {
  std::int64_t step = 0;  // number of the plan's location
  std::string event;      // "Go(r2)"
  std::string source;     // "fetch.lisp:4"
  ActionCall call;
  bool succeeded = false;
  std::string object;     // what it found
  std::string condition;  // what its failure raised
  friend bool operator==(const PathStep&, const PathStep&) = default;
};

/// The path of an executed plan.
struct ExecutedPath {
  std::int64_t start = 0;  // number of the initial state, from 1
  /// The target that the start was chosen for; empty: it was drawn.
  std::string target;
  std::vector<PathStep> steps;
  PathEnd end = PathEnd::kDone;
  std::string detail;  // kFailed: the class; kCut: the form
  friend bool operator==(const ExecutedPath&, const ExecutedPath&) = default;
};

/// One finished simulation: the line of the journal, and all that a replay needs besides the calls.
struct SampleRecord {
  std::int64_t trace = 0;    // from 1
  std::int64_t sample = 0;   // from 1, in order of consumption
  std::int64_t attempt = 0;  // draws of this sample that were rejected before the one used
  DrawPhase phase = DrawPhase::kCertify;  // kConfirm: the repetition of a discrepancy
  bool searched = false;                  // its start was not drawn, but proposed by a search
  /// Its initial state was chosen, because no run that counts had tried it.
  bool visit = false;
  /// Number of the trace's initial state that it begins in, from 1; 0 where there is one only.
  std::int64_t start_state = 0;
  std::uint64_t seed = 0;
  SampleStatus status = SampleStatus::kOk;
  std::int64_t rejected = 0;
  std::int64_t redrawn = 0;  // candidates that conditions of the sampling law refused
  std::int64_t retries = 0;  // attempts that were lost and made again with the same start and seed
  std::string reason;        // why not kOk
  State initial;
  std::vector<State> observations;      // per timepoint; fewer when lost
  std::vector<ActionOutcome> outcomes;  // per event; fewer when lost
  std::string digest;                   // of the last observation
  std::optional<ExecutedPath> path;     // of a plan that was executed
  /// "BUILD/ARITHMETIC" of the worker that made it, where workers may be of several kinds.
  std::string kind = {};
  friend bool operator==(const SampleRecord&, const SampleRecord&) = default;
};

/// How many simulations workers of one kind made.
struct KindCount {
  std::string kind;  // as in SampleRecord
  std::int64_t simulations = 0;
};
/// The kinds of these simulations, sorted; empty where workers were of one kind only.
std::vector<KindCount> count_kinds(std::span<const SampleRecord> records);

/// The seconds that the simulator says its acts took, of all samples together.
double simulated_s(std::span<const SampleRecord> records);

/// Was its start drawn? Claims and rates are about such samples alone.
bool is_drawn(const SampleRecord& record);

/// Was it lost because the simulator took back what it showed (kOfTheSolver)?
bool is_of_the_solver(const SampleRecord& record);

/// The reason of a loss without what differs from run to run: what stands in front of the first
/// colon or bracket, at most 80 bytes. "of the solver", "it ended during `act`".
std::string loss_kind(std::string_view reason);

/// The digest that the last observation shows; empty if it shows none.
std::string digest_of(const SampleRecord& record);

/// Equal to the last bit: 0.0 and -0.0 are not, nor are 1 and 1.0.
bool bit_equal(const Value& a, const Value& b);

/// A value as the shortest decimal that reads back to it, with its bits for a number that is not
/// whole: "0.1 (0x1.999999999999ap-4)".
std::string exact_text(const Value& value);

/// Where two simulations of one start part first, in order of time: outcome of an act, then the
/// observation after it, variables in order of their names.
struct RecordDifference {
  std::int64_t timepoint = 0;
  std::string variable;  // "box.x", or "act: status"
  std::string a, b;      // exact_text, or "absent"
};
std::optional<RecordDifference> first_difference(const SampleRecord& a, const SampleRecord& b);

}  // namespace parallax::harness
