// Values of a rule's conditions in states that are partly known, and rules as text.
//
// A condition has three values. Its own variables are existential: values for them are tried by
// backtracking, each variable when the first literal that mentions it is reached, over the
// constants of its sort. A false literal ends a branch, a branch that is true ends the search;
// if all branches fail but some are unknown the condition is unknown. For many examples at once
// the value is remembered by the state and the head variables that the condition mentions, since
// it depends on nothing else.
//
// Cost: the product of the domains of the condition's own variables, for each different key.

#include "tools/learn/rule.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace parallax::tools {

namespace {

/// Looks for values of a unit's own variables.
class UnitQuestion {
 public:
  UnitQuestion(const RuleUnit& unit, const LearnVocabulary& vocabulary,
               const std::vector<Truth>& state, const std::vector<std::size_t>& binding)
      : unit_(unit),
        vocabulary_(vocabulary),
        state_(state),
        binding_(binding),
        own_(unit.own.size(), kOpen) {}

  Truth answer() {
    descend(0, Truth::kTrue);
    return best_;
  }

 private:
  static constexpr auto kOpen = static_cast<std::size_t>(-1);

  /// kOpen: a number that the model does not have.
  std::size_t value(const RuleTerm& term) const {
    if (term.kind == RuleTerm::Kind::kConstant) return term.index;
    const auto plain = term.kind == RuleTerm::Kind::kHead ? binding_[term.index] : own_[term.index];
    return term.step == 0 ? plain : vocabulary_.stepped(plain, term.step).value_or(kOpen);
  }

  Truth truth(const RuleLiteral& literal) {
    if (literal.equation) {
      const auto left = value(literal.terms[0]), right = value(literal.terms[1]);
      const bool holds = literal.less ? vocabulary_.is_less(left, right) : left == right;
      return holds != literal.negated ? Truth::kTrue : Truth::kFalse;
    }
    arguments_.clear();
    for (const auto& term : literal.terms) {
      arguments_.push_back(value(term));
      if (arguments_.back() == kOpen) return Truth::kFalse;
    }
    const auto atom = vocabulary_.atom(literal.symbol, arguments_);
    return atom ? state_[*atom] : Truth::kFalse;
  }

  /// `so_far`: true, or unknown.
  void descend(std::size_t place, Truth so_far) {
    if (best_ == Truth::kTrue) return;
    if (place == unit_.literals.size()) {
      best_ = so_far;
      return;
    }
    const auto& literal = unit_.literals[place];
    for (const auto& term : literal.terms) {
      if (term.kind != RuleTerm::Kind::kOwn || own_[term.index] != kOpen) continue;
      for (const auto constant : vocabulary_.domain(unit_.own[term.index])) {
        own_[term.index] = constant;
        descend(place, so_far);
      }
      own_[term.index] = kOpen;
      return;
    }
    const auto here = truth(literal);
    if (here == Truth::kFalse) return;
    descend(place + 1, here == Truth::kUnknown ? here : so_far);
  }

  const RuleUnit& unit_;
  const LearnVocabulary& vocabulary_;
  const std::vector<Truth>& state_;
  const std::vector<std::size_t>& binding_;
  std::vector<std::size_t> own_, arguments_;
  Truth best_ = Truth::kFalse;
};

/// Names for the variables of a rule: their sorts, numbered where there are several of one.
class RuleNames {
 public:
  RuleNames(const LearnedRule& rule, const LearnVocabulary& vocabulary,
            std::vector<std::string> given = {})
      : vocabulary_(vocabulary), head_(std::move(given)) {
    const std::set<std::string> taken(head_.begin(), head_.end());
    std::map<std::string, int> count, next;
    const auto sort_name = [&](auto sort) { return vocabulary.typed().sorts[sort].name; };
    for (const auto sort : rule.variables) ++count[sort_name(sort)];
    for (const auto& unit : rule.units) {
      for (const auto sort : unit.own) ++count[sort_name(sort)];
    }
    const auto name = [&](auto sort) {
      const auto base = sort_name(sort);
      if (count[base] == 1 && !taken.contains(base)) return base;
      auto out = base + std::to_string(++next[base]);
      while (taken.contains(out)) out = base + std::to_string(++next[base]);
      return out;
    };
    if (head_.empty()) {
      for (const auto sort : rule.variables) head_.push_back(name(sort));
    }
    for (const auto& unit : rule.units) {
      auto& names = own_.emplace_back();
      for (const auto sort : unit.own) names.push_back(name(sort));
    }
  }

