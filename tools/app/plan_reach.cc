// Finds traces that together go every way of a plan that any trace can go.
//
// A way leads from one perform and its outcome through branches to the next perform. For each
// length there is a literal for each way still wanted, which implies its two performs, the
// outcome and the free choices; one call asks for a trace with any of them. An answer covers all
// that its whole path covers, and what is covered is asked for no more. Guards are not part of
// the literals, so an answer may take another way between the same performs. Then a clause
// demands that something which the deciding guard read has another value, and the question is
// repeated (refinement by counterexamples). After a limited number of these a way is given up.
//
// Cost: for each length one call for each answer and one more; ways are limited for each outcome
// of a perform, since there may be exponentially many in the branches.

#include "tools/app/plan_reach.h"

#include <algorithm>
#include <utility>

namespace parallax::tools {

using compiler::AtomKind;
using compiler::BranchId;
using compiler::Literal;
using compiler::LocationId;
using compiler::Timepoint;
using runtime::SolveStatus;

namespace {

// Ways from one perform to the next; more behind further branches are not looked for.
constexpr std::size_t kMaxWaysFromOne = 1024;
// Limit, per way and number of steps, on answers that took another way between the same performs.
constexpr int kMaxRefinements = 64;

compiler::PlanStepId step_of(LocationId id) {
  return compiler::PlanStepId(static_cast<std::uint32_t>(id.index()));
}

}  // namespace

PlanReach::PlanReach(const ScenarioModel& loaded, ClosedLoop& loop, const PlanCoverage& plan)
    : loaded_(loaded),
      graph_(*loaded.compilation.plan),
      loop_(loop),
      plan_(plan),
      index_(loaded.compilation.model) {
  const auto& model = loaded.compilation.model;
  std::map<std::string, std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < model.fluents.size(); ++i)
    numbers.emplace(model.fluents[i].name, i);
  for (const auto& name : loop.scenario_plan().questions().fluents()) {
    const auto found = numbers.find(name);
    known_.push_back(found != numbers.end());
    fluents_.emplace_back(known_.back() ? found->second : 0);
  }
  std::set<std::string> performed;
  for (const auto& perform : loop.scenario_plan().performs()) performed.insert(perform.event);
  std::set<std::uint32_t> slots;
  for (const auto& event : model.events) {
    if (event.slot && performed.contains(event.name)) slots.insert(*event.slot);
  }
  for (const auto slot : loop.admission().undemanded()) {
    if (!slots.contains(slot)) idle_.push_back(slot);
  }
  auto left = kMaxWaysFromOne;
  add_ways({}, graph_.entry, left);
  for (std::size_t i = 0; i < graph_.locations.size(); ++i) {
    const auto id = graph_.locations.id_at(i);
    for (const bool succeeded : {true, false}) {
      Way way;
      way.from = id;
      way.succeeded = succeeded;
      left = kMaxWaysFromOne;
      add_ways(std::move(way),
               succeeded ? graph_.locations[id].on_success : graph_.locations[id].on_failure, left);
    }
  }
}

/// Recursion is as deep as branches follow each other.
void PlanReach::add_ways(Way way, const compiler::PlanTarget& target, std::size_t& left) {
  if (left == 0) {
    too_many_ways_ = true;
    return;
  }
  if (const auto* id = std::get_if<BranchId>(&target)) {
    const auto& branch = graph_.branches[*id];
    for (const bool side : {true, false}) {
      auto next = way;
      next.decisions.emplace_back(*id, side);
      add_ways(std::move(next), side ? branch.if_true : branch.if_false, left);
    }
    return;
  }
  --left;
  if (const auto* location = std::get_if<LocationId>(&target)) way.to = *location;
  PlanPath path;
  if (way.from) path.steps.push_back({*way.from, way.succeeded});
  path.decisions = way.decisions;
  way.items = plan_.covered_by(path);
  ways_.push_back(std::move(way));
}

