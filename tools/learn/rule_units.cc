// Conditions that a rule may be made of: those that hold in one step, cheapest first.
//
// The head of the rule has variables, and the step binds them to constants. Units are equations
// between head variables and literals whose places take head variables or variables of their
// own; each gets the sign under which it holds in the state before the step. Later stages add
// conjunctions of two facts of the state, then constants as places, then conjunctions of three
// facts. Constants of joined facts become variables unless they are the head's, and only facts
// that such variables connect are joined, because others say no more than separate units. The
// cost of a unit grows with its literals, its own variables, its constants and a negation, and a
// literal without a head variable costs more.
//
// Cost: for each symbol the product of its places' choices, and the cube of the facts that are
// joined; all of them are limited.

#include "tools/learn/rule_units.h"

#include <algorithm>
#include <map>
#include <set>

namespace parallax::tools {

using compiler::SortId;
using compiler::SymbolKind;

namespace {

constexpr int kLiteral = 10, kPredicate = 9, kUnlike = 6, kConstant = 10, kEquation = 20;
constexpr int kNegation = 1, kSome = 2, kWithoutHead = 3;
constexpr std::size_t kMostEach = 4000;    // literals of one symbol with constants
constexpr std::size_t kMostFacts = 120;    // that are joined
constexpr std::size_t kMostJoined = 4000;  // conditions

class UnitMaker {
 public:
  UnitMaker(const RuleHead& head, const LearnVocabulary& vocabulary,
            const std::vector<Truth>& state, const std::vector<std::size_t>& binding)
      : head_(head), vocabulary_(vocabulary), state_(state), binding_(binding) {}

