#include "tests/support/interpreter/random_case.h"

#include <algorithm>
#include <random>

namespace parallax::test {
namespace {

class Generator {
 public:
  explicit Generator(std::uint64_t seed) : random_(seed) {}

  PlanCase make() {
    PlanCase out;
    model(out.model);
    out.horizon = 2 + below(4);
    out.by_turns = below(4) == 0;
    std::string text;
    text += "(defparameter *thing* 't1)\n";
    if (coin()) {
      text += std::string(coin() ? "(defun" : "(def-cram-function") + " helper (?x) " +
              statement(2, {"?x"}) + " " + act("?x") + ")\n";
      helpers_.push_back("helper");
    }
    if (coin()) {
      text += std::string(coin() ? "(defun" : "(def-cram-function") +
              " task (?x) (unwind-protect " + statement(2, {"?x"}) + " " + act("*thing*") + "))\n";
      helpers_.push_back("task");
    }
    text += "(def-cram-function main () " + statement(4, {}) + " " + statement(3, {}) + ")";
    out.plan = read_data(text);
    return out;
  }

 private:
  using Names = std::vector<std::string>;

  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
  bool coin() { return below(2) == 0; }
  template <typename T>
  const T& one_of(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(below(static_cast<int>(list.size())))];
  }

  RuleLiteral literal(const RuleModel& model, const std::string& thing) {
    if (thing.empty() || below(3) == 0) return {one_of(model.plain_fluents) + "()", coin()};
    return {one_of(model.thing_fluents) + "(" + thing + ")", coin()};
  }

  void rules_for(RuleModel& model, const std::string& event, const std::string& thing) {
    for (const auto& fluent : model.fluents()) {
      const bool own = !thing.empty() && fluent.find("(" + thing + ")") != std::string::npos;
      if (below(own ? 2 : 5) != 0) continue;
      // At most one way to change a fluent, or two whose conditions exclude each other.
      Rule rule{event, {}, {fluent, coin()}};
      for (int i = below(2); i-- > 0;) rule.condition.push_back(literal(model, one_of(things_)));
      model.rules.push_back(rule);
      if (rule.condition.size() == 1 && coin()) {
        rule.condition[0].value = !rule.condition[0].value;
        rule.effect.value = !rule.effect.value;
        model.rules.push_back(rule);
      }
    }
  }

  void model(RuleModel& model) {
    const int count = 2 + below(2);
    for (int i = 0; i < count; ++i) {
      things_.push_back("t" + std::to_string(i + 1));
      model.things.emplace_back(things_.back(), i == 1 && coin() ? "k2" : "k1");
    }
    model.things.back().second = coin() ? "k1" : "k2";
    for (const auto& [thing, kind] : model.things) kinds_.push_back(kind);
    model.thing_fluents = {"Lit"};
    if (coin()) model.thing_fluents.push_back("Held");
    model.plain_fluents = {"Open"};
    model.thing_events = {"Poke", "Take"};
    model.kind_events = {"Look"};
    model.plain_events = {"Wait"};
    for (const auto& thing : things_) {
      rules_for(model, "Poke(" + thing + ")", thing);
      rules_for(model, "Take(" + thing + ")", thing);
    }
    for (const auto& kind : {"k1", "k2"}) {
      if (std::find(kinds_.begin(), kinds_.end(), kind) != kinds_.end()) {
        rules_for(model, std::string("Look(") + kind + ")", "");
      }
    }
    rules_for(model, "Wait()", "");
    int open = 0;
    for (const auto& fluent : model.fluents()) {
      if (below(2) == 0 && open++ < 4) continue;
      model.start.push_back({fluent, coin()});
    }
    const Names classes = {"manipulation-goal-not-reached", "manipulation-pose-unreachable",
                           "gripper-goal-not-reached", "perception-object-not-found"};
    model.bindings = {
        {"poking", "Poke(?o)", {literal(model, "?o")}, below(2), false, one_of(classes)},
        {"taking", "Take(?o)", {literal(model, "?o")}, 1, false, one_of(classes)},
        {"looking",
         "Look(?k)",
         {literal(model, "?o")},
         below(2),
         true,
         "perception-object-not-found"},
        {"waiting", "Wait()", {literal(model, "")}, 1, false, "navigation-pose-unreachable"}};
    if (coin()) model.bindings[1].success.push_back(literal(model, "?o"));
    if (coin()) model.bindings[2].success.clear();
    model.goal = {literal(model, one_of(things_))};
    if (below(4) == 0) model.goal.push_back(literal(model, one_of(things_)));
    if (below(3) == 0) model.goal_event = coin() ? "Take(" + one_of(things_) + ")" : "Wait()";
  }

