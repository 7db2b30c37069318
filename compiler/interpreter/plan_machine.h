#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/builtins/designator_links.h"
#include "compiler/builtins/plan_builtins.h"
#include "compiler/builtins/plan_value.h"
#include "compiler/interpreter/plan_compiler.h"
#include "compiler/lisp/lisp_data.h"
#include "compiler/plan/unroll_limits.h"

namespace parallax::compiler {

enum class FrameKind : std::uint8_t { kCall, kHandler, kCleanup };
enum class PendingKind : std::uint8_t { kNone, kExit, kCross, kFail };

/// Action that a clean-up interrupted: a jump out of the frames above `frame`, a failure on its way
/// out of a task, or the end of the plan.
struct Pending {
  PendingKind kind = PendingKind::kNone;
  std::uint32_t frame = 0;
  std::uint32_t exit = 0;  // kExit: the target; kCross: the guard of the task's border
  ValueId value;           // kExit: carried along; kCross and kFail: the failure
};

/// One activation of a unit. Everything is an index, so equal activations compare equal.
struct PlanFrame {
  std::uint32_t unit = 0;
  std::uint32_t pc = 0;
  std::uint32_t link = 0;        // the frame of the unit around this one in the source
  std::uint32_t base = 0;        // where its variables start on the stack
  std::uint32_t guard_base = 0;  // guards below belong to other frames
  FrameKind kind = FrameKind::kCall;
  std::uint32_t skip_to = 0;  // kHandler: guards from here up to guard_base are asleep
  std::uint32_t clause = 0;   // kHandler: the clause of the table that it is
  ValueId failure;            // kHandler: what it handles
  Pending pending;            // kCleanup
  // Not part of the state's identity: performs on the way here, when the frame was made.
  std::uint32_t performs = 0;
};

/// kTask: a task begins here, which no failure leaves before its clean-ups have run. kEvaporated:
/// the same of a branch that another one's failure has ended; failures of its clean-ups are lost.
/// kSpecial: a special variable is rebound here, by the value at `height`.
enum class GuardKind : std::uint8_t { kHandlers, kCleanup, kTask, kEvaporated, kSpecial };

/// The index of a kTask that ends with the function called in it.
inline constexpr std::uint32_t kPerformTask = 1;

/// An active with-failure-handling or unwind-protect, the border of a task, a rebound special.
struct PlanGuard {
  GuardKind kind = GuardKind::kHandlers;
  std::uint32_t index = 0;  // the handler table, the clean-up's unit, the global
  std::uint32_t frame = 0;
  std::uint32_t height = 0;  // of the stack when it began
};

/// The question of a branch of a `par` to the model when it has its turn: a fluent of `holds`, a
/// goal of `prolog`, the goal of an action, or which function carries out an action.
enum class TurnQuestion : std::uint8_t { kNone, kFluent, kProof, kAllProofs, kGoal, kGrounding };

/// A perform, a `sleep`, a `wait-for` or a question that a branch of a `par` waits at for its turn.
struct PlanTurn {
  ValueId designator;  // of a question: the fluent or the goal
  DatumId form;
  bool sleeps = false;
  std::optional<ValueId> until = std::nullopt;  // it has a turn while this fluent is not nil
  TurnQuestion asks = TurnQuestion::kNone;
};

struct PlanPar;

/// A branch of a `par` that is not running: its part on top of the state that all branches share.
/// All begin at the same height, so that the indices in it are right whenever it is put back.
struct PlanBranchState {
  bool started = false;
  bool fresh = false;  // on the way to its first perform
  bool asks = false;   // has asked the model on the way to a perform
  bool awake = false;  // woke up at this turn, which may be that of a question as well
  bool done = false;
  ValueId result;  // done
  std::optional<PlanTurn> turn;
  std::vector<PlanFrame> frames;
  std::vector<PlanGuard> guards;
  std::vector<ValueId> stack;
  std::vector<PlanPar> pars;  // at most one: of a branch that is itself in branches
};

/// An active `par` or `pursue` whose branches take turns, perform by perform. The first failure
/// that leaves a branch decides it, and of a `pursue` the first value as well. Then the other
/// branches may still carry out the perform at which they wait, and nothing more.
struct PlanPar {
  std::uint32_t frames = 0;  // number of frames that the branches share
  std::uint32_t guards = 0;
  std::uint32_t height = 0;
  std::size_t active = 0;             // the branch whose state is in place
  std::optional<std::uint32_t> exit;  // `pursue`: where it goes on with its value
  bool tries = false;                 // `try-all`: it fails only when all branches have failed
  std::optional<ValueId> failure;
  std::optional<ValueId> value;  // `pursue` only; both are set if a failure came second
  DatumId form;
  std::vector<PlanBranchState> branches;
};

/// All that the rest of an execution depends on.
struct PlanState {
  std::vector<PlanFrame> frames;
  std::vector<PlanGuard> guards;
  std::vector<ValueId> stack;
  std::vector<PlanPar> pars;  // outermost first
  DesignatorLinks links;
  std::uint32_t performs = 0;  // on the path so far; not part of the state's identity
  std::uint32_t missed = 0;    // references that failed since the last perform; the same
  // How often branches woke up since the last perform, and 1 + the turn at which the last one did.
  // Not part of the identity of what performs next, but of questions and turns before it.
  std::uint32_t slept = 0;
  std::uint32_t asleep = 0;
};

/// Calls visit(value) for every value that the state holds, also in branches that wait.
void for_each_value(const PlanState& state, const std::function<void(ValueId)>& visit);

/// Forgets the links of designators that nothing else in the state, and nothing of `more`, refers
/// to.
void drop_dead_links(PlanState& state, std::span<const ValueId> more, const ValueStore& values);

/// The same for cells.
void drop_dead_cells(PlanState& state, std::span<const ValueId> more, const ValueStore& values);

/// Equal for equal states. Without `counters`, states that differ only in how often an endless loop
/// has run are equal: coming back to such a state is a cycle, not news.
std::vector<std::uint32_t> state_key(const PlanState& state, const ValueStore& values,
                                     bool counters);

/// Why the machine stopped; in the first two cases the caller pushes the answer and runs it again.
struct StopPerform {
  ValueId designator;
  DatumId form;
};
struct StopQuestion {                           // only the model knows
  std::variant<ValueId, ModelEquality> fluent;  // a fluent's list, or whether two values are equal
  DatumId form;
};
struct StopProof {  // the goal of a `prolog` form
  ValueId goal;
  DatumId form;
  bool all = false;                                  // every solution, not just one
  std::optional<StopPerform> action = std::nullopt;  // it is the goal of this action
};
struct StopDone {};
struct StopFailed {
  std::string failure_class;
  std::string cause;  // the class, or that of the error in an envelope
};
struct StopBound {
  std::string form;
  DatumId at;
};
struct StopTurn {
};  // of the outermost `par` every branch is over or waits, or it may end in two ways
struct StopUnit {  // the code of a unit is not complete yet; run tries again
  std::uint32_t unit = 0;
};
struct StopError {};  // reported
using PlanStop = std::variant<StopPerform, StopQuestion, StopProof, StopDone, StopFailed, StopBound,
                              StopTurn, StopUnit, StopError>;

/// Names the calls of macros that made the form.
void note_macro_calls(base::DiagnosticBuilder& report, const LispData& data, DatumId form);

/// Executes plan code on one state at a time, silently, up to the next thing that is not silent.
/// Deterministic: the answer depends on the state alone.
class PlanMachine {
 public:
  /// `stop`, raised to end the unrolling early, may be null.
  PlanMachine(const PlanCode& code, const LispData& data, const UnrollLimits& limits,
              const std::atomic<bool>* stop, ValueStore& values, base::DiagnosticSink& sink)
      : code_(code),
        data_(data),
        limits_(limits),
        stop_(stop),
        values_(values),
        sink_(sink),
        handlers_met_(code.handlers.size()) {}

