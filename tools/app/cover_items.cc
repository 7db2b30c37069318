#include "tools/app/cover_items.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "compiler/base/ground_name.h"
#include "harness/campaign/loop_judge.h"
#include "harness/campaign/loop_samples.h"

namespace parallax::tools {

using compiler::Literal;
using compiler::LocationId;
using compiler::Timepoint;
using runtime::SolveStatus;

namespace {

compiler::PlanStepId plan_step(LocationId id) {
  return compiler::PlanStepId(static_cast<std::uint32_t>(id.index()));
}

harness::CoverItem item_of(const CoverageKey& key) {
  const auto what = key.group == CoverageGroup::kHandlers ? "handler of " + key.id
                    : key.group == CoverageGroup::kEvents ? key.id + " happens"
                                                          : key.id;
  return {fmt::format("{}:{}", key.file, key.line), what};
}

}  // namespace

std::string outcome_of(const harness::PathStep& step, const compiler::PlanLocation& location) {
  if (step.succeeded) return "succeeds";
  return location.failures.empty() ? "fails" : "fails with " + step.condition;
}

std::unique_ptr<ScenarioCoverWatch> ScenarioCoverWatch::make(const ScenarioModel& loaded,
                                                             ClosedLoop& loop,
                                                             const PlanCoverage& plan,
                                                             std::uint64_t seed,
                                                             const base::SourceFiles& files) {
  auto out =
      std::unique_ptr<ScenarioCoverWatch>(new ScenarioCoverWatch(loaded, loop, plan, seed, files));
  if (!out->settle()) return nullptr;
  return out;
}

ScenarioCoverWatch::ScenarioCoverWatch(const ScenarioModel& loaded, ClosedLoop& loop,
                                       const PlanCoverage& plan, std::uint64_t seed,
                                       const base::SourceFiles& files)
    : loaded_(loaded),
      loop_(loop),
      plan_(plan),
      seed_(seed),
      files_(files),
      index_(loaded.compilation.model),
      fluents_(*loop.symbols()) {}

CoverageKey ScenarioCoverWatch::perform_key(LocationId id, const std::string& event,
                                            const std::string& outcome) const {
  return coverage_key(CoverageGroup::kPerforms, loaded_.compilation.plan->locations[id].source,
                      fmt::format("{} {}", event, outcome), files_);
}

void ScenarioCoverWatch::add_targets() {
  const auto& graph = *loaded_.compilation.plan;
  const auto& model = loaded_.compilation.model;
  std::map<std::string, std::uint32_t> slots;
  for (const auto& event : model.events) {
    if (event.slot) slots.emplace(event.name, *event.slot);
  }
  std::set<std::pair<std::int64_t, std::string>> known;
  std::set<std::uint32_t> idle_or_performed(loop_.admission().undemanded().begin(),
                                            loop_.admission().undemanded().end());
  for (const auto& perform : loop_.scenario_plan().performs()) {
    const auto slot = slots.find(perform.event);
    if (slot != slots.end()) idle_or_performed.insert(slot->second);
    if (!known.emplace(perform.step, perform.event).second) continue;
    const auto id = graph.locations.id_at(static_cast<std::size_t>(perform.step));
    Target target;
    target.location = id;
    target.is_perform = true;
    if (slot != slots.end()) target.slots.insert(slot->second);
    const auto add = [&](bool succeeded, const std::string& outcome) {
      target.key = perform_key(id, perform.event, outcome);
      target.succeeded = succeeded;
      wanted_.insert(target.key);
      // An event without a slot is not in the model, so no execution has it.
      if (!target.slots.empty()) targets_.push_back(target);
    };
    add(true, "succeeds");
    const auto& failures = graph.locations[id].failures;
    if (failures.empty()) add(false, "fails");
    for (const auto& way : failures) add(false, "fails with " + way.failure_class);
  }
  for (std::size_t i = 0; i < graph.locations.size(); ++i) {
    const auto id = graph.locations.id_at(i);
    if (plan_.earlier(id).empty()) continue;
    Target target;
    target.key = plan_.retry(graph.locations[id]);
    target.location = id;
    target.is_perform = true;
    wanted_.insert(target.key);
    targets_.push_back(std::move(target));
  }
  std::map<std::string, Target> by_symbol;
  const auto& typed = *loaded_.compilation.typed;
  for (const auto& event : model.events) {
    if (!event.slot || idle_or_performed.contains(*event.slot)) continue;
    const auto name = base::symbol_of(event.name);
    const auto symbol = typed.find_symbol(name);
    if (!symbol) continue;
    auto& target = by_symbol[name];
    target.key =
        coverage_key(CoverageGroup::kEvents, typed.symbols[*symbol].declared, name, files_);
    target.slots.insert(*event.slot);
  }
  for (auto& [name, target] : by_symbol) {
    demanded_.emplace(name, target.key);
    wanted_.insert(target.key);
    targets_.push_back(std::move(target));
  }
}

/// Alternative sets of literals with which an execution of `n` steps ends with the target.
std::vector<std::vector<Literal>> ScenarioCoverWatch::ways_to(const Target& target,
                                                              Timepoint n) const {
  const auto& model = loaded_.compilation.model;
  std::vector<std::vector<Literal>> out;
  if (!target.is_perform) {
    for (const auto slot : target.slots) {
      out.push_back({Literal::positive(model.variable(slot, n - 1))});
    }
    return out;
  }
  const auto at = index_.at(plan_step(target.location), n - 1);
  if (!at) return out;
  if (target.succeeded) {
    const auto succeeded = index_.succeeded(plan_step(target.location), n);
    if (*target.succeeded && !succeeded) return out;
    for (const auto slot : target.slots) {
      out.push_back({*at, Literal::positive(model.variable(slot, n - 1))});
      if (succeeded) out.back().push_back(*target.succeeded ? *succeeded : ~*succeeded);
    }
    return out;
  }
  for (const auto earlier : plan_.earlier(target.location)) {
    for (Timepoint t = 0; t + 1 < n; ++t) {
      const auto was_at = index_.at(plan_step(earlier), t);
      if (!was_at) continue;
      out.push_back({*at, *was_at});
      if (const auto succeeded = index_.succeeded(plan_step(earlier), t + 1)) {
        out.back().push_back(~*succeeded);
      }
    }
  }
  return out;
}

/// All targets that executions of `n` steps end with. False if the solver was stopped.
bool ScenarioCoverWatch::look_at(const PlanReach& reach, Timepoint n) {
  auto& session = loop_.session();
  struct Open {
    const CoverageKey* key;
    std::vector<std::vector<Literal>> ways;
    std::vector<Literal> goes;  // of each way
  };
  std::vector<Open> open;
  for (const auto& target : targets_) {
    if (found_.contains(target.key)) continue;
    Open one{&target.key, ways_to(target, n), {}};
    for (const auto& way : one.ways) {
      one.goes.push_back(session.new_variable());
      for (const auto literal : way) session.add_clause(std::vector{~one.goes.back(), literal});
    }
    if (!one.ways.empty()) open.push_back(std::move(one));
  }
  const auto holds = [&](const std::vector<Literal>& way) {
    return std::all_of(way.begin(), way.end(), [&](Literal one) { return session.value(one); });
  };
  const auto assumptions = reach.nothing_idle(n);
  while (!open.empty()) {
    const auto some = session.new_variable();
    std::vector<Literal> clause = {~some};
    for (const auto& one : open) clause.insert(clause.end(), one.goes.begin(), one.goes.end());
    session.add_clause(clause);
    auto assumed = assumptions;
    assumed.push_back(some);
    const auto status = session.solve_whole(n, assumed);
    if (status == SolveStatus::kUnknown) return false;
    if (status == SolveStatus::kSatisfiable) {
      for (const auto& one : open) {
        if (std::any_of(one.ways.begin(), one.ways.end(), holds)) found_.insert(*one.key);
      }
    }
    const auto retired = ~some;
    session.add_clause(std::span(&retired, 1));
    if (status == SolveStatus::kUnsatisfiable) return true;
    std::erase_if(open, [&](const Open& one) { return found_.contains(*one.key); });
  }
  return true;
}

bool ScenarioCoverWatch::settle() {
  add_targets();
  PlanReach reach(loaded_, loop_, plan_);
  if (!reach.run()) return false;
  for (Timepoint n = 1; n <= loaded_.compilation.model.horizon; ++n) {
    if (found_.size() == wanted_.size()) break;
    if (!look_at(reach, n)) return false;
  }
  auto items = found_;
  std::set<CoverageKey> unreachable;
  std::set_difference(wanted_.begin(), wanted_.end(), found_.begin(), found_.end(),
                      std::inserter(unreachable, unreachable.end()));
  for (const auto& key : plan_.all()) {
    // Outcomes and retries are covered by the targets, which are more exact.
    if (key.group != CoverageGroup::kBranches && key.group != CoverageGroup::kHandlers) continue;
    if (plan_.outcomes().contains(key) || plan_.without_performs().contains(key)) continue;
    const bool may_be = reach.found().contains(key) || reach.is_undecided(key);
    (may_be ? items : unreachable).insert(key);
  }
  name_all(items, unreachable);
  return true;
}

void ScenarioCoverWatch::name_all(const std::set<CoverageKey>& items,
                                  const std::set<CoverageKey>& unreachable) {
  // In the order of the files.
  const auto by_place = [](const std::set<CoverageKey>& keys) {
    std::vector<CoverageKey> out(keys.begin(), keys.end());
    std::stable_sort(out.begin(), out.end(), [](const CoverageKey& a, const CoverageKey& b) {
      return std::tie(a.file, a.line, a.column) < std::tie(b.file, b.line, b.column);
    });
    return out;
  };
  for (const auto& key : by_place(items)) {
    numbers_.emplace(key, items_.size());
    items_.push_back(item_of(key));
  }
  for (const auto& key : by_place(unreachable)) unreachable_.push_back(item_of(key));
}

std::vector<std::size_t> ScenarioCoverWatch::shown_by(const harness::SampleRecord& record,
                                                      bool admitted) {
  std::set<std::size_t> shown;
  const auto show = [&](const CoverageKey& key) {
    if (const auto found = numbers_.find(key); found != numbers_.end()) {
      shown.insert(found->second);
    }
  };
  const auto draw = harness::LoopSamples::choices_key(seed_, record.sample);
  if (const auto path = loop_.scenario_plan().retrace(draw, record)) {
    for (const auto& key : plan_.covered_by(*path)) show(key);
  }
  const auto& graph = *loaded_.compilation.plan;
  const auto& steps = record.path->steps;
  for (const auto& step : steps) {
    const auto id = graph.locations.id_at(static_cast<std::size_t>(step.step));
    show(perform_key(id, step.event, outcome_of(step, graph.locations[id])));
  }
  if (!admitted || demanded_.empty()) return {shown.begin(), shown.end()};
  // Events that nobody performed are read from a trace of the model that goes the same way.
  std::set<std::string> missing;
  std::vector<harness::LoopFeed::ObservedFluents> states;
  const auto& scenario = loaded_.scenario;
  for (auto& seen :
       harness::path_states(*scenario.mapping, fluents_, record, scenario.comparison(), missing)) {
    states.push_back(std::move(seen.state.holds));
  }
  if (const auto trace = loop_.trace_of(steps, steps.size(), states)) {
    for (std::size_t t = 0; t < trace->points.size(); ++t) {
      for (const auto event : trace->happens(t)) {
        const auto found = demanded_.find(base::symbol_of(event));
        if (found != demanded_.end()) show(found->second);
      }
    }
  }
  return {shown.begin(), shown.end()};
}

}  // namespace parallax::tools
