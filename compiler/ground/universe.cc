#include "compiler/ground/universe.h"

#include <algorithm>
#include <limits>

#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;

enum : std::uint8_t { kUntouched, kInWork, kDone };

}  // namespace

base::Result<Universe> Universe::make(const TypedModel& model, const GroundOptions& options,
                                      GroundTermStore& terms, base::DiagnosticSink& sink) {
  Universe universe;
  const auto count = model.sorts.size();
  universe.domains_.resize(count);
  universe.members_.resize(count);
  universe.unbounded_.resize(count, false);
  universe.state_.resize(count, kUntouched);
  for (std::size_t i = 0; i < count; ++i) {
    if (!universe.add_domain(model.sorts.id_at(i), model, options, terms, sink)) {
      return sink.already_reported();
    }
  }
  PARALLAX_REQUIRE(model.core.time.has_value(), "a model loads the event calculus");
  const auto& time = model.sorts[*model.core.time];
  auto& timepoints = universe.domains_[model.core.time->index()];
  std::sort(timepoints.begin(), timepoints.end(),
            [&](GroundTermId a, GroundTermId b) { return terms[a].integer < terms[b].integer; });
  if (timepoints.empty()) return sink.error(DiagnosticCode::kNoTimepoints, time.declared);
  if (terms[timepoints.front()].integer != 0) {
    const auto where = time.ranges.empty() ? time.declared : time.ranges.front().declared;
    return sink.error(DiagnosticCode::kTimeMustStartAtZero, where,
                      terms[timepoints.front()].integer);
  }
  for (std::size_t i = 1; i < timepoints.size(); ++i) {
    const auto before = terms[timepoints[i - 1]].integer, after = terms[timepoints[i]].integer;
    if (after == before + 1) continue;
    const auto where = time.ranges.empty() ? time.declared : time.ranges.back().declared;
    return sink.error(DiagnosticCode::kTimeHasGap, where, before + 1, before, after);
  }
  universe.horizon_ = static_cast<std::int32_t>(timepoints.size()) - 1;
  return universe;
}

bool Universe::add_domain(SortId sort, const TypedModel& model, const GroundOptions& options,
                          GroundTermStore& terms, base::DiagnosticSink& sink) {
  auto& state = state_[sort.index()];
  if (state == kDone) return true;
  const auto& declared = model.sorts[sort];
  if (state == kInWork) {
    sink.error(DiagnosticCode::kSortContainsItself, declared.declared, declared.name);
    return false;
  }
  state = kInWork;
  std::vector<GroundTermId> domain;
  bool bounded_below = !declared.ranges.empty();
  for (std::size_t i = 0; i < model.sorts.size(); ++i) {
    const auto below = model.sorts.id_at(i);
    const auto& parents = model.sorts[below].parents;
    if (std::find(parents.begin(), parents.end(), sort) == parents.end()) continue;
    if (!add_domain(below, model, options, terms, sink)) return false;
    const auto& inner = domains_[below.index()];
    domain.insert(domain.end(), inner.begin(), inner.end());
  }
  for (const auto object : declared.constants) domain.push_back(terms.object(object));
  std::int64_t total = static_cast<std::int64_t>(domain.size());
  for (const auto& range : declared.ranges) {
    std::int64_t width = 0;
    if (__builtin_sub_overflow(range.upper, range.lower, &width) ||
        __builtin_add_overflow(total, width, &total) || total >= options.max_domain) {
      sink.error(DiagnosticCode::kDomainTooLarge, range.declared, declared.name,
                 options.max_domain);
      return false;
    }
    ++total;
  }
  for (const auto& range : declared.ranges) {
    for (std::int64_t v = range.lower; v <= range.upper; ++v) domain.push_back(terms.integer(v));
  }
  domains_[sort.index()] = std::move(domain);
  if (declared.reified && !add_constructors(sort, model, options, terms, sink)) return false;

  auto& mine = domains_[sort.index()];
  auto& members = members_[sort.index()];
  for (const auto term : mine) members.push_back(term.index());
  std::sort(members.begin(), members.end());
  if (std::adjacent_find(members.begin(), members.end()) != members.end()) {
    // Overlapping ranges or subsorts: keep the first occurrence of each term.
    members.erase(std::unique(members.begin(), members.end()), members.end());
    std::vector<bool> seen(terms.size(), false);
    std::erase_if(mine, [&](GroundTermId term) {
      const bool again = seen[term.index()];
      seen[term.index()] = true;
      return again;
    });
  }
  unbounded_[sort.index()] = declared.integer && !bounded_below && mine.empty();
  state = kDone;
  return true;
}

bool Universe::add_constructors(SortId sort, const TypedModel& model, const GroundOptions& options,
                                GroundTermStore& terms, base::DiagnosticSink& sink) {
  for (std::size_t i = 0; i < model.symbols.size(); ++i) {
    const auto symbol_id = model.symbols.id_at(i);
    const auto& symbol = model.symbols[symbol_id];
    if (symbol.result != sort || symbol.kind == SymbolKind::kFunction) continue;
    std::int64_t instances = 1;
    for (const auto argument : symbol.arguments) {
      if (!add_domain(argument, model, options, terms, sink)) return false;
      const auto size = static_cast<std::int64_t>(domains_[argument.index()].size());
      if (__builtin_mul_overflow(instances, size, &instances) || instances > options.max_domain) {
        sink.error(DiagnosticCode::kDomainTooLarge, symbol.declared, symbol.name,
                   options.max_domain);
        return false;
      }
    }
    std::vector<std::size_t> odometer(symbol.arguments.size(), 0);
    for (std::int64_t k = 0; k < instances; ++k) {
      std::vector<GroundTermId> arguments;
      for (std::size_t a = 0; a < odometer.size(); ++a) {
        arguments.push_back(domains_[symbol.arguments[a].index()][odometer[a]]);
      }
      domains_[sort.index()].push_back(terms.apply(symbol_id, std::move(arguments)));
      for (std::size_t a = odometer.size(); a-- > 0;) {
        if (++odometer[a] < domains_[symbol.arguments[a].index()].size()) break;
        odometer[a] = 0;
      }
    }
  }
  return true;
}

bool Universe::contains(SortId sort, GroundTermId term, const GroundTermStore& terms) const {
  if (unbounded_[sort.index()]) return terms[term].kind == TermKind::kInteger;
  const auto& members = members_[sort.index()];
  return std::binary_search(members.begin(), members.end(), term.index());
}

}  // namespace parallax::compiler