  /// Sets the global constants; false if that reported an error.
  bool run_definitions();
  PlanState start() const;
  /// A state that calls the unit with these arguments; it is done with the result on the stack.
  PlanState start(std::uint32_t unit, const std::vector<ValueId>& arguments) const;
  /// Place to name in errors that arise at `own`: an error in a macro is reported at its call.
  struct Blame {
    DatumId own;
    DatumId call;
  };
  void blame(std::optional<Blame> blame) { blame_ = blame; }
  PlanStop run(PlanState& state);
  /// Lets the current step fail instead of answering; run goes on from there.
  std::optional<PlanStop> raise(PlanState& state, ValueId failure);
  /// The units of the handlers that began to run since this was asked last.
  std::vector<std::uint32_t> take_handlers_run() { return std::exchange(handlers_run_, {}); }
  /// By handler table: has any state had it around itself?
  const std::vector<bool>& handlers_met() const { return handlers_met_; }
  /// The failure as those outside of the task see it: a Lisp error in its envelope.
  ValueId leaving_task(ValueId failure) const;
  /// Inside a `par`: the running branch waits at this perform, others run up to theirs. None: run
  /// goes on with another branch.
  std::optional<PlanStop> wait(PlanState& state, const PlanTurn& turn);
  /// Where branches wait: the way to each through nested `par`s, in written order.
  using BranchPath = std::vector<std::size_t>;
  std::vector<BranchPath> waiting(const PlanState& state);
  /// How a `par` that is decided may end now. The clean-ups of the branches that it ends run in
  /// tasks of their own, so a handler of its failure may decide before them or after.
  /// Without clean-ups: they come behind everything that is left of the plan.
  enum class ParEnd : std::uint8_t {
    kValue,
    kValueWithoutCleanups,
    kFailure,
    kFailureAfterCleanups,
    kFailureWithoutCleanups
  };
  struct Ending {
    BranchPath path;  // to the `par`
    ParEnd end = ParEnd::kValue;
  };
  static std::vector<Ending> endings(const PlanState& state);
  /// Ends the `par` like that; run goes on after it.
  std::optional<PlanStop> end_par(PlanState& state, const Ending& ending);
  /// Must the running branch wait for its turn before it asks the model? What others perform first
  /// may change the answer. One that has just woken up may ask once.
  static bool waits_to_ask(PlanState& state);
  /// Puts that branch in place. Its perform or its question is next; if it slept, run goes on.
  static PlanTurn resume(PlanState& state, const BranchPath& path);
  /// Lets a function of the plan answer, in a task of its own; run goes into it.
  std::optional<PlanStop> enter(PlanState& state, std::uint32_t unit,
                                const std::vector<ValueId>& arguments, DatumId form);
  /// A state in which the unit is all that runs: StopDone with its value on top.
  PlanState computation(std::uint32_t unit, const std::vector<ValueId>& arguments,
                        DesignatorLinks links) const;
  /// Prepares the making of designators: an identity that neither the state nor `more` has.
  void refresh_links(PlanState& state, std::span<const ValueId> more) const;
  /// Neither a bound was reached nor was it stopped.
  bool has_room() const {
    return !values_.full() && steps_ + values_.elements_read() <= limits_.max_steps && !stopped();
  }
  /// Counts a step, also of work that is done elsewhere; false if there is no room for more.
  bool count_step() {
    ++steps_;
    return has_room();
  }
  /// Says why a built-in has no value.
  void report(const BuiltinFailure& failure, std::uint32_t builtin, DatumId form);
  /// Where and why the answer of a built-in may be another one on the robot.
  const std::map<DatumId, std::string_view>& doubts() const { return doubts_; }
  void note_doubt(DatumId at) {
    if (const auto why = values_.take_doubt(); !why.empty()) doubts_.emplace(place_of(at), why);
  }
  bool stopped() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }
  /// The bound of values, text or steps that was reached, or that somebody ended it.
  void report_full(DatumId at);

