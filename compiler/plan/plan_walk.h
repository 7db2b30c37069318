#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

/// What the registers of a plan hold: names of objects.
using RegisterObjects = std::map<ModelValueId, std::string>;

/// What a location performs: "PickUp(left,spoon1)", without blanks, and what its designator gives a
/// controller; registers by what they hold.
std::string event_text(const PlanLocation& location, const RegisterObjects& registers);
PlanArguments arguments_of(const PlanLocation& location, const RegisterObjects& registers);

/// What a plan asks on its way from one perform to the next.
class PlanSurroundings {
 public:
  virtual ~PlanSurroundings() = default;
  /// Does the guard of the branch hold now?
  virtual bool holds(BranchId branch, const RegisterObjects& registers) = 0;
  /// Any number below `count`, which is at least 2: which way a free choice goes.
  virtual std::uint64_t choose(std::uint64_t count) = 0;
};

/// One execution of a plan: a walk through its graph. The world decides what becomes of a perform,
/// the surroundings what lies between two of them.
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

  /// Goes silently to the next perform or end. Of the ways that free choices leave, each that an
  /// execution can take is equally likely.
  void go_on(PlanSurroundings& surroundings);

  /// Where control waits for a perform; none at an end, and before `go_on`.
  std::optional<LocationId> location() const;
  /// Where it has ended; none else.
  const PlanTerminal* end() const;
  const RegisterObjects& registers() const { return registers_; }
  /// Of the location.
  std::string event() const;
  /// The branches that control has passed since the last perform began, and which way.
  const std::vector<PlanDecision>& passed() const { return passed_; }

  /// The perform has succeeded, and found that object if it returns one.
  void succeed(const std::string& returned);
  /// It has failed for the reason: the condition that this raises. None, and nothing has changed,
  /// if the binding table names reasons and this is none of them.
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
