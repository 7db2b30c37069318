#include <stdexcept>

#include "tests/support/interpreter/evaluator.h"
#include "tests/support/interpreter/jumps.h"

namespace parallax::test {
namespace {

PlanItem quoted(const Datum& datum) {
  if (datum.kind == Datum::Kind::kNumber) return number_item(datum.number);
  if (datum.kind == Datum::Kind::kSymbol) {
    if (datum.is("nil")) return {};
    auto out = datum.is("t") ? true_item(true) : symbol_item(datum.text);
    out.keyword = datum.keyword;
    return out;
  }
  PlanItem out;
  if (datum.kind == Datum::Kind::kString) {
    out.kind = PlanItem::Kind::kString;
    out.text = datum.text;
    return out;
  }
  if (datum.items.empty()) return out;
  out.kind = PlanItem::Kind::kList;
  for (const auto& item : datum.items) out.items.push_back(quoted(item));
  return out;
}

bool has_no_effect(const std::string& head) {
  return head == "ros-info" || head == "ros-warn" || head == "ros-error" || head == "format" ||
         head == "sleep" || head == "declare" || head == "on-event";
}

}  // namespace

bool Evaluator::control(const Datum& form, const ScopePtr& scope, PlanItem& out) {
  const auto head = form.head();
  const auto& items = form.items;
  if (head == "quote") {
    out = quoted(items[1]);
  } else if (has_no_effect(head)) {
    out = {};
  } else if (head == "progn" || head == "seq" || head == "top-level") {
    out = body(items, 1, scope);
  } else if ((head == "par" || head == "pursue") && by_turns_ && items.size() > 2) {
    out = taking_turns(form, scope, head == "pursue");
  } else if (head == "pursue") {
    out = in_task([&] { return eval(items[1], scope); });  // it ends before another begins
  } else if (head == "par") {
    for (std::size_t i = 1; i < items.size(); ++i) {
      auto value = in_task([&] { return eval(items[i], scope); });
      if (i == 1) out = std::move(value);
    }
  } else if (head == "print") {
    out = eval(items[1], scope);
  } else if (head == "if") {
    if (!eval(items[1], scope).is_nil()) {
      out = eval(items[2], scope);
    } else if (items.size() > 3) {
      out = eval(items[3], scope);
    }
  } else if (head == "when" || head == "unless") {
    if (eval(items[1], scope).is_nil() == (head == "unless")) out = body(items, 2, scope);
  } else if (head == "cond") {
    for (std::size_t i = 1; i < items.size(); ++i) {
      out = eval(items[i].items[0], scope);
      if (out.is_nil()) continue;
      if (items[i].items.size() > 1) out = body(items[i].items, 1, scope);
      break;
    }
  } else if (head == "and" || head == "or") {
    out = true_item(head == "and");
    for (std::size_t i = 1; i < items.size(); ++i) {
      out = eval(items[i], scope);
      if (out.is_nil() == (head == "and")) break;
    }
  } else if (head == "case" || head == "ecase") {
    const auto key = eval(items[1], scope);
    for (std::size_t i = 2; i < items.size(); ++i) {
      const auto& clause = items[i].items;
      const auto test = quoted(clause[0]);
      bool chosen = clause[0].is("t") || clause[0].is("otherwise") || test == key;
      for (const auto& item : test.items) chosen = chosen || item == key;
      if (!chosen) continue;
      out = body(clause, 1, scope);
      return true;
    }
    if (head == "ecase") signal("case-failure");
  } else if (head == "block") {
    out = in_block(items[1].text, [&] { return body(items, 2, scope); });
  } else if (head == "return" || head == "return-from") {
    const auto name = head == "return" ? std::string("nil") : items[1].text;
    const std::size_t at = head == "return" ? 1 : 2;
    const auto value = items.size() > at ? eval(items[at], scope) : PlanItem();
    for (auto i = blocks_.size(); i-- > 0;) {
      if (blocks_[i].name == name) throw Leave{blocks_[i].id, value};
    }
    throw std::runtime_error("no block " + name);
  } else {
    return false;
  }
  return true;
}

bool Evaluator::loops(const Datum& form, const ScopePtr& scope, PlanItem& out) {
  const auto head = form.head();
  const auto& items = form.items;
  if (head == "loop") {
    out = in_block("nil", [&] { return loop_form(form, scope); });
    return true;
  }
  if (head != "dolist" && head != "dotimes") return false;
  out = in_block("nil", [&] {
    auto over = eval(items[1].items[1], scope);
    if (head == "dotimes") {
      const auto count = over.number;
      over = {};
      for (double i = 0; i < count; ++i) over.items.push_back(number_item(i));
    }
    for (const auto& item : over.items) {
      auto inner = std::make_shared<Scope>();
      inner->outer = scope;
      inner->variables[items[1].items[0].text] = item;
      body(items, 2, inner);
    }
    return items[1].items.size() > 2 ? eval(items[1].items[2], scope) : PlanItem();
  });
  return true;
}

/// One clause of `while`, `until`, `repeat` or `for v in list`, and then `do`.
PlanItem Evaluator::loop_form(const Datum& form, const ScopePtr& scope) {
  const auto& items = form.items;
  auto inner = std::make_shared<Scope>();
  inner->outer = scope;
  std::size_t at = 1;
  const Datum* test = nullptr;
  bool until = false;
  std::vector<PlanItem> elements;
  const Datum* variable = nullptr;
  double count = -1.0;
  if (items[at].is("while") || items[at].is("until")) {
    until = items[at].is("until");
    test = &items[at + 1];
    at += 2;
  } else if (items[at].is("repeat")) {
    count = eval(items[at + 1], scope).number;
    at += 2;
  } else if (items[at].is("for")) {
    variable = &items[at + 1];
    elements = eval(items[at + 3], scope).items;
    count = static_cast<double>(elements.size());
    at += 4;
  }
  if (items[at].is("do")) ++at;
  for (double turn = 0.0; count < 0.0 || turn < count; ++turn) {
    if (test != nullptr && eval(*test, inner).is_nil() != until) break;
    if (variable != nullptr) {
      inner->variables[variable->text] = elements[static_cast<std::size_t>(turn)];
    }
    body(items, at, inner);
    if (turn > 10'000) throw std::runtime_error("a loop that performs nothing");
  }
  return {};
}

PlanItem Evaluator::builtin(const std::string& name, const std::vector<PlanItem>& arguments) {
  const auto& a = arguments;
  if (name == "list") {
    PlanItem out;
    if (!a.empty()) out.kind = PlanItem::Kind::kList;
    out.items = a;
    return out;
  }
  if (name == "not" || name == "null") return true_item(a.at(0).is_nil());
  if (name == "eq" || name == "eql" || name == "equal") {
    const bool object = a.at(0).object || a.at(1).object;
    return true_item(object ? a[0].text == a[1].text : a[0] == a[1]);
  }
  if (name == "=") return true_item(a.at(0).number == a.at(1).number);
  if (name == "<") return true_item(a.at(0).number < a.at(1).number);
  if (name == ">") return true_item(a.at(0).number > a.at(1).number);
  if (name == "+") return number_item(a.at(0).number + a.at(1).number);
  if (name == "-") return number_item(a.at(0).number - a.at(1).number);
  if (name == "first" || name == "car") return a.at(0).is_nil() ? PlanItem() : a[0].items[0];
  if (name == "rest" || name == "cdr") {
    PlanItem out = a.at(0);
    if (!out.items.empty()) out.items.erase(out.items.begin());
    return out.items.empty() ? PlanItem() : out;
  }
  if (name == "second") return a.at(0).items.at(1);
  if (name == "length") return number_item(static_cast<double>(a.at(0).items.size()));
  if (name == "member") {
    for (std::size_t i = 0; i < a.at(1).items.size(); ++i) {
      if (a[1].items[i] == a[0]) return true_item(true);
    }
    return {};
  }
  if (name == "next-solution") return {};
  if (name == "make-pose-stamped") return a.at(2);  // where it is; its heading does not matter here
  if (name == "make-3d-vector") return builtin("list", a);
  if (name == "make-identity-rotation" || name == "make-quaternion") return {};
  throw std::runtime_error("the interpreter knows no function " + name);
}

}  // namespace parallax::test