 private:
  using Step = std::optional<PlanStop>;  // empty: go on
  Step execute(PlanState& state, const PlanInstruction& instruction);
  Step leave(PlanState& state);
  Step load_global(PlanState& state, const PlanInstruction& instruction);
  Step expect_list(const PlanState& state, const PlanInstruction& instruction);
  Step builtin(PlanState& state, const PlanInstruction& instruction);
  Step call(PlanState& state, const PlanInstruction& instruction);
  Step make_function(PlanState& state, const PlanInstruction& instruction);
  Step call_value(PlanState& state, const PlanInstruction& instruction);
  Step enter_value(PlanState& state, std::vector<ValueId> arguments,
                   const PlanFunctionValue& function, ValueId kept,
                   const PlanInstruction& instruction);
  Step enter_unit(PlanState& state, std::uint32_t unit, std::uint32_t link, DatumId form);
  bool outlives(ValueId value, std::size_t frame, std::size_t place) const;
  Step check_life(const PlanState& state, const PlanInstruction& instruction);
  void take_primary(PlanState& state, const PlanInstruction& instruction);
  void stamp(PlanState& state, const PlanInstruction& instruction);
  void multiple_values(PlanState& state, const PlanInstruction& instruction);
  base::DiagnosticBuilder report(base::DiagnosticCode code, DatumId at, auto&&... args) {
    return note_blame(sink_.error(code, data_.source(place_of(at)), args...), at);
  }
  base::DiagnosticBuilder note_blame(base::DiagnosticBuilder report, DatumId at) const;
  /// Where an error in that form is shown: our own Lisp stands for its caller.
  DatumId place_of(DatumId form) const;
  Step tick(PlanState& state, const PlanInstruction& instruction);
  Step fail_value(PlanState& state, const PlanInstruction& instruction);
  void push_guard(PlanState& state, const PlanInstruction& instruction);
  void run_cleanup(PlanState& state, const PlanInstruction& instruction);
  Step end_handler(PlanState& state);
  Step end_cleanup(PlanState& state);
  Step search(PlanState& state, ValueId failure, std::size_t limit, std::size_t clause = 0);
  Step leave_task(PlanState& state, std::size_t border, ValueId failure);
  Step check_exit(const PlanState& state, const PlanInstruction& instruction, std::uint32_t frame);
  Step bind_special(PlanState& state, const PlanInstruction& instruction);
  Step store_special(PlanState& state, const PlanInstruction& instruction);
  std::optional<std::size_t> special(const PlanState& state, std::uint32_t global) const;
  Step sleep(PlanState& state, DatumId form);
  Step wait_for(PlanState& state, const PlanInstruction& instruction);
  std::variant<ValueId, BuiltinFailure> fluent_value(const PlanState& state, ValueId fluent);
  bool has_turn(const PlanState& state, const PlanTurn& turn);
  void find_waiting(const PlanState& state, const PlanPar& par, BranchPath& path,
                    std::vector<BranchPath>& out);
  std::optional<DatumId> run_to_sleep(PlanState& state);
  bool is_own(const PlanState& state, const PlanInstruction& instruction) const;
  Step start_par(PlanState& state, const PlanInstruction& instruction);
  Step end_branch(PlanState& state);
  Step next_branch(PlanState& state);
  Step fail_branch(PlanState& state, ValueId failure);
  Step evaporate(PlanState& state, ParEnd end);
  Step jump_out(PlanState& state, const Pending& pending);
  Step unwind(PlanState& state, Pending pending);
  void add_key(PlanState& state, const PlanInstruction& instruction);
  std::size_t place(const PlanState& state, const PlanInstruction& instruction) const;
  std::uint32_t linked(const PlanState& state, std::uint32_t level) const;
  StopError error(base::DiagnosticCode code, const PlanInstruction& at, std::string text);
  std::string name_at(DatumId form) const;

  const PlanCode& code_;
  const LispData& data_;
  UnrollLimits limits_;
  const std::atomic<bool>* stop_;
  ValueStore& values_;
  base::DiagnosticSink& sink_;
  std::vector<std::optional<ValueId>> globals_;
  PlanHeap first_heap_;  // what the definitions of globals made
  std::int64_t steps_ = 0;
  std::vector<std::uint32_t> handlers_run_;
  std::vector<bool> handlers_met_;
  std::optional<Blame> blame_;
  std::map<DatumId, std::string_view> doubts_;
  const PlanState* running_ = nullptr;
};

}  // namespace parallax::compiler
