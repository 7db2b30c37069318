#include "tests/support/model_edits.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <vector>

namespace parallax::test {
namespace {

bool is_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

template <typename T>
void shuffle(std::vector<T>& values, FuzzRandom& random) {
  for (auto i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.below(i)]);
}

bool is_quantifier(const RandomFormula& formula) {
  return formula.parts.size() == 1 && (formula.text[0] == '[' || formula.text[0] == '{');
}

std::vector<std::string> variables_of(const RandomFormula& quantifier) {
  std::vector<std::string> names;
  std::string name;
  for (const char c : quantifier.text) {
    if (is_letter(c)) {
      name += c;
    } else if (!name.empty()) {
      names.push_back(std::move(name));
      name.clear();
    }
  }
  return names;
}

void collect_variables(const RandomFormula& formula, std::map<std::string, std::string>& names) {
  if (is_quantifier(formula)) {
    for (const auto& name : variables_of(formula)) names.emplace(name, "");
  }
  for (const auto& part : formula.parts) collect_variables(part, names);
}

std::string with_names(const std::string& text, const std::map<std::string, std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    auto end = i;
    while (end < text.size() && is_letter(text[end])) ++end;
    const auto word = text.substr(i, end - i);
    const auto renamed = names.find(word);
    // A symbol is followed by a bracket, a variable never is.
    const bool is_symbol = end < text.size() && text[end] == '(';
    out += renamed != names.end() && !is_symbol ? renamed->second : word;
    if (end == text.size()) break;
    out += text[end];
    i = end + 1;
  }
  return out;
}

void rewrite(RandomFormula& formula, const std::map<std::string, std::string>& names,
             FuzzRandom& random) {
  if (is_quantifier(formula)) {
    auto list = variables_of(formula);
    shuffle(list, random);
    std::string text;
    for (const auto& name : list) text += (text.empty() ? "" : " , ") + names.at(name);
    formula.text = formula.text[0] == '[' ? "[" + text + "]" : "{" + text + "}";
  } else if (formula.parts.empty()) {
    formula.text = with_names(formula.text, names);
  }
  if ((formula.text == "&" || formula.text == "|" || formula.text == "<->") && random.chance(50)) {
    std::swap(formula.parts[0], formula.parts[1]);
  }
  for (auto& part : formula.parts) rewrite(part, names, random);
}

void collect(RandomFormula& formula, std::vector<RandomFormula*>& all) {
  all.push_back(&formula);
  for (auto& part : formula.parts) collect(part, all);
}

/// Replaces one occurrence of a number by another one.
bool change_number(std::string& text, FuzzRandom& random) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool alone = std::isdigit(static_cast<unsigned char>(text[i])) != 0 &&
                       (i == 0 || !is_letter(text[i - 1]));
    if (!alone) continue;
    text[i] = static_cast<char>('0' + random.below(3));
    return true;
  }
  return false;
}

bool replace(std::string& text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) return false;
  text.replace(at, from.size(), to);
  return true;
}

void edit_leaf(RandomFormula& leaf, FuzzRandom& random) {
  switch (random.below(4)) {
    case 0:
      if (change_number(leaf.text, random)) return;
      break;
    case 1:
      if (replace(leaf.text, "Initiates(", "Terminates(")) return;
      if (replace(leaf.text, "Terminates(", "Initiates(")) return;
      break;
    case 2:
      if (replace(leaf.text, ",time)", ",0)")) return;
      break;
    default:
      break;
  }
  leaf = {"!", {leaf}};
}

void edit(RandomFormula& formula, FuzzRandom& random) {
  std::vector<RandomFormula*> all;
  collect(formula, all);
  auto& where = *all[random.below(all.size())];
  if (where.parts.empty()) return edit_leaf(where, random);
  if (is_quantifier(where)) {
    where.text = where.text[0] == '[' ? "{" + where.text.substr(1) : "[" + where.text.substr(1);
    where.text.back() = where.text[0] == '[' ? ']' : '}';
    return;
  }
  if (where.text == "!") {
    auto inner = where.parts[0];
    where = std::move(inner);
    return;
  }
  if (random.chance(50)) {
    auto kept = where.parts[random.below(2)];
    where = std::move(kept);
    return;
  }
  static const std::vector<std::string> kOperators = {"&", "|", "->", "<->"};
  where.text = random.pick(kOperators);
}

}  // namespace

RandomModel rewritten(RandomModel model, FuzzRandom& random) {
  std::vector<RandomStatement> formulas;
  std::erase_if(model.statements, [&](const RandomStatement& statement) {
    if (statement.formula) formulas.push_back(statement);
    return statement.formula.has_value();
  });
  for (auto& statement : formulas) {
    std::map<std::string, std::string> names;
    collect_variables(*statement.formula, names);
    std::size_t next = 1 + random.below(90);
    for (auto& [name, renamed] : names) {
      renamed = name;
      while (std::isdigit(static_cast<unsigned char>(renamed.back())) != 0) renamed.pop_back();
      renamed += std::to_string(next++);
    }
    rewrite(*statement.formula, names, random);
  }
  shuffle(formulas, random);
  for (auto& statement : formulas) {
    if (random.chance(10)) model.statements.push_back(statement);
    model.statements.push_back(std::move(statement));
  }
  return model;
}

RandomModel edited(RandomModel model, FuzzRandom& random) {
  std::vector<std::size_t> formulas;
  for (std::size_t i = 0; i < model.statements.size(); ++i) {
    if (model.statements[i].formula) formulas.push_back(i);
  }
  if (formulas.empty()) return model;
  const auto which = random.pick(formulas);
  const auto at = model.statements.begin() + static_cast<std::ptrdiff_t>(which);
  const auto roll = random.below(100);
  if (roll < 25) {
    model.statements.erase(at);
  } else if (roll < 40) {
    auto more = *at;
    edit(*more.formula, random);
    model.statements.push_back(std::move(more));
  } else {
    edit(*at->formula, random);
  }
  return model;
}

}  // namespace parallax::test
