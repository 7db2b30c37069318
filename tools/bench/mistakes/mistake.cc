#include "tools/bench/mistakes/mistake.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <set>
#include <utility>

namespace parallax::tools {
namespace {

using Kind = AxiomText::Kind;

std::string opposite(const std::string& literal) {
  if (literal.starts_with("!")) return literal.substr(1);
  if (literal.starts_with("{")) return "!(" + literal + ")";
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"!=", "="}, {"<=", ">"}, {">=", "<"}, {"=", "!="}, {"<", ">="}, {">", "<="}}) {
    const auto parts = split_outside(literal, from);
    if (parts.size() == 2 && literal.find("HoldsAt") == std::string::npos) {
      return parts[0] + to + parts[1];
    }
  }
  return "!" + literal;
}

std::vector<std::string> without(std::vector<std::string> parts, std::size_t at) {
  parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(at));
  return parts;
}

std::vector<std::string> replaced(std::vector<std::string> parts, std::size_t at,
                                  std::string text) {
  parts[at] = std::move(text);
  return parts;
}

/// Makes the mistakes of one model.
class MistakeMaker {
 public:
  explicit MistakeMaker(const ModelText& model)
      : model_(model), declared_(read_declarations(model.declarations)) {
    for (const auto& [name, sorts] : declared_.fluents) names_.insert(name);
    for (const auto& [name, sorts] : declared_.events) names_.insert(name);
  }

  std::vector<Mistake> all() {
    for (line_ = 0; line_ < model_.rules.size(); ++line_) add_rule(read_axiom(model_.rules[line_]));
    in_start_ = true;
    for (line_ = 0; line_ < model_.start.size(); ++line_) add_initial(model_.start[line_]);
    return std::move(mistakes_);
  }

 private:
  void add(MistakeKind kind, std::string text) {
    const auto& lines = in_start_ ? model_.start : model_.rules;
    if (text == lines[line_]) return;
    if (!made_.insert(std::to_string(in_start_) + std::to_string(line_) + " " + text).second) {
      return;
    }
    mistakes_.push_back({kind, in_start_, line_, std::move(text)});
  }
  void add(MistakeKind kind, const AxiomText& axiom) { add(kind, axiom.to_text()); }

  void add_rule(const AxiomText& axiom) {
    switch (axiom.kind) {
      case Kind::kEffect:
        add_effect(axiom);
        break;
      case Kind::kRamification:
        add_ramification(axiom);
        break;
      case Kind::kTrigger:
        add_trigger(axiom);
        break;
      case Kind::kPrecondition:
        add_precondition(axiom);
        break;
      case Kind::kDefinition:
        add_definition(axiom);
        break;
      case Kind::kConstraint:
        add_constraint(axiom);
        break;
      case Kind::kFact:
        add_numbers(model_.rules[line_]);
        return;
      case Kind::kOther:
        return;
    }
    add_numbers(model_.rules[line_]);
  }

  void add_effect(const AxiomText& axiom) {
    add(MistakeKind::kEffectDropped, "");
    add_other_sign(MistakeKind::kWrongSign, axiom);
    for (const auto& head : other_fluents(axiom)) {
      auto other = axiom;
      other.conclusion[0] = head;
      add(MistakeKind::kWrongFluent, other);
    }
    add_other_arguments(MistakeKind::kWrongArgument, axiom);
    add_without_condition(MistakeKind::kConditionDropped, axiom);
    for (const auto& literal : literals(axiom)) {
      auto other = axiom;
      other.arrow = " -> ";
      other.condition.push_back(literal);
      add(MistakeKind::kConditionAdded, other);
    }
  }

  void add_ramification(const AxiomText& axiom) {
    add(MistakeKind::kDefinitionWrong, "");
    add_other_sign(MistakeKind::kDefinitionWrong, axiom);
    for (std::size_t i = 1; i < axiom.condition.size(); ++i) {
      auto other = axiom;
      other.condition = without(axiom.condition, i);
      add(MistakeKind::kDefinitionWrong, other);
    }
    for (const auto& head : other_fluents(axiom)) {
      auto other = axiom;
      other.conclusion[0] = head;
      add(MistakeKind::kDefinitionWrong, other);
    }
  }