  std::string object(const Names& scope) {
    if (scope.empty() || below(3) == 0) return "(an object (name " + one_of(things_) + "))";
    const auto& name = one_of(scope);
    return coin() ? name : "(an object (name " + name + "))";
  }
  std::string act(const std::string& of) {
    return std::string("(perform (an action (type ") + (coin() ? "poking" : "taking") +
           ") (object " + of + ")))";
  }
  std::string look() {
    return "(perform (an action (type looking) (object (an object (type " + one_of(kinds_) +
           ")))))";
  }
  std::string perform(const Names& scope) {
    const int choice = below(8);
    if (choice == 0) return "(perform (an action (type waiting)))";
    if (choice == 2) return act("*thing*");
    return choice == 1 ? look() : act(object(scope));
  }
  std::string condition(int depth, const Names& scope) {
    switch (below(depth > 0 ? 8 : 3)) {
      case 0:
        return "(holds '(open))";
      case 1:
        return "(holds '(lit " + one_of(things_) + "))";
      case 2:
        return scope.empty() ? "(holds '(lit t1))" : "(holds (list 'lit " + one_of(scope) + "))";
      case 3:
        return "(not " + condition(depth - 1, scope) + ")";
      case 4:
        return "(and " + condition(depth - 1, scope) + " " + condition(depth - 1, scope) + ")";
      case 5:
        return "(or " + condition(depth - 1, scope) + " " + perform(scope) + ")";
      case 6:
        return perform(scope);
      default:
        return scope.empty() ? "(holds '(open))"
                             : "(eq " + one_of(scope) + " '" + one_of(things_) + ")";
    }
  }
  std::string failure_class() {
    const Names classes = {"plan-failure",
                           "low-level-failure",
                           "manipulation-low-level-failure",
                           "perception-low-level-failure",
                           "(or perception-object-not-found gripper-low-level-failure)",
                           "(or low-level-failure manipulation-low-level-failure)",
                           "simple-plan-failure",
                           "high-level-failure"};
    return one_of(classes);
  }
  std::string handler(int depth, const Names& scope, const std::string& counter) {
    const auto head = "(" + failure_class() + " (e) ";
    switch (below(7)) {
      case 0:
        return head + "(return))";
      case 1:
        return head + "(do-retry " + counter + " (retry)))";
      case 2:
        return head + "(do-retry " + counter + " " + statement(depth - 1, scope) +
               " (retry)) (return nil))";
      case 3:
        return head + "(fail 'object-unfetchable))";
      case 4:
        return head + statement(depth - 1, scope) + ")";
      case 5:
        return head + perform(scope) + " (retry))";
      default:
        return head + statement(depth - 1, scope) + " (return))";
    }
  }
  std::string handling(int depth, const Names& scope) {
    const auto counter = "tries" + std::to_string(++fresh_);
    auto out = "(with-retry-counters ((" + counter + " " + std::to_string(below(3)) +
               ")) (with-failure-handling (" + handler(depth, scope, counter);
    for (int more = below(3); more-- > 0;) out += " " + handler(depth, scope, counter);
    out += ") " + statement(depth - 1, scope) + " " + perform(scope);
    if (below(4) == 0) out += " (do-retry " + counter + " (retry))";
    return out + "))";
  }
  std::string with_variable(int depth, const Names& scope) {
    const auto name = "?v" + std::to_string(++fresh_);
    auto inner = scope;
    inner.push_back(name);
    auto out = "(let ((" + name + " " + look() + ")) " + statement(depth - 1, inner) + " " +
               statement(depth - 1, inner);
    if (below(3) == 0) out += " (setf " + name + " " + look() + ") " + act(name);
    return out + ")";
  }
  std::string looping(int depth, const Names& scope) {
    const auto name = "?v" + std::to_string(++fresh_);
    auto inner = scope;
    inner.push_back(name);
    switch (below(4)) {
      case 0:
        return "(dolist (" + name + " '(t1 t2)) " + statement(depth - 1, inner) + " " + act(name) +
               ")";
      case 1:
        return "(dotimes (?i 2) " + statement(depth - 1, scope) + ")";
      case 2:
        return std::string("(loop ") + (coin() ? "while " : "until ") + condition(0, scope) +
               " do " + perform(scope) + " " + statement(depth - 1, scope) + ")";
      default:
        return "(dolist (" + name + " '(t2 t1)) (when " + condition(1, inner) + " (return " + name +
               ")) " + perform(inner) + ")";
    }
  }
  std::string counting(int depth, const Names& scope) {
    const auto name = "?n" + std::to_string(++fresh_);
    return "(let ((" + name + " 0)) (with-failure-handling ((plan-failure (e) (incf " + name +
           ") " + (coin() ? "(when (< " + name + " 2) (retry)) " : "") + "(return))) " +
           statement(depth - 1, scope) + ") (if (= " + name + " 0) " + perform(scope) + " " +
           statement(depth - 1, scope) + "))";
  }
  std::string statement(int depth, const Names& scope) {
    if (depth <= 0) return perform(scope);
    const auto sub = [&] { return statement(depth - 1, scope); };
    switch (below(15)) {
      case 13:
        return "(let ((*thing* 't2)) " + sub() + " " + perform(scope) + ")";
      case 0:
        return "(progn " + sub() + " " + sub() + ")";
      case 1:
        return "(if " + condition(1, scope) + " " + sub() + " " + sub() + ")";
      case 2:
        return std::string(coin() ? "(when " : "(unless ") + condition(2, scope) + " " + sub() +
               ")";
      case 3:
      case 4:
        return handling(depth, scope);
      case 5:
        return with_variable(depth, scope);
      case 6:
        return looping(depth, scope);
      case 7:
        return "(unwind-protect " + sub() + " " + perform(scope) + ")";
      case 8:
        if (coin()) return "(try-in-order " + sub() + " " + sub() + ")";
        return std::string(below(3) > 0 ? "(par " : "(pursue ") + sub() + " " + sub() + ")";
      case 9:
        return "(block b " + sub() + " (when " + condition(1, scope) + " (return-from b)) " +
               sub() + ")";
      case 10:
        return counting(depth, scope);
      case 11:
        return "(cond (" + condition(1, scope) + " " + sub() + ") (t " + sub() + "))";
      case 12:
        if (!helpers_.empty()) {
          return "(" + one_of(helpers_) + " " + (scope.empty() ? "'t1" : one_of(scope)) + ")";
        }
        return perform(scope);
      default:
        return perform(scope);
    }
  }

