#include "compiler/asp/term_writer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_set>
#include <utility>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/grounding.h"

namespace parallax::compiler {

namespace {

/// Predicates of the exported program itself, and `not`, the one word that clingo reserves.
constexpr std::array<std::string_view, 20> kReserved = {
    "not",        "holds_at", "happens",    "released_at",  "initiates",
    "terminates", "releases", "initiated",  "terminated",   "released",
    "stopped_in", "horizon",  "started_in", "step",         "noninertial",
    "trajectory", "inertial", "free_start", "axiom_exists", "antitrajectory"};

std::string identifier(std::string_view wanted) {
  std::string name;
  for (const char c : wanted) name += base::is_name_character(c) ? c : '_';
  const auto first = name.find_first_not_of('_');
  if (first == std::string::npos || !base::is_letter(name[first])) return "x" + name;
  name[first] = base::to_lower(name[first]);
  return name;
}

}  // namespace

AspNames::AspNames(const TypedModel& model) {
  for (const auto word : kReserved) taken_.emplace(word);
  const auto& core = model.core;
  const std::array<std::pair<std::optional<SymbolId>, std::string_view>, 8> fixed = {
      {{core.holds_at, "holds_at"},
       {core.happens, "happens"},
       {core.released_at, "released_at"},
       {core.initiates, "initiates"},
       {core.terminates, "terminates"},
       {core.releases, "releases"},
       {core.trajectory, "trajectory"},
       {core.anti_trajectory, "antitrajectory"}}};
  for (const auto& sort : model.sorts) sorts_.push_back(fresh(sort.name));
  for (std::size_t i = 0; i < model.symbols.size(); ++i) {
    const auto id = model.symbols.id_at(i);
    const auto known = std::find_if(fixed.begin(), fixed.end(),
                                    [&](const auto& entry) { return entry.first == id; });
    if (known != fixed.end()) {
      symbols_.emplace_back(known->second);
    } else {
      symbols_.push_back(fresh(model.symbols[id].name));
      originals_.emplace(symbols_.back(), model.symbols[id].name + "()");
    }
  }
  for (const auto& object : model.objects) {
    objects_.push_back(fresh(object.name));
    originals_.emplace(objects_.back(), object.name);
  }
  for (const auto& [name, original] : originals_) by_original_.emplace(original, name);
}

std::string AspNames::fresh(std::string_view wanted) {
  auto name = identifier(wanted);
  while (!taken_.insert(name).second) name += '_';
  return name;
}

std::string AspNames::original(std::string_view printed) const {
  std::string out;
  for (std::size_t i = 0; i < printed.size();) {
    if (!base::is_name_character(printed[i])) {
      out += printed[i++];
      continue;
    }
    std::size_t end = i;
    while (end < printed.size() && base::is_name_character(printed[end])) ++end;
    const auto word = printed.substr(i, end - i);
    const auto known = originals_.find(word);
    const bool applied = end < printed.size() && printed[end] == '(';
    if (known == originals_.end()) {
      out += word;
    } else {
      const auto& name = known->second;
      out += applied ? name.substr(0, name.find('(')) : name;
    }
    i = end;
  }
  return out;
}

std::string AspNames::printed(std::string_view original) const {
  std::string out;
  for (std::size_t i = 0; i < original.size();) {
    if (!base::is_name_character(original[i])) {
      out += original[i++];
      continue;
    }
    std::size_t end = i;
    while (end < original.size() && base::is_name_character(original[end])) ++end;
    std::string word(original.substr(i, end - i));
    const auto rest = original.substr(end);
    if (rest.starts_with('(')) word += "()";
    const auto known = by_original_.find(word);
    out += known == by_original_.end() ? original.substr(i, end - i) : known->second;
    i = rest.starts_with("()") ? end + 2 : end;
  }
  return out;
}

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

void TermWriter::start() {
  variables_.clear();
  used_.clear();
  values_.clear();
}

std::string TermWriter::fresh_variable(const std::string& wanted) {
  std::string name;
  for (const char c : wanted) name += base::is_name_character(c) ? c : '_';
  const auto first = name.find_first_not_of('_');
  if (first == std::string::npos || base::is_digit(name[first])) {
    name = "X" + name;
  } else {
    name[first] = base::to_upper(name[first]);
  }
  while (!used_.insert(name).second) name += '_';
  return name;
}

const std::string& TermWriter::variable(VariableId id) {
  auto& name = variables_[id.index()];
  if (name.empty()) name = fresh_variable(model_.variables[id].name);
  return name;
}

AspBody TermWriter::domains(const std::vector<VariableId>& variables) {
  AspBody body;
  for (const auto id : variables) {
    body.push_back(plain_literal(applied(names_.sort(model_.variables[id].sort), {variable(id)})));
  }
  return body;
}

bool TermWriter::is_unbounded(SortId sort) const {
  if (!model_.sorts[sort].integer) return false;
  for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
    const auto below = model_.sorts.id_at(i);
    if (!model_.sorts[below].ranges.empty() && model_.is_subsort(below, sort)) return false;
  }
  return true;
}

