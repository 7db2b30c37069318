#include "tests/support/interpreter/evaluator.h"

#include <stdexcept>
#include <utility>

#include "tests/support/interpreter/jumps.h"

namespace parallax::test {
namespace {

struct ClassAndParent {
  const char* name;
  const char* parent;
};
constexpr ClassAndParent kClasses[] = {
    {"simple-plan-failure", "plan-failure"},
    {"common-lisp-error-envelope", "plan-failure"},
    {"composite-failure", "plan-failure"},
    {"low-level-failure", "simple-plan-failure"},
    {"high-level-failure", "simple-plan-failure"},
    {"case-failure", "error"},
    {"navigation-low-level-failure", "low-level-failure"},
    {"navigation-pose-unreachable", "navigation-low-level-failure"},
    {"manipulation-low-level-failure", "low-level-failure"},
    {"manipulation-goal-not-reached", "manipulation-low-level-failure"},
    {"manipulation-pose-unreachable", "manipulation-low-level-failure"},
    {"gripper-low-level-failure", "low-level-failure"},
    {"gripper-goal-not-reached", "gripper-low-level-failure"},
    {"perception-low-level-failure", "low-level-failure"},
    {"perception-object-not-found", "perception-low-level-failure"},
    {"ptu-low-level-failure", "low-level-failure"},
    {"ptu-goal-unreachable", "ptu-low-level-failure"},
    {"object-unfetchable", "high-level-failure"},
    {"object-undeliverable", "high-level-failure"},
    {"object-nowhere-to-be-found", "high-level-failure"},
};

bool is_definition(const std::string& head) {
  return head == "defun" || head == "def-cram-function" || head == "def-top-level-cram-function";
}

}  // namespace

Evaluator::Evaluator(const std::vector<Datum>& program, World& world, int horizon,
                     std::vector<Pick> picks, bool by_turns)
    : world_(world),
      horizon_(horizon),
      picks_(std::move(picks)),
      globals_(std::make_shared<Scope>()),
      by_turns_(by_turns) {
  for (const auto& entry : kClasses) parents_[entry.name] = entry.parent;
  const Datum* last = nullptr;
  for (const auto& form : program) {
    const auto head = form.head();
    if (is_definition(head)) {
      functions_[form.items[1].text] = &form;
      last = &form;
    } else if (head == "defparameter" || head == "defvar" || head == "defconstant") {
      globals_->variables[form.items[1].text] = eval(form.items[2], globals_);
    } else if (head == "define-condition") {
      parents_[form.items[1].text] = form.items[2].items[0].text;
    } else if (head != "in-package") {
      main_.push_back(&form);
    }
  }
  if (main_.empty() && last != nullptr) main_.push_back(last);
}

Ending Evaluator::run() {
  try {
    for (const auto* form : main_) {
      if (is_definition(form->head())) {
        Datum invocation;
        invocation.items.push_back(form->items[1]);
        call(invocation, globals_);
      } else {
        eval(*form, globals_);
      }
    }
    return ended({Ending::Kind::kDone, {}});
  } catch (const Unhandled& failure) {
    return ended({Ending::Kind::kFailed, failure.what});
  } catch (const Stop& stop) {
    return stop.hit ? Ending{Ending::Kind::kHit, key_} : Ending{Ending::Kind::kBeyond, {}};
  }
}

std::size_t Evaluator::pick(std::size_t choices) {
  if (next_pick_ == picks_.size()) picks_.push_back({0, choices});
  return picks_[next_pick_++].chosen;
}

/// A trace has at least one step: a plan that performs nothing waits for one, and the constraint
/// may hold then.
Ending Evaluator::ended(Ending ending) const {
  const bool waits = time_ == 0 && horizon_ > 0 && world_.hit();
  return waits ? Ending{Ending::Kind::kHit, ";"} : ending;
}

PlanItem Evaluator::eval(const Datum& form, const ScopePtr& scope) {
  if (++steps_ > 200'000) throw std::runtime_error("the plan goes on without performing");
  switch (form.kind) {
    case Datum::Kind::kNumber:
      return number_item(form.number);
    case Datum::Kind::kString: {
      PlanItem out = symbol_item(form.text);
      out.kind = PlanItem::Kind::kString;
      return out;
    }
    case Datum::Kind::kSymbol: {
      if (form.is("nil")) return {};
      if (form.is("t")) return true_item(true);
      if (form.keyword) {
        auto out = symbol_item(form.text);
        out.keyword = true;
        return out;
      }
      if (const auto* value = find(form.text, scope)) return *value;
      return symbol_item(form.text);  // a keyword; a misspelt variable would show in the events
    }
    case Datum::Kind::kList:
      return form.items.empty() ? PlanItem() : list_form(form, scope);
  }
  return {};
}

PlanItem Evaluator::body(const std::vector<Datum>& forms, std::size_t from, const ScopePtr& scope) {
  PlanItem out;
  for (std::size_t i = from; i < forms.size(); ++i) {
    if (forms[i].kind == Datum::Kind::kString && i + 1 < forms.size()) continue;  // a docstring
    out = eval(forms[i], scope);
  }
  return out;
}

PlanItem Evaluator::list_form(const Datum& form, const ScopePtr& scope) {
  PlanItem out;
  if (control(form, scope, out) || binding(form, scope, out) || loops(form, scope, out) ||
      failures(form, scope, out) || acting(form, scope, out)) {
    return out;
  }
  return call(form, scope);
}

PlanItem* Evaluator::find(const std::string& name, const ScopePtr& scope) {
  for (auto at = scope; at; at = at->outer) {
    const auto found = at->variables.find(name);
    if (found != at->variables.end()) return &found->second;
  }
  for (auto i = specials_.size(); i-- > task_specials_;) {
    if (specials_[i].first == name) return &specials_[i].second;
  }
  const auto global = globals_->variables.find(name);
  return global == globals_->variables.end() ? nullptr : &global->second;
}

void Evaluator::set(const Datum& place, PlanItem value, const ScopePtr& scope) {
  auto* variable = find(place.text, scope);
  if (variable == nullptr) throw std::runtime_error("setf of no variable: " + place.text);
  *variable = std::move(value);
}

bool Evaluator::binding(const Datum& form, const ScopePtr& scope, PlanItem& out) {
  const auto head = form.head();
  const auto& items = form.items;
  if (head == "let" || head == "let*") {
    auto inner = std::make_shared<Scope>();
    inner->outer = scope;
    std::vector<std::pair<std::string, PlanItem>> specials;
    for (const auto& entry : items[1].items) {
      const bool bare = !entry.is_list();
      const auto value = bare || entry.items.size() < 2
                             ? PlanItem()
                             : eval(entry.items[1], head == "let*" ? inner : scope);
      const auto& name = bare ? entry.text : entry.items[0].text;
      if (globals_->variables.contains(name)) {
        specials.emplace_back(name, value);
      } else {
        inner->variables[name] = value;
      }
    }
    out = rebinding([&] {
      specials_.insert(specials_.end(), specials.begin(), specials.end());
      return body(items, 2, inner);
    });
  } else if (head == "destructuring-bind") {
    auto inner = std::make_shared<Scope>();
    inner->outer = scope;
    const auto values = eval(items[2], scope).items;
    for (std::size_t i = 0; i < items[1].items.size(); ++i) {
      inner->variables[items[1].items[i].text] = values.at(i);
    }
    out = body(items, 3, inner);
  } else if (head == "setf" || head == "setq") {
    for (std::size_t i = 1; i + 1 < items.size(); i += 2) {
      out = eval(items[i + 1], scope);
      set(items[i], out, scope);
    }
  } else if (head == "incf" || head == "decf") {
    const double by = items.size() > 2 ? eval(items[2], scope).number : 1.0;
    out = number_item(eval(items[1], scope).number + (head == "incf" ? by : -by));
    set(items[1], out, scope);
  } else if (head == "push") {
    auto list = eval(items[2], scope);
    list.kind = PlanItem::Kind::kList;
    list.items.insert(list.items.begin(), eval(items[1], scope));
    set(items[2], list, scope);
    out = list;
  } else if (head == "flet" || head == "labels") {
    auto inner = std::make_shared<Scope>();
    inner->outer = scope;
    for (const auto& function : items[1].items)
      inner->functions[function.items[0].text] = &function;
    inner->functions_scope = head == "labels" ? inner : scope;
    out = body(items, 2, inner);
    inner->functions_scope.reset();  // `labels` would keep itself alive
  } else {
    return false;
  }
  return true;
}

PlanItem Evaluator::in_block(const std::string& name, const std::function<PlanItem()>& run) {
  const int id = ++next_id_;
  blocks_.push_back({name, id});
  const auto depth = blocks_.size();
  const auto handlers = handlers_;
  const auto leave = [&] {
    blocks_.resize(depth - 1);
    handlers_ = handlers;
  };
  try {
    auto out = run();
    leave();
    return out;
  } catch (const Leave& jump) {
    leave();
    if (jump.block != id) throw;
    return jump.value;
  } catch (...) {
    leave();
    throw;
  }
}

/// Evaluates `run`, and undoes its rebindings of specials on every way out.
PlanItem Evaluator::rebinding(const std::function<PlanItem()>& run) {
  const auto depth = specials_.size();
  try {
    auto out = run();
    specials_.resize(depth);
    return out;
  } catch (...) {
    specials_.resize(depth);
    throw;
  }
}

/// A task of its own: it sees no block and no rebound special around it, and a failure that nobody
/// in it handles ends it, with its clean-ups, before it is signalled outside.
PlanItem Evaluator::in_task(const std::function<PlanItem()>& run) {
  const int id = ++next_id_;
  const auto handlers = handlers_;
  const auto blocks = std::exchange(blocks_, {});
  const auto specials = std::exchange(task_specials_, specials_.size());
  const auto leave = [&] {
    handlers_ = handlers;
    blocks_ = blocks;
    task_specials_ = specials;
  };
  Handler border;
  border.task = true;
  border.id = id;
  handlers_.push_back(border);
  std::string failure;
  try {
    auto out = rebinding(run);
    leave();
    return out;
  } catch (const TaskFailed& failed) {
    leave();
    if (failed.task != id) throw;
    failure = failed.what;
  } catch (...) {
    leave();
    throw;
  }
  signal(failure);
}

PlanItem Evaluator::apply(const std::vector<Datum>& parameters, const std::vector<Datum>& forms,
                          std::size_t from, const std::vector<PlanItem>& arguments,
                          const ScopePtr& outer, const std::string& name) {
  auto scope = std::make_shared<Scope>();
  scope->outer = outer;
  std::size_t next = 0;
  std::string mode;
  for (const auto& parameter : parameters) {
    if (parameter.text.starts_with("&")) {
      mode = parameter.text;
      continue;
    }
    const auto& variable = parameter.is_list() ? parameter.items[0].text : parameter.text;
    PlanItem value;
    bool given = false;
    if (mode == "&key") {
      for (std::size_t i = next; i + 1 < arguments.size(); i += 2) {
        const auto plain = variable.starts_with("?") ? variable.substr(1) : variable;
        if (given || (arguments[i].text != variable && arguments[i].text != plain)) continue;
        value = arguments[i + 1];
        given = true;
      }
    } else if (next < arguments.size()) {
      value = arguments[next++];
      given = true;
    }
    if (!given && parameter.is_list() && parameter.items.size() > 1) {
      value = eval(parameter.items[1], globals_);
    }
    scope->variables[variable] = value;
  }
  const auto blocks = std::exchange(blocks_, {});  // blocks are lexical
  const auto restore = [&] { blocks_ = blocks; };
  try {
    auto out = in_block(name, [&] { return body(forms, from, scope); });
    restore();
    return out;
  } catch (...) {
    restore();
    throw;
  }
}

PlanItem Evaluator::call(const Datum& form, const ScopePtr& scope) {
  const auto name = form.head();
  std::vector<PlanItem> arguments;
  for (std::size_t i = 1; i < form.items.size(); ++i) {
    arguments.push_back(eval(form.items[i], scope));
  }
  for (auto at = scope; at; at = at->outer) {
    const auto found = at->functions.find(name);
    if (found == at->functions.end()) continue;
    const auto& items = found->second->items;
    return apply(items[1].items, items, 2, arguments, at->functions_scope, name);
  }
  const auto found = functions_.find(name);
  if (found == functions_.end()) return builtin(name, arguments);
  const auto& items = found->second->items;
  const auto run = [&] { return apply(items[2].items, items, 3, arguments, nullptr, name); };
  return items[0].is("defun") ? run() : in_task(run);
}

}  // namespace parallax::test
