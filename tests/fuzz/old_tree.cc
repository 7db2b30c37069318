#include "tests/fuzz/old_tree.h"

#include <algorithm>
#include <utility>

namespace parallax::test {
namespace {

using Kind = OldTree::Kind;

OldTree negated(OldTree tree) { return OldTree::of(Kind::kNot, {std::move(tree)}); }

bool is_literal(const OldTree& tree) {
  return tree.is(Kind::kAtom) || (tree.is(Kind::kNot) && tree.parts[0].is(Kind::kAtom));
}

OldTree simple_list(const OldTree& tree, bool expand) {
  const bool all = tree.is(Kind::kAnd);
  std::vector<OldTree> kept;
  std::vector<std::string> seen;
  for (const auto& part : tree.parts) {
    auto made = simplified(part, expand);
    if (made.is(all ? Kind::kFalse : Kind::kTrue)) return made;
    if (made.is(Kind::kTrue) || made.is(Kind::kFalse)) continue;
    auto printed = made.print();
    if (std::find(seen.begin(), seen.end(), printed) != seen.end()) continue;
    seen.push_back(std::move(printed));
    kept.push_back(std::move(made));
  }
  if (kept.empty()) return OldTree::constant(all);
  if (kept.size() == 1) return std::move(kept.front());
  return OldTree::of(tree.kind, std::move(kept));
}

OldTree simple_negation(const OldTree& inner, bool expand) {
  switch (inner.kind) {
    case Kind::kTrue:
    case Kind::kFalse:
      return OldTree::constant(inner.is(Kind::kFalse));
    case Kind::kAtom:
      return negated(inner);
    case Kind::kNot:
      return simplified(inner.parts[0], expand);
    case Kind::kImplies:
      return simplified(OldTree::of(Kind::kAnd, {inner.parts[0], negated(inner.parts[1])}), expand);
    case Kind::kAnd:
    case Kind::kOr: {
      std::vector<OldTree> parts;
      for (const auto& part : inner.parts) parts.push_back(negated(part));
      return simplified(
          OldTree::of(inner.is(Kind::kAnd) ? Kind::kOr : Kind::kAnd, std::move(parts)), expand);
    }
    case Kind::kEquiv:
      break;
  }
  const auto made = simplified(inner, expand);
  if (!made.is(Kind::kEquiv)) return simplified(negated(made), expand);
  // Here the program stops; the equivalence is written out.
  return simplified(negated(simplified(inner, true)), true);
}

OldTree simple_equivalence(const OldTree& tree, bool expand) {
  if (expand) {
    const auto implies = [](const OldTree& a, const OldTree& b) {
      return OldTree::of(Kind::kOr, {negated(a), b});
    };
    return simplified(OldTree::of(Kind::kAnd, {implies(tree.parts[0], tree.parts[1]),
                                               implies(tree.parts[1], tree.parts[0])}),
                      true);
  }
  auto left = simplified(tree.parts[0], false), right = simplified(tree.parts[1], false);
  if (left.is(Kind::kTrue)) return right;
  if (right.is(Kind::kTrue)) return left;
  if (left.is(Kind::kFalse)) return simplified(negated(std::move(right)), false);
  if (right.is(Kind::kFalse)) return simplified(negated(std::move(left)), false);
  return OldTree::of(Kind::kEquiv, {std::move(left), std::move(right)});
}

std::size_t flat_length(const OldTree& tree, Kind kind) {
  if (!tree.is(kind)) return 1;
  std::size_t length = 0;
  for (const auto& part : tree.parts) length += flat_length(part, kind);
  return length;
}

double clauses_by_names(const OldTree& tree, Kind around) {
  if (is_literal(tree)) return 0;
  double count = 0;
  for (const auto& part : tree.parts) count += clauses_by_names(part, tree.kind);
  if (tree.is(Kind::kEquiv)) return count + 4;
  // A list in a list of the same kind is part of it.
  if (tree.is(around)) return count;
  return count + 1 + static_cast<double>(flat_length(tree, tree.kind));
}

double clauses_by_distribution(const OldTree& tree) {
  if (is_literal(tree)) return 1;
  double count = tree.is(Kind::kOr) ? 1 : 0;
  for (const auto& part : tree.parts) {
    const auto own = clauses_by_distribution(part);
    count = tree.is(Kind::kOr) ? count * own : count + own;
  }
  return count;
}

std::vector<OldClause> clauses_of(const OldTree& tree) {
  if (tree.is(Kind::kAtom)) return {{tree.atom}};
  if (tree.is(Kind::kNot)) return {{"!" + tree.parts[0].atom}};
  std::vector<OldClause> made;
  if (tree.is(Kind::kAnd)) {
    for (const auto& part : tree.parts) {
      for (auto& clause : clauses_of(part)) made.push_back(std::move(clause));
    }
    return made;
  }
  made = {{}};
  for (const auto& part : tree.parts) {
    std::vector<OldClause> longer;
    for (const auto& more : clauses_of(part)) {
      for (auto clause : made) {
        for (const auto& literal : more) {
          if (std::find(clause.begin(), clause.end(), literal) == clause.end()) {
            clause.push_back(literal);
          }
        }
        longer.push_back(std::move(clause));
      }
    }
    made = std::move(longer);
  }
  return made;
}

}  // namespace

std::string OldTree::print() const {
  static constexpr const char* kNames[] = {"T", "F", "", "not", "and", "or", "implies", "equiv"};
  if (kind == Kind::kAtom) return atom;
  std::string text = std::string("[") + kNames[static_cast<std::size_t>(kind)];
  for (const auto& part : parts) text += " " + part.print();
  return text + "]";
}

bool OldTree::has_beyond() const {
  return is_beyond || std::any_of(parts.begin(), parts.end(),
                                  [](const OldTree& part) { return part.has_beyond(); });
}

OldTree old_conjunction(std::vector<OldTree> parts) {
  for (const auto& part : parts) {
    if (part.is(Kind::kFalse)) return part;
  }
  return OldTree::of(Kind::kAnd, std::move(parts));
}

OldTree old_disjunction(std::vector<OldTree> parts) {
  for (const auto& part : parts) {
    if (part.is(Kind::kTrue)) return part;
  }
  return OldTree::of(Kind::kOr, std::move(parts));
}

OldTree simplified(const OldTree& tree, bool expand) {
  switch (tree.kind) {
    case Kind::kTrue:
    case Kind::kFalse:
    case Kind::kAtom:
      return tree;
    case Kind::kNot:
      return simple_negation(tree.parts[0], expand);
    case Kind::kImplies:
      return simplified(OldTree::of(Kind::kOr, {negated(tree.parts[0]), tree.parts[1]}), expand);
    case Kind::kAnd:
    case Kind::kOr:
      return simple_list(tree, expand);
    case Kind::kEquiv:
      return simple_equivalence(tree, expand);
  }
  return tree;
}

bool distributed(const OldTree& simple, std::vector<OldClause>& clauses) {
  const auto expanded = simplified(simple, true);
  if (clauses_by_distribution(expanded) > 1 + clauses_by_names(simple, Kind::kTrue)) return false;
  clauses = clauses_of(expanded);
  return true;
}

}  // namespace parallax::test
