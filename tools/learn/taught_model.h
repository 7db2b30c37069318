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

namespace parallax::tools {

/// The model that all runs so far have taught.
class TaughtModel {
 public:
  /// The declarations of the scenario's model, of which no run is known yet. `context` outlives the
  /// object. Reports kUsage where the declarations by themselves are no model.
  static base::Result<std::unique_ptr<TaughtModel>> make(const ScenarioModel& loaded,
                                                         const std::string& scenario,
                                                         Context& context);

  /// Takes runs of a round into account; their ids become "3/1.4".
  void add(std::vector<ObservedPath> paths, const compiler::CompiledModel& model,
           std::int64_t round);
  void add(Evidence run, std::int64_t round);
  /// The model that explains them all; the one before if it was stopped meanwhile.
  void relearn();

  const std::string& text() const { return text_; }
  std::vector<std::string> axioms() const;  // about events, printed
  const std::vector<Evidence>& runs() const { return runs_; }
  const std::vector<std::string>& contradictions() const { return effects_.contradictions; }
  std::size_t dropped() const { return declarations_.dropped; }
  RunsCheck check(const std::vector<Evidence>& runs) const;
  /// What runs cannot teach, or have not taught, in words.
  std::vector<std::string> not_learned() const;

 private:
  TaughtModel(std::string scenario, Context& context)
      : scenario_(std::move(scenario)), context_(context) {}
  void leave_off(const std::string& id, std::size_t t);

  std::string scenario_;
  Context& context_;
  std::unique_ptr<DomainModel> domain_;
  Declarations declarations_;
  std::unique_ptr<LearnVocabulary> vocabulary_;
  std::optional<compiler::CompiledModel> states_;
  std::unique_ptr<StateCompletion> completion_;
  std::unique_ptr<Observations> observations_;
  std::vector<Evidence> runs_;
  std::set<std::string> attempted_;  // symbols of events
  LearnedEffects effects_;
  std::string text_;
  std::size_t left_off_ = 0;
  std::string first_left_off_;
};

}  // namespace parallax::tools