  const std::vector<std::string>& head() const { return head_; }
  const std::vector<std::string>& own(std::size_t unit) const { return own_[unit]; }
  std::string term(const RuleTerm& term, std::size_t unit) const {
    if (term.kind == RuleTerm::Kind::kConstant) return vocabulary_.constant(term.index);
    const auto& name =
        term.kind == RuleTerm::Kind::kHead ? head_[term.index] : own_[unit][term.index];
    return term.step == 0 ? name : name + (term.step > 0 ? "+1" : "-1");
  }
  std::string call(std::size_t symbol, const std::vector<RuleTerm>& terms, std::size_t unit) const {
    std::string out = vocabulary_.symbols()[symbol].name + "(";
    for (std::size_t i = 0; i < terms.size(); ++i) {
      out += (i == 0 ? "" : ",") + term(terms[i], unit);
    }
    return out + ")";
  }

 private:
  const LearnVocabulary& vocabulary_;
  std::vector<std::string> head_;
  std::vector<std::vector<std::string>> own_;
};

std::string print_literal(const RuleLiteral& literal, std::size_t unit, const RuleNames& names,
                          const LearnVocabulary& vocabulary, const std::string& time) {
  if (literal.equation) {
    const auto* relation =
        literal.less ? (literal.negated ? ">=" : "<") : (literal.negated ? "!=" : "=");
    return names.term(literal.terms[0], unit) + relation + names.term(literal.terms[1], unit);
  }
  const auto atom = names.call(literal.symbol, literal.terms, unit);
  const bool fluent = vocabulary.symbols()[literal.symbol].kind == compiler::SymbolKind::kFluent;
  return fluent ? "HoldsAt(" + atom + "," + time + ")" : atom;
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ",") + name;
  return out;
}

std::string print_unit(const RuleUnit& unit, std::size_t number, const RuleNames& names,
                       const LearnVocabulary& vocabulary, const std::string& time) {
  std::string out;
  for (const auto& literal : unit.literals) {
    out += (out.empty() ? "" : " & ") + print_literal(literal, number, names, vocabulary, time);
  }
  if (!unit.negated) return out;
  if (unit.own.empty()) return unit.literals.size() == 1 ? "!" + out : "!(" + out + ")";
  return "!({" + listed(names.own(number)) + "} " + out + ")";
}

}  // namespace

double bits_to_tell(double held, double failed) {
  const auto part = [&](double count) {
    return count > 0 ? count * std::log2((held + failed) / count) : 0.0;
  };
  return part(held) + part(failed);
}

bool LearnedRule::bind(const std::vector<std::size_t>& event_arguments,
                       const std::vector<std::size_t>& fluent_arguments,
                       std::vector<std::size_t>& binding) const {
  binding = event_arguments;
  binding.resize(variables.size(), 0);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto& term = terms[i];
    if (term.kind == RuleTerm::Kind::kConstant) {
      if (term.index != fluent_arguments[i]) return false;
    } else if (term.index < event_arguments.size()) {
      if (binding[term.index] != fluent_arguments[i]) return false;
    } else {
      binding[term.index] = fluent_arguments[i];
    }
  }
  return true;
}

Truth value_of(const RuleUnit& unit, const LearnVocabulary& vocabulary,
               const std::vector<Truth>& state, const std::vector<std::size_t>& binding) {
  const auto holds = UnitQuestion(unit, vocabulary, state, binding).answer();
  if (!unit.negated || holds == Truth::kUnknown) return holds;
  return holds == Truth::kTrue ? Truth::kFalse : Truth::kTrue;
}

std::vector<Truth> values_of(const RuleUnit& unit, const LearnVocabulary& vocabulary,
                             const std::vector<std::vector<Truth>>& states,
                             const std::vector<RuleInstance>& instances) {
  // The value depends only on the state and on the head's variables that it mentions.
  std::vector<std::size_t> mentioned;
  for (const auto& literal : unit.literals) {
    for (const auto& term : literal.terms) {
      if (term.kind != RuleTerm::Kind::kHead) continue;
      if (std::find(mentioned.begin(), mentioned.end(), term.index) == mentioned.end()) {
        mentioned.push_back(term.index);
      }
    }
  }
  std::vector<Truth> out;
  out.reserve(instances.size());
  std::unordered_map<std::uint64_t, Truth> known;
  const auto constants = static_cast<std::uint64_t>(vocabulary.constant_count());
  double keys = static_cast<double>(states.size());
  for (std::size_t i = 0; i < mentioned.size(); ++i) keys *= static_cast<double>(constants);
  const bool has_keys = keys < 1e18;
  for (const auto& instance : instances) {
    if (!has_keys) {
      out.push_back(value_of(unit, vocabulary, states[instance.state], instance.binding));
      continue;
    }
    std::uint64_t key = instance.state;
    for (const auto variable : mentioned) key = key * constants + instance.binding[variable];
    const auto [place, is_new] = known.try_emplace(key, Truth::kUnknown);
    if (is_new) {
      place->second = value_of(unit, vocabulary, states[instance.state], instance.binding);
    }
    out.push_back(place->second);
  }
  return out;
}

