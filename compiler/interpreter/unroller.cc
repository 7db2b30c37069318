// The graph of a plan: its code is run on static values, and every decision of the model is a
// fork.
//
// The machine stops at each perform, at each question to the model and at each choice between
// parallel branches. There the state of the machine (stacks, frames, variables) is looked up: a
// state that was met before ends the path at the known place of the graph, else a location or
// branch is added and a job is queued for each way on. So the graph grows with the states of the
// plan and not with its paths, and loops that come back to a state become cycles. Objects that
// only the model knows are kept in registers; a register is used again once no value of the
// state refers to it. Loops and calls beyond their bounds end in terminals that say so.
//
// Jobs are taken last in, first out, success first, so ids follow the order of the text. Cost:
// the steps of the machine for each pair of state and way; states, words and steps are limited.

#include "compiler/interpreter/unroller.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/base/word_table.h"
#include "compiler/interpreter/explorer.h"
#include "compiler/interpreter/idle_designators.h"
#include "compiler/interpreter/plan_compiler.h"
#include "compiler/lisp/lisp_packages.h"
#include "compiler/lisp/lisp_reader.h"

namespace parallax::compiler {

void Explorer::set(const Job& job, PlanTarget target) {
  using Edge = Job::Edge;
  if (job.edge == Edge::kEntry) {
    graph_.entry = target;
  } else if (job.edge == Edge::kSuccess || job.edge == Edge::kFailure) {
    auto& location = graph_.locations[LocationId(job.owner)];
    (job.edge == Edge::kSuccess ? location.on_success : location.on_failure) = target;
  } else {
    auto& branch = graph_.branches[BranchId(job.owner)];
    (job.edge == Edge::kTrue ? branch.if_true : branch.if_false) = target;
  }
}

PlanTarget Explorer::terminal(TerminalKind kind, std::string detail, std::optional<DatumId> at) {
  const auto key = fmt::format("{} {} {}", static_cast<int>(kind), at ? at->index() : 0, detail);
  const auto found = terminals_.find(key);
  if (found != terminals_.end()) return found->second;
  PlanTerminal out{kind, std::move(detail), std::nullopt};
  if (at) out.source = data_.source(*at);
  const auto id = graph_.terminals.add(std::move(out));
  terminals_.emplace(key, id);
  return id;
}

/// The calls of macros that made the form, outermost first.
std::vector<base::SourceRange> macro_calls(const LispData& data, DatumId form) {
  std::vector<base::SourceRange> out;
  for (auto call = data.macro_call(form); call; call = data.macro_call(*call)) {
    out.insert(out.begin(), data.source(*call));
  }
  return out;
}

/// The call sites that are active, outermost first.
std::vector<base::SourceRange> Explorer::calls(const PlanState& state) const {
  std::vector<base::SourceRange> out;
  for (std::size_t i = 1; i < state.frames.size(); ++i) {
    const auto& frame = state.frames[i];
    const auto& caller = state.frames[i - 1];
    if (frame.kind != FrameKind::kCall || caller.pc == 0) continue;
    const auto call = code_.units[caller.unit].code[caller.pc - 1].source;
    if (data_.in_library(call)) continue;
    const auto macros = macro_calls(data_, call);
    out.insert(out.end(), macros.begin(), macros.end());
    out.push_back(data_.source(call));
  }
  return out;
}

/// Deep calls make large states: not only their number is limited.
bool Explorer::has_room(const StateKey& key, DatumId form) {
  constexpr std::size_t kWords = 400;  // for each location
  key_words_ += key.size();
  ++states_[form];
  const auto limit = static_cast<std::size_t>(options_.limits.max_locations);
  const auto words = std::max(std::size_t{20'000}, limit) * kWords;
  const bool many = graph_.locations.size() >= limit;
  if (!many && key_words_ <= words) return true;
  if (full_) return false;
  full_ = true;
  wants_horizon_ = !up_to_horizon_ && options_.horizon;
  if (wants_horizon_) return false;
  const auto most =
      std::max_element(states_.begin(), states_.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  sink_
      .error(codes::kUnrollLimit, data_.source(form), many ? limit : words,
             many ? "locations" : "words for the states of its calls")
      .note(data_.source(most->first),
            fmt::format("most of its states, {}, begin at this `{}`: with other variables, from "
                        "other calls or with other branches on their way",
                        most->second, data_.head(most->first).value_or("form")));
  return false;
}

/// The one that was found last; up to a horizon one with the fewest performs before it.
std::optional<Job> Explorer::next_job() {
  if (up_to_horizon_) {
    for (auto& job : jobs_) later_[job.state.performs].push_back(std::move(job));
    jobs_.clear();
  }
  auto& open = up_to_horizon_ && !later_.empty() ? later_.begin()->second : jobs_;
  if (open.empty()) return std::nullopt;
  auto job = std::move(open.back());
  open.pop_back();
  if (up_to_horizon_ && open.empty()) later_.erase(later_.begin());
  return job;
}

std::optional<PlanTarget> Explorer::perform(PlanState& state, const StopPerform& stop) {
  auto key = state_key(state, values_, false);
  key.push_back(stop.designator.index());
  const auto found = locations_.find(key);
  if (found != locations_.end()) return found->second;
  if (!has_room(key, stop.form)) return std::nullopt;
  const auto source = data_.source(stop.form);
  const auto* entry = resolver_.find_entry(stop.designator, source);
  if (entry == nullptr) return std::nullopt;
  if (const auto object = resolver_.reference(*entry, stop.designator)) {
    return refer(state, stop, *object);
  }
  auto resolved = resolver_.resolve(*entry, stop.designator, source);
  if (!resolved) return std::nullopt;
  auto& location = *resolved;
  if (!options_.failures_by_reason) location.failures.clear();
  location.calls = calls(state);
  const auto macros = macro_calls(data_, stop.form);
  location.calls.insert(location.calls.end(), macros.begin(), macros.end());
  const auto failure = machine_.leaving_task(values_.failure(location.failure_class));
  const auto id = graph_.locations.add(std::move(location));
  locations_.emplace(std::move(key), id);
  auto result = values_.truth();
  if (entry->returns) {
    const auto value = free_register(state, stop.form, *entry->returns);
    graph_.locations[id].result = value;
    result = found_object(value, stop.designator);
  }
  ++state.performs;
  state.missed = state.slept = state.asleep = 0;
  // The last job is taken first: success.
  if (entry->always) {
    graph_.locations[id].on_failure = terminal(TerminalKind::kNever, {}, std::nullopt);
  } else if (graph_.locations[id].failures.empty()) {
    jobs_.push_back({state, failure, {}, Job::Edge::kFailure, id.index(), id});
  } else {
    fail_by_reason(id, state, stop.form);
  }
  jobs_.push_back({std::move(state), {}, {}, Job::Edge::kSuccess, id.index()});
  jobs_.back().state.stack.push_back(result);
  return id;
}

/// The perform fails any way that the binding gives a reason for.
void Explorer::fail_by_reason(LocationId id, const PlanState& state, DatumId form) {
  const auto ways = graph_.locations[id].failures;
  std::vector<Job> jobs;
  auto edge = Job::Edge::kFailure;
  auto owner = id.index();
  for (std::size_t way = 0; way < ways.size(); ++way) {
    const auto failure = machine_.leaving_task(values_.failure(ways[way].failure_class));
    if (way + 1 < ways.size()) {
      const auto next = free_branch("it fails with " + ways[way].failure_class, form);
      if (way == 0) {
        graph_.locations[id].on_failure = next;
      } else {
        graph_.branches[BranchId(owner)].if_false = next;
      }
      jobs.push_back({state, failure, {}, Job::Edge::kTrue, next.index(), id, way});
      edge = Job::Edge::kFalse;
      owner = next.index();
    } else {
      jobs.push_back({state, failure, {}, edge, owner, id, way});
    }
  }
  jobs_.insert(jobs_.end(), std::make_move_iterator(jobs.rbegin()),
               std::make_move_iterator(jobs.rend()));
}

/// Object that a perform returns. If the plan asks for properties, the object keeps the description
/// by which it was sought.
ValueId Explorer::found_object(ModelValueId id, ValueId designator) {
  const auto sought = code_.describes ? values_.key(designator, "object") : std::nullopt;
  Value value;
  value.kind = ValueKind::kModel;
  value.model = id;
  if (sought && is_designator(values_[*sought])) value.keys = values_[*sought].keys;
  std::erase_if(value.keys, [](const auto& key) { return key.first == "name"; });
  return values_.intern(std::move(value));
}

/// The first register of this perform that the plan does not refer to any more.
ModelValueId Explorer::free_register(const PlanState& state, DatumId form,
                                     const std::string& variable) {
  std::set<ModelValueId> taken;
  const auto note = [&](ValueId value) {
    const auto& registers = values_[value].registers;
    taken.insert(registers.begin(), registers.end());
  };
  for_each_value(state, note);
  auto& own = registers_[{form.index(), variable}];
  for (const auto value : own) {
    if (!taken.contains(value)) return value;
  }
  // No input has that name.
  auto number = graph_.values.size() + 1;
  const auto name = [&] { return fmt::format("?{}{}", variable, number); };
  while (std::find(code_.inputs.begin(), code_.inputs.end(), name()) != code_.inputs.end())
    ++number;
  own.push_back(graph_.values.add({name(), variable}));
  return own.back();
}

base::Result<FormulaTree> Explorer::guard_of(const StopQuestion& stop) {
  const auto source = data_.source(stop.form);
  if (const auto* fluent = std::get_if<ValueId>(&stop.fluent)) {
    return resolver_.question(*fluent, source);
  }
  const auto& equality = std::get<ModelEquality>(stop.fluent);
  const auto left = resolver_.constant(equality.left, "eq", source);
  const auto right = resolver_.constant(equality.right, "eq", source);
  if (!left || !right) return sink_.already_reported();
  return equal_terms(*left, *right);
}

std::optional<PlanTarget> Explorer::question(PlanState& state, const StopQuestion& stop) {
  auto guard = guard_of(stop);
  if (!guard) return std::nullopt;
  std::pair key(state_key(state, values_, true), *std::move(guard));
  const auto found = branches_.find(key);
  if (found != branches_.end()) return found->second;
  if (!has_room(key.first, stop.form)) return std::nullopt;
  const auto id = branch(key.second, stop.form);
  branches_.emplace(std::move(key), id);
  jobs_.push_back({state, {}, {}, Job::Edge::kFalse, id.index()});
  jobs_.back().state.stack.push_back(values_.nil());
  jobs_.push_back({std::move(state), {}, {}, Job::Edge::kTrue, id.index()});
  jobs_.back().state.stack.push_back(values_.truth());
  return id;
}

std::optional<PlanTarget> Explorer::stopped(PlanState& state, const PlanStop& stop) {
  if (const auto* at = std::get_if<StopPerform>(&stop)) return perform(state, *at);
  drop_dead_cells(state, {}, values_);
  if (const auto* at = std::get_if<StopQuestion>(&stop)) return question(state, *at);
  if (const auto* at = std::get_if<StopFailed>(&stop))
    return terminal(TerminalKind::kFailed, at->cause, std::nullopt);
  if (const auto* at = std::get_if<StopBound>(&stop))
    return terminal(TerminalKind::kBound, at->form, at->at);
  if (std::holds_alternative<StopTurn>(stop)) return take_turns(state);
  if (std::holds_alternative<StopDone>(stop)) {
    return terminal(TerminalKind::kDone, {}, std::nullopt);
  }
  return std::nullopt;
}

std::optional<PlanTarget> Explorer::advance(Job& job) {
  if (job.failure) {
    auto stop = machine_.raise(job.state, *job.failure);
    if (job.failed) note_handlers(*job.failed, job.way);
    if (stop) return stopped(job.state, *stop);
  }
  if (job.ending) {
    if (auto stop = machine_.end_par(job.state, *job.ending)) return stopped(job.state, *stop);
  }
  if (job.act) return perform(job.state, *job.act);
  for (;;) {
    if (job.proof) {
      const auto ruled = ask_rules(job);
      if (ruled.stop) return stopped(job.state, *ruled.stop);
      if (!ruled.goes_on) return ruled.target;
    }
    const bool begins = job.begin.has_value() && !job.ask;
    auto stop = next_stop(job);
    if (job.proof) continue;
    if (const auto* goal = std::get_if<StopProof>(&stop)) {
      job.proof = *goal;
      continue;
    }
    if (const auto* question = std::get_if<StopQuestion>(&stop)) {
      const auto* fluent = std::get_if<ValueId>(&question->fluent);
      if (fluent == nullptr || !must_wait(job)) return stopped(job.state, stop);
      PlanTurn turn{*fluent, question->form};
      turn.asks = TurnQuestion::kFluent;
      if (const auto ended = machine_.wait(job.state, turn)) return stopped(job.state, *ended);
      continue;
    }
    auto* act = std::get_if<StopPerform>(&stop);
    if (act == nullptr) return stopped(job.state, stop);
    act->designator = resolve_links(job.state.links, values_, act->designator);
    drop_dead_links(job.state, std::span(&act->designator, 1), values_);
    drop_dead_cells(job.state, std::span(&act->designator, 1), values_);
    if (!begins) {
      const auto asked = ask_goal(job, *act);
      if (asked && asked->stop) return stopped(job.state, *asked->stop);
      if (asked && !asked->goes_on) return asked->target;
      if (asked) continue;
    }
    if (is_ruled(*act)) {
      job.proof = *act;
      continue;
    }
    std::optional<PlanStop> ended;
    if (const auto* entry = resolver_.find_plan(act->designator)) {
      ended = run_plan(job.state, *act, *entry);
    } else if (job.state.pars.empty()) {
      return perform(job.state, *act);
    } else {
      ended = machine_.wait(job.state, {act->designator, act->form});
    }
    if (ended) return stopped(job.state, *ended);
  }
}

/// Whose failure the handlers took up that began to run just now.
void Explorer::note_handlers(std::optional<LocationId> failed, std::size_t way) {
  for (const auto unit : machine_.take_handlers_run()) {
    auto& handler = handlers_[unit];
    if (failed) {
      handler.failures.push_back(*failed);
      if (!graph_.locations[*failed].failures.empty()) handler.ways.emplace_back(*failed, way);
    } else {
      handler.otherwise = true;
    }
  }
}

void Explorer::write_handlers() {
  std::map<std::pair<std::uint32_t, std::uint32_t>, PlanHandler> in_order;  // by unit's place
  for (std::size_t table = 0; table < code_.handlers.size(); ++table) {
    if (!machine_.handlers_met()[table]) continue;
    for (const auto& clause : code_.handlers[table]) {
      if (clause.opens) continue;  // it stands there once more
      const auto source = data_.source(code_.units[clause.unit].source);
      const auto [entry, fresh] = in_order.try_emplace({source.begin, clause.unit});
      auto& handler = entry->second;
      if (fresh) {
        handler = handlers_[clause.unit];
        handler.source = source;
        std::sort(handler.failures.begin(), handler.failures.end());
        std::sort(handler.ways.begin(), handler.ways.end());
      }
      handler.failure_classes.push_back(clause.failure_class);
    }
  }
  for (auto& [place, handler] : in_order) graph_.handlers.push_back(std::move(handler));
}

void Explorer::write_gaps() {
  for (const auto& gap : code_.gaps) {
    graph_.gaps.push_back({gap.text, data_.source(gap.source), gap.kind});
  }
  for (const auto& [place, goal] : resolver_.unbound_goals()) {
    graph_.gaps.push_back({fmt::format("the goal `{}`, which the table does not bind", goal), place,
                           GapKind::kMeaning});
  }
  for (const auto& [form, why] : machine_.doubts()) {
    graph_.gaps.push_back({std::string(why), data_.source(form), GapKind::kMeaning});
  }
  for (const auto form : late_cleanups_) {
    const auto text =
        fmt::format("clean-ups of `{}` among what follows it", data_.head(form).value_or("par"));
    graph_.gaps.push_back({text, data_.source(form), GapKind::kOrder});
  }
  const auto by_place = [](const PlanGap& a, const PlanGap& b) {
    return std::pair(a.source.file, a.source.begin) < std::pair(b.source.file, b.source.begin);
  };
  std::stable_sort(graph_.gaps.begin(), graph_.gaps.end(), by_place);
}

base::Result<PlanGraph> Explorer::explore() {
  if (!machine_.run_definitions()) return sink_.already_reported();
  for (const auto& input : code_.inputs) {
    graph_.inputs.push_back(graph_.values.add({input, input.substr(1)}));
  }
  jobs_.push_back({machine_.start(), {}, {}, Job::Edge::kEntry, 0});
  while (!full_) {
    auto job = next_job();
    if (!job) break;
    if (up_to_horizon_ && std::int64_t{job->state.performs} > *options_.horizon) {
      set(*job, terminal(TerminalKind::kBound, "horizon", std::nullopt));
      continue;
    }
    const auto target = advance(*job);
    note_handlers(std::nullopt);
    if (target) {
      set(*job, *target);
    } else {
      failed_ = true;
      if (!machine_.has_room()) break;
    }
  }
  if (wants_horizon_) return PlanGraph();  // a part of no use
  if (failed_) return sink_.already_reported();
  write_handlers();
  write_gaps();
  return std::move(graph_);
}

/// The perform of an action that is a function of the plan: runs it.
std::optional<PlanStop> Explorer::run_plan(PlanState& state, const StopPerform& stop,
                                           const BindingEntry& entry) {
  const auto full = code_.function_names.find(*entry.plan);
  const auto function =
      code_.functions.find(full == code_.function_names.end() ? *entry.plan : full->second);
  if (function == code_.functions.end()) {
    sink_.error(codes::kUnknownPlanForm, entry.source, *entry.plan);
    return StopError{};
  }
  const auto wanted = code_.units[function->second].parameters;
  if (wanted != entry.plan_arguments.size()) {
    sink_
        .error(codes::kPlanArguments, entry.source, *entry.plan,
               fmt::format("the binding gives {} arguments, the function takes {}",
                           entry.plan_arguments.size(), wanted))
        .note(data_.source(code_.units[function->second].source), "defined here");
    return StopError{};
  }
  std::vector<ValueId> arguments;
  for (const auto& name : entry.plan_arguments) {
    const auto value = resolver_.variable(entry, stop.designator, name, data_.source(stop.form));
    if (!value) return StopError{};
    arguments.push_back(*value);
  }
  return machine_.enter(state, function->second, arguments, stop.form);
}

BranchId Explorer::branch(FormulaTree guard, DatumId form) {
  return graph_.branches.add(
      {std::move(guard), {}, data_.source(form), TerminalId(0), TerminalId(0), false});
}

BranchId Explorer::free_branch(std::string choice, DatumId form) {
  return graph_.branches.add(
      {{}, std::move(choice), data_.source(form), TerminalId(0), TerminalId(0), true});
}

base::Result<PlanGraph> unroll_plan(const base::SourceFiles& files,
                                    std::span<const base::FileId> plan, const PlanBinding& binding,
                                    const PoseLocator& locator, const UnrollOptions& options,
                                    base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  auto text = read_lisp(files, plan, sink);
  if (!text || !resolve_packages(*text, sink)) return sink.already_reported();
  ValueStore values;
  const auto facts = read_fact_groups(*text, values, sink);
  const auto code = compile_plan(*text, {options.entry, options.entry_forms}, options.interleave,
                                 binding, values, sink);
  if (!code || sink.error_count() != errors_before) return sink.already_reported();
  warn_of_idle_designators(*text, *code, binding, values, sink);
  const auto explorer = [&](bool up_to_horizon) {
    return Explorer(text->data, *code, facts, binding, locator, options, up_to_horizon, values,
                    sink);
  };
  auto whole = explorer(false);
  auto graph = whole.explore();
  if (!whole.wants_horizon()) return graph;
  if (sink.error_count() != errors_before) return sink.already_reported();
  return explorer(true).explore();
}

}  // namespace parallax::compiler
