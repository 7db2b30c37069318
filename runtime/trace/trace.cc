#include "runtime/trace/trace.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::Literal;

namespace {

/// Location atoms are named L0, L1, ... after the plan's steps; terminals have other names.
std::optional<std::size_t> step_number(std::string_view name, std::size_t count) {
  if (!name.starts_with('L')) return std::nullopt;
  std::size_t number = 0;
  const auto* end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + 1, end, number);
  if (error != std::errc() || stop != end || number >= count) return std::nullopt;
  return number;
}

}  // namespace

Trace decode_trace(const CompiledModel& model, Timepoint length,
                   const std::function<bool(Literal)>& value) {
  Trace trace;
  trace.points.resize(static_cast<std::size_t>(length) + 1);
  for (std::size_t i = 0; i < model.atoms.size(); ++i) {
    const auto& atom = model.atoms[i];
    if (compiler::needed_horizon(atom) > length) continue;
    if (!value(Literal::positive(static_cast<std::int32_t>(i + 1)))) continue;
    if (!atom.time) {
      if (atom.kind == AtomKind::kPredicate) trace.predicates.push_back(atom.name);
      continue;
    }
    auto& point = trace.points[static_cast<std::size_t>(*atom.time)];
    switch (atom.kind) {
      case AtomKind::kHoldsAt:
        point.holds.push_back(atom.name);
        break;
      case AtomKind::kHappens:
        point.happens.push_back(atom.name);
        break;
      case AtomKind::kReleasedAt:
        point.released.push_back(atom.name);
        break;
      case AtomKind::kLocation:
        if (*atom.time < length) point.plan_step = step_number(atom.name, model.plan.size());
        break;
      case AtomKind::kPredicate:
      case AtomKind::kHit:
      case AtomKind::kRunning:
        break;
    }
  }
  for (auto& point : trace.points) {
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
    const auto& happens = trace.points[t].happens;
    for (std::size_t i = 0; i < happens.size(); ++i) {
      if (i > 0) key += '+';
      key += happens[i];
    }
    key += ';';
  }
  return key;
}

}  // namespace parallax::runtime