Truth value_of(const std::vector<RuleUnit>& units, const LearnVocabulary& vocabulary,
               const std::vector<Truth>& state, const std::vector<std::size_t>& binding) {
  auto out = Truth::kTrue;
  for (const auto& unit : units) {
    const auto here = value_of(unit, vocabulary, state, binding);
    if (here == Truth::kFalse) return here;
    if (here == Truth::kUnknown) out = here;
  }
  return out;
}

std::string print_condition(const LearnedRule& rule, const LearnVocabulary& vocabulary,
                            const std::vector<std::string>& head, const std::string& time) {
  const RuleNames names(rule, vocabulary, head);
  std::string out;
  for (std::size_t i = 0; i < rule.units.size(); ++i) {
    const auto& unit = rule.units[i];
    auto text = print_unit(unit, i, names, vocabulary, time);
    if (!unit.negated && !unit.own.empty()) text = "({" + listed(names.own(i)) + "} " + text + ")";
    out += (i == 0 ? "" : " & ") + text;
  }
  return out;
}

std::string print(const LearnedRule& rule, const LearnVocabulary& vocabulary) {
  const RuleNames names(rule, vocabulary);
  // An existential quantifier of an antecedent becomes a universal one in front of the rule.
  auto variables = names.head();
  std::string condition;
  for (std::size_t i = 0; i < rule.units.size(); ++i) {
    const auto& unit = rule.units[i];
    if (!unit.negated) {
      variables.insert(variables.end(), names.own(i).begin(), names.own(i).end());
    }
    condition += (i == 0 ? "" : " & ") + print_unit(unit, i, names, vocabulary, "time");
  }
  variables.emplace_back("time");
  std::vector<RuleTerm> arguments;
  for (std::size_t i = 0; i < vocabulary.symbols()[rule.event].sorts.size(); ++i) {
    arguments.push_back({RuleTerm::Kind::kHead, i});
  }
  const auto event = names.call(rule.event, arguments, 0);
  const auto effect = event + "," + names.call(rule.fluent, rule.terms, 0) + ",time)";
  if (rule.unless_open) condition += (condition.empty() ? "!Releases(" : " & !Releases(") + effect;
  std::string head;
  if (rule.kind == RuleKind::kTies) {
    const auto afterwards = [&](std::size_t fluent, const std::vector<RuleTerm>& terms) {
      return "HoldsAt(" + names.call(fluent, terms, 0) + ",time+1)";
    };
    condition = "Happens(" + event + ",time)" + (condition.empty() ? "" : " & ") + condition;
    head = "(" + afterwards(rule.fluent, rule.terms) + " <-> " + (rule.tied->same ? "" : "!") +
           afterwards(rule.tied->fluent, rule.tied->terms) + ")";
  } else if (rule.kind == RuleKind::kForbids) {
    head = "!Happens(" + event + ",time)";
  } else {
    const auto* kind = rule.kind == RuleKind::kInitiates    ? "Initiates("
                       : rule.kind == RuleKind::kTerminates ? "Terminates("
                                                            : "Releases(";
    head = kind + effect;
  }
  return "[" + listed(variables) + "] " + (condition.empty() ? "" : condition + " -> ") + head +
         ".";
}

std::string print_settled(std::size_t fluent, const LearnVocabulary& vocabulary) {
  LearnedRule rule;
  rule.variables = vocabulary.symbols()[fluent].sorts;
  for (std::size_t i = 0; i < rule.variables.size(); ++i) {
    rule.terms.push_back({RuleTerm::Kind::kHead, i});
  }
  const RuleNames names(rule, vocabulary);
  const auto atom = names.call(fluent, rule.terms, 0);
  auto variables = names.head();
  variables.emplace_back("time");
  std::string out;
  for (const bool holds : {true, false}) {
    const std::string sign = holds ? "" : "!";
    const std::string ends = holds ? "Terminates" : "Initiates";
    const auto effect = "(event," + atom + ",time)";
    out += "[" + listed(variables) + "] " + sign + "HoldsAt(" + atom +
           ",time) & !({event} Happens(event,time) & (" + ends + effect + " | Releases" + effect +
           ")) -> " + sign + "HoldsAt(" + atom + ",time+1).\n";
  }
  return out;
}

}  // namespace parallax::tools