  void add_trigger(const AxiomText& axiom) {
    add(MistakeKind::kTriggerDropped, "");
    add_without_condition(MistakeKind::kTriggerWrong, axiom);
    add_negated_condition(MistakeKind::kTriggerWrong, axiom);
    add_other_arguments(MistakeKind::kTriggerWrong, axiom);
    const auto event = terms_in(axiom.conclusion[0], names_).front();
    for (const auto& [name, sorts] : declared_.events) {
      if (name == event.term.name || sorts != declared_.events.at(event.term.name)) continue;
      auto other = axiom;
      other.conclusion[0].replace(event.begin, event.length,
                                  TermText{name, event.term.arguments}.to_text());
      add(MistakeKind::kTriggerWrong, other);
    }
    for (const auto& literal : literals(axiom)) {
      auto other = axiom;
      other.condition.push_back(literal);
      add(MistakeKind::kTriggerWrong, other);
    }
  }

  void add_precondition(const AxiomText& axiom) {
    for (std::size_t i = 1; i < axiom.condition.size(); ++i) {
      auto other = axiom;
      other.condition = without(axiom.condition, i);
      add(MistakeKind::kConditionDropped, other);
    }
    for (std::size_t i = 0; i < axiom.conclusion.size(); ++i) {
      auto other = axiom;
      other.conclusion = replaced(axiom.conclusion, i, opposite(axiom.conclusion[i]));
      add(MistakeKind::kConditionAdded, other);
    }
    if (!axiom.inner.empty()) return;  // what is added would stand inside of its quantifier
    for (const auto& literal : literals(axiom)) {
      auto other = axiom;
      other.conclusion.push_back(literal);
      add(MistakeKind::kConditionAdded, other);
    }
  }

  void add_definition(const AxiomText& axiom) {
    add(MistakeKind::kDefinitionWrong, "");
    for (std::size_t i = 0; i < axiom.conclusion.size(); ++i) {
      auto other = axiom;
      if (axiom.conclusion.size() > 1) {
        other.conclusion = without(axiom.conclusion, i);
        add(MistakeKind::kDefinitionWrong, other);
      }
      other.conclusion = replaced(axiom.conclusion, i, opposite(axiom.conclusion[i]));
      add(MistakeKind::kDefinitionWrong, other);
    }
  }

  void add_constraint(const AxiomText& axiom) {
    add(MistakeKind::kConstraintWrong, "");
    add_without_condition(MistakeKind::kConstraintWrong, axiom);
    add_negated_condition(MistakeKind::kConstraintWrong, axiom);
    add_other_arguments(MistakeKind::kConstraintWrong, axiom);
    for (std::size_t i = 0; i < axiom.conclusion.size(); ++i) {
      auto other = axiom;
      other.conclusion = replaced(axiom.conclusion, i, opposite(axiom.conclusion[i]));
      add(MistakeKind::kConstraintWrong, other);
    }
  }

  void add_initial(const std::string& line) {
    const auto axiom = read_axiom(line);
    if (axiom.conclusion.empty()) return;
    if (axiom.kind != Kind::kDefinition) {
      auto other = axiom;
      other.conclusion = replaced(axiom.conclusion, 0, opposite(axiom.conclusion[0]));
      add(MistakeKind::kInitialFactWrong, other);
      for (const auto& variable : axiom.variables) {
        if (sort_of_variable(variable) == "time") continue;
        for (const auto& constant : declared_.constants[sort_of_variable(variable)]) {
          other = axiom;
          other.condition = {variable + "!=" + constant};
          other.arrow = " -> ";
          add(MistakeKind::kInitialFactWrong, other);
        }
      }
      return;
    }
    for (const auto& [sort, constants] : declared_.constants) {
      for (const auto& constant : constants) {
        const auto at = line.find("=" + constant);
        if (at == std::string::npos) continue;
        const auto end = at + 1 + constant.size();
        if (end < line.size() && std::isalnum(static_cast<unsigned char>(line[end])) != 0) continue;
        for (const auto& other : constants) {
          add(MistakeKind::kInitialFactWrong, line.substr(0, at + 1) + other + line.substr(end));
        }
      }
    }
  }