bool TermWriter::is_empty(SortId sort) const {
  if (empty_.empty()) {
    // Sorts gain elements until nothing changes; terms of a sort never contain terms of that sort.
    for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
      const auto& declared = model_.sorts[model_.sorts.id_at(i)];
      empty_[static_cast<std::uint32_t>(i)] = declared.constants.empty() && declared.ranges.empty();
    }
    for (bool changed = true; changed;) {
      changed = false;
      const auto fill = [&](SortId filled) {
        changed = changed || empty_[filled.index()];
        empty_[filled.index()] = false;
      };
      for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
        if (empty_[static_cast<std::uint32_t>(i)]) continue;
        for (const auto parent : model_.sorts[model_.sorts.id_at(i)].parents) fill(parent);
      }
      for (const auto& symbol : model_.symbols) {
        if (!symbol.result || symbol.kind == SymbolKind::kFunction) continue;
        if (std::none_of(symbol.arguments.begin(), symbol.arguments.end(),
                         [&](SortId argument) { return empty_[argument.index()]; })) {
          fill(*symbol.result);
        }
      }
    }
  }
  return empty_[sort.index()];
}

std::string TermWriter::number(std::int64_t value, base::SourceRange source) const {
  if (value < std::numeric_limits<std::int32_t>::min() ||
      value > std::numeric_limits<std::int32_t>::max()) {
    sink_.error(codes::kAspNumber, source, value);
  }
  return std::to_string(value);
}

AspTerm TermWriter::term(TermId root) {
  // Post-order without recursion: (term, how many of its arguments are done).
  std::vector<std::pair<TermId, std::size_t>> stack = {{root, 0}};
  std::vector<AspTerm> values;
  while (true) {
    auto& [id, done] = stack.back();
    const auto& node = model_.terms[id];
    if (done < node.arguments.size()) {
      stack.emplace_back(node.arguments[done++], 0);
      continue;
    }
    const auto first = values.end() - static_cast<std::ptrdiff_t>(node.arguments.size());
    std::vector<AspTerm> arguments(std::make_move_iterator(first),
                                   std::make_move_iterator(values.end()));
    values.erase(first, values.end());
    auto value = combined(id, std::move(arguments));
    stack.pop_back();
    if (stack.empty()) return value;
    values.push_back(std::move(value));
  }
}

AspTerm TermWriter::leaf(const Term& node) {
  if (node.kind == TermKind::kVariable) return {variable(node.variable), {}, {}};
  if (node.kind == TermKind::kObject) return {names_.object(node.object), {}, {}};
  return {number(node.integer, node.source), {}, {}};
}

AspTerm TermWriter::combined(TermId id, std::vector<AspTerm> arguments) {
  const auto& node = model_.terms[id];
  if (node.kind == TermKind::kArithmetic) {
    return arithmetic(node, std::move(arguments[0]), std::move(arguments[1]));
  }
  if (node.kind != TermKind::kApply) return leaf(node);
  const auto& symbol = model_.symbols[node.symbol];
  AspTerm value;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    require_member(model_.terms[node.arguments[i]], symbol.arguments[i], arguments[i]);
    append(value.needs, arguments[i].needs);
    append(value.lookups, arguments[i].lookups);
    texts.push_back(std::move(arguments[i].text));
  }
  value.text = applied(names_.symbol(node.symbol), texts);
  if (symbol.kind != SymbolKind::kFunction) return value;
  // The table is a predicate with the value as its last argument.
  auto& result = values_[value.text];
  if (result.empty()) result = fresh_variable(symbol.name);
  texts.push_back(result);
  const auto lookup = plain_literal(applied(names_.symbol(node.symbol), texts));
  value.needs.push_back(lookup);
  value.lookups.push_back(lookup);
  value.text = result;
  return value;
}

