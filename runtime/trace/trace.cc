#include "runtime/trace/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/base/hash.h"

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::Literal;

namespace {

template <typename Id>
Names sorted(const compiler::SymbolTable& symbols, std::span<const Id> ids) {
  Names names;
  names.reserve(ids.size());
  for (const auto id : ids) names.push_back(symbols.name(id));
  std::sort(names.begin(), names.end());
  return names;
}

/// Instances of one symbol stand together in declaration order, but nothing is taken for granted.
void add(std::vector<SymbolInstances>& symbols, const std::string& atom, std::size_t id) {
  const auto symbol = base::symbol_of(atom);
  if (symbols.empty() || symbols.back().symbol != symbol) {
    const auto known = std::find_if(symbols.begin(), symbols.end(),
                                    [&](const auto& one) { return one.symbol == symbol; });
    if (known != symbols.end()) {
      known->atoms.push_back(atom);
      known->ids.push_back(static_cast<std::uint32_t>(id));
      return;
    }
    symbols.push_back({symbol, {}, {}});
  }
  symbols.back().atoms.push_back(atom);
  symbols.back().ids.push_back(static_cast<std::uint32_t>(id));
}

}  // namespace

Symbols symbols_of(const CompiledModel& model) {
  return std::make_shared<const compiler::SymbolTable>(model);
}

Names sorted_names(const compiler::SymbolTable& symbols, std::span<const compiler::FluentId> ids) {
  return sorted(symbols, ids);
}
Names sorted_names(const compiler::SymbolTable& symbols, std::span<const compiler::EventId> ids) {
  return sorted(symbols, ids);
}

TracePoint point_of_names(std::span<const std::string> holds, std::span<const std::string> happens,
                          compiler::SymbolTable& symbols) {
  TracePoint point;
  for (const auto& name : holds) point.holds.push_back(symbols.add_fluent(name));
  for (const auto& name : happens) point.happens.push_back(symbols.add_event(name));
  std::sort(point.holds.begin(), point.holds.end());
  std::sort(point.happens.begin(), point.happens.end());
  return point;
}

Trace decode_trace(const CompiledModel& model, Symbols symbols, Timepoint length,
                   const std::function<bool(Literal)>& value) {
  Trace trace;
  trace.symbols = std::move(symbols);
  trace.points.resize(static_cast<std::size_t>(length) + 1);
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.needed_horizon(model.horizon) > length) return;
    if (!value(atom.literal())) return;
    if (!atom.time) {
      if (atom.kind == AtomKind::kPredicate) trace.predicates.push_back(atom.name);
      return;
    }
    const auto time = static_cast<std::size_t>(*atom.time);
    auto& point = trace.points[time];
    switch (atom.kind) {
      case AtomKind::kHoldsAt:
        point.holds.push_back(atom.fluent());
        break;
      case AtomKind::kHappens:
        point.happens.push_back(atom.event());
        break;
      case AtomKind::kReleasedAt:
        point.released.push_back(atom.fluent());
        break;
      case AtomKind::kLocation:
        // A choice that is taken here says nothing of the step.
        if (*atom.time == length) break;
        if (const auto* step = std::get_if<compiler::PlanStepId>(&atom.plan)) {
          if (step->index() < model.plan.size()) point.plan_step = step->index();
        }
        break;
      case AtomKind::kSucceeded:
        trace.points[time - 1].succeeded = true;
        break;
      case AtomKind::kResult:
        if (const auto* returned = std::get_if<compiler::ReturnedObject>(&atom.plan)) {
          trace.points[time - 1].returned = returned->object;
        }
        break;
      case AtomKind::kRegister:
        if (const auto* known = std::get_if<compiler::RegisterValue>(&atom.plan)) {
          point.registers.emplace(known->name, known->object);
        }
        break;
      case AtomKind::kPredicate:
      case AtomKind::kHit:
      case AtomKind::kRunning:
      case AtomKind::kAuxiliary:
      case AtomKind::kUnused:
        break;
    }
  });
  for (auto& point : trace.points) {  // in any order of the model's variables
    std::sort(point.holds.begin(), point.holds.end());
    std::sort(point.happens.begin(), point.happens.end());
    std::sort(point.released.begin(), point.released.end());
  }
  std::sort(trace.predicates.begin(), trace.predicates.end());
  return trace;
}

std::string event_key(const Trace& trace) {
  std::string key;
  for (std::size_t t = 0; t + 1 < trace.points.size(); ++t) {
    const auto happens = trace.happens(t);
    for (std::size_t i = 0; i < happens.size(); ++i) {
      if (i > 0) key += '+';
      key += happens[i];
    }
    if (trace.points[t].returned) key += '=' + *trace.points[t].returned;
    key += ';';
  }
  return key;
}

Vocabulary vocabulary_of(const compiler::CompiledModel& model) {
  Vocabulary out;
  for (std::size_t f = 0; f < model.fluents.size(); ++f) {
    add(out.fluents, model.fluents[f].name, f);
    if (model.release_slots[f]) add(out.releasable, model.fluents[f].name, f);
  }
  for (std::size_t e = 0; e < model.events.size(); ++e) add(out.events, model.events[e].name, e);
  std::vector<std::string> predicates;
  for (const auto& atom : model.fixed) {
    if (atom.kind == compiler::AtomKind::kPredicate) predicates.push_back(atom.name);
    if (atom.kind == compiler::AtomKind::kHappens) out.last_events.insert(atom.name);
  }
  out.horizon = model.horizon;
  std::sort(predicates.begin(), predicates.end());
  for (std::size_t p = 0; p < predicates.size(); ++p) add(out.predicates, predicates[p], p);
  return out;
}

std::string model_hash(const compiler::CompiledModel& model) {
  std::string bytes;
  for (const auto& source : model.sources) bytes += fmt::format("{:016x}\n", source.hash);
  for (const auto& [name, value] : model.options) bytes += fmt::format("{}={}\n", name, value);
  return fmt::format("{:016x}", base::fnv1a64(bytes));
}

}  // namespace parallax::runtime