  void add_other_sign(MistakeKind kind, const AxiomText& axiom) {
    auto other = axiom;
    auto& head = other.conclusion[0];
    if (head.starts_with("Initiates(")) {
      head.replace(0, 9, "Terminates");
    } else {
      head.replace(0, head.find('('), "Initiates");
    }
    add(kind, other);
  }

  void add_without_condition(MistakeKind kind, const AxiomText& axiom) {
    for (std::size_t i = 0; i < axiom.condition.size(); ++i) {
      auto other = axiom;
      other.condition = without(axiom.condition, i);
      if (!other.condition.empty() || axiom.kind == Kind::kEffect) add(kind, other);
    }
  }

  void add_negated_condition(MistakeKind kind, const AxiomText& axiom) {
    for (std::size_t i = 0; i < axiom.condition.size(); ++i) {
      auto other = axiom;
      other.condition = replaced(axiom.condition, i, opposite(axiom.condition[i]));
      add(kind, other);
    }
  }

  /// Each argument of a fluent or event replaced by another variable of its sort, or, where the
  /// axiom has none, by a constant; constants by each other one.
  void add_other_arguments(MistakeKind kind, const AxiomText& axiom) {
    const auto text = axiom.to_text();
    for (const auto& place : terms_in(text, names_)) {
      const auto& sorts = sorts_of(place.term.name);
      for (std::size_t i = 0; i < place.term.arguments.size() && i < sorts.size(); ++i) {
        for (const auto& value : values(axiom, sorts[i], place.term.arguments[i])) {
          auto term = place.term;
          term.arguments[i] = value;
          auto other = text;
          add(kind, other.replace(place.begin, place.length, term.to_text()));
        }
      }
    }
  }

  std::vector<std::string> values(const AxiomText& axiom, const std::string& sort,
                                  const std::string& instead_of) {
    std::vector<std::string> out;
    for (const auto& variable : axiom.variables) {
      if (sort_of_variable(variable) == sort && variable != instead_of) out.push_back(variable);
    }
    const auto& constants = declared_.constants[sort];
    const bool is_constant =
        std::find(constants.begin(), constants.end(), instead_of) != constants.end();
    if (!out.empty() && !is_constant) return out;
    for (const auto& constant : constants) {
      if (constant == instead_of) continue;
      out.push_back(constant);
      if (!is_constant) break;
    }
    return out;
  }

  /// A conclusion about each other fluent that the axiom's variables can name.
  std::vector<std::string> other_fluents(const AxiomText& axiom) {
    std::vector<std::string> out;
    const auto head = read_term(axiom.conclusion[0]);
    const auto fluent = head ? read_term(head->arguments[1]) : std::nullopt;
    if (!fluent) return out;
    for (const auto& [name, sorts] : declared_.fluents) {
      if (name == fluent->name || declared_.derived.count(name) != 0) continue;
      auto arguments = sorts == sorts_of(fluent->name) ? std::optional(fluent->arguments)
                                                       : arguments_of(axiom, sorts);
      if (!arguments) continue;
      auto other = *head;
      other.arguments[1] = TermText{name, std::move(*arguments)}.to_text();
      out.push_back(other.to_text());
    }
    return out;
  }

  /// Conditions over each fluent that the axiom's variables can name, and their opposites.
  std::vector<std::string> literals(const AxiomText& axiom) {
    std::vector<std::string> out;
    for (const auto& [name, sorts] : declared_.fluents) {
      const auto arguments = arguments_of(axiom, sorts);
      if (!arguments) continue;
      const auto literal = "HoldsAt(" + TermText{name, *arguments}.to_text() + ",time)";
      if (joined(axiom.condition, " ").find(literal) != std::string::npos) continue;
      out.push_back(literal);
      out.push_back(opposite(literal));
    }
    return out;
  }

