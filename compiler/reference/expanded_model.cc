#include "compiler/reference/expanded_model.h"

#include "compiler/reference/model_expander.h"

namespace parallax::compiler {
namespace {

std::optional<std::uint32_t> look_up(const std::map<std::string, std::uint32_t>& numbers,
                                     const std::string& text) {
  const auto found = numbers.find(text);
  if (found == numbers.end()) return std::nullopt;
  return found->second;
}

}  // namespace

ExpandedModel::ExpandedModel(const TypedModel& model, ReferenceBudget& budget) {
  ModelExpander(model, budget, *this).run();
}

std::optional<std::uint32_t> ExpandedModel::fluent(const std::string& text) const {
  return look_up(fluent_numbers_, text);
}

std::optional<std::uint32_t> ExpandedModel::event(const std::string& text) const {
  return look_up(event_numbers_, text);
}

std::optional<std::uint32_t> ExpandedModel::predicate(const std::string& text) const {
  return look_up(predicate_numbers_, text);
}

std::uint32_t ExpandedModel::released(std::uint32_t fluent, std::int64_t t) const {
  return place(t, fluents_.size() + fluent);
}

std::uint32_t ExpandedModel::happens(std::uint32_t event, std::int64_t t) const {
  return place(t, 2 * fluents_.size() + event);
}

std::optional<std::int64_t> ExpandedModel::timepoint(std::uint32_t atom) const {
  if (atom >= timed_atoms()) return std::nullopt;
  return static_cast<std::int64_t>(atom / (2 * fluents_.size() + events_.size()));
}

std::int64_t ExpandedModel::needed(std::uint32_t atom) const {
  const auto t = timepoint(atom);
  if (!t) return 0;
  return atom >= place(*t, 2 * fluents_.size()) ? *t + 1 : *t;
}

std::string ExpandedModel::atom_text(std::uint32_t atom) const {
  const auto t = timepoint(atom);
  if (!t) return predicates_[atom - timed_atoms()];
  const auto offset = atom - place(*t, 0);
  const auto count = fluents_.size();
  const auto end = "," + std::to_string(*t) + ")";
  if (offset < count) return "HoldsAt(" + fluents_[offset] + end;
  if (offset < 2 * count) return "ReleasedAt(" + fluents_[offset - count] + end;
  return "Happens(" + events_[offset - 2 * count] + end;
}

}  // namespace parallax::compiler
