#include "compiler/repair/plan_text.h"

#include <algorithm>
#include <utility>

namespace parallax::compiler {
namespace {

/// Where the body of a form begins; none: it has none that another form could be put into.
std::optional<std::size_t> body_begin(std::string_view head) {
  static const std::map<std::string_view, std::size_t> kBodies = {
      {"progn", 1},
      {"seq", 1},
      {"top-level", 1},
      {"with-tags", 1},
      {"with-simulated-robot", 1},
      {"with-real-robot", 1},
      {"block", 2},
      {"let", 2},
      {"let*", 2},
      {"dolist", 2},
      {"dotimes", 2},
      {"when", 2},
      {"unless", 2},
      {"lambda", 2},
      {"do-retry", 2},
      {"with-failure-handling", 2},
      {"with-retry-counters", 2},
      {"destructuring-bind", 3},
      {"multiple-value-bind", 3},
      {"defun", 3},
      {"def-cram-function", 3},
      {"def-top-level-cram-function", 3},
  };
  const auto found = kBodies.find(head);
  if (found == kBodies.end()) return std::nullopt;
  return found->second;
}

bool is_function_head(std::string_view head) {
  return head == "defun" || head == "def-cram-function" || head == "def-top-level-cram-function";
}

bool is_global_head(std::string_view head) {
  return head == "defparameter" || head == "defvar" || head == "defconstant";
}

constexpr std::size_t kMostTypes = 2;   // of designators that one action performs
constexpr std::size_t kMostValues = 8;  // values that a variable of a copied form is tried with

}  // namespace

std::optional<PlanText> PlanText::read(const base::SourceFiles& files,
                                       std::span<const base::FileId> plan) {
  base::DiagnosticSink unread;
  auto text = read_lisp(files, plan, unread);
  if (!text) return std::nullopt;
  return PlanText(files, *std::move(text));
}

PlanText::PlanText(const base::SourceFiles& files, LispText text)
    : files_(&files), text_(std::move(text)) {
  parents_.resize(text_.data.end_id().index());
  for_each_datum(text_.forms, [&](DatumId form) {
    for (const auto child : text_.data.children(form)) parents_[child.index()] = form;
  });
  for (const auto form : text_.forms) {
    const auto head = text_.data.head(form);
    const auto items = text_.data.children(form);
    if (!head || items.size() < 2 || !text_.data.is_symbol(items[1])) continue;
    if (is_function_head(*head)) functions_.emplace(text_.data.name(items[1]), form);
    if (is_global_head(*head)) globals_.insert(text_.data.name(items[1]));
  }
}

std::optional<DatumId> PlanText::parent(DatumId form) const { return parents_[form.index()]; }

bool PlanText::is_written(DatumId form) const {
  if (parent(form)) return true;
  return std::find(text_.forms.begin(), text_.forms.end(), form) != text_.forms.end();
}

bool PlanText::is_quoted(DatumId form) const {
  auto inner = form;
  for (auto around = parent(form); around; inner = *around, around = parent(*around)) {
    const auto head = text_.data.head(*around);
    if (head == "quote" || head == "quasiquote") return true;
    if (head && is_function_head(*head) && place_in_parent(inner) < 3) return true;
  }
  return false;
}

std::size_t PlanText::place_in_parent(DatumId form) const {
  const auto items = text_.data.children(*parent(form));
  return static_cast<std::size_t>(std::find(items.begin(), items.end(), form) - items.begin());
}

bool PlanText::is_definition(DatumId form) const {
  const auto head = text_.data.head(form);
  return head && (head->starts_with("def") || *head == "in-package" || *head == "declare");
}

std::optional<DatumId> PlanText::form_at(const base::SourceRange& source) const {
  for (std::uint32_t i = 0; i < parents_.size(); ++i) {
    if (text_.data.source(DatumId(i)) == source && text_.data.is_list(DatumId(i))) {
      return DatumId(i);
    }
  }
  return std::nullopt;
}

std::optional<DatumId> PlanText::statement_around(DatumId form) const {
  for (;;) {
    const auto around = parent(form);
    if (!around) return is_definition(form) ? std::nullopt : std::optional(form);
    const auto head = text_.data.head(*around);
    if (head == "quote" || head == "quasiquote") return std::nullopt;
    const auto begin = head ? body_begin(*head) : std::nullopt;
    if (begin && place_in_parent(form) >= *begin && !is_definition(form)) return form;
    form = *around;
  }
}

bool PlanText::is_last_of_body(DatumId statement) const {
  const auto around = parent(statement);
  return around && text_.data.children(*around).back() == statement;
}

void PlanText::collect_symbols(DatumId form, std::set<std::string>& out) const {
  for_each_datum({form}, [&](DatumId datum) {
    if (text_.data.is_symbol(datum)) out.insert(text_.data.name(datum));
  });
}

/// Names of the variables that a form binds for its body.
std::vector<std::string> PlanText::bound_by(DatumId form) const {
  const auto& data = text_.data;
  const auto head = data.head(form);
  const auto items = data.children(form);
  std::vector<std::string> out;
  if (!head || items.size() < 2) return out;
  const auto add = [&](DatumId datum) {
    if (data.is_symbol(datum) && !data.name(datum).starts_with('&'))
      out.push_back(data.name(datum));
  };
  if (*head == "let" || *head == "let*") {
    for (const auto binding : data.children(items[1])) {
      data.is_list(binding) && !data.children(binding).empty() ? add(data.children(binding)[0])
                                                               : add(binding);
    }
  } else if ((*head == "dolist" || *head == "dotimes") && !data.children(items[1]).empty()) {
    add(data.children(items[1])[0]);
  } else if (is_function_head(*head) && items.size() > 2) {
    for (const auto parameter : data.children(items[2])) {
      data.is_list(parameter) && !data.children(parameter).empty()
          ? add(data.children(parameter)[0])
          : add(parameter);
    }
  } else if (*head == "lambda" || *head == "multiple-value-bind") {
    for (const auto name : data.children(items[1])) add(name);
  } else if (*head == "destructuring-bind") {
    std::set<std::string> names;
    collect_symbols(items[1], names);
    for (const auto& name : names) {
      if (!name.starts_with('&')) out.push_back(name);
    }
  }
  return out;
}

std::set<std::string> PlanText::scope(DatumId statement) const {
  std::set<std::string> out;
  auto inner = statement;
  for (auto around = parent(statement); around; inner = *around, around = parent(*around)) {
    const auto head = text_.data.head(*around);
    const auto begin = head ? body_begin(*head) : std::nullopt;
    if (!begin || place_in_parent(inner) < *begin) continue;
    for (auto& name : bound_by(*around)) out.insert(std::move(name));
  }
  return out;
}

std::set<std::string> PlanText::free_variables(DatumId form) const {
  std::set<std::string> symbols, out;
  collect_symbols(form, symbols);
  const auto known = scope(form);
  for (const auto& name : symbols) {
    if (known.contains(name) || globals_.contains(name)) out.insert(name);
  }
  return out;
}

std::string PlanText::function_of(DatumId form) const {
  for (auto around = parent(form); around; around = parent(*around)) {
    const auto head = text_.data.head(*around);
    if (head && is_function_head(*head)) return text_.data.name(text_.data.children(*around)[1]);
  }
  return {};
}

bool PlanText::jumps(DatumId form) const {
  std::set<std::string> symbols;
  collect_symbols(form, symbols);
  return symbols.contains("return") || symbols.contains("retry");
}

void PlanText::add_types(DatumId form, std::set<std::string>& out,
                         std::set<std::string>& seen) const {
  const auto& data = text_.data;
  std::vector<DatumId> todo = {form};
  while (!todo.empty()) {
    const auto datum = todo.back();
    todo.pop_back();
    const auto head = data.head(datum);
    const auto items = data.children(datum);
    if (head == "perform" && items.size() > 1) {
      for (const auto pair : data.children(items[1])) {
        const auto parts = data.children(pair);
        const bool is_type = parts.size() == 2 &&
                             (data.is_symbol(parts[0]) || data.is_keyword(parts[0])) &&
                             data.name(parts[0]) == "type";
        if (is_type && !data.is_list(parts[1])) out.insert(data.name(parts[1]));
      }
    }
    if (head) {
      const auto called = functions_.find(*head);
      if (called != functions_.end() && seen.insert(called->first).second) {
        todo.push_back(called->second);
      }
    }
    for (const auto child : items) todo.push_back(child);
  }
}

std::set<std::string> PlanText::performed_types(DatumId form) const {
  std::set<std::string> out, seen;
  add_types(form, out, seen);
  return out;
}

void PlanText::add_called(DatumId form, std::set<std::string>& seen) const {
  std::set<std::string> types;
  add_types(form, types, seen);
}

bool PlanText::is_constant(DatumId form) const {
  const auto& data = text_.data;
  if (data.is_list(form)) return false;
  return !data.is_symbol(form) || globals_.contains(data.name(form));
}

/// Values that the plan gives a variable bound around `where`, as they are written; none where the
/// value is computed.
std::vector<std::string> PlanText::values_of(const std::string& variable, DatumId where) const {
  const auto& data = text_.data;
  std::vector<std::string> out;
  const auto add = [&](DatumId value) {
    auto text = std::string(written(value));
    const bool known = std::find(out.begin(), out.end(), text) != out.end();
    if (is_constant(value) && !known && out.size() < kMostValues) out.push_back(std::move(text));
  };
  for (auto around = parent(where); around; around = parent(*around)) {
    const auto names = bound_by(*around);
    const auto name = std::find(names.begin(), names.end(), variable);
    if (name == names.end()) continue;
    const auto items = data.children(*around);
    const auto head = data.head(*around);
    if (head == "dolist" && data.children(items[1]).size() > 1) {
      const auto list = data.children(items[1])[1];
      const auto quoted = data.head(list);
      if (quoted == "quote") {
        for (const auto value : data.children(data.children(list)[1])) add(value);
      } else if (quoted == "list") {
        for (const auto value : data.children(list).subspan(1)) add(value);
      }
    } else if (head && is_function_head(*head)) {
      const auto place = static_cast<std::size_t>(name - names.begin()) + 1;
      const auto& function = data.name(items[1]);
      for (std::uint32_t i = 0; i < parents_.size(); ++i) {
        if (data.head(DatumId(i)) != function) continue;
        const auto call = data.children(DatumId(i));
        if (place < call.size()) add(call[place]);
      }
    }
    break;
  }
  return out;
}

/// The form on one line, without comments, variables replaced.
std::string PlanText::one_line(DatumId form,
                               const std::map<std::string, std::string>& values) const {
  const auto& data = text_.data;
  if (!data.is_list(form)) {
    if (data.is_symbol(form)) {
      const auto value = values.find(data.name(form));
      if (value != values.end()) return value->second;
    }
    return std::string(written(form));
  }
  // 'x and its like are written as they stand.
  if (!written(form).starts_with('(')) return std::string(written(form));
  std::string out = "(";
  for (const auto child : data.children(form)) {
    if (out.size() > 1) out += ' ';
    out += one_line(child, values);
  }
  return out + ")";
}

std::vector<PlanText::Action> PlanText::actions_for(DatumId statement) const {
  const auto& data = text_.data;
  const auto visible = scope(statement);
  const auto home = function_of(statement);
  std::vector<Action> out;
  for (std::uint32_t i = 0; i < parents_.size(); ++i) {
    const DatumId form(i);
    const auto head = data.head(form);
    const bool calls = head && functions_.contains(*head);
    if (!head || (*head != "perform" && !calls)) continue;
    // Found objects that are handed on at once are values, not statements.
    const auto own = statement_around(form);
    if (!own || (calls && *own != form)) continue;
    if (calls) {
      std::set<std::string> called;
      add_called(form, called);
      if (called.contains(home)) continue;
    }
    const auto types = performed_types(form);
    if (types.empty() || types.size() > kMostTypes) continue;
    std::vector<std::map<std::string, std::string>> ways = {{}};
    bool substituted = false;
    for (const auto& name : free_variables(form)) {
      if (visible.contains(name) || globals_.contains(name)) continue;
      substituted = true;
      std::vector<std::map<std::string, std::string>> more;
      for (const auto& value : values_of(name, form)) {
        for (const auto& way : ways) {
          if (more.size() == kMostValues) break;
          auto& next = more.emplace_back(way);
          next[name] = value;
        }
      }
      ways = std::move(more);
    }
    for (const auto& way : ways) {
      Action action{one_line(form, way), types, form, substituted};
      const bool known = std::any_of(out.begin(), out.end(),
                                     [&](const auto& other) { return other.text == action.text; });
      if (!known) out.push_back(std::move(action));
    }
  }
  return out;
}

std::string PlanText::prefixed(std::string_view symbol) const {
  for (std::uint32_t i = 0; i < parents_.size(); ++i) {
    const DatumId datum(i);
    if (!text_.data.is_symbol(datum, symbol)) continue;
    const auto text = std::string(written(datum));
    if (!text_.data.package(datum).empty()) return text;
  }
  return std::string(symbol);
}

}  // namespace parallax::compiler