  std::vector<RuleUnit> make(UnitStage stage) {
    const bool constants = stage >= UnitStage::kConstants;
    add_equations(constants);
    for (std::size_t i = 0; i < vocabulary_.symbols().size(); ++i) {
      if (vocabulary_.symbols()[i].kind != SymbolKind::kEvent) add_literals(i, constants);
    }
    if (stage >= UnitStage::kJoined) add_joined(stage >= UnitStage::kChained ? 3 : 2);
    std::stable_sort(out_.begin(), out_.end(),
                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
    return std::move(out_);
  }

 private:
  const compiler::TypedModel& typed() const { return vocabulary_.typed(); }

  void add_equations(bool constants) {
    for (std::size_t i = 0; i < binding_.size(); ++i) {
      const RuleTerm left{RuleTerm::Kind::kHead, i};
      for (std::size_t j = i + 1; j < binding_.size(); ++j) {
        if (binding_[i] == binding_[j]) continue;
        if (!typed().sorts_overlap(head_.variables[i], head_.variables[j])) continue;
        add_equation(left, true, {RuleTerm::Kind::kHead, j}, kUnlike);
      }
      const auto& domain = vocabulary_.domain(head_.variables[i]);
      if (!constants || domain.size() > kMostFacts) continue;
      for (const auto constant : domain) {
        add_equation(left, constant != binding_[i], {RuleTerm::Kind::kConstant, constant},
                     kEquation + (constant != binding_[i] ? kNegation : 0));
      }
    }
  }

  void add_equation(const RuleTerm& left, bool unlike, const RuleTerm& right, int cost) {
    RuleUnit unit;
    unit.literals.push_back({true, unlike, 0, {left, right}});
    unit.cost = cost;
    out_.push_back(std::move(unit));
  }

  std::vector<RuleTerm> choices(SortId sort, bool constants) const {
    std::vector<RuleTerm> out;
    for (std::size_t i = 0; i < head_.variables.size(); ++i) {
      if (typed().sorts_overlap(head_.variables[i], sort)) {
        out.push_back({RuleTerm::Kind::kHead, i});
      }
    }
    out.push_back({RuleTerm::Kind::kOwn, 0});
    if (!constants) return out;
    for (const auto constant : vocabulary_.domain(sort)) {
      out.push_back({RuleTerm::Kind::kConstant, constant});
    }
    return out;
  }

  void add_literals(std::size_t symbol, bool constants) {
    const auto& sorts = vocabulary_.symbols()[symbol].sorts;
    std::vector<std::vector<RuleTerm>> places;
    std::size_t count = 1;
    for (const auto sort : sorts) {
      places.push_back(choices(sort, constants));
      count = std::min(count * places.back().size(), kMostEach + 1);
    }
    if (count > kMostEach) return;
    std::vector<std::size_t> at(places.size(), 0);
    while (true) {
      std::vector<RuleTerm> terms;
      for (std::size_t i = 0; i < at.size(); ++i) terms.push_back(places[i][at[i]]);
      add_literal(symbol, std::move(terms));
      std::size_t i = at.size();
      while (i > 0 && ++at[i - 1] == places[i - 1].size()) at[--i] = 0;
      if (i == 0) break;
    }
  }

  void add_literal(std::size_t symbol, std::vector<RuleTerm> terms) {
    const auto& declared = vocabulary_.symbols()[symbol];
    // An effect needs no condition on its own fluent; an opening may.
    const bool effect = head_.kind == RuleKind::kInitiates || head_.kind == RuleKind::kTerminates;
    if (effect && symbol == head_.fluent && terms == head_.terms) return;
    if (head_.kind == RuleKind::kAdmits && symbol == head_.fluent) return;
    RuleUnit unit;
    bool about_head = terms.empty();
    unit.cost = declared.kind == SymbolKind::kPredicate ? kPredicate : kLiteral;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      auto& term = terms[i];
      about_head = about_head || term.kind == RuleTerm::Kind::kHead;
      if (term.kind == RuleTerm::Kind::kConstant) unit.cost += kConstant;
      if (term.kind != RuleTerm::Kind::kOwn) continue;
      term.index = unit.own.size();
      unit.own.push_back(declared.sorts[i]);
      unit.cost += kSome;
    }
    if (!about_head) unit.cost += kWithoutHead;
    unit.literals.push_back({false, false, symbol, std::move(terms)});
    const auto value = value_of(unit, vocabulary_, state_, binding_);
    if (value == Truth::kUnknown) return;
    unit.negated = value == Truth::kFalse;
    if (unit.negated && !fits(unit.literals.front())) return;
    if (unit.negated) unit.cost += kNegation;
    out_.push_back(std::move(unit));
  }

  /// Is the sort of each head variable within that of its place? Otherwise there are no atoms
  /// beyond that sort, and a false value there tells nothing.
  bool fits(const RuleLiteral& literal) const {
    const auto& sorts = vocabulary_.symbols()[literal.symbol].sorts;
    for (std::size_t i = 0; i < sorts.size(); ++i) {
      const auto& term = literal.terms[i];
      if (term.kind != RuleTerm::Kind::kHead) continue;
      if (!typed().is_subsort(head_.variables[term.index], sorts[i])) return false;
    }
    return true;
  }

  /// Conjunctions of facts of the state that are connected by constants outside of the head.
  void add_joined(std::size_t most) {
    std::vector<std::size_t> facts;
    for (std::size_t i = 0; i < state_.size() && facts.size() < kMostFacts; ++i) {
      if (state_[i] == Truth::kTrue) facts.push_back(i);
    }
    std::set<std::string> known;
    std::size_t made = 0;
    for (std::size_t a = 0; a < facts.size(); ++a) {
      for (std::size_t b = a + 1; b < facts.size(); ++b) {
        add_conjunction({facts[a], facts[b]}, known, made);
        if (made > kMostJoined) return;
      }
    }
    if (most < 3) return;
    for (std::size_t a = 0; a < facts.size(); ++a) {
      for (std::size_t b = a + 1; b < facts.size(); ++b) {
        for (std::size_t c = b + 1; c < facts.size(); ++c) {
          add_conjunction({facts[a], facts[b], facts[c]}, known, made);
          if (made > kMostJoined) return;
        }
      }
    }
  }