std::optional<Literal> PlanReach::choice(BranchId branch, Timepoint t) const {
  return index_.plan(AtomKind::kLocation,
                     compiler::PlanChoiceId(static_cast<std::uint32_t>(branch.index())), t);
}

/// None: no execution goes that way at this time. Guards are not included: an answer may take
/// another way between the same performs.
std::optional<std::vector<Literal>> PlanReach::literals(const Way& way, Timepoint n) const {
  std::vector<Literal> out;
  if (!way.from && n > 0) return std::nullopt;
  if (way.from) {
    if (n == 0) return std::nullopt;
    const auto at = index_.at(step_of(*way.from), n - 1);
    const auto succeeded = index_.succeeded(step_of(*way.from), n);
    if (!at || (way.succeeded && !succeeded)) return std::nullopt;
    out.push_back(*at);
    if (succeeded) out.push_back(way.succeeded ? *succeeded : ~*succeeded);
  }
  for (const auto& [branch, side] : way.decisions) {
    if (!graph_.branches[branch].free) continue;
    const auto literal = choice(branch, n);
    if (!literal && side) return std::nullopt;
    if (literal) out.push_back(side ? *literal : ~*literal);
  }
  if (way.to) {
    const auto at = index_.at(step_of(*way.to), n);
    if (!at) return std::nullopt;
    out.push_back(*at);
  }
  return out;
}

bool PlanReach::wanted(const Way& way) const {
  return std::any_of(way.items.begin(), way.items.end(),
                     [&](const CoverageKey& key) { return !found_.contains(key); });
}

bool PlanReach::run() {
  for (Timepoint n = 0; n <= loaded_.compilation.model.horizon; ++n) {
    if (!look_at(n)) return false;
    std::erase_if(ways_, [&](const Way& way) { return !wanted(way); });
    if (ways_.empty()) break;
  }
  return true;
}

std::vector<Literal> PlanReach::nothing_idle(Timepoint n) const {
  std::vector<Literal> out;
  for (Timepoint t = 0; t < n; ++t) {
    for (const auto slot : idle_) {
      out.push_back(~Literal::positive(loaded_.compilation.model.variable(slot, t)));
    }
  }
  return out;
}

bool PlanReach::look_at(Timepoint n) {
  auto& session = loop_.session();
  std::vector<OpenWay> open;
  for (const auto& way : ways_) {
    auto all = literals(way, n);
    if (!all) continue;
    const auto goes = session.new_variable();
    for (const auto literal : *all) session.add_clause(std::vector{~goes, literal});
    open.push_back({&way, *std::move(all), goes});
  }
  const auto assumptions = nothing_idle(n);
  while (!open.empty()) {
    const auto some = session.new_variable();
    std::vector<Literal> clause = {~some};
    for (const auto& one : open) clause.push_back(one.goes);
    session.add_clause(clause);
    auto assumed = assumptions;
    assumed.push_back(some);
    const auto status = session.solve_whole(n, assumed);
    const auto retired = ~some;
    session.add_clause(std::span(&retired, 1));
    if (status == SolveStatus::kUnknown) return false;
    if (status == SolveStatus::kUnsatisfiable) break;
    const auto answer = std::make_shared<const ReachingTrace>(read(n));
    for (const auto& key : plan_.covered_by(answer->path)) found_.try_emplace(key, answer);
    std::erase_if(open,
                  [&](OpenWay& one) { return !wanted(*one.way) || !refine(one, *answer, n); });
  }
  return true;
}

