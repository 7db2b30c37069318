#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/app/observed_path.h"
#include "tools/app/scenario_model.h"
#include "tools/learn/learned_model.h"
#include "tools/learn/state_axioms.h"

namespace parallax::tools {

/// The model learned from all runs so far.
class TaughtModel {
 public:
  /// The declarations of the scenario's model, of which no run is known yet. `context` outlives the
  /// object. Reports kUsage where the declarations by themselves are no model.
  static base::Result<std::unique_ptr<TaughtModel>> make(const ScenarioModel& loaded,
                                                         const std::string& scenario,
                                                         Context& context);

  /// Adds runs of a round; their ids become "3/1.4". `from_outcomes`: symbols of unobserved fluents
  /// with values from outcomes (add_outcome_facts).
  void add(std::vector<ObservedPath> paths, const compiler::CompiledModel& model,
           std::int64_t round, const std::set<std::string>& from_outcomes);
  void add(Evidence run, std::int64_t round);
  /// The model that explains them all; the one before if it was stopped meanwhile.
  void relearn();
  /// Takes the added runs as further evidence for the same model.
  void confirm() { settle_states(false); }

  const std::string& text() const { return text_; }
  std::vector<std::string> axioms() const;  // about events, printed
  /// The same, and what is left of the formulas about states.
  std::vector<std::string> all_axioms() const;
  const std::vector<Evidence>& runs() const { return runs_; }
  const std::vector<std::string>& contradictions() const { return effects_.contradictions; }
  std::vector<RefutedFormula> refuted() const { return axioms_->refuted(); }
  /// Does the model leave an outcome open?
  bool leaves_open() const;
  std::size_t dropped() const { return declarations_.dropped; }
  RunsCheck check(const std::vector<Evidence>& runs) const;
  /// Describes what runs cannot teach, or have not taught.
  std::vector<std::string> not_learned() const;

 private:
  TaughtModel(std::string scenario, Context& context)
      : scenario_(std::move(scenario)), context_(context) {}
  void leave_off(const std::string& id, std::size_t t);
  void settle_states(bool learns = true);

  std::string scenario_;
  Context& context_;
  std::unique_ptr<DomainModel> domain_;
  Declarations declarations_;
  std::unique_ptr<LearnVocabulary> vocabulary_;
  std::unique_ptr<StateAxioms> axioms_;
  std::optional<std::size_t> version_;  // of the formulas that what follows was made of
  std::optional<compiler::CompiledModel> states_;
  std::unique_ptr<StateCompletion> completion_;
  std::unique_ptr<Observations> observations_;
  std::vector<Evidence> seen_;            // as it was
  std::vector<Evidence> runs_;            // up to where no state of the model looks like it
  std::set<std::string> attempted_;       // symbols of events
  std::set<std::string> from_outcomes_;   // symbols of fluents
  std::vector<std::string> in_no_state_;  // "run 1/1.1 at 3", told by the mapping
  std::vector<std::string> left_off_;     // the same, and by the formulas about states
  LearnedEffects effects_;
  std::string text_;
};

}  // namespace parallax::tools