  void add_conjunction(const std::vector<std::size_t>& facts, std::set<std::string>& known,
                       std::size_t& made) {
    // Constants outside of the head, with the facts that contain them.
    std::map<std::size_t, std::set<std::size_t>> places;
    for (std::size_t i = 0; i < facts.size(); ++i) {
      const auto& atom = vocabulary_.atoms()[facts[i]];
      const auto& sorts = vocabulary_.symbols()[atom.symbol].sorts;
      for (std::size_t k = 0; k < sorts.size(); ++k) {
        if (!head_term(atom.arguments[k], sorts[k])) places[atom.arguments[k]].insert(i);
      }
    }
    // Each fact hangs together with the others.
    std::set<std::size_t> linked = {0};
    for (bool more = true; more;) {
      more = false;
      for (const auto& [constant, who] : places) {
        const bool touches =
            std::any_of(who.begin(), who.end(), [&](auto fact) { return linked.contains(fact); });
        if (!touches) continue;
        for (const auto fact : who) more = linked.insert(fact).second || more;
      }
    }
    if (linked.size() != facts.size()) return;
    RuleUnit unit;
    std::map<std::size_t, std::size_t> variables;
    bool about_head = false;
    for (const auto fact : facts) {
      const auto& atom = vocabulary_.atoms()[fact];
      const auto& declared = vocabulary_.symbols()[atom.symbol];
      RuleLiteral literal{false, false, atom.symbol, {}};
      for (std::size_t k = 0; k < declared.sorts.size(); ++k) {
        const auto constant = atom.arguments[k];
        if (const auto head = head_term(constant, declared.sorts[k])) {
          literal.terms.push_back(*head);
          about_head = true;
          continue;
        }
        const auto [place, is_new] = variables.emplace(constant, unit.own.size());
        if (is_new) unit.own.push_back(declared.sorts[k]);
        auto& sort = unit.own[place->second];
        if (typed().is_subsort(declared.sorts[k], sort)) sort = declared.sorts[k];
        literal.terms.push_back({RuleTerm::Kind::kOwn, place->second});
      }
      unit.cost += declared.kind == SymbolKind::kPredicate ? kPredicate : kLiteral;
      unit.literals.push_back(std::move(literal));
    }
    unit.cost += kSome * static_cast<int>(unit.own.size()) + (about_head ? 0 : kWithoutHead);
    std::string key;
    for (const auto& literal : unit.literals) {
      key += "/" + std::to_string(literal.symbol);
      for (const auto& term : literal.terms) {
        key += term.kind == RuleTerm::Kind::kHead ? ",h" : ",o";
        key += std::to_string(term.index);
      }
    }
    if (!known.insert(key).second) return;
    ++made;
    out_.push_back(std::move(unit));
  }

  std::optional<RuleTerm> head_term(std::size_t constant, SortId sort) const {
    for (std::size_t i = 0; i < binding_.size(); ++i) {
      if (binding_[i] == constant && typed().sorts_overlap(head_.variables[i], sort)) {
        return RuleTerm{RuleTerm::Kind::kHead, i};
      }
    }
    return std::nullopt;
  }

  const RuleHead& head_;
  const LearnVocabulary& vocabulary_;
  const std::vector<Truth>& state_;
  const std::vector<std::size_t>& binding_;
  std::vector<RuleUnit> out_;
};

}  // namespace

std::vector<RuleUnit> units_that_hold(const RuleHead& head, const LearnVocabulary& vocabulary,
                                      const std::vector<Truth>& state,
                                      const std::vector<std::size_t>& binding, UnitStage stage) {
  return UnitMaker(head, vocabulary, state, binding).make(stage);
}

}  // namespace parallax::tools
