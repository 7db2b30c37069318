// Reachability by names in the text: a function is reached if a reached text names it, as a call
// or as data. Names that are put together while the plan runs are not seen; a call
// of such a function is reported where it happens. Cost: linear in the text, times the rounds in
// which further rules begin to count.
#include "compiler/interpreter/plan_reach.h"

#include <algorithm>

#include "compiler/interpreter/fact_base.h"

namespace parallax::compiler {

void PlanReach::reach(std::string_view name) {
  if (!reached_.emplace(name).second) return;
  const auto [begin, end] = definitions_.equal_range(name);
  for (auto found = begin; found != end; ++found) open_.push_back(found->second);
}

void PlanReach::add_slots(DatumId condition) {
  const auto items = data_.children(condition);
  if (items.size() < 4) return;
  for (const auto slot : data_.children(items[3])) {
    const auto parts = data_.children(slot);
    const auto options = [&](std::string_view name) {
      std::vector<DatumId> out;
      for (std::size_t i = 1; i + 1 < parts.size(); i += 2) {
        if (data_.is_keyword(parts[i]) && data_.name(parts[i]) == name) out.push_back(parts[i + 1]);
      }
      return out;
    };
    for (const auto* kind : {"reader", "accessor"}) {
      for (const auto reader : options(kind)) {
        if (!data_.is_symbol(reader)) continue;
        for (const auto initial : options("initform")) define(data_.key(reader), initial);
      }
    }
  }
}

void PlanReach::read(DatumId form) {
  std::vector<DatumId> inside = {form};
  while (!inside.empty()) {
    const auto datum = inside.back();
    inside.pop_back();
    const auto items = data_.children(datum);
    inside.insert(inside.end(), items.begin(), items.end());
    if (!data_.is_symbol(datum) && !data_.is_keyword(datum)) continue;
    reach(data_.name(datum));
    if (data_.is_symbol(datum)) reach(data_.key(datum));
  }
}

void PlanReach::add_facts(DatumId group) {
  const auto items = data_.children(group);
  for (std::size_t i = 3; i < items.size(); ++i) {
    const auto parts = data_.children(items[i]);
    if (parts.size() < 2) continue;
    Clause clause{{}, items[i]};
    const auto head = data_.head(parts[1]).value_or("");
    if (head != kGroundingRule) {
      clause.conditions.emplace_back(head);
      clauses_.push_back(std::move(clause));
      continue;
    }
    // (:type :fetching), wherever it stands in the rule
    std::vector<DatumId> inside(parts.begin() + 2, parts.end());
    while (!inside.empty()) {
      const auto pair = data_.children(inside.back());
      inside.pop_back();
      inside.insert(inside.end(), pair.begin(), pair.end());
      if (pair.size() != 2 || !data_.is_keyword(pair[0]) || data_.name(pair[0]) != "type") continue;
      const bool named = data_.is_keyword(pair[1]) ||
                         (data_.is_symbol(pair[1]) && !data_.name(pair[1]).starts_with('?'));
      if (named) clause.conditions.push_back(data_.name(pair[1]));
    }
    clauses_.push_back(std::move(clause));
  }
}

bool PlanReach::counts(const Clause& clause) const {
  if (clause.conditions.empty()) return true;
  return std::any_of(clause.conditions.begin(), clause.conditions.end(),
                     [&](const std::string& name) { return reached_.contains(name); });
}

void PlanReach::find(std::span<const DatumId> forms, std::span<const std::string> names) {
  for (const auto& name : names) reach(name);
  open_.insert(open_.end(), forms.begin(), forms.end());
  while (!open_.empty()) {
    const auto form = open_.back();
    open_.pop_back();
    read(form);
    if (!open_.empty()) continue;
    const auto next = std::stable_partition(clauses_.begin(), clauses_.end(),
                                            [&](const Clause& clause) { return !counts(clause); });
    for (auto clause = next; clause != clauses_.end(); ++clause) open_.push_back(clause->form);
    clauses_.erase(next, clauses_.end());
  }
}

}  // namespace parallax::compiler