  std::mt19937_64 random_;
  Names things_, kinds_;
  Names helpers_;  // functions written so far
  int fresh_ = 0;
};

/// Every way to make one list of the datum smaller by a step.
void smaller(const Datum& datum, const std::function<void(const Datum&)>& visit) {
  if (!datum.is_list()) return;
  for (std::size_t i = 0; i < datum.items.size(); ++i) {
    if (datum.items[i].is_list()) visit(datum.items[i]);
    auto without = datum;
    without.items.erase(without.items.begin() + static_cast<std::ptrdiff_t>(i));
    visit(without);
    smaller(datum.items[i], [&](const Datum& part) {
      auto changed = datum;
      changed.items[i] = part;
      visit(changed);
    });
  }
}

}  // namespace

std::string PlanCase::plan_text() const {
  std::string out;
  for (const auto& form : plan) out += print(form) + "\n";
  return out;
}

PlanCase random_plan_case(std::uint64_t seed) { return Generator(seed).make(); }

PlanCase shrunk(PlanCase found, const std::function<bool(const PlanCase&)>& fails) {
  for (bool progress = true; progress;) {
    progress = false;
    for (std::size_t i = found.model.rules.size(); i-- > 0;) {
      auto smaller_case = found;
      smaller_case.model.rules.erase(smaller_case.model.rules.begin() +
                                     static_cast<std::ptrdiff_t>(i));
      if (fails(smaller_case)) found = std::move(smaller_case), progress = true;
    }
    for (std::size_t i = found.plan.size(); i-- > 0;) {
      std::vector<Datum> candidates;
      smaller(found.plan[i], [&](const Datum& datum) { candidates.push_back(datum); });
      for (const auto& candidate : candidates) {
        auto smaller_case = found;
        smaller_case.plan[i] = candidate;
        if (!fails(smaller_case)) continue;
        found = std::move(smaller_case);
        progress = true;
        break;
      }
    }
  }
  return found;
}

}  // namespace parallax::test
