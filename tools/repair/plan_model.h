#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/pipeline/compile.h"
#include "runtime/compare/trace_difference.h"
#include "runtime/session/solver_session.h"
#include "tools/app/edited_scenario.h"
#include "tools/repair/evidence.h"

namespace parallax::tools {

/// A step that did not go as the model says.
struct BadStep {
  Evidence::Step step;
  Evidence::State seen;  // behind it, unlike what the model says
  /// Not empty: the step is bad wherever these hold before it, whatever its outcome.
  Evidence::State where = {};
};

/// Goal that an execution of a plan has to reach.
struct PlanGoal {
  bool constraints = false;  // a state in which the constraints hold
  bool done = false;         // the end of the plan
  std::string event = {};    // that happens on the way; may be empty
  bool any() const { return constraints || done; }
};

/// A model and a plan, compiled together, to be queried for executions.
class PlanModel {
 public:
  using Literals = std::vector<runtime::Literal>;

  /// Compiles the scenario with these texts. None where they are not a valid model or plan: `why`,
  /// and the places of the errors.
  struct Wrong {
    std::string why;
    std::vector<base::SourceRange> places;
  };
  static std::unique_ptr<PlanModel> compile(const harness::Scenario& scenario,
                                            const EditedTexts& texts, Context& context,
                                            Wrong& wrong);

  const compiler::CompiledModel& model() const { return compilation_.model; }
  runtime::ComparedModel& compared() { return compared_; }
  const compiler::PlanGraph& graph() const { return *compilation_.plan; }
  runtime::SolverSession& session() { return session_; }
  compiler::Timepoint horizon() const { return compilation_.model.horizon; }

  /// Literals for: an execution begins like the evidence. None: it cannot.
  std::optional<Literals> start(const Evidence& evidence) const;
  /// Literals for: it goes like the evidence for this number of steps, through this number of
  /// states.
  std::optional<Literals> like(const Evidence& evidence, std::size_t steps,
                               std::size_t states) const;
  /// The performs of an execution that goes like the evidence up to `t`, including the one at `t`.
  std::vector<compiler::LocationId> locations(const Evidence& evidence, std::size_t t);

  /// From now on `clean()` means that no step of an execution is a bad one.
  void set_bad(const BadStep& bad);
  runtime::Literal clean() const { return *clean_; }
  /// Some execution has a bad step. None: the solver was stopped.
  std::optional<bool> can_be_bad();

  /// Solves for an execution of `n` steps that satisfies `facts` and reaches the goal after
  /// timepoint `after`.
  runtime::SolveStatus solve(const PlanGoal& goal, compiler::Timepoint n, Literals facts,
                             std::size_t after = 0);
  /// Is there an execution of more than `after` and at most `horizon` steps that satisfies `facts`
  /// and reaches the goal? None: the solver was stopped. The valuation is that of `length()`.
  std::optional<bool> reaches(const PlanGoal& goal, const Literals& facts, std::size_t after = 0);
  compiler::Timepoint length() const { return length_; }
  const compiler::AtomIndex& index() const { return index_; }

 private:
  PlanModel(compiler::Compilation compilation, const std::atomic<bool>& stop);

  compiler::Compilation compilation_;
  runtime::ComparedModel compared_;
  runtime::SolverSession session_;
  compiler::AtomIndex index_;
  std::optional<runtime::Literal> clean_;
  std::vector<Literals> bad_;  // by timepoint: each means a bad step there
  /// By length and first timepoint: the constraints hold somewhere on the way.
  std::map<std::pair<compiler::Timepoint, std::size_t>, runtime::Literal> hits_;
  std::map<compiler::Timepoint, runtime::Literal> happened_;  // by length: the event of the goal
  compiler::Timepoint length_ = 0;
};

}  // namespace parallax::tools
