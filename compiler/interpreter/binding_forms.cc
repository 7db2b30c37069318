#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "compiler/interpreter/destructuring.h"
#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/variables.h"

namespace parallax::compiler {
namespace {

void let(FormCompiler& c, DatumId form, FormItems items, bool sequential) {
  if (items.size() < 2 || (!c.data.is_list(items[1]) && !c.data.is_nil(items[1]))) {
    return c.refuse(form, "expected a list of bindings");
  }
  const auto scope = c.code.scope().size();
  std::vector<LexicalBinding> bound;
  std::uint32_t count = 0;
  for (const auto binding : c.data.children(items[1])) {
    const auto parts = c.data.children(binding);
    const auto name = parts.empty() ? binding : parts.front();
    if (!c.data.is_symbol(name) || parts.size() > 2) {
      c.malformed(form, "a binding is a name or (name value)");
      continue;
    }
    if (parts.size() == 2) {
      c.compile(parts[1]);
    } else {
      c.nil(binding);
    }
    ++count;
    bound.push_back(variable(c, name, c.code.height() - 1));
    if (sequential) show_variable(c, bound.back(), form);
  }
  for (const auto& binding : bound) {
    if (!sequential) show_variable(c, binding, form);
  }
  c.compile_declared(items.subspan(2));
  close_variables(c, scope, count, form);
}

void form_let(FormCompiler& c, DatumId form, FormItems items) { let(c, form, items, false); }
void form_let_star(FormCompiler& c, DatumId form, FormItems items) { let(c, form, items, true); }

DatumId symbol_at(FormCompiler& c, std::string_view name, DatumId place) {
  return c.data.add_named(DatumKind::kSymbol, name, "", c.data.source(place));
}

DatumId list_at(FormCompiler& c, std::vector<DatumId> items, DatumId place) {
  return c.data.add_list(items, c.data.source(place));
}

/// Does the place name what a thing holds: a fluent, a table, an array or a structure?
bool is_cell_place(const FormCompiler& c, DatumId place) {
  struct Cell {
    std::string_view name;
    std::size_t least = 1, most = 1;  // operands
  };
  static constexpr Cell kCells[] = {
      {"value"}, {"gethash", 2, 3}, {"aref", 1, 100}, {"svref", 2, 2}, {"slot-value", 2, 2}};
  const auto items = c.data.children(place);
  const auto head = c.data.head(place).value_or("");
  if (head.empty()) return false;
  if (c.defined.accessors.contains(c.data.key(items[0]))) return items.size() == 2;
  const auto* cell = std::find_if(std::begin(kCells), std::end(kCells),
                                  [&](const Cell& known) { return known.name == head; });
  const auto operands = items.size() - 1;
  if (cell == std::end(kCells) || operands < cell->least || operands > cell->most) return false;
  return !c.defined.functions.contains(c.data.key(items[0]));
}

/// The operands of the place are computed before the value, which stays on the stack.
void set_cell(FormCompiler& c, DatumId form, DatumId place, DatumId value) {
  const auto items = c.data.children(place);
  const std::string head(*c.data.head(place));
  const bool table = head == "gethash";
  for (std::size_t i = 1; i < items.size(); ++i) {
    c.compile(items[i]);
    if (table && i > 2) c.code.drop(form);  // the default
  }
  const auto accessor = c.defined.accessors.find(c.data.key(items[0]));
  const bool slot = accessor != c.defined.accessors.end();
  // The type and the slot, as `type slot`.
  const auto names = slot ? accessor->second : std::string();
  const auto border = names.find(' ');
  if (slot) c.code.constant(c.values.symbol(names.substr(border + 1)), form);
  c.compile(value);
  if (slot) {
    c.code.constant(c.values.symbol(names.substr(0, border)), form);
    return c.code.builtin("%set-slot", 4, form);
  }
  if (head == "slot-value") return c.code.builtin("%set-slot", 3, form);
  if (table) return c.code.builtin("%set-hash", 3, form);
  if (head == "value") return c.code.builtin("%set-value", 2, form);
  c.code.builtin("%set-aref", static_cast<std::uint32_t>(items.size()), form);
}

/// Does the place name a part of a list or of a designator in a variable?
bool is_part(const FormCompiler& c, DatumId place) {
  // How many operands each has, and which of them is what it is a part of.
  struct PlacePart {
    std::string_view name;
    std::size_t least = 1, most = 1;
    std::size_t whole = 1;
  };
  static constexpr PlacePart kPlaceParts[] = {{"car"},
                                              {"cdr"},
                                              {"first"},
                                              {"rest"},
                                              {"second"},
                                              {"third"},
                                              {"fourth"},
                                              {"fifth"},
                                              {"cadr"},
                                              {"caddr"},
                                              {"cadddr"},
                                              {"last"},
                                              {"nth", 2, 2, 2},
                                              {"elt", 2, 2},
                                              {"getf", 2, 3},
                                              {"find", 2, 4, 2},
                                              {"assoc", 2, 2, 2},
                                              {"description"}};
  const auto head = c.data.head(place).value_or("");
  const auto* part = std::find_if(std::begin(kPlaceParts), std::end(kPlaceParts),
                                  [&](const PlacePart& known) { return known.name == head; });
  if (part == std::end(kPlaceParts)) return false;
  const auto items = c.data.children(place);
  const auto operands = items.size() - 1;
  if (operands < part->least || operands > part->most) return false;
  // A place is found by name, or in what another place has.
  const auto whole = items[part->whole];
  return c.data.is_symbol(whole) || is_cell_place(c, whole) || is_part(c, whole);
}

/// A new list takes the place of the one in the variable: lists are values here. Others that share
/// the old one do not see the change, which they would in Lisp. Our own macro of that name says in
/// which order the arguments are computed.
void change_part(FormCompiler& c, DatumId form, std::string_view macro,
                 std::vector<DatumId> arguments) {
  const auto place = arguments[0];
  if (!is_cell_place(c, place)) {
    c.code.code().gaps.push_back({"changes of shared lists", form, GapKind::kMeaning});
  }
  arguments.insert(arguments.begin(), symbol_at(c, macro, form));
  c.compile(list_at(c, std::move(arguments), form));
}

void form_setf(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() % 2 == 0) c.malformed(form, "expected pairs of a place and a value");
  if (items.size() < 3) return c.nil(form);
  for (std::size_t i = 1; i + 1 < items.size(); i += 2) {
    if (i > 1) {
      c.code.drop(form);
    }
    if (is_cell_place(c, items[i])) {
      set_cell(c, form, items[i], items[i + 1]);
      continue;
    }
    if (is_part(c, items[i])) {
      change_part(c, form, "%set-place", {items[i], items[i + 1]});
      continue;
    }
    c.compile(items[i + 1]);
    const auto* target = assignable(c, form, items[i]);
    if (target != nullptr) assign(c, *target, form);
  }
}

void form_incf(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || items.size() > 3) {
    return c.refuse(form, "expected a variable and perhaps a step");
  }
  if (is_part(c, items[1]) || is_cell_place(c, items[1])) {
    const auto one = c.data.add_number(Number(1), c.data.source(form));
    const auto step = items.size() == 3 ? items[2] : one;
    const auto sign = symbol_at(c, c.form_name(form) == "decf" ? "-" : "+", form);
    return change_part(c, form, "%change-place", {items[1], sign, step});
  }
  const auto* target = assignable(c, form, items[1]);
  if (target == nullptr) return c.nil(form);
  const LexicalBinding place = *target;  // compiling may grow the scope
  const std::string_view operation = c.form_name(form) == "decf" ? "-" : "+";
  if (items.size() == 3) {
    // The step is computed before the variable is read.
    const auto step = c.code.height();
    c.compile(items[2]);
    c.compile(items[1]);
    c.code.load(step, form);
    c.code.builtin(operation, 2, form);
    c.code.squeeze(1, form);
  } else {
    c.compile(items[1]);
    c.code.constant(c.values.number(Number(1)), form);
    c.code.builtin(operation, 2, form);
  }
  assign(c, place, form);
}

