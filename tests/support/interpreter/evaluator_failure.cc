#include <exception>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/interpreter/evaluator.h"
#include "tests/support/interpreter/jumps.h"

namespace parallax::test {
namespace {

constexpr const char* kRetry = "%retry";

/// In front of the class of a Lisp error that has left a task.
constexpr std::string_view kEnveloped = "enveloped ";

const Datum& unquoted(const Datum& datum) {
  return datum.head() == "quote" ? datum.items[1] : datum;
}

}  // namespace

bool Evaluator::below(std::string failure, const std::string& ancestor) const {
  if (failure.starts_with(kEnveloped)) failure = "common-lisp-error-envelope";
  for (;;) {
    if (failure == ancestor) return true;
    const auto parent = parents_.find(failure);
    if (parent == parents_.end()) return false;
    failure = parent->second;
  }
}

namespace {

/// A clause for `(or a b)` stands for one with a and one with b.
std::vector<std::string> named_classes(const Datum& clause) {
  const auto& named = unquoted(clause.items[0]);
  if (!named.is_list()) return {named.text};
  std::vector<std::string> out;
  for (const auto& item : named.items) {
    if (!item.is("or")) out.push_back(unquoted(item).text);
  }
  return out;
}

}  // namespace

/// Clauses are functions named by their class: the last one with the name is called.
const Datum& Evaluator::clause_called(const std::vector<Datum>& clauses,
                                      const std::string& name) const {
  const Datum* out = nullptr;
  for (const auto& clause : clauses) {
    for (const auto& other : named_classes(clause)) {
      if (other == name) out = &clause;
    }
  }
  return *out;
}

/// Handlers are asked from the inside outwards, on top of the failed form.
void Evaluator::signal(const std::string& failure) {
  const auto active = handlers_;
  for (auto i = active.size(); i-- > 0;) {
    const auto& handler = active[i];
    handlers_.assign(active.begin(), active.begin() + static_cast<std::ptrdiff_t>(i));
    blocks_ = handler.blocks;
    if (handler.task) {
      const bool lisp = below(failure, "error") && !below(failure, "plan-failure");
      throw TaskFailed{handler.id, lisp ? std::string(kEnveloped) + failure : failure};
    }
    if (handler.clauses == nullptr) throw Leave{handler.id, symbol_item("%failed")};
    std::vector<std::pair<const Datum*, std::string>> called;  // and with what
    const bool enveloped = failure.starts_with(kEnveloped);
    const auto error = enveloped ? failure.substr(kEnveloped.size()) : "";
    for (const auto& [signalled, all] : {std::pair(error, false), std::pair(failure, true)}) {
      if (!all && !enveloped) continue;
      for (const auto& written : *handler.clauses) {
        for (const auto& name : named_classes(written)) {
          if (!all && !called.empty()) continue;
          if (!below(signalled, name)) continue;
          called.emplace_back(&clause_called(*handler.clauses, name), signalled);
        }
      }
    }
    for (const auto& [function, signalled] : called) {
      const auto& clause = *function;
      auto scope = std::make_shared<Scope>();
      scope->outer = handler.scope;
      scope->variables[kRetry] = number_item(handler.id);
      if (!clause.items[1].items.empty()) {
        PlanItem value = symbol_item(signalled);
        value.kind = PlanItem::Kind::kFailure;
        scope->variables[clause.items[1].items[0].text] = value;
      }
      body(clause.items, 2, scope);  // it declined if that returns: the next clause, then outwards
    }
  }
  throw Unhandled{failure.starts_with(kEnveloped) ? failure.substr(kEnveloped.size()) : failure};
}

PlanItem Evaluator::handling(const std::vector<Datum>& clauses, const Datum& form, std::size_t from,
                             const ScopePtr& scope) {
  return in_block("nil", [&] {
    const int id = ++next_id_;
    const auto outer = handlers_;
    const auto blocks = blocks_;
    for (;;) {
      handlers_ = outer;
      blocks_ = blocks;
      handlers_.push_back({&clauses, false, scope, id, blocks});
      try {
        auto inner = std::make_shared<Scope>();
        inner->outer = scope;
        inner->variables[kRetry] = number_item(id);
        return body(form.items, from, inner);
      } catch (const Again& again) {
        if (again.handling != id) throw;
      }
    }
  });
}

/// A form whose failure, of whatever class, is reported to the caller by the symbol %failed.
PlanItem Evaluator::attempt(const Datum& form, const ScopePtr& scope) {
  return in_block("%attempt", [&] {
    handlers_.push_back({nullptr, false, scope, blocks_.back().id, blocks_});
    return eval(form, scope);
  });
}

bool Evaluator::failures(const Datum& form, const ScopePtr& scope, PlanItem& out) {
  const auto head = form.head();
  const auto& items = form.items;
  if (head == "with-failure-handling") {
    out = handling(items[1].items, form, 2, scope);
  } else if (head == "retry") {
    throw Again{static_cast<int>(find(kRetry, scope)->number)};
  } else if (head == "fail") {
    std::string what = "simple-plan-failure";
    if (items.size() > 1 && items[1].kind != Datum::Kind::kString) {
      const auto value = eval(items[1], scope);
      what = value.text;
    }
    signal(what);
  } else if (head == "with-retry-counters") {
    auto inner = std::make_shared<Scope>();
    inner->outer = scope;
    for (const auto& counter : items[1].items) {
      inner->variables["%counter " + counter.items[0].text] = eval(counter.items[1], scope);
    }
    out = body(items, 2, inner);
  } else if (head == "do-retry") {
    auto* counter = find("%counter " + items[1].text, scope);
    if (counter->number > 0) {
      counter->number -= 1;
      out = body(items, 2, scope);
    }
  } else if (head == "get-counter") {
    out = *find("%counter " + items[1].text, scope);
  } else if (head == "unwind-protect") {
    out = cleaned_up(form, scope);
  } else if (head == "try-in-order") {
    out = in_block("nil", [&] {
      for (std::size_t i = 1; i < items.size(); ++i) {
        auto value = attempt(items[i], scope);
        if (value.text != "%failed") return value;
      }
      signal("composite-failure");
      return PlanItem();
    });
  } else {
    return false;
  }
  return true;
}

bool Evaluator::acting(const Datum& form, const ScopePtr& scope, PlanItem& out) {
  const auto head = form.head();
  if (head == "perform") {
    out = perform(eval(form.items[1], scope));
  } else if (head == "a" || head == "an") {
    out = designator(form, scope);
  } else if (head == "holds") {
    const auto fluent = eval(form.items[1], scope).items;
    wait_for_turn(true);
    out = true_item(world_.holds(fluent));
  } else {
    return false;
  }
  return true;
}

PlanItem Evaluator::designator(const Datum& form, const ScopePtr& scope) {
  PlanItem out;
  out.kind = PlanItem::Kind::kDesignator;
  out.text = form.items[1].text;
  for (std::size_t i = 2; i < form.items.size(); ++i) {
    const auto& key = form.items[i].items;
    if (form.items[i].head() == "when") {
      if (eval(key[1], scope).is_nil()) continue;
      out.keys.emplace_back(key[2].items[0].text, designator_value(key[2].items[1], scope));
    } else {
      out.keys.emplace_back(key[0].text, designator_value(key[1], scope));
    }
  }
  return out;
}

/// Symbols stand for themselves; variables, globals and designators are evaluated.
PlanItem Evaluator::designator_value(const Datum& datum, const ScopePtr& scope) {
  if (datum.is_list()) return eval(datum, scope);
  const bool symbol = datum.kind == Datum::Kind::kSymbol;
  // CRAM's macro takes the value that the global was defined with.
  if (symbol && datum.text.starts_with("*")) return globals_->variables.at(datum.text);
  const bool variable = symbol && datum.text.starts_with("?");
  if (variable || datum.kind != Datum::Kind::kSymbol) return eval(datum, scope);
  return symbol_item(datum.text);
}

PlanItem Evaluator::perform(const PlanItem& what) {
  wait_for_turn();
  if (time_ == horizon_) throw Stop{false};
  const auto outcome = world_.perform(what);
  ++time_;
  key_ += outcome.event;
  auto result = true_item(true);
  if (outcome.success && !outcome.returns.empty()) {
    result = symbol_item(outcome.returns[pick(outcome.returns.size())]);
    result.object = true;
    key_ += '=' + result.text;
  }
  key_ += ';';
  if (world_.hit()) throw Stop{true};
  if (!outcome.success) signal(outcome.failure_class);
  return result;
}

}  // namespace parallax::test
