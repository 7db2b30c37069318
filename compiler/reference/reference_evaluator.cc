#include "compiler/reference/reference_evaluator.h"

#include <algorithm>

#include "compiler/base/contract.h"

namespace parallax::compiler {

ReferenceEvaluator::ReferenceEvaluator(const TypedModel& model, const ReferenceLimits& limits)
    : model_(model),
      limits_(limits),
      budget_(limits.max_instances, limits.stop),
      expanded_(model, budget_) {}

std::optional<std::string> ReferenceEvaluator::refusal() const {
  if (expanded_.too_deep()) return "its formulas nest too deep";
  if (!budget_.spent()) return std::nullopt;
  if (limits_.stop != nullptr && limits_.stop->load()) return "the check was stopped";
  return "the model has more than " + std::to_string(limits_.max_instances) +
         " ground terms and instances";
}

std::optional<Violation> ReferenceEvaluator::check(const Valuation& valuation) const {
  auto report = violations(valuation, 1);
  if (report.violations.empty()) return std::nullopt;
  return std::move(report.violations.front());
}

ReferenceReport ReferenceEvaluator::violations(const Valuation& valuation,
                                               std::size_t limit) const {
  PARALLAX_REQUIRE(!refusal(), "a model within the limits");
  ReferenceReport report;
  note_strange_atoms(valuation, limit, report.violations);
  const auto values = values_of(valuation);
  const auto length = static_cast<std::int64_t>(valuation.holds.size()) - 1;
  ReferenceSearch search(model_, expanded_, values, std::min(length, horizon()));
  search.run(limit - report.violations.size(), limits_.max_reasons);
  for (const auto& finding : search.found()) report.violations.push_back(describe(finding, values));
  report.finished = search.finished();
  return report;
}

bool ReferenceEvaluator::accepts(const Values& values) const {
  ReferenceSearch search(model_, expanded_, values, horizon());
  search.run(1, limits_.max_reasons);
  return search.found().empty();
}

std::vector<base::SourceRange> ReferenceEvaluator::silent_axioms() const {
  std::vector<base::SourceRange> sources;
  for (const auto axiom : expanded_.silent_axioms()) {
    sources.push_back(model_.axioms[axiom].source);
  }
  return sources;
}

ReferenceEvaluator::Values ReferenceEvaluator::values_of(const Valuation& valuation) const {
  Values values(expanded_.atom_count(), 0);
  const auto last = std::min(static_cast<std::int64_t>(valuation.holds.size()) - 1, horizon());
  for (std::int64_t t = 0; t <= last; ++t) {
    const auto now = static_cast<std::size_t>(t);
    for (const auto& text : valuation.holds[now]) {
      if (const auto f = expanded_.fluent(text)) values[expanded_.holds(*f, t)] = 1;
    }
    if (now < valuation.released.size()) {
      for (const auto& text : valuation.released[now]) {
        if (const auto f = expanded_.fluent(text)) values[expanded_.released(*f, t)] = 1;
      }
    }
    if (t == last || now >= valuation.happens.size()) continue;
    for (const auto& text : valuation.happens[now]) {
      if (const auto e = expanded_.event(text)) values[expanded_.happens(*e, t)] = 1;
    }
  }
  for (const auto& text : valuation.predicates) {
    if (const auto number = expanded_.predicate(text)) values[*number] = 1;
  }
  return values;
}

/// Atoms that the model does not have, or that nothing could be a reason for.
void ReferenceEvaluator::note_strange_atoms(const Valuation& valuation, std::size_t limit,
                                            std::vector<Violation>& out) const {
  const auto note = [&](std::string what, std::int64_t t) {
    if (out.size() < limit) out.push_back({{}, what, t, what});
  };
  const auto scan = [&](const std::vector<std::set<std::string>>& points, const std::string& name,
                        std::int64_t last, const auto& known) {
    for (std::size_t t = 0; t < points.size(); ++t) {
      const auto time = static_cast<std::int64_t>(t);
      for (const auto& text : points[t]) {
        if (time <= last && known(text)) continue;
        note("there is no " + name + "(" + text + "," + std::to_string(t) + ")", time);
      }
    }
  };
  const auto last = static_cast<std::int64_t>(valuation.holds.size()) - 1;
  if (last < 0 || last > horizon()) {
    note(
        "the trace ends at " + std::to_string(last) + ", the model at " + std::to_string(horizon()),
        last);
  }
  const auto is_fluent = [&](const auto& text) { return expanded_.fluent(text).has_value(); };
  const auto is_event = [&](const auto& text) { return expanded_.event(text).has_value(); };
  scan(valuation.holds, "HoldsAt", horizon(), is_fluent);
  scan(valuation.released, "ReleasedAt", last, is_fluent);
  scan(valuation.happens, "Happens", last - 1, is_event);
  for (const auto& text : valuation.predicates) {
    if (expanded_.predicate(text)) continue;
    const auto symbol = model_.find_symbol(text.substr(0, text.find('(')));
    if (!symbol || model_.symbols[*symbol].kind != SymbolKind::kPredicate) {
      note("there is no " + text, 0);
      continue;
    }
    for (const auto& completion : model_.completions) {
      if (completion.predicate != *symbol) continue;
      const auto what = "completion of " + text;
      if (out.size() < limit) out.push_back({completion.source, what, 0, what + ": no reason"});
    }
  }
}

}  // namespace parallax::compiler
