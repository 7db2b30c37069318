#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/base/result.h"
#include "compiler/interpreter/perform_resolver.h"
#include "compiler/interpreter/plan_compiler.h"
#include "compiler/interpreter/plan_machine.h"
#include "compiler/interpreter/rule_proofs.h"
#include "compiler/interpreter/unroller.h"

namespace parallax::compiler {

/// An execution that waits to be continued, and the edge that it gives a target to.
struct Job {
  enum class Edge : std::uint8_t { kEntry, kSuccess, kFailure, kTrue, kFalse };
  PlanState state;
  std::optional<ValueId> failure;  // goes on by failing
  std::optional<StopPerform> act;  // goes on by performing
  Edge edge = Edge::kEntry;
  std::uint32_t owner = 0;                         // location or branch
  std::optional<LocationId> failed = {};           // what it goes on by failing
  std::size_t way = 0;                             // likewise: the reason, if it goes by reasons
  std::optional<PlanMachine::Ending> ending = {};  // goes on by the end of a `par`
  /// Goes on by asking the rules again: what carries out an action, or whether a goal holds.
  std::optional<std::variant<StopPerform, StopProof>> proof = {};
  std::vector<std::uint32_t> answers = {};  // the model's answers to the rules' questions so far
  std::optional<StopPerform> begin = {};    // goes on by beginning it: its goal does not hold
  std::optional<PlanTurn> ask = {};         // a branch goes on by asking this
  bool in_turn = false;                     // what it asks now is what the branch waited for
};

/// Explores the states of a plan depth first, success before failure, and writes the graph.
class Explorer {
 public:
  Explorer(const LispData& data, const PlanCode& code, const FactBase& facts,
           const PlanBinding& binding, const PoseLocator& locator, const UnrollOptions& options,
           bool up_to_horizon, ValueStore& values, base::DiagnosticSink& sink)
      : data_(data),
        code_(code),
        binding_(binding),
        options_(options),
        up_to_horizon_(up_to_horizon),
        values_(values),
        sink_(sink),
        machine_(code, data, options.limits, options.stop, values, sink),
        resolver_(binding, locator, ModelNames(options.constants), ModelNames(options.fluents),
                  code.classes, graph_, values, sink),
        rules_(
            facts, data, code, options, resolver_, machine_,
            [this](const StopQuestion& stop) { return guard_of(stop); }, values, sink) {}

  base::Result<PlanGraph> explore();
  /// The graph was larger than the limit, which was not reported, as a part of it may do.
  bool wants_horizon() const { return wants_horizon_; }

 private:
  using StateKey = std::vector<std::uint32_t>;
  void set(const Job& job, PlanTarget target);
  void note_handlers(std::optional<LocationId> failed, std::size_t way = 0);
  void write_handlers();
  void write_gaps();
  std::optional<PlanTarget> advance(Job& job);
  std::optional<PlanTarget> stopped(PlanState& state, const PlanStop& stop);
  PlanStop next_stop(Job& job);
  bool has_room(const StateKey& key, DatumId form);
  std::optional<Job> next_job();
  std::optional<PlanTarget> perform(PlanState& state, const StopPerform& stop);
  void fail_by_reason(LocationId id, const PlanState& state, DatumId form);
  std::optional<PlanStop> run_plan(PlanState& state, const StopPerform& stop,
                                   const BindingEntry& entry);
  std::optional<PlanTarget> refer(PlanState& state, const StopPerform& stop,
                                  const PerformResolver::Reference& reference);
  /// One of the ways whose guards hold, or, with the number 0, none of them.
  BranchId one_of(const std::vector<ModelWay>& ways, DatumId form,
                  const std::function<Job(std::uint32_t)>& job);
  /// Outcome of asking the rules about a perform or a goal. Control goes to `target` if the rules
  /// ask the model or report an error; otherwise the machine goes on, unless it stopped.
  struct Ruled {
    bool goes_on = false;
    std::optional<PlanTarget> target;
    std::optional<PlanStop> stop;
  };
  Ruled ask_rules(Job& job);
  Ruled ground(Job& job, const StopPerform& perform);
  Ruled prove(Job& job, const StopProof& proof);
  Ruled ask_model(Job& job, const ProofQuestion& question, DatumId form);
  static bool must_wait(Job& job) { return !job.in_turn && PlanMachine::waits_to_ask(job.state); }
  Ruled wait_to_ask(Job& job, const PlanTurn& turn);
  Ruled nothing_fits(Job& job, const StopPerform& perform, bool fits);
  bool is_ruled(const StopPerform& perform) const;
  StopPerform named(const StopPerform& stop, const PerformResolver::Reference& reference,
                    std::string_view name);
  std::optional<PlanTarget> take_turns(const PlanState& state);
  BranchId branch(FormulaTree guard, DatumId form);
  BranchId free_branch(std::string choice, DatumId form);
  std::optional<PlanTarget> question(PlanState& state, const StopQuestion& stop);
  /// Asks the model or the rules whether the goal of an action holds already. None: it has no goal
  /// that counts.
  std::optional<Ruled> ask_goal(Job& job, const StopPerform& perform);
  base::Result<FormulaTree> guard_of(const StopQuestion& stop);
  ValueId found_object(ModelValueId id, ValueId designator);
  ModelValueId free_register(const PlanState& state, DatumId form, const std::string& variable);
  PlanTarget terminal(TerminalKind kind, std::string detail, std::optional<DatumId> at);
  std::vector<base::SourceRange> calls(const PlanState& state) const;

  const LispData& data_;
  const PlanCode& code_;
  const PlanBinding& binding_;
  const UnrollOptions& options_;
  bool up_to_horizon_;
  ValueStore& values_;
  base::DiagnosticSink& sink_;
  PlanGraph graph_;
  PlanMachine machine_;
  PerformResolver resolver_;
  RuleProofs rules_;
  std::vector<Job> jobs_;
  std::map<std::uint32_t, std::vector<Job>> later_;  // by performs before; up to the horizon
  std::map<StateKey, LocationId> locations_;
  std::map<std::pair<StateKey, FormulaTree>, BranchId> branches_;
  std::map<StateKey, BranchId> references_;
  std::map<StateKey, BranchId> turns_;
  std::map<std::string, TerminalId> terminals_;
  std::set<DatumId> late_cleanups_;  // forms whose clean-ups may come behind everything else
  std::map<std::pair<std::uint32_t, std::string>, std::vector<ModelValueId>> registers_;
  std::map<std::uint32_t, PlanHandler> handlers_;  // by unit: what they take up
  bool failed_ = false;
  std::size_t key_words_ = 0;
  std::map<DatumId, std::size_t> states_;  // by form
  bool full_ = false;                      // the limit of locations was reached
  bool wants_horizon_ = false;
};

}  // namespace parallax::compiler
