#include "compiler/pipeline/plan_formula_text.h"

#include <fmt/core.h>

#include <utility>
#include <vector>

namespace parallax::compiler {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '?';
}

std::size_t word_length(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_word(text[end])) ++end;
  return end - at;
}

/// `exists i, j.` as it was written.
struct WordQuantifier {
  bool for_all = false;
  std::vector<std::string> names;
  std::size_t end = 0;  // behind the full stop
};

/// Reads the names behind `exists` or `forall`; none if this is something else.
std::optional<WordQuantifier> read_quantifier(std::string_view text, std::size_t at) {
  const auto word = text.substr(at, word_length(text, at));
  if (word != "exists" && word != "forall") return std::nullopt;
  WordQuantifier out;
  out.for_all = word == "forall";
  for (auto i = at + word.size(); i < text.size();) {
    if (is_blank(text[i]) || text[i] == ',') {
      ++i;
    } else if (text[i] == '.' && !out.names.empty()) {
      out.end = i + 1;
      return out;
    } else if (const auto length = word_length(text, i); length > 0) {
      out.names.emplace_back(text.substr(i, length));
      i += length;
    } else {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<SortId> sort_by_use(const TypedModel& model, std::string_view text,
                                  std::string_view name) {
  struct Open {
    std::string_view symbol;
    std::size_t argument = 0;
  };
  std::vector<Open> open;
  std::string_view last;
  for (std::size_t i = 0; i < text.size();) {
    if (const auto length = word_length(text, i); length > 0) {
      last = text.substr(i, length);
      i += length;
      if (last != name || open.empty()) continue;
      const auto symbol = model.find_symbol(open.back().symbol);
      if (!symbol || open.back().argument >= model.symbols[*symbol].arguments.size()) continue;
      return model.symbols[*symbol].arguments[open.back().argument];
    }
    if (text[i] == '(') open.push_back({last, 0});
    if (text[i] == ')' && !open.empty()) open.pop_back();
    if (text[i] == ',' && !open.empty()) ++open.back().argument;
    if (!is_blank(text[i])) last = {};
    ++i;
  }
  return std::nullopt;
}

std::string replace_word(std::string_view text, std::string_view name, std::string_view by) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto length = word_length(text, i);
    if (length == 0) {
      out += text[i++];
      continue;
    }
    const auto word = text.substr(i, length);
    out += word == name ? by : word;
    i += length;
  }
  return out;
}

std::optional<SortId> sort_of_variable(const TypedModel& model, std::string_view variable) {
  while (!variable.empty() && variable.back() >= '0' && variable.back() <= '9') {
    variable.remove_suffix(1);
  }
  return model.find_sort(variable);
}

std::string fresh_variable(const TypedModel& model, SortId sort, std::string_view text) {
  for (int number = 9000;; ++number) {
    auto name = fmt::format("{}{}", model.sorts[sort].name, number);
    if (text.find(name) == std::string_view::npos) return name;
  }
}

PlanFormulaText to_model_syntax(const TypedModel& model, std::string_view formula) {
  PlanFormulaText out;
  out.text = formula;
  for (std::size_t i = 0; i < out.text.size();) {
    const auto quantifier = read_quantifier(out.text, i);
    if (!quantifier) {
      const auto length = word_length(out.text, i);
      i += length > 0 ? length : 1;
      continue;
    }
    std::string head = quantifier->for_all ? "[" : "{";
    for (const auto& name : quantifier->names) {
      head += (head.size() == 1 ? "" : ",") + name;
    }
    head += quantifier->for_all ? "]" : "}";
    out.text.replace(i, quantifier->end - i, head);
    for (const auto& name : quantifier->names) {
      const auto sort = sort_by_use(model, out.text, name);
      if (sort_of_variable(model, name) || !sort || out.renamed.contains(name)) continue;
      auto fresh = fresh_variable(model, *sort, out.text);
      out.text = replace_word(out.text, name, fresh);
      out.renamed.emplace(name, std::move(fresh));
    }
  }
  return out;
}

}  // namespace parallax::compiler