AspTerm TermWriter::member(TermId id, SortId sort) {
  auto value = term(id);
  require_member(model_.terms[id], sort, value);
  return value;
}

void TermWriter::require_member(const Term& node, SortId sort, AspTerm& value) const {
  if (is_unbounded(sort) || surely_member(node, sort)) return;
  value.needs.push_back(plain_literal(applied(names_.sort(sort), {value.text})));
}

bool TermWriter::surely_member(const Term& node, SortId sort) const {
  switch (node.kind) {
    case TermKind::kVariable:
      return model_.is_subsort(model_.variables[node.variable].sort, sort);
    case TermKind::kObject: {
      const auto& sorts = model_.objects[node.object].sorts;
      return std::any_of(sorts.begin(), sorts.end(),
                         [&](SortId own) { return model_.is_subsort(own, sort); });
    }
    case TermKind::kInteger:
      // The last timepoint may be moved when the program is run, the first may not.
      if (sort == model_.core.time) return node.integer == 0;
      return std::any_of(model_.sorts[sort].ranges.begin(), model_.sorts[sort].ranges.end(),
                         [&](const auto& range) {
                           return range.lower <= node.integer && node.integer <= range.upper;
                         });
    case TermKind::kApply: {
      const auto& symbol = model_.symbols[node.symbol];
      return symbol.kind != SymbolKind::kFunction && symbol.result &&
             model_.is_subsort(*symbol.result, sort);
    }
    case TermKind::kArithmetic:
      return false;
  }
  return false;
}

bool TermWriter::never_negative(TermId id) const {
  const auto& node = model_.terms[id];
  if (node.kind == TermKind::kInteger) return node.integer >= 0;
  if (node.kind != TermKind::kVariable) return false;
  const auto sort = model_.variables[node.variable].sort;
  for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
    const auto below = model_.sorts.id_at(i);
    if (!model_.is_subsort(below, sort)) continue;
    for (const auto& range : model_.sorts[below].ranges) {
      if (range.lower < 0) return false;
    }
  }
  return true;
}

/// Division cuts off towards zero and the remainder has the sign of the dividend. Solvers differ
/// for negative numbers, so these are written with absolute values and signs; the sign of x is
/// (|x+1|-|x-1|)/2, in which nothing is cut off.
AspTerm TermWriter::arithmetic(const Term& node, AspTerm left, AspTerm right) const {
  AspTerm value = std::move(left);
  append(value.needs, right.needs);
  append(value.lookups, right.lookups);
  const auto a = value.text;
  const auto b = right.text;
  const auto sign = [](const std::string& x) { return "((|" + x + "+1|-|" + x + "-1|)/2)"; };
  const bool plain = never_negative(node.arguments[0]) && never_negative(node.arguments[1]);
  switch (node.op) {
    case ArithmeticOp::kAdd:
      value.text = "(" + a + "+" + b + ")";
      break;
    case ArithmeticOp::kSubtract:
      value.text = "(" + a + "-" + b + ")";
      break;
    case ArithmeticOp::kMultiply:
      value.text = "(" + a + "*" + b + ")";
      break;
    case ArithmeticOp::kDivide:
      value.text = plain ? "(" + a + "/" + b + ")"
                         : "(" + sign(a) + "*" + sign(b) + "*(|" + a + "|/|" + b + "|))";
      break;
    case ArithmeticOp::kModulo:
      value.text =
          plain ? "(" + a + "\\" + b + ")" : "(" + sign(a) + "*(|" + a + "|\\|" + b + "|))";
      break;
  }
  return value;
}

}  // namespace parallax::compiler
