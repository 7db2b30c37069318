#include "compiler/repair/number_term.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <limits>
#include <set>

namespace parallax::compiler {
namespace {

constexpr std::int64_t kMostNumerals = 16;
constexpr std::size_t kMostFunctionTerms = 12;  // of one function
constexpr std::size_t kMostTerms = 16;          // of all functions

bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::optional<std::int64_t> read_number(std::string_view text) {
  std::int64_t out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return out;
}

std::optional<std::int64_t> number_or_variable(const std::string& term,
                                               const std::map<std::string, std::string>& values) {
  const auto found = values.find(term);
  return read_number(found == values.end() ? std::string_view(term)
                                           : std::string_view(found->second));
}

/// The text of a node with another one for a part of it.
std::string with_part(const Ast& ast, const Node& whole, const Node& part,
                      const std::string& instead) {
  return std::string(ast.text({whole.begin, part.begin})) + instead +
         std::string(ast.text({part.end, whole.end}));
}

/// The opposite first.
std::vector<Operator> other_relations(Operator op) {
  using enum Operator;
  if (op == kEqual) return {kNotEqual};
  if (op == kNotEqual) return {kEqual};
  if (op == kLess) return {kGreaterEqual, kLessEqual, kGreater};
  if (op == kLessEqual) return {kGreater, kLess, kGreaterEqual};
  if (op == kGreater) return {kLessEqual, kGreaterEqual, kLess};
  return {kLess, kGreater, kLessEqual};
}

class OtherNumbers {
 public:
  OtherNumbers(const Ast& ast, NodeId root, const TypedModel& model,
               const std::vector<SortedVariable>& variables)
      : ast_(ast), root_(ast[root]), model_(model), variables_(variables) {}

  /// Texts of the root with one change in the part `at`.
  void collect(NodeId at, std::vector<OtherText>& out) const {
    const auto& node = ast_[at];
    const auto add = [&](const Node& part, const std::string& text, int oddity) {
      out.emplace_back(with_part(ast_, root_, part, text), oddity);
    };
    if (node.kind == NodeKind::kNumber) {
      const auto number = read_number(ast_.name(node));
      if (!number) return;
      if (*number < std::numeric_limits<std::int64_t>::max()) {
        add(node, std::to_string(*number + 1), 2);
      }
      if (*number > 0) add(node, std::to_string(*number - 1), 2);
      return;
    }
    if (node.kind == NodeKind::kName) {
      const auto sort = sort_of_variable(model_, ast_.name(node));
      if (!sort) return;
      for (const auto& other : variables_) {
        if (other.name == ast_.name(node) || !model_.sorts_overlap(other.sort, *sort)) continue;
        add(node, other.name, 2);
      }
      return;
    }
    const bool sum = node.kind == NodeKind::kBinary && node.child_count == 2 &&
                     (node.op == Operator::kAdd || node.op == Operator::kSubtract);
    if (sum) {
      const auto& left = ast_[ast_.child(node, 0)];
      const auto& right = ast_[ast_.child(node, 1)];
      const auto* sign = node.op == Operator::kAdd ? "-" : "+";
      add(node,
          std::string(ast_.text({left.begin, left.end})) + sign +
              std::string(ast_.text({right.begin, right.end})),
          1);
      add(node, std::string(ast_.text({left.begin, left.end})), 2);
    }
    for (std::uint32_t i = 0; i < node.child_count; ++i) collect(ast_.child(node, i), out);
  }

 private:
  const Ast& ast_;
  const Node& root_;
  const TypedModel& model_;
  const std::vector<SortedVariable>& variables_;
};

}  // namespace

bool is_number_sort(const TypedModel& model, SortId sort) {
  return model.sorts[sort].integer &&
         (!model.core.time || !model.is_subsort(sort, *model.core.time));
}

std::vector<std::string> numerals_of(const TypedModel& model, SortId sort) {
  if (!is_number_sort(model, sort)) return {};
  std::set<std::int64_t> numbers;
  for (std::uint32_t i = 0; i < model.sorts.size(); ++i) {
    if (!model.is_subsort(SortId(i), sort)) continue;
    for (const auto& range : model.sorts[SortId(i)].ranges) {
      // Ranges may reach to the ends of 64 bits.
      const auto last =
          static_cast<std::uint64_t>(range.upper) - static_cast<std::uint64_t>(range.lower);
      if (range.upper < range.lower) continue;
      if (last >= static_cast<std::uint64_t>(kMostNumerals)) return {};
      for (std::uint64_t k = 0; k <= last; ++k) {
        numbers.insert(range.lower + static_cast<std::int64_t>(k));
      }
    }
  }
  if (numbers.size() > static_cast<std::size_t>(kMostNumerals)) return {};
  std::vector<std::string> out;
  for (const auto n : numbers) out.push_back(std::to_string(n));
  return out;
}

std::string with_names(const std::string& term, const std::map<std::string, std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < term.size();) {
    if (!is_of_name(term[i])) {
      out += term[i++];
      continue;
    }
    auto end = i;
    while (end < term.size() && is_of_name(term[end])) ++end;
    const auto word = term.substr(i, end - i);
    const auto found = names.find(word);
    out += found == names.end() ? word : found->second;
    i = end;
  }
  return out;
}

