#include "compiler/plan/unroller.h"

#include <fmt/core.h>

#include <set>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/lisp_reader.h"
#include "compiler/plan/plan_compiler.h"
#include "compiler/plan/plan_explorer.h"

namespace parallax::compiler {

using base::DiagnosticCode;

void Explorer::set(const Job& job, PlanTarget target) {
  switch (job.edge) {
    case Job::Edge::kEntry:
      graph_.entry = target;
      return;
    case Job::Edge::kSuccess:
      graph_.locations[LocationId(job.owner)].on_success = target;
      return;
    case Job::Edge::kFailure:
      graph_.locations[LocationId(job.owner)].on_failure = target;
      return;
    case Job::Edge::kTrue:
      graph_.branches[BranchId(job.owner)].if_true = target;
      return;
    case Job::Edge::kFalse:
      graph_.branches[BranchId(job.owner)].if_false = target;
      return;
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

/// The call sites that are active, outermost first.
std::vector<base::SourceRange> Explorer::calls(const PlanState& state) const {
  std::vector<base::SourceRange> out;
  for (std::size_t i = 1; i < state.frames.size(); ++i) {
    const auto& frame = state.frames[i];
    const auto& caller = state.frames[i - 1];
    if (frame.kind != FrameKind::kCall || caller.pc == 0) continue;
    out.push_back(data_.source(code_.units[caller.unit].code[caller.pc - 1].source));
  }
  return out;
}

/// Deep calls make large states: not only their number is limited.
bool Explorer::has_room(const StateKey& key, DatumId form) {
  constexpr std::size_t kMaxWords = 8'000'000;
  key_words_ += key.size();
  const auto limit = static_cast<std::size_t>(options_.max_locations);
  const bool many = graph_.locations.size() >= limit;
  if (!many && key_words_ <= kMaxWords) return true;
  if (!full_) {
    sink_.error(DiagnosticCode::kUnrollLimit, data_.source(form), many ? limit : kMaxWords,
                many ? "locations" : "words for the states of its calls");
  }
  full_ = true;
  return false;
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
  location.calls = calls(state);
  const auto failure = values_.failure(location.failure_class);
  const auto id = graph_.locations.add(std::move(location));
  locations_.emplace(std::move(key), id);
  auto result = values_.truth();
  if (entry->returns) {
    const auto value = free_register(state, stop.form, *entry->returns);
    graph_.locations[id].result = value;
    result = values_.model(value);
  }
  ++state.performs;
  state.missed = 0;
  // The last job is taken first: success.
  jobs_.push_back({state, failure, {}, Job::Edge::kFailure, id.index()});
  jobs_.push_back({std::move(state), {}, {}, Job::Edge::kSuccess, id.index()});
  jobs_.back().state.stack.push_back(result);
  return id;
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
  const auto name = fmt::format("?{}{}", variable, graph_.values.size() + 1);
  own.push_back(graph_.values.add({name, variable}));
  return own.back();
}

base::Result<FormulaTree> Explorer::guard_of(const StopQuestion& stop) {
  const auto source = data_.source(stop.form);
  if (const auto* fluent = std::get_if<ValueId>(&stop.fluent)) {
    return resolver_.question(*fluent, stop.query_only, source);
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
  if (const auto* at = std::get_if<StopQuestion>(&stop)) return question(state, *at);
  if (const auto* at = std::get_if<StopFailed>(&stop)) {
    return terminal(TerminalKind::kFailed, at->failure_class, std::nullopt);
  }
  if (const auto* at = std::get_if<StopBound>(&stop)) {
    return terminal(TerminalKind::kBound, at->form, at->at);
  }
  if (std::holds_alternative<StopDone>(stop)) {
    return terminal(TerminalKind::kDone, {}, std::nullopt);
  }
  return std::nullopt;
}

std::optional<PlanTarget> Explorer::advance(Job& job) {
  if (job.failure) {
    if (auto stop = machine_.raise(job.state, *job.failure)) return stopped(job.state, *stop);
  }
  if (job.act) return perform(job.state, *job.act);
  for (;;) {
    auto stop = machine_.run(job.state);
    const auto* act = std::get_if<StopPerform>(&stop);
    const auto* entry = act != nullptr ? resolver_.find_plan(act->designator) : nullptr;
    if (act != nullptr && entry == nullptr && !job.state.pars.empty()) {
      const auto all_wait = machine_.wait(job.state, *act);
      if (!all_wait) continue;
      return take_turns(job.state);
    }
    if (std::holds_alternative<StopTurn>(stop)) return take_turns(job.state);
    if (entry == nullptr) return stopped(job.state, stop);
    if (auto ended = run_plan(job.state, *act, *entry)) return stopped(job.state, *ended);
  }
}

base::Result<PlanGraph> Explorer::explore() {
  if (!machine_.run_definitions()) return sink_.already_reported();
  jobs_.push_back({machine_.start(), {}, {}, Job::Edge::kEntry, 0});
  while (!jobs_.empty() && !full_) {
    auto job = std::move(jobs_.back());
    jobs_.pop_back();
    if (const auto target = advance(job)) {
      set(job, *target);
    } else {
      failed_ = true;
    }
  }
  if (failed_) return sink_.already_reported();
  return std::move(graph_);
}

base::Result<PlanGraph> unroll_plan(const base::SourceFiles& files, base::FileId plan,
                                    const PlanBinding& binding, const PoseLocator& locator,
                                    const UnrollOptions& options, base::DiagnosticSink& sink) {
  const auto text = read_lisp(files, plan, sink);
  if (!text) return sink.already_reported();
  ValueStore values;
  const auto code = compile_plan(*text, options.entry, options.interleave, values, sink);
  if (!code) return sink.already_reported();
  return Explorer(text->data, *code, binding, locator, options, values, sink).explore();
}

}  // namespace parallax::compiler