/// (push value variable), and (pushnew value variable), which adds a value that is not yet a member
/// by `eql`.
void form_push(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 3) {
    return c.refuse(form, "expected a value and a variable");
  }
  if (is_part(c, items[2]) || is_cell_place(c, items[2])) {
    const auto joins = symbol_at(c, c.form_name(form) == "push" ? "cons" : "adjoin", form);
    return change_part(c, form, "%push-place", {items[2], joins, items[1]});
  }
  c.compile(items[1]);
  const auto* target = assignable(c, form, items[2]);
  if (target == nullptr) return;
  const LexicalBinding place = *target;
  c.compile(items[2]);
  c.code.builtin(c.form_name(form) == "push" ? "cons" : "adjoin", 2, form);
  assign(c, place, form);
}

/// (pop variable) is the first element, which the variable loses.
void form_pop(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) return c.refuse(form, "expected a variable");
  if (is_part(c, items[1]) || is_cell_place(c, items[1])) {
    return change_part(c, form, "%pop-place", {items[1]});
  }
  const auto* target = assignable(c, form, items[1]);
  if (target == nullptr) return c.nil(form);
  const LexicalBinding place = *target;
  c.compile(items[1]);
  c.code.builtin("car", 1, form);
  c.compile(items[1]);
  c.code.builtin("cdr", 1, form);
  assign(c, place, form);
  c.code.drop(form);
}

void form_destructuring_bind(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3 || !c.data.is_list(items[1])) {
    return c.refuse(form, "expected a pattern and a list");
  }
  const auto scope = c.code.scope().size();
  const auto height = c.code.height();
  c.compile(items[2]);
  c.code.emit(PlanOp::kExpectList, 0, 0, form);
  destructure(c, form, items[1], height);
  c.compile_declared(items.subspan(3));
  close_variables(c, scope, c.code.height() - 1 - height, form);
}

}  // namespace

std::span<const FormEntry> binding_forms() {
  static constexpr FormEntry kForms[] = {
      {"let", form_let},   {"let*", form_let_star},
      {"setf", form_setf}, {"setq", form_setf},
      {"incf", form_incf}, {"decf", form_incf},
      {"push", form_push}, {"pushnew", form_push},
      {"pop", form_pop},   {"destructuring-bind", form_destructuring_bind},
  };
  return kForms;
}

}  // namespace parallax::compiler