std::optional<SteppedVariable> stepped_variable(const std::string& term) {
  const auto end = static_cast<std::size_t>(std::find_if_not(term.begin(), term.end(), is_of_name) -
                                            term.begin());
  if (end == 0 || read_number(std::string_view(term).substr(0, end))) return std::nullopt;
  const auto step = std::string_view(term).substr(end);
  if (step.empty()) return SteppedVariable{term, 0};
  if (step != "+1" && step != "-1") return std::nullopt;
  return SteppedVariable{term.substr(0, end), step == "+1" ? 1 : -1};
}

std::optional<std::int64_t> number_of(const std::string& term,
                                      const std::map<std::string, std::string>& values) {
  const auto sign = term.find_first_of("+-", 1);
  if (sign == std::string::npos) return number_or_variable(term, values);
  const auto left = number_or_variable(term.substr(0, sign), values);
  const auto right = number_or_variable(term.substr(sign + 1), values);
  if (!left || !right) return std::nullopt;
  std::int64_t out = 0;
  const bool too_large = term[sign] == '+' ? __builtin_add_overflow(*left, *right, &out)
                                           : __builtin_sub_overflow(*left, *right, &out);
  return too_large ? std::nullopt : std::optional(out);
}

std::optional<bool> compares(const ConditionLiteral& literal,
                             const std::map<std::string, std::string>& values) {
  const auto value = [&](const LiteralArgument& argument) -> std::optional<std::string> {
    if (argument.kind == LiteralArgument::Kind::kTerm) {
      const auto number = number_of(argument.name, values);
      return number ? std::optional(std::to_string(*number)) : std::nullopt;
    }
    if (argument.kind != LiteralArgument::Kind::kVariable) return argument.name;
    const auto found = values.find(argument.name);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  };
  const auto left = value(literal.arguments[0]), right = value(literal.arguments[1]);
  if (!left || !right) return std::nullopt;
  if (!literal.less) return (*left == *right) != literal.negated;
  const auto a = read_number(*left), b = read_number(*right);
  if (!a || !b) return std::nullopt;
  return (*a < *b) != literal.negated;
}

std::vector<std::string> function_terms(const TypedModel& model, SortId sort,
                                        const std::vector<SortedVariable>& variables) {
  std::vector<std::string> out;
  for (const auto& symbol : model.symbols) {
    if (out.size() >= kMostTerms) break;
    if (symbol.kind != SymbolKind::kFunction || !symbol.result || symbol.arguments.empty())
      continue;
    if (!model.sorts_overlap(*symbol.result, sort)) continue;
    std::vector<std::string> texts = {""};
    for (const auto place : symbol.arguments) {
      std::vector<std::string> next;
      for (const auto& begun : texts) {
        for (const auto& variable : variables) {
          if (!model.sorts_overlap(variable.sort, place)) continue;
          next.push_back(begun + (begun.empty() ? "" : ",") + variable.name);
        }
      }
      texts = std::move(next);
      if (texts.size() > kMostFunctionTerms) texts.clear();
    }
    for (const auto& text : texts) out.push_back(symbol.name + "(" + text + ")");
  }
  return out;
}

std::vector<OtherText> other_comparisons(const Ast& ast, NodeId comparison, const TypedModel& model,
                                         const std::vector<SortedVariable>& variables) {
  const auto& node = ast[comparison];
  std::vector<OtherText> out;
  if (node.kind != NodeKind::kBinary || !is_comparison(node.op) || node.child_count != 2)
    return out;
  const auto& left = ast[ast.child(node, 0)];
  const auto& right = ast[ast.child(node, 1)];
  for (const auto op : other_relations(node.op)) {
    out.emplace_back(std::string(ast.text({left.begin, left.end})) + std::string(spelling(op)) +
                         std::string(ast.text({right.begin, right.end})),
                     2);
  }
  const OtherNumbers numbers(ast, comparison, model, variables);
  numbers.collect(ast.child(node, 0), out);
  numbers.collect(ast.child(node, 1), out);
  // `count<2` may have any other numeral.
  if (right.kind == NodeKind::kNumber && left.kind == NodeKind::kName) {
    const auto sort = sort_of_variable(model, ast.name(left));
    for (const auto& numeral : sort ? numerals_of(model, *sort) : std::vector<std::string>()) {
      if (numeral != ast.name(right)) out.emplace_back(with_part(ast, node, right, numeral), 3);
    }
  }
  // `count2=count1` may lack its step.
  if (right.kind != NodeKind::kName) return out;
  const auto sort = sort_of_variable(model, ast.name(right));
  if (!sort || !is_number_sort(model, *sort)) return out;
  for (const auto* step : {"+1", "-1"}) {
    out.emplace_back(with_part(ast, node, right, std::string(ast.name(right)) + step), 2);
  }
  return out;
}

}  // namespace parallax::compiler