  /// The first variables of the axiom that have these sorts; nullopt if there are too few.
  static std::optional<std::vector<std::string>> arguments_of(
      const AxiomText& axiom, const std::vector<std::string>& sorts) {
    std::vector<std::string> out;
    for (const auto& sort : sorts) {
      const auto found = std::find_if(
          axiom.variables.begin(), axiom.variables.end(), [&](const std::string& variable) {
            return sort_of_variable(variable) == sort &&
                   std::find(out.begin(), out.end(), variable) == out.end();
          });
      if (found == axiom.variables.end()) return std::nullopt;
      out.push_back(*found);
    }
    return out;
  }

  const std::vector<std::string>& sorts_of(const std::string& name) const {
    const auto fluent = declared_.fluents.find(name);
    return fluent != declared_.fluents.end() ? fluent->second : declared_.events.at(name);
  }

  /// Each numeral one more and one less, and each border of a comparison open instead of closed.
  void add_numbers(const std::string& line) {
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      const auto before = line[i - 1];
      if (std::isdigit(static_cast<unsigned char>(line[i])) != 0 &&
          std::string("=<>+-(,").find(before) != std::string::npos &&
          std::isalnum(static_cast<unsigned char>(line[i + 1])) == 0) {
        for (const char digit : {static_cast<char>(line[i] + 1), static_cast<char>(line[i] - 1)}) {
          auto other = line;
          other[i] = digit;
          if (digit >= '0' && digit <= '9') add(MistakeKind::kNumberWrong, other);
        }
      }
      if ((line[i] != '<' && line[i] != '>') || before == '-' || line[i + 1] == '-') continue;
      auto other = line;
      if (line[i + 1] == '=') {
        other.erase(i + 1, 1);
      } else {
        other.insert(i + 1, "=");
      }
      add(MistakeKind::kNumberWrong, other);
    }
  }

  const ModelText& model_;
  DeclarationText declared_;
  std::set<std::string> names_;  // of fluents and events
  bool in_start_ = false;
  std::size_t line_ = 0;
  std::set<std::string> made_;
  std::vector<Mistake> mistakes_;
};

}  // namespace

const char* to_string(MistakeKind kind) {
  static constexpr std::array<const char*, kMistakeKinds> kNames = {
      "effect dropped",    "wrong sign",       "wrong fluent",       "wrong argument",
      "condition dropped", "condition added",  "trigger dropped",    "trigger wrong",
      "number wrong",      "constraint wrong", "initial fact wrong", "definition wrong"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::set<std::string> demanded_events(const ModelText& model) {
  std::set<std::string> out;
  for (const auto& line : model.rules) {
    const auto axiom = read_axiom(line);
    if (axiom.kind != Kind::kTrigger) continue;
    const auto head = read_term(axiom.conclusion[0]);
    const auto event = head ? read_term(head->arguments[0]) : std::nullopt;
    if (event) out.insert(event->name);
  }
  return out;
}

std::vector<Mistake> make_mistakes(const ModelText& model, std::size_t per_kind) {
  const auto all = MistakeMaker(model).all();
  std::vector<Mistake> out;
  for (int kind = 0; kind < kMistakeKinds; ++kind) {
    std::vector<Mistake> of_kind;
    std::copy_if(all.begin(), all.end(), std::back_inserter(of_kind),
                 [&](const Mistake& mistake) { return static_cast<int>(mistake.kind) == kind; });
    const auto count = std::min(per_kind, of_kind.size());
    for (std::size_t i = 0; i < count; ++i) out.push_back(of_kind[i * of_kind.size() / count]);
  }
  return out;
}

std::vector<std::string> with_mistakes(std::vector<std::string> lines,
                                       const std::vector<Mistake>& mistakes, bool is_start) {
  for (const auto& mistake : mistakes) {
    if (mistake.in_start == is_start) lines[mistake.line] = mistake.text;
  }
  std::vector<std::string> out;
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(out),
               [](const std::string& line) { return !line.empty(); });
  return out;
}

}  // namespace parallax::tools
