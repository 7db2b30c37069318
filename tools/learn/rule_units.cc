// Conditions that a rule may be made of: those that hold in one step, cheapest first.
//
// The head of the rule has variables, and the step binds them to constants. Units are the
// conditions that repairs are made of (compiler/repair/condition_literal.h): comparisons of head
// variables, and literals whose places take head variables, their neighbours if they are numbers,
// or variables of their own; each gets the sign under which it holds in the state before the step.
// Later stages add conjunctions of two facts of the state, then constants as places, then
// conjunctions of three facts. Constants of joined facts become variables unless they are the
// head's, and only facts that such variables connect are joined, because others say no more than
// separate units. The cost of a unit grows with its literals, its own variables, its constants and
// a negation, and a literal without a head variable costs more.
//
// Cost: for each symbol the product of its places' choices, and the cube of the facts that are
// joined; all of them are limited.

#include "tools/learn/rule_units.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "compiler/repair/condition_literal.h"
#include "compiler/repair/number_term.h"

namespace parallax::tools {

using compiler::ConditionLiteral;
using compiler::SortId;
using compiler::SymbolKind;

namespace {

constexpr int kLiteral = 10, kPredicate = 9, kUnlike = 6, kConstant = 10, kEquation = 20;
constexpr int kNegation = 1, kSome = 2, kWithoutHead = 3, kStep = 2;
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
    add_plain(constants);
    if (stage >= UnitStage::kJoined) add_joined(stage >= UnitStage::kChained ? 3 : 2);
    std::stable_sort(out_.begin(), out_.end(),
                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
    return std::move(out_);
  }

 private:
  const compiler::TypedModel& typed() const { return vocabulary_.typed(); }

  /// Literals of the language that repairs are written in, each with the sign under which it holds.
  void add_plain(bool constants) {
    std::vector<compiler::SortedVariable> variables;
    std::map<std::string, std::size_t> places;
    for (const auto sort : head_.variables) {
      const auto name = "x" + std::to_string(variables.size());
      places.emplace(name, variables.size());
      variables.push_back({name, sort});
    }
    for (const auto& literal :
         compiler::condition_literals(typed(), variables, kMostEach, constants)) {
      auto unit = unit_of(literal, places);
      if (!unit) continue;
      const bool is_equation = literal.kind == ConditionLiteral::Kind::kEqual;
      if (is_equation ? compare(*unit) : hold(*unit)) out_.push_back(*std::move(unit));
    }
  }

  std::optional<RuleUnit> unit_of(const ConditionLiteral& literal,
                                  const std::map<std::string, std::size_t>& places) const {
    const bool is_equation = literal.kind == ConditionLiteral::Kind::kEqual;
    // An atom comes with both signs; the state says which one holds.
    if (literal.negated && !is_equation) return std::nullopt;
    RuleLiteral out{is_equation, literal.negated, literal.less, 0, {}};
    RuleUnit unit;
    if (!is_equation) {
      const auto symbol = vocabulary_.symbol_named(literal.symbol);
      if (!symbol) return std::nullopt;
      out.symbol = *symbol;
    }
    for (const auto& argument : literal.arguments) {
      using Kind = compiler::LiteralArgument::Kind;
      if (argument.kind == Kind::kSome) {
        out.terms.push_back({RuleTerm::Kind::kOwn, unit.own.size()});
        unit.own.push_back(vocabulary_.symbols()[out.symbol].sorts[out.terms.size() - 1]);
      } else if (argument.kind == Kind::kConstant) {
        const auto constant = vocabulary_.constant_named(argument.name);
        if (!constant) return std::nullopt;
        out.terms.push_back({RuleTerm::Kind::kConstant, *constant});
      } else {
        const auto stepped = compiler::stepped_variable(argument.name);
        if (!stepped) return std::nullopt;  // values of functions are not among the observations
        out.terms.push_back({RuleTerm::Kind::kHead, places.at(stepped->variable), stepped->by});
      }
    }
    unit.literals.push_back(std::move(out));
    return unit;
  }

  /// A comparison that holds and says more than the head does; its cost.
  bool compare(RuleUnit& unit) const {
    const auto& literal = unit.literals.front();
    const auto& right = literal.terms[1];
    const bool constant = right.kind == RuleTerm::Kind::kConstant;
    // Two variables that are always the same are one.
    if (!constant && !literal.less && !literal.negated && right.step == 0) return false;
    unit.cost = constant ? kEquation + (literal.negated ? kNegation : 0) : kUnlike;
    if (literal.less || right.step != 0) unit.cost += kStep;
    return value_of(unit, vocabulary_, state_, binding_) == Truth::kTrue;
  }

  /// An atom of the state, with its sign and cost. False: it says nothing that is known.
  bool hold(RuleUnit& unit) const {
    const auto& literal = unit.literals.front();
    if (head_.kind == RuleKind::kAdmits && literal.symbol == head_.fluent) return false;
    bool about_head = literal.terms.empty(), is_stepped = false;
    const auto kind = vocabulary_.symbols()[literal.symbol].kind;
    unit.cost = kind == SymbolKind::kPredicate ? kPredicate : kLiteral;
    for (const auto& term : literal.terms) {
      about_head = about_head || term.kind == RuleTerm::Kind::kHead;
      is_stepped = is_stepped || term.step != 0;
      if (term.kind == RuleTerm::Kind::kConstant) unit.cost += kConstant;
      if (term.kind == RuleTerm::Kind::kOwn) unit.cost += kSome;
      if (term.step != 0) unit.cost += kStep;
    }
    if (!about_head) unit.cost += kWithoutHead;
    const auto value = value_of(unit, vocabulary_, state_, binding_);
    if (value == Truth::kUnknown) return false;
    unit.negated = value == Truth::kFalse;
    if (!unit.negated) return true;
    unit.cost += kNegation;
    // If the model has no number `x+1`, the literal has no instance: its negation does not hold
    // either.
    return !is_stepped && fits(literal);
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
      RuleLiteral literal{false, false, false, atom.symbol, {}};
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
