#include "compiler/reference/expanded_model.h"

#include <algorithm>

#include "compiler/base/contract.h"
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

FormulaTrees::Node FormulaTrees::atom(std::uint32_t number) {
  nodes_.push_back({FormulaKind::kAtom, number, 0});
  return static_cast<Node>(nodes_.size() - 1);
}

FormulaTrees::Node FormulaTrees::add(FormulaKind kind, const std::vector<Node>& parts) {
  nodes_.push_back(
      {kind, static_cast<std::uint32_t>(parts_.size()), static_cast<std::uint32_t>(parts.size())});
  parts_.insert(parts_.end(), parts.begin(), parts.end());
  return static_cast<Node>(nodes_.size() - 1);
}

FormulaTrees::Node FormulaTrees::junction(bool conjunction, const std::vector<Node>& parts) {
  std::vector<Node> open;
  for (const auto part : parts) {
    if (part == constant(!conjunction)) return part;
    if (part != constant(conjunction)) open.push_back(part);
  }
  if (open.empty()) return constant(conjunction);
  if (open.size() == 1) return open.front();
  return add(conjunction ? FormulaKind::kAnd : FormulaKind::kOr, open);
}

FormulaTrees::Node FormulaTrees::connect(FormulaKind kind, const std::vector<Node>& parts) {
  const auto negation = [this](Node node) {
    if (node == kTruth || node == kFalsity) return constant(node == kFalsity);
    return add(FormulaKind::kNot, {node});
  };
  switch (kind) {
    case FormulaKind::kNot:
      return negation(parts[0]);
    case FormulaKind::kAnd:
    case FormulaKind::kOr:
      return junction(kind == FormulaKind::kAnd, parts);
    case FormulaKind::kImplies:
      return junction(false, {negation(parts[0]), parts[1]});
    case FormulaKind::kIff:
      for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
        if (parts[i] == kTruth) return parts[1 - i];
        if (parts[i] == kFalsity) return negation(parts[1 - i]);
      }
      return add(kind, parts);
    case FormulaKind::kTrue:
    case FormulaKind::kFalse:
    case FormulaKind::kAtom:
    case FormulaKind::kCompare:
    case FormulaKind::kForall:
    case FormulaKind::kExists:
      break;
  }
  PARALLAX_REQUIRE(false, "a connective");
  return kFalsity;
}

void FormulaTrees::rewind(std::size_t size) {
  while (nodes_.size() > size) {
    if (nodes_.back().kind != FormulaKind::kAtom) parts_.resize(nodes_.back().first);
    nodes_.pop_back();
  }
}

std::vector<FormulaTrees::Node> FormulaTrees::conjuncts(Node root) const {
  std::vector<Node> out, visit = {root};
  while (!visit.empty()) {
    const auto node = visit.back();
    visit.pop_back();
    const auto& entry = nodes_[node];
    if (entry.kind != FormulaKind::kAnd) {
      out.push_back(node);
      continue;
    }
    for (std::uint32_t i = entry.count; i-- > 0;) visit.push_back(parts_[entry.first + i]);
  }
  return out;
}

std::vector<std::uint32_t> FormulaTrees::atoms_of(Node root) const {
  std::vector<std::uint32_t> atoms;
  std::vector<Node> visit = {root};
  while (!visit.empty()) {
    const auto& entry = nodes_[visit.back()];
    visit.pop_back();
    if (entry.kind == FormulaKind::kAtom) {
      atoms.push_back(entry.first);
      continue;
    }
    for (std::uint32_t i = 0; i < entry.count; ++i) visit.push_back(parts_[entry.first + i]);
  }
  std::sort(atoms.begin(), atoms.end());
  atoms.erase(std::unique(atoms.begin(), atoms.end()), atoms.end());
  return atoms;
}

bool FormulaTrees::value(Node node, const std::vector<std::uint8_t>& values) const {
  const auto& entry = nodes_[node];
  const auto part = [&](std::uint32_t i) { return value(parts_[entry.first + i], values); };
  switch (entry.kind) {
    case FormulaKind::kTrue:
      return true;
    case FormulaKind::kFalse:
      return false;
    case FormulaKind::kAtom:
      return values[entry.first] != 0;
    case FormulaKind::kNot:
      return !part(0);
    case FormulaKind::kIff:
      return part(0) == part(1);
    case FormulaKind::kAnd:
      for (std::uint32_t i = 0; i < entry.count; ++i) {
        if (!part(i)) return false;
      }
      return true;
    case FormulaKind::kOr:
      for (std::uint32_t i = 0; i < entry.count; ++i) {
        if (part(i)) return true;
      }
      return false;
    case FormulaKind::kImplies:
    case FormulaKind::kCompare:
    case FormulaKind::kForall:
    case FormulaKind::kExists:
      break;
  }
  PARALLAX_REQUIRE(false, "a tree has atoms and connectives");
  return false;
}

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
