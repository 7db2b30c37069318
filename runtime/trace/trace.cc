#include "runtime/trace/trace.h"

#include <algorithm>
#include <utility>

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

Trace decode_trace(const CompiledModel& model, Symbols symbols, Timepoint length,
                   const std::function<bool(Literal)>& value) {
  Trace trace;
  trace.symbols = std::move(symbols);
  trace.points.resize(static_cast<std::size_t>(length) + 1);
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.time.value_or(0) + (atom.kind == AtomKind::kHappens ? 1 : 0) > length) return;
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

}  // namespace parallax::runtime
