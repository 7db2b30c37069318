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
  model.for_each_atom([&](std::int32_t variable, AtomKind kind, const std::string& name,
                          std::optional<Timepoint> time) {
    if (time.value_or(0) + (kind == AtomKind::kHappens ? 1 : 0) > length) return;
    if (!value(Literal::positive(variable))) return;
    if (!time) {
      if (kind == AtomKind::kPredicate) trace.predicates.push_back(name);
      return;
    }
    auto& point = trace.points[static_cast<std::size_t>(*time)];
    switch (kind) {
      case AtomKind::kHoldsAt:
        point.holds.push_back(name);
        break;
      case AtomKind::kHappens:
        point.happens.push_back(name);
        break;
      case AtomKind::kReleasedAt:
        point.released.push_back(name);
        break;
      case AtomKind::kLocation:
        if (*time < length) point.plan_step = step_number(name, model.plan.size());
        break;
      case AtomKind::kSucceeded:
        trace.points[static_cast<std::size_t>(*time) - 1].succeeded = true;
        break;
      case AtomKind::kResult:
        trace.points[static_cast<std::size_t>(*time) - 1].returned = name;
        break;
      case AtomKind::kRegister:
        point.registers.emplace(name.substr(0, name.find('=')), name.substr(name.find('=') + 1));
        break;
      case AtomKind::kPredicate:
      case AtomKind::kHit:
      case AtomKind::kRunning:
      case AtomKind::kAuxiliary:
      case AtomKind::kUnused:
        break;
    }
  });
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
    if (trace.points[t].returned) key += '=' + *trace.points[t].returned;
    key += ';';
  }
  return key;
}

}  // namespace parallax::runtime
