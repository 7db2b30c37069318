#include "compiler/asp/rule.h"

#include <unordered_set>

namespace parallax::compiler {

AspAlternatives constant(bool value) {
  return value ? AspAlternatives{AspBody{}} : AspAlternatives{};
}

AspLiteral plain_literal(std::string text) { return {std::move(text), std::nullopt, {}, true}; }

void append(AspBody& body, const AspBody& more) {
  body.insert(body.end(), more.begin(), more.end());
}

std::string applied(const std::string& name, const std::vector<std::string>& arguments) {
  if (arguments.empty()) return name;
  std::string text = name;
  for (std::size_t i = 0; i < arguments.size(); ++i) text += (i == 0 ? "(" : ",") + arguments[i];
  return text + ")";
}

std::string rule_text(const std::string& head, const AspBody& body) {
  static constexpr std::size_t kWidth = 100;
  std::unordered_set<std::string> all;
  for (const auto& literal : body) all.insert(literal.text);
  const auto implied = [&](const std::string& text) {
    // A timepoint with a successor is a timepoint.
    return text.starts_with("time(") && all.contains("step" + text.substr(4));
  };
  std::string text = head;
  std::size_t line = text.size();
  std::unordered_set<std::string> written;
  for (const auto& literal : body) {
    if (implied(literal.text) || !written.insert(literal.text).second) continue;
    const bool first = written.size() == 1;
    text += !first ? "," : head.empty() ? ":-" : " :-";
    if (line + literal.text.size() > kWidth) {
      text += "\n   ";
      line = 3;
    }
    text += ' ' + literal.text;
    line += literal.text.size() + 2;
  }
  if (written.empty() && head.empty()) text += ":- #true";
  return text + ".\n";
}

}  // namespace parallax::compiler