bool PlanReach::refine(OpenWay& open, const ReachingTrace& answer, Timepoint n) {
  const auto& session = loop_.session();
  const bool between = std::all_of(open.literals.begin(), open.literals.end(),
                                   [&](Literal literal) { return session.value(literal); });
  if (!between) return true;
  if (++open.other_ways > kMaxRefinements) {
    given_up_.insert(open.way->items.begin(), open.way->items.end());
    return false;
  }
  const auto& model = loaded_.compilation.model;
  const auto& point = answer.trace.points.back();
  for (const auto& [branch, side] : open.way->decisions) {
    if (graph_.branches[branch].free || holds(branch, point) == side) continue;
    // The guard decides the same again as long as everything that it reads has these values.
    std::vector<Literal> other = {~open.goes};
    for (const auto number : loop_.scenario_plan().questions().of_guard(branch).fluents) {
      const auto literal =
          known_[number] ? model.holds_at(fluents_[number], n) : std::optional<Literal>();
      if (literal) other.push_back(session.value(*literal) ? ~*literal : *literal);
    }
    for (const auto id : compiler::registers_in(graph_.branches[branch].guard)) {
      const compiler::PlanAtom atom =
          compiler::RegisterValue{graph_.values[id].name, registers_.at(id)};
      if (const auto literal = index_.plan(AtomKind::kRegister, atom, n)) {
        other.push_back(~*literal);
      }
    }
    loop_.session().add_clause(other);
    return true;
  }
  return false;
}

bool PlanReach::holds(BranchId branch, const runtime::TracePoint& point) const {
  return loop_.scenario_plan().questions().holds(branch, registers_, [&](std::uint32_t number) {
    return known_[number] && runtime::contains(point.holds, fluents_[number]);
  });
}

ReachingTrace PlanReach::read(Timepoint n) {
  ReachingTrace out;
  out.trace =
      runtime::decode_trace(loaded_.compilation.model, loop_.symbols(), n,
                            [&](Literal literal) { return loop_.session().value(literal); });
  out.path = path_of(out.trace);
  return out;
}

std::optional<ReachingTrace> PlanReach::whole(const std::vector<compiler::FluentId>& state,
                                              const std::vector<compiler::FluentId>& fluents) {
  const auto& model = loaded_.compilation.model;
  auto assumed = nothing_idle(model.horizon);
  for (const auto fluent : fluents) {
    const auto literal = model.holds_at(fluent, 0);
    if (literal) assumed.push_back(runtime::contains(state, fluent) ? *literal : ~*literal);
  }
  if (loop_.session().solve(model.horizon, assumed) != SolveStatus::kSatisfiable) {
    return std::nullopt;
  }
  return read(model.horizon);
}

/// Uses the free choices of the current valuation, which belongs to the trace.
PlanPath PlanReach::path_of(const runtime::Trace& trace) {
  const auto is_chosen = [&](BranchId branch, Timepoint t) {
    const auto literal = choice(branch, t);
    return literal && loop_.session().value(*literal);
  };
  PlanPath path;
  registers_.clear();
  auto target = graph_.entry;
  for (Timepoint t = 0;; ++t) {
    const auto& point = trace.points[static_cast<std::size_t>(t)];
    while (const auto* id = std::get_if<BranchId>(&target)) {
      const auto& branch = graph_.branches[*id];
      const bool side = branch.free ? is_chosen(*id, t) : holds(*id, point);
      path.decisions.emplace_back(*id, side);
      target = side ? branch.if_true : branch.if_false;
    }
    const auto* id = std::get_if<LocationId>(&target);
    if (id == nullptr || t == trace.length()) return path;
    const auto& location = graph_.locations[*id];
    PlanPath::Step step{*id, point.succeeded};
    if (point.succeeded) {
      if (location.result && point.returned) registers_[*location.result] = *point.returned;
      target = location.on_success;
    } else {
      target = location.on_failure;
      for (std::size_t way = 0; way < location.failures.size(); ++way) {
        const auto passed = compiler::decisions_of_way(graph_, location, way);
        const bool taken = std::all_of(passed.begin(), passed.end(), [&](const auto& decision) {
          return is_chosen(decision.first, t + 1) == decision.second;
        });
        if (taken) step.way = way;
      }
    }
    path.steps.push_back(step);
  }
}

}  // namespace parallax::tools
