#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

/// Names of the objects that the registers of a plan hold.
using RegisterObjects = std::map<ModelValueId, std::string>;

/// Event of a location, as "PickUp(left,spoon1)" without blanks, and the arguments that its
/// designator gives a controller. Registers are replaced by the objects they hold.
std::string event_text(const PlanLocation& location, const RegisterObjects& registers);
PlanArguments arguments_of(const PlanLocation& location, const RegisterObjects& registers);

/// Answers to the questions of a plan on its way from one perform to the next.
class PlanSurroundings {
 public:
  virtual ~PlanSurroundings() = default;
  /// Does the guard of the branch hold now?
  virtual bool holds(BranchId branch, const RegisterObjects& registers) = 0;
  /// Chooses the way of a free choice: any number below `count`, which is at least 2.
  virtual std::uint64_t choose(std::uint64_t count) = 0;
};

/// One execution of a plan: a walk through its graph. The world decides the outcome of a perform,
/// the surroundings the way between two of them.
///
///     walk.go_on(surroundings)
///     while walk.location():
///       carry walk.event() out
///       walk.succeed(..) or walk.fail(..)
///       walk.go_on(surroundings)
class PlanWalk {
 public:
  /// `graph` outlives the walk.
  explicit PlanWalk(const PlanGraph& graph);

  /// Goes silently to the next perform or end. At free choices, each way on that an execution can
  /// take is equally likely.
  void go_on(PlanSurroundings& surroundings);

  /// The location where control waits for a perform; none at an end, and before `go_on`.
  std::optional<LocationId> location() const;
  /// The terminal where it has ended; null otherwise.
  const PlanTerminal* end() const;
  const RegisterObjects& registers() const { return registers_; }
  /// The event of the location.
  std::string event() const;
  /// The branches that control has passed since the last perform began, and which way.
  const std::vector<PlanDecision>& passed() const { return passed_; }

  /// Notes that the perform succeeded and, if it returns an object, found this one.
  void succeed(const std::string& returned);
  /// Notes that the perform failed for the reason; returns the condition that this raises. None,
  /// and nothing has changed, if the binding table names reasons and this is not one of them.
  std::optional<std::string> fail(std::string_view reason);

 private:
  std::uint64_t ways(const PlanTarget& target, PlanSurroundings& surroundings,
                     std::map<BranchId, std::uint64_t>& known);

  const PlanGraph* graph_;
  PlanTarget at_;
  RegisterObjects registers_;
  std::vector<PlanDecision> passed_;
};

}  // namespace parallax::compiler
