#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/session/solver_session.h"
#include "tools/app/context.h"
#include "tools/app/observed_path.h"

namespace parallax::tools {

/// Observations of recorded runs that went the same way: by names, for models with other
/// numberings.
struct Evidence {
  struct Step {
    std::string event;
    bool failed = false;  // the world did not do it
    std::string reason;   // in its words
    friend bool operator==(const Step&, const Step&) = default;
  };
  using State = std::map<std::string, bool>;  // what was seen, by fluent
  bool executed = false;                      // the plan was, in closed loop
  std::vector<Step> steps;
  std::vector<State> states;     // one more than steps
  std::vector<std::string> ids;  // of the runs: "1.4"; of experiments "e1.4"
  /// The first timepoint that the model cannot reach like that; none: it admits all of it.
  std::optional<std::size_t> divergence;
  /// Later observations are set aside: another run went the same way and failed.
  std::optional<std::size_t> until;

  std::size_t runs() const { return ids.size(); }
  /// The timepoints that a repaired model has to admit: up to the divergence, as it may not be the
  /// only mistake.
  std::size_t needed() const { return until.value_or(seen_to()); }
  std::size_t seen_to() const { return divergence.value_or(steps.size()); }
};

/// The paths as evidence, equal ones merged, without their divergence. In the order of the first
/// run of each.
std::vector<Evidence> evidence_of(const std::vector<ObservedPath>& paths,
                                  const compiler::CompiledModel& model);

/// Adds literals for the first `states` observed states. False: one of them has a true fluent that
/// the model does not know.
bool add_states(const compiler::AtomIndex& index, const Evidence& evidence, std::size_t states,
                std::vector<compiler::Literal>& out);

/// Asks a model without a plan how far it admits the evidence.
class EvidenceAdmission {
 public:
  /// The model, and `stop`, outlive the object.
  EvidenceAdmission(const compiler::CompiledModel& model, const std::atomic<bool>& stop);

  struct Answer {
    std::size_t reached = 0;  // the last timepoint up to which it goes
    bool start = true;        // it can begin like that
    bool whole = false;
    /// The model says that the event at step `refuse_at` cannot happen, and goes on without it.
    bool refused = false;
    bool stopped = false;
  };
  /// `refuse_at`: a step whose event the world refused, which the model may forbid.
  Answer ask(const Evidence& evidence, std::optional<std::size_t> refuse_at = std::nullopt);
  /// Only whether it goes to the end, which takes fewer calls where it does not.
  Answer ask_whole(const Evidence& evidence, std::optional<std::size_t> refuse_at);

  /// A fluent of these symbols that the model leaves open on the evidence: with the same events,
  /// and the same values of all others, it may be otherwise. Up to a last event that failed.
  std::optional<std::string> left_open(const Evidence& evidence,
                                       const std::set<std::string>& symbols);

  /// The fluents observed at `t` that are each impossible in the model after the observations
  /// before; all fluents observed there if none of them is impossible by itself.
  Evidence::State impossible(const Evidence& evidence, std::size_t t);

 private:
  std::optional<std::vector<compiler::Literal>> facts(const Evidence& evidence, std::size_t steps,
                                                      std::size_t states,
                                                      std::optional<std::size_t> without);
  runtime::SolveStatus goes(const Evidence& evidence, std::size_t t,
                            std::optional<std::size_t> without);
  bool possible(const Evidence& evidence, std::size_t t, std::optional<std::size_t> without,
                Answer& answer);
  bool refuses(const Evidence& evidence, std::size_t step, Answer& answer);

  runtime::SolverSession session_;
  compiler::AtomIndex index_;
  std::vector<std::uint32_t> undemanded_;  // slots of events
};

/// Does the reason say that the simulator's world cannot do the action at all?
bool says_not_possible(const std::string& reason);

}  // namespace parallax::tools
