#include "tests/support/random_formulas.h"

namespace parallax::test {

std::string sort_of(const std::string& variable) {
  return variable.substr(0, variable.find_last_not_of("0123456789") + 1);
}

std::string RandomFormulas::enter(const std::string& sort) {
  static const std::vector<std::string> kSuffixes = {"", "1", "2"};
  scope_.push_back(sort + random_.pick(kSuffixes));
  return scope_.back();
}

std::string RandomFormulas::any_sort() {
  if (random_.chance(40)) return "time";
  if (random_.chance(25)) return random_.chance(60) ? "event" : "fluent";
  std::vector<std::string> sorts;
  for (const auto& [sort, elements] : schema_.elements) {
    if (!elements.empty() || random_.chance(30)) sorts.push_back(sort);
  }
  return random_.pick(sorts);
}

std::optional<std::string> RandomFormulas::variable(const std::string& sort) {
  std::vector<std::string> fitting;
  for (const auto& name : scope_) {
    const auto own = sort_of(name);
    if (schema_.below(own, sort)) {
      fitting.insert(fitting.end(), 4, name);
    } else if (schema_.related(own, sort)) {
      fitting.push_back(name);
    }
  }
  if (fitting.empty()) return std::nullopt;
  return random_.pick(fitting);
}

std::string RandomFormulas::time() {
  std::vector<std::string> moments;
  for (const auto& name : scope_) {
    if (sort_of(name) == "time") moments.push_back(name);
  }
  const auto literal = [&] {
    return std::to_string(random_.below(static_cast<std::size_t>(schema_.horizon) + 1));
  };
  if (moments.empty() || random_.chance(8)) return literal();
  return moment_near(random_.pick(moments));
}

void RandomFormulas::start() {
  scope_.clear();
  const auto roll = random_.below(100);
  look_ = roll < 50   ? Look::kNow
          : roll < 72 ? Look::kAhead
          : roll < 92 ? Look::kBack
                      : Look::kAnywhere;
}

std::string RandomFormulas::moment_near(const std::string& moment) {
  switch (look_) {
    case Look::kNow:
      return moment;
    case Look::kAhead:
      if (random_.chance(60)) return moment;
      return moment + (schema_.horizon > 2 && random_.chance(25) ? "+2" : "+1");
    case Look::kBack:
      return random_.chance(60) ? moment : moment + "-1";
    case Look::kAnywhere:
      break;
  }
  static const std::vector<std::string> kFar = {"", "+1", "-1", "+2", "*2", "-2", "/2"};
  if (const auto other = variable("integer"); other && random_.chance(25)) {
    return moment + "+" + *other;
  }
  return moment + random_.pick(kFar);
}

std::optional<std::string> RandomFormulas::arithmetic(const std::string& sort, int depth) {
  const auto left = term(sort, depth - 1);
  if (!left) return std::nullopt;
  static const std::vector<std::string> kSteps = {"+1", "-1", "*2", "/2", "%2", "+2", "*(-1)"};
  if (random_.chance(70)) return "(" + *left + ")" + random_.pick(kSteps);
  // Minus a number is a number, which the front end wants in the range.
  const bool number = left->find_first_not_of("-()0123456789") == std::string::npos;
  if (!number && random_.chance(20)) return "-(" + *left + ")";
  const auto right = term(random_.chance(70) ? sort : "time", depth - 1);
  if (!right) return std::nullopt;
  static const std::vector<std::string> kOperators = {"+", "-", "*", "+", "-"};
  return "(" + *left + ")" + random_.pick(kOperators) + "(" + *right + ")";
}

std::optional<std::string> RandomFormulas::apply(const RandomSymbol& symbol, int depth) {
  std::string text = symbol.name + "(";
  for (std::size_t i = 0; i < symbol.arguments.size(); ++i) {
    const auto& sort = symbol.arguments[i];
    const auto value = sort == "time" ? std::optional(time()) : term(sort, depth - 1);
    if (!value) return std::nullopt;
    text += (i > 0 ? "," : "") + *value;
  }
  return text + ")";
}

std::optional<std::string> RandomFormulas::term(const std::string& sort, int depth) {
  if (sort == "time") return time();
  const auto roll = random_.below(100);
  if (roll < 55) {
    if (auto found = variable(sort)) return found;
  }
  if (depth > 0 && roll >= 85 && schema_.is_integer(sort)) return arithmetic(sort, depth);
  if (depth > 0 && roll >= 75) {
    std::vector<RandomSymbol> fitting;
    for (const auto& function : schema_.functions) {
      if (schema_.related(function.result, sort)) fitting.push_back(function);
    }
    if (!fitting.empty()) {
      if (auto found = apply(random_.pick(fitting), depth)) return found;
    }
  }
  if (depth > 0) {
    std::vector<RandomSymbol> fitting;
    for (const auto* symbols : {&schema_.terms, &schema_.fluents, &schema_.events}) {
      for (const auto& symbol : *symbols) {
        if (symbol.result == sort) fitting.push_back(symbol);
      }
    }
    if (!fitting.empty()) return apply(random_.pick(fitting), depth);
  }
  const auto elements = schema_.elements.find(sort);
  if (elements == schema_.elements.end() || elements->second.empty()) return variable(sort);
  return random_.pick(elements->second);
}

std::optional<std::string> RandomFormulas::holds(const char* predicate) {
  const auto fluent = term("fluent", 3);
  if (!fluent) return std::nullopt;
  return std::string(predicate) + "(" + *fluent + "," + time() + ")";
}

std::optional<std::string> RandomFormulas::user_atom() {
  if (schema_.predicates.empty()) return std::nullopt;
  return apply(random_.pick(schema_.predicates), 3);
}

std::optional<std::string> RandomFormulas::comparison() {
  static const std::vector<std::string> kEqual = {"=", "!="};
  static const std::vector<std::string> kOrder = {"<", "<=", ">", ">=", "=", "!="};
  const auto sort = scope_.empty() ? any_sort() : sort_of(random_.pick(scope_));
  const auto left = variable(sort) ? variable(sort) : term(sort, 1);
  const auto right = term(sort, 2);
  if (!left || !right) return std::nullopt;
  return *left + random_.pick(schema_.is_integer(sort) ? kOrder : kEqual) + *right;
}

RandomFormula RandomFormulas::occurrence() {
  if (const auto event = term("event", 3)) return {"Happens(" + *event + "," + time() + ")", {}};
  return {time() + "<2", {}};
}

RandomFormula RandomFormulas::atom() {
  const auto roll = random_.below(100);
  std::optional<std::string> text;
  if (roll < 42) {
    text = holds("HoldsAt");
  } else if (roll < 67) {
    return occurrence();
  } else if (roll < 74) {
    text = holds("ReleasedAt");
  } else if (roll < 88) {
    text = user_atom();
  } else {
    text = comparison();
  }
  if (!text) text = holds("HoldsAt");
  return {text ? *text : "1<2", {}};
}

/// One or two, entered.
std::string RandomFormulas::new_variables() {
  std::string variables;
  const auto count = 1 + (random_.chance(25) ? 1U : 0U);
  for (std::size_t i = 0; i < count; ++i) {
    const auto name = enter(any_sort());
    if (i > 0 && scope_[scope_.size() - 2] == name) {
      scope_.pop_back();
      continue;
    }
    variables += (variables.empty() ? "" : ",") + name;
  }
  return variables;
}

RandomFormula RandomFormulas::quantified(int depth) {
  const auto before = scope_.size();
  const auto variables = new_variables();
  auto body = formula(depth - 1);
  scope_.resize(before);
  const auto head = random_.chance(45) ? "[" + variables + "]" : "{" + variables + "}";
  return {head, {std::move(body)}};
}

std::string RandomFormulas::number(const std::vector<std::string>& numbers,
                                   std::size_t variable_percent) {
  if (!random_.chance(variable_percent)) return random_.pick(numbers);
  std::vector<std::string> fitting;
  for (const auto& name : scope_) {
    if (schema_.is_integer(sort_of(name)) || sort_of(name) == "time") fitting.push_back(name);
  }
  if (fitting.empty()) return random_.pick(numbers);
  return random_.pick(fitting) +
         (random_.chance(30) ? random_.pick(std::vector<std::string>{"-1", "+1", "*2"}) : "");
}

RandomFormula RandomFormulas::aggregate(int depth) {
  static const std::vector<std::string> kSigns = {">=", "<=", "=", "<", ">", "!="};
  static const std::vector<std::string> kMirrored = {"<=", ">=", "=", ">", "<", "!="};
  const auto limit = number({"0", "1", "1", "2", "2", "3", "-1"}, 15);
  const auto before = scope_.size();
  auto head = (random_.chance(60) ? "count{" : "sum{") + new_variables() + ": ";
  if (head[0] == 's') head += number({"1", "2", "3", "-1", "-2", "0"}, 40) + ": ";
  auto body = formula(depth - 1);
  scope_.resize(before);
  const auto sign = random_.below(kSigns.size());
  if (random_.chance(15)) return {limit + kMirrored[sign] + head, {std::move(body)}, "}"};
  return {head, {std::move(body)}, "}" + kSigns[sign] + limit};
}

RandomFormula RandomFormulas::formula(int depth) {
  if (aggregates_ && depth > 0 && random_.chance(25)) return aggregate(depth);
  const auto roll = depth <= 0 ? 99 : random_.below(100);
  if (roll < 10) return {"!", {formula(depth - 1)}};
  if (roll < 62) {
    const auto* connective = roll < 28 ? "&" : roll < 43 ? "|" : roll < 55 ? "->" : "<->";
    auto left = formula(depth - 1);
    return {connective, {std::move(left), formula(depth - 1)}};
  }
  if (roll < 78) return quantified(depth);
  return atom();
}

}  // namespace parallax::test
