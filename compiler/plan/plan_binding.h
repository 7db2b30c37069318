#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"
#include "compiler/base/word_table.h"
#include "compiler/plan/failure_classes.h"
#include "compiler/plan/formula_tree.h"

namespace parallax::compiler {

/// Which designators can be performed.
enum class PerformKind : std::uint8_t { kMotion, kAction };
inline constexpr auto kPerformKindWords = base::word_table<PerformKind>("motion", "action");
constexpr std::string_view to_string(PerformKind kind) { return kPerformKindWords.of(kind); }

/// The role that a designator key names: target|pose|location -> target, object|for ->
/// object, arm|gripper|left-...|right-... -> arm; every other key is its own role. Without colon.
std::string normalise_key(std::string_view key);

/// `:target ?p` binds the value of the key; `:object type ?y` one property of the designator there.
struct BindingKey {
  std::string key;                      // normalised, without colon
  std::optional<std::string> property;  // "type", "name"
  std::string variable;                 // "?p"
};

/// `on REASON CLASS`: a failure for this reason raises this condition where the plan is executed.
struct FailureReason {
  std::string reason;  // the word before the first colon of the simulator's message
  std::string failure_class;
  base::SourceRange source;
};

/// Meaning of one kind of perform in the model.
struct BindingEntry {
  PerformKind kind = PerformKind::kMotion;
  std::string type;
  std::vector<BindingKey> keys;
  std::string event_symbol;
  std::vector<FormulaTree> event_arguments;
  FormulaTree formula;
  std::int32_t time_offset = 0;        // @t: 0, @t+1: 1
  bool always = false;                 // `ok: always`: it cannot fail
  std::optional<std::string> returns;  // the quantified variable of the formula that is the result
  std::string failure_class = "simple-plan-failure";
  std::vector<FailureReason> reasons;       // empty: every failure is of `failure_class`
  std::optional<std::string> plan;          // instead of an event: the plan's function to run
  std::vector<std::string> plan_arguments;  // the variables that it is called with
  base::SourceRange source;                 // the entry's head
  base::SourceRange formula_source;
  base::SourceRange failure_source;
};

/// Meaning of a plan's query: (prolog '(name argument...)).
struct QueryBinding {
  std::string name;
  std::vector<std::string> variables;
  FormulaTree formula;  // at the time of the question
  base::SourceRange source;
  base::SourceRange formula_source;
};

/// Meaning of a goal, `(goal (name argument...))` in an action designator, like a query's.
using GoalBinding = QueryBinding;

/// Which objects an object designator without a name can mean.
struct ObjectBinding {
  std::vector<BindingKey> keys;
  std::string variable;  // the object: "?o"
  FormulaTree formula;   // at the time of the perform
  std::string failure_class = "designator-reference-failure";
  base::SourceRange source;
  base::SourceRange formula_source;
  base::SourceRange failure_source;
};

/// The binding table: the meaning of a plan's designators in the model.
struct PlanBinding {
  std::vector<BindingEntry> entries;   // in source order, aliases expanded
  std::vector<QueryBinding> queries;   // in source order
  std::vector<GoalBinding> goals;      // in source order
  std::vector<ObjectBinding> objects;  // the first that fits is taken
  FailureTable failures = FailureTable::kDevel;
  /// The types of one kind, each once, in source order; for messages.
  std::vector<std::string> types(PerformKind kind) const;
};

/// Reads a binding file. Blank-separated, any line layout; an entry starts with `motion` or
/// `action`:
///
///     motion going (:target ?p) -> Go(region(?p))  ok: RobotAt(region(?p)) @t+1
///                                  else navigation-pose-unreachable
///     motion detecting (:object type ?y) -> Detect(?y)
///         ok: exists i. TypeOf(i,?y) & Visible(i) @t
///         returns i ; else perception-object-not-found
///     action opening|accessing (:arm :object) -> Open(?o)  ok: IsOpen(?o) @t+1
///         else manipulation-goal-not-reached
///         on slipped gripper-goal-not-reached  on out-of-reach manipulation-pose-unreachable
///     action navigating = going
///     action fetching (:object ?o :arm ?a) -> plan fetch(?o,?a)
///     object (:type ?y) ok: TypeOf(?o,?y) & Perceived(?o) @t  returns ?o
///     query object-in-hand (?o) ok: exists arm. Holding(arm,?o) @t
///     goal (object-in-hand ?o) -> exists arm. Holding(arm,?o)
///
/// In front of the entries `failures: devel` or `failures: 2020` chooses CRAM's failure classes.
/// A key without a variable binds the usual one: :target ?p, :object ?o, another its first letter.
/// A bare `place` in the formula repeats `place(...)` of the event. Reports E4001 (syntax), E4002
/// (bound twice), E4003 (unbound variable), E4004 (alias of nothing), several per run.
base::Result<PlanBinding> parse_plan_binding(const base::SourceFiles& files, base::FileId file,
                                             base::DiagnosticSink& sink);

}  // namespace parallax::compiler
