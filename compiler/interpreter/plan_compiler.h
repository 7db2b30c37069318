#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/builtins/plan_value.h"
#include "compiler/lisp/lisp_data.h"
#include "compiler/lisp/lisp_reader.h"
#include "compiler/plan/failure_classes.h"
#include "compiler/plan/plan_binding.h"
#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

/// A plan as code for a small stack machine. The compiler resolves variables, blocks and handlers,
/// so that the state at run time consists of plain numbers. Two equal states behave alike, which
/// lets the unroller merge paths. A variable is a place on its frame's part of the stack.
enum class PlanOp : std::uint8_t {
  kConstant,      // push value a
  kLoad,          // push variable b of the frame a static links out
  kStore,         // variable b of the frame a links out := top, which stays
  kLoadGlobal,    // push global a; b = 1: its own value, whatever has rebound it
  kStoreGlobal,   // global a := pop
  kBindSpecial,   // global a means variable b of this frame from here on
  kStoreSpecial,  // meaning of global a in this task := top, which stays
  kPop,           // drop the top
  kSqueeze,       // drop a values below the top
  kJump,          // to a
  kJumpIfNil,     // pop; to a if it was nil
  kBuiltin,       // pop b arguments, push the result of built-in a
  kHolds,         // pop a fluent (a = 1: a query); push t or nil: the model decides
  kDesignator,    // push an empty designator of kind a
  kAddKey,        // pop a value; add it under key (string) a to the designator on top
  kPerform,       // pop a designator; push the result: the model decides
  kCall,          // pop the arguments of unit a, run it, push its result
  kCallLocal,     // the same for a unit whose parent frame is b static links out
  kFunction,      // push the function value of template a
  kCallValue,     // pop a arguments and the function below; b = 1: the last one is a list of more
  kValues,        // pop a values, push them as multiple values
  kSpreadValues,  // pop a list, push its elements as multiple values
  kListValues,    // pop multiple values, push the list of them
  kUnpack,        // pop multiple values, push the first a of them, nil where there are fewer
  kStamp,         // the list on top was made at template (datum) a
  kReturn,        // leave the unit with the top as its result
  kPushHandlers,  // failures look into table a from here on
  kPushCleanup,   // leaving runs unit a from here on
  kPushTask,      // a task begins: its clean-ups run before any handler around it
  kPopGuard,      // the last of those, or of kBindSpecial, ends
  kRunCleanup,    // run unit a as a clean-up, push nothing
  kEndHandler,    // the handler fell through: the failure goes outward
  kEndCleanup,    // go on with what the clean-up interrupted
  kExit,          // pop; leave to target b in the frame a static links out, with that value
  kFail,          // fail with class (string) a
  kFailValue,     // pop a failure or a class name and fail with it
  kExpectList,    // the top must be a list that is known (CPL021, CPL008)
  kPar,           // start the branches of table a, which take turns
  kEndBranch,     // a branch is over, with the top as its value
  kSleep,         // push nil; a branch of a `par` waits here for its turn
  kWait,          // pop a fluent, push its value; a branch waits for it, with a = 1 not for ever
  kTick,          // count variable a up; cut here beyond the loop limit
  kDone,          // the plan is over
};

struct PlanInstruction {
  PlanOp op = PlanOp::kDone;
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  DatumId source;
};

/// How a parameter of a function gets its value.
struct UnitParameter {
  enum class Kind : std::uint8_t { kRequired, kOptional, kKey, kRest };
  Kind kind = Kind::kRequired;
  std::string name;
  std::string keyword;    // kKey, without colon
  ValueId default_value;  // kOptional, kKey: what stands for an argument that is not given
};

/// A function, a handler, a clean-up or a local function.
struct PlanUnit {
  std::string name;
  std::uint32_t parameters = 0;
  std::vector<UnitParameter> signature;  // functions: one for each parameter
  bool other_keys = false;               // &allow-other-keys
  bool top_level = false;                // def-top-level-cram-function
  bool ready = false;                    // its code is complete
  std::uint32_t kept = 0;  // variables that a function value keeps lie below its parameters
  std::optional<std::uint32_t> around;  // the unit that it is written in
  std::set<std::uint32_t> assigned;     // places of variables that the plan sets
  DatumId source;
  std::vector<PlanInstruction> code;
};

/// A variable of a frame `level` static links out.
struct FramePlace {
  std::uint32_t level = 0;
  std::uint32_t index = 0;
};

/// How a function value is made.
struct FunctionTemplate {
  std::uint32_t unit = 0;
  bool builtin = false;
  std::optional<std::uint32_t> level;  // of the frame that it is linked to, if it needs one
  std::vector<FramePlace> kept;        // variables that never change: their values go along
  std::vector<FramePlace> shared;      // variables and blocks that it must not outlive
};

/// Where a kExit goes: the frame keeps `height` values and `guards` guards of its own.
struct ExitTarget {
  std::uint32_t unit = 0;
  std::uint32_t pc = 0;
  std::uint32_t height = 0;
  std::uint32_t guards = 0;
};

struct HandlerClause {
  std::string failure_class;
  std::uint32_t unit = 0;
  // `with-failure-handling` takes the error in an envelope as well: the first such clause that fits
  // it is asked before any other.
  bool opens = false;
};

/// The branches of a `par` or `pursue`, each a unit.
struct ParBranches {
  std::vector<std::uint32_t> units;
  std::optional<std::uint32_t> exit;  // `pursue`: where the first value goes on
  bool tries = false;                 // `try-all`
};

/// A place at which executions of the real plan may differ from those of the code.
struct CodeGap {
  std::string text;
  DatumId source;
  GapKind kind = GapKind::kOrder;
};

struct PlanGlobal {
  std::string name;
  DatumId source;
};

struct PlanCode {
  std::vector<PlanUnit> units;
  std::uint32_t definitions = 0;  // the unit that sets the globals
  std::uint32_t main = 0;
  std::uint32_t halt = 0;  // a unit that is over at once: a computation of its own returns to it
  std::vector<ExitTarget> exits;
  std::vector<std::vector<HandlerClause>> handlers;
  std::vector<ParBranches> pars;
  std::vector<FunctionTemplate> functions_made;
  std::vector<PlanGlobal> globals;
  std::vector<std::string> strings;
  std::vector<CodeGap> gaps;
  std::vector<std::string> inputs;  // free variables of the entry: the registers from 0 on
  FailureClasses classes;
  std::map<std::string, std::uint32_t, std::less<>> functions;     // the plan's own: their units
  std::map<std::string, std::string, std::less<>> function_names;  // by `package::name`: that name
  bool identities = false;       // designators are equated: each is a thing of its own
  bool sets_globals = false;     // some form sets a global that nothing around it rebinds
  bool describes = false;        // properties are asked for: found objects keep their description
  bool multiple_values = false;  // some form gives several values
};

/// The code that runs: a function, or the forms at top level of one file. If neither is given, the
/// forms at top level of all files, or the last function defined if there are none.
struct PlanStart {
  std::optional<std::string> function = std::nullopt;
  std::optional<base::FileId> forms = std::nullopt;
};

/// Turns a plan into code for the unroller's machine; CPL006 if there is nothing to
/// run. What the run cannot come to is not looked at. `binding` names functions that carry actions
/// out, and the table of failure classes. `interleave`: the branches of `par` take turns; otherwise
/// they run in written order (W-PAR). Macros add their expansions to the text's data.
base::Result<PlanCode> compile_plan(LispText& text, const PlanStart& entry, bool interleave,
                                    const PlanBinding& binding, ValueStore& values,
                                    base::DiagnosticSink& sink);

}  // namespace parallax::compiler
