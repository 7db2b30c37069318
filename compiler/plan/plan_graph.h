#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/base/id.h"
#include "compiler/base/source_file.h"
#include "compiler/plan/formula_tree.h"

namespace parallax::compiler {

/// The control flow of a plan, compressed so that only its performing locations remain. It knows
/// nothing of Lisp: another plan language can produce the same value. Only a location advances
/// time; branches are silent, and no cycle consists of branches alone. Cycles through locations
/// are possible (a `loop` that comes back to the same state).
struct LocationTag {
  static constexpr bool kOrdered = true;  // order of discovery: success before failure, depth first
};
struct TerminalTag {
  static constexpr bool kOrdered = true;  // order of discovery
};
struct BranchTag {
  static constexpr bool kOrdered = true;  // order of discovery
};
using LocationId = base::Id<LocationTag>;
using TerminalId = base::Id<TerminalTag>;
using BranchId = base::Id<BranchTag>;

/// Where control goes next.
using PlanTarget = std::variant<LocationId, TerminalId, BranchId>;

enum class TerminalKind : std::uint8_t {
  kDone,    // the plan is over
  kFailed,  // a failure that nobody handled; the prefix is a valid execution all the same
  kBound,   // unrolling was cut here: nothing is known of what follows
  kNever,   // no execution comes here: it rules out ways that a free branch could go
};

/// One terminal per kind and detail (kBound: and form).
struct PlanTerminal {
  TerminalKind kind = TerminalKind::kDone;
  std::string detail;                       // kFailed: the failure class; kBound: the form's name
  std::optional<base::SourceRange> source;  // kBound: the form that was cut
};

/// Condition that separates success from failure of a perform at timepoint t. The outcome is never
/// free: control goes on at t+1 along `on_success` where the formula holds, along `on_failure`
/// elsewhere.
struct SuccessCondition {
  /// All parameters and mapping functions have their values: atoms are fluents or predicates over
  /// constants and registers (`RobotAt(r2)`), connectives as in a model.
  FormulaTree formula;
  std::int32_t time_offset = 0;  // evaluated at t (0) or at t+1 (1)
  base::SourceRange source;      // the formula in the binding file
};

/// A designator's argument for a controller: metres, radians, counts or names; a register stands
/// for the name of the object it holds.
using PlanArgument = std::variant<double, std::int64_t, std::string, ModelValueId>;
/// Sorted by name. A pose under key `target` gives target.x, target.y, target.z [m] and target.yaw
/// [rad]; a named object under `object` gives `object`.
using PlanArguments = std::map<std::string, PlanArgument>;

/// A condition that a failed perform can raise where the simulator's reason decides.
struct FailureWay {
  std::string failure_class;
  std::vector<std::string> reasons;
};

/// One `perform`, reached in one particular state of the plan's variables.
struct PlanLocation {
  base::SourceRange source;              // the perform form
  std::vector<base::SourceRange> calls;  // the calls that lead to it, outermost first
  FormulaTree event;                     // "Go(r2)": no blanks
  std::string event_symbol;              // "Go"
  SuccessCondition success;
  std::string failure_class;  // the class of the failure edge
  /// Explored by reason, and the binding names some: `on_failure` leads to free branches, of which
  /// number i goes to what way i does (failure_target). Else empty.
  std::vector<FailureWay> failures;
  base::SourceRange binding;  // the entry of the binding table
  PlanArguments arguments;
  std::optional<ModelValueId> result;  // bound when it succeeds
  PlanTarget on_success;
  PlanTarget on_failure;
};

/// A register for a value that only the model determines: the success formulas of the locations
/// that bind it quantify over it. It keeps the value found last; a plan that still knows an earlier
/// value binds the next one in another register.
struct ModelValue {
  std::string name;      // unique, starts with `?`: "?i1"
  std::string variable;  // the quantified variable of the success formulas: "i"
};

/// A silent decision by the model's state at the timepoint at which control passes through, or a
/// free one: both ways are explored.
struct PlanBranch {
  FormulaTree guard;   // as in SuccessCondition, evaluated at the current timepoint
  std::string choice;  // free: what is chosen
  base::SourceRange source;
  PlanTarget if_true;
  PlanTarget if_false;
  bool free = false;  // nothing decides
  /// For people.
  const std::string& text() const { return free ? choice : guard.text; }
};

/// A clause of `with-failure-handling` that some way through the plan has around it.
struct PlanHandler {
  std::vector<std::string> failure_classes;
  base::SourceRange source;
  std::vector<LocationId> failures;  // performs whose failure it handles; sorted
  /// The ways handled for performs that fail by reason, each a place in their `failures`; sorted.
  std::vector<std::pair<LocationId, std::size_t>> ways;
  bool otherwise = false;  // also handles failures that the plan itself signals or hands on
};

/// kOrder: orders of branches that the graph leaves out. kMeaning: a form that the graph takes in
/// another way than the real language may.
enum class GapKind : std::uint8_t { kOrder, kMeaning };

/// A place at which executions of the real plan may differ from those of the graph. No claim about
/// all executions of such a plan is proved.
struct PlanGap {
  std::string text;  // a noun: "the other orders of `par`"
  base::SourceRange source;
  GapKind kind = GapKind::kOrder;
};

struct PlanGraph {
  PlanTarget entry = TerminalId(0);  // an empty plan goes straight to a terminal
  base::Store<LocationId, PlanLocation> locations;
  base::Store<TerminalId, PlanTerminal> terminals;
  base::Store<BranchId, PlanBranch> branches;
  base::Store<ModelValueId, ModelValue> values;
  /// Registers that have any value of their sort from the beginning: free variables of the call
  /// that the plan begins with.
  std::vector<ModelValueId> inputs;
  std::vector<PlanHandler> handlers;  // in the order of the text
  std::vector<PlanGap> gaps;          // in the order of the text
};

/// Where control goes when the perform fails the way of this number (0 if it has no ways).
PlanTarget failure_target(const PlanGraph& graph, const PlanLocation& location, std::size_t way);

/// A branch, and whether its true side was taken.
using PlanDecision = std::pair<BranchId, bool>;
/// The free branches that lead there, and which way.
std::vector<PlanDecision> decisions_of_way(const PlanGraph& graph, const PlanLocation& location,
                                           std::size_t way);

/// "L3", "B1", "DONE", "FAILED(navigation-pose-unreachable)", "BOUND(loop at plan.lisp:12)".
std::string to_string(const PlanGraph& graph, const PlanTarget& target,
                      const base::SourceFiles& files);

/// One paragraph a location, in order of ids, with source places. Ends with a newline.
std::string dump_text(const PlanGraph& graph, const base::SourceFiles& files);

/// A picture for Graphviz: solid edges for success, dashed ones for failure.
std::string dump_dot(const PlanGraph& graph, const base::SourceFiles& files);

/// The number of performs on the shortest way from the entry to the plan's end; none if no way
/// leads there. Linear in the graph's size.
std::optional<std::int64_t> shortest_path(const PlanGraph& graph);

/// The number of performs on the longest way from the entry to a terminal; none if a cycle makes
/// it unlimited. Linear in the graph's size.
std::optional<std::int64_t> longest_path(const PlanGraph& graph);

using RegisterSet = std::set<ModelValueId>;

/// Which registers the rest of the plan still reads: by location and by branch. Terminals read
/// none.
struct PlanLiveness {
  std::vector<RegisterSet> locations;
  std::vector<RegisterSet> branches;
  /// The registers read from a place that control goes to.
  const RegisterSet& at(const PlanTarget& target) const;
  /// The registers read after a location.
  const RegisterSet& behind(const PlanLocation& location, bool success) const {
    return at(success ? location.on_success : location.on_failure);
  }
};

/// The least fixed point, backwards. At most (places times registers) rounds over the graph, and
/// hardly ever more than three.
PlanLiveness plan_liveness(const PlanGraph& graph);

/// For every location: the earlier attempts that it repeats, sorted. An attempt is a location of
/// the same perform form with the same event, behind whose failure the location can come; itself
/// too, where control can return. Visits at most `max_visits` places; locations beyond that repeat
/// nothing.
std::vector<std::vector<LocationId>> earlier_attempts(const PlanGraph& graph,
                                                      std::size_t max_visits = 20'000'000);

}  // namespace parallax::compiler
