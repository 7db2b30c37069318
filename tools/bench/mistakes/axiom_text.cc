#include "tools/bench/mistakes/axiom_text.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace parallax::tools {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

int bracket_step(char c) {
  if (c == '(' || c == '{' || c == '[') return 1;
  return c == ')' || c == '}' || c == ']' ? -1 : 0;
}

/// The place behind the bracket that closes the one at `open`; npos if none does.
std::size_t behind_bracket(const std::string& text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    depth += bracket_step(text[i]);
    if (depth == 0) return i + 1;
  }
  return std::string::npos;
}

/// Takes a quantifier with these brackets, and the blank behind it, from the front of the text.
std::string take_quantifier(std::string& text, char open) {
  if (text.empty() || text.front() != open) return "";
  auto end = behind_bracket(text, 0);
  if (end == std::string::npos) return "";
  if (end < text.size() && text[end] == ' ') ++end;
  auto quantifier = text.substr(0, end);
  text.erase(0, end);
  return quantifier;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](const std::string& start) { return text.starts_with(start); });
}

const std::vector<std::string>& effect_predicates() {
  static const std::vector<std::string> all = {"Initiates(", "Terminates(", "Releases("};
  return all;
}

AxiomText::Kind kind_of(const AxiomText& axiom) {
  using Kind = AxiomText::Kind;
  if (axiom.arrow == " <-> ") return Kind::kDefinition;
  const auto& head = axiom.conclusion.front();
  if (starts_with_any(head, effect_predicates())) {
    const bool follows = std::any_of(
        axiom.condition.begin(), axiom.condition.end(),
        [](const std::string& part) { return starts_with_any(part, effect_predicates()); });
    return follows ? Kind::kRamification : Kind::kEffect;
  }
  if (head.starts_with("Happens(")) return Kind::kTrigger;
  if (!axiom.condition.empty() && axiom.condition.front().starts_with("Happens(")) {
    return Kind::kPrecondition;
  }
  if (axiom.arrow.empty() && head.find("HoldsAt(") == std::string::npos) return Kind::kFact;
  return Kind::kConstraint;
}

std::vector<std::string> words(const std::string& line, const std::string& separators) {
  std::string text = line.substr(0, line.find(';'));
  for (auto& c : text) {
    if (separators.find(c) != std::string::npos) c = ' ';
  }
  std::istringstream in(text);
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

}  // namespace

std::string joined(const std::vector<std::string>& parts, const std::string& separator) {
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

std::string TermText::to_text() const { return name + "(" + joined(arguments, ",") + ")"; }

std::vector<std::string> split_outside(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += bracket_step(text[i]);
    if (depth != 0 || text.compare(i, separator.size(), separator) != 0) continue;
    parts.push_back(text.substr(begin, i - begin));
    begin = i + separator.size();
    i = begin - 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

std::optional<TermText> read_term(const std::string& text) {
  const auto open = text.find('(');
  if (open == std::string::npos || open == 0 || behind_bracket(text, open) != text.size()) {
    return std::nullopt;
  }
  if (!std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(open), is_word)) {
    return std::nullopt;
  }
  TermText term{text.substr(0, open), {}};
  const auto inside = text.substr(open + 1, text.size() - open - 2);
  if (!inside.empty()) term.arguments = split_outside(inside, ",");
  return term;
}

std::vector<TermPlace> terms_in(const std::string& text, const std::set<std::string>& names) {
  std::vector<TermPlace> out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!is_word(text[i]) || (i > 0 && is_word(text[i - 1]))) continue;
    auto end = i;
    while (end < text.size() && is_word(text[end])) ++end;
    if (end == text.size() || text[end] != '(' || names.count(text.substr(i, end - i)) == 0) {
      continue;
    }
    const auto behind = behind_bracket(text, end);
    if (behind == std::string::npos) continue;
    if (auto term = read_term(text.substr(i, behind - i))) {
      out.push_back({std::move(*term), i, behind - i});
    }
  }
  return out;
}

std::string AxiomText::to_text() const {
  std::string text = variables.empty() ? "" : "[" + joined(variables, ",") + "] ";
  if (!condition.empty()) text += joined(condition, " & ") + arrow;
  return text + inner + joined(conclusion, " & ") + ".";
}

AxiomText read_axiom(const std::string& line) {
  AxiomText axiom;
  if (line.empty() || line.back() != '.' || line.front() == ';') return axiom;
  auto text = line.substr(0, line.size() - 1);
  const auto quantifier = take_quantifier(text, '[');
  if (!quantifier.empty()) axiom.variables = words(quantifier, "[],");
  for (const std::string arrow : {" <-> ", " -> "}) {
    const auto sides = split_outside(text, arrow);
    if (sides.size() != 2) continue;
    axiom.arrow = arrow;
    axiom.condition = split_outside(sides[0], " & ");
    text = sides[1];
    break;
  }
  axiom.inner = take_quantifier(text, '{');
  axiom.conclusion = split_outside(text, " & ");
  axiom.kind = kind_of(axiom);
  return axiom;
}

std::string sort_of_variable(const std::string& variable) {
  const auto end = variable.find_last_not_of("0123456789");
  return end == std::string::npos ? "" : variable.substr(0, end + 1);
}

DeclarationText read_declarations(const std::vector<std::string>& lines) {
  DeclarationText out;
  for (const auto& line : lines) {
    const auto parts = words(line, "(),:");
    if (parts.size() < 2) continue;
    const std::vector<std::string> rest(parts.begin() + 2, parts.end());
    if (parts[0] == "fluent") {
      out.fluents[parts[1]] = rest;
    } else if (parts[0] == "event") {
      out.events[parts[1]] = rest;
    } else if (parts[0] == "noninertial") {
      out.derived.insert(parts.begin() + 1, parts.end());
    } else if (parts[0] == "sort") {
      out.constants[parts[1]];
    } else if (parts[0] == "range") {
      for (int n = std::stoi(parts[2]); n <= std::stoi(parts[3]); ++n) {
        out.constants[parts[1]].push_back(std::to_string(n));
      }
    } else if (const auto sort = out.constants.find(parts[0]); sort != out.constants.end()) {
      sort->second.assign(parts.begin() + 1, parts.end());
    }
  }
  return out;
}

}  // namespace parallax::tools
