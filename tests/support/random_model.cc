#include "tests/support/random_model.h"

#include <algorithm>
#include <cctype>

#include "tests/support/random_formulas.h"
#include "tests/support/random_schema.h"

namespace parallax::test {
namespace {

class ModelMaker {
 public:
  ModelMaker(FuzzRandom& random, RandomSchema schema, bool large, bool aggregates)
      : random_(random),
        schema_(std::move(schema)),
        formulas_(random, schema_, aggregates),
        large_(large) {}

  std::vector<RandomStatement> make() {
    statements_ = schema_.statements;
    effects();
    start();
    const auto count = 1 + random_.below(large_ ? 4 : 3);
    for (std::size_t i = 0; i < count; ++i) axiom();
    definitions();
    trajectories();
    exclusion();
    completions();
    return std::move(statements_);
  }

  /// Must be called after the rest, so that models without them are the same.
  std::vector<RandomStatement> make_effect_constraints() {
    statements_.clear();
    const auto count = 1 + random_.below(3);
    for (std::size_t i = 0; i < count; ++i) effect_constraint();
    return std::move(statements_);
  }

  /// Must be called after the rest: an aggregate alone, or as a condition, or as a consequence.
  std::vector<RandomStatement> make_aggregates() {
    statements_.clear();
    const auto count = 1 + random_.below(2);
    for (std::size_t i = 0; i < count; ++i) {
      const auto quantifier = open(random_.chance(70));
      auto sum = formulas_.aggregate(1);
      const auto roll = random_.below(100);
      if (roll < 30) {
        sum = {"->", {std::move(sum), formulas_.occurrence()}};
      } else if (roll < 60) {
        sum = under_condition(std::move(sum), 50);
      } else if (roll < 75) {
        if (auto head = effect()) sum = {"->", {std::move(sum), *std::move(head)}};
      }
      state(closed(quantifier, std::move(sum)), 20);
    }
    return std::move(statements_);
  }

  /// Must be called after the rest. Two or three names with none to two arguments of one sort, not
  /// all with the same number.
  std::vector<RandomStatement> make_exclusion() {
    statements_.clear();
    std::vector<std::string> sorts;
    for (const auto& sort : schema_.plain) {
      if (schema_.elements.at(sort).size() <= 2) sorts.push_back(sort);
    }
    if (sorts.empty()) return {};
    const auto& sort = random_.pick(sorts);
    const bool events = random_.chance(70);
    std::vector<std::size_t> counts = {1 + random_.below(2), random_.below(3)};
    if (counts[0] == counts[1]) counts[1] = 3 - counts[0];
    if (random_.chance(30)) counts.push_back(random_.below(2));
    std::string names;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const auto name = "X" + std::to_string(i);
      std::string arguments;
      for (std::size_t k = 0; k < counts[i]; ++k) arguments += (k > 0 ? "," : "") + sort;
      declare((events ? "event " : "fluent ") + name + "(" + arguments + ")");
      names += (i > 0 ? ", " : "") + name;
    }
    declare((random_.chance(70) ? "mutex " : "xor ") + names);
    return std::move(statements_);
  }

 private:
  void declare(std::string text) { statements_.push_back({std::move(text), {}, {}}); }

  /// Most formulas have no label; those that are reasons for a completed predicate often do.
  void state(RandomFormula formula, std::size_t label_percent = 8) {
    std::string label;
    if (random_.chance(label_percent)) label = random_.chance(70) ? "Delta" : "Theta";
    statements_.push_back({{}, std::move(label), std::move(formula)});
  }

  /// New variables for a formula of its own: nearly always a timepoint, sometimes two.
  std::string open(bool timed) {
    auto& scope = formulas_.scope();
    formulas_.start();
    if (timed) formulas_.enter("time");
    if (timed && random_.chance(12)) formulas_.enter("time");
    while (random_.chance(40) && scope.size() < 4) formulas_.enter(formulas_.any_sort());
    std::sort(scope.begin(), scope.end());
    scope.erase(std::unique(scope.begin(), scope.end()), scope.end());
    std::string list;
    for (const auto& name : scope) list += (list.empty() ? "" : ",") + name;
    return list.empty() ? list : "[" + list + "]";
  }

  static RandomFormula closed(const std::string& quantifier, RandomFormula body) {
    if (quantifier.empty()) return body;
    return {quantifier, {std::move(body)}};
  }

  /// `condition -> head`, or the head alone.
  RandomFormula under_condition(RandomFormula head, std::size_t percent) {
    if (!random_.chance(percent)) return head;
    return {"->", {formulas_.formula(1), std::move(head)}};
  }

  std::string effect_time() {
    for (const auto& name : formulas_.scope()) {
      if (sort_of(name) == "time" && random_.chance(92)) return name;
    }
    return formulas_.time();
  }

  std::optional<RandomFormula> effect() {
    const auto event = formulas_.term("event", 3);
    if (!event) return std::nullopt;
    if (!schema_.releasable.empty() && random_.chance(35)) {
      const auto& name = random_.pick(schema_.releasable);
      for (const auto& fluent : schema_.fluents) {
        if (fluent.name != name) continue;
        const auto term = formulas_.apply(fluent, 3);
        if (!term) return std::nullopt;
        return RandomFormula{"Releases(" + *event + "," + *term + "," + effect_time() + ")", {}};
      }
    }
    const auto fluent = formulas_.term("fluent", 3);
    if (!fluent) return std::nullopt;
    const auto* name = random_.chance(55) ? "Initiates(" : "Terminates(";
    return RandomFormula{name + *event + "," + *fluent + "," + effect_time() + ")", {}};
  }

  void effects() {
    const auto count = random_.below(large_ ? 5 : 4);
    for (std::size_t i = 0; i < count; ++i) {
      const auto quantifier = open(random_.chance(96));
      auto head = effect();
      if (!head) continue;
      if (random_.chance(10)) {
        if (auto second = effect()) {
          head = RandomFormula{"&", {*std::move(head), *std::move(second)}};
        }
      }
      state(closed(quantifier, under_condition(*std::move(head), 55)), 5);
    }
  }

  /// Some fluents and events are stated outright.
  void start() {
    for (const auto& fluent : schema_.elements.at("fluent")) {
      const auto roll = random_.below(100);
      if (roll >= 45) continue;
      RandomFormula atom{"HoldsAt(" + fluent + ",0)", {}};
      state(roll < 25 ? RandomFormula{"!", {atom}} : atom);
    }
    for (const auto& event : schema_.elements.at("event")) {
      if (!random_.chance(30)) continue;
      const auto t =
          random_.below(static_cast<std::size_t>(schema_.horizon) + (random_.chance(5) ? 1 : 0));
      RandomFormula atom{"Happens(" + event + "," + std::to_string(t) + ")", {}};
      state(random_.chance(25) ? RandomFormula{"!", {atom}} : atom, 25);
    }
  }

  void axiom() {
    const auto roll = random_.below(100);
    if (roll < 22) return trigger();
    if (roll < 32) return disjunctive();
    if (roll < 40) return over_effects();
    const auto quantifier = open(random_.chance(85));
    auto body = formulas_.formula(large_ ? 3 : 2 + static_cast<int>(random_.below(2)));
    state(closed(quantifier, std::move(body)));
  }

  void trigger() {
    const auto quantifier = open(true);
    state(closed(quantifier, under_condition(formulas_.occurrence(), 85)), 25);
  }

  void disjunctive() {
    const auto quantifier = open(random_.chance(60));
    if (random_.chance(30) && !schema_.plain.empty()) {
      const auto before = formulas_.scope().size();
      const auto name = formulas_.enter(random_.pick(schema_.plain));
      RandomFormula some{"{" + name + "}", {formulas_.occurrence()}};
      formulas_.scope().resize(before);
      return state(closed(quantifier, under_condition(std::move(some), 50)), 25);
    }
    auto left = formulas_.occurrence();
    RandomFormula either{"|", {std::move(left), formulas_.occurrence()}};
    state(closed(quantifier, under_condition(std::move(either), 50)), 25);
  }

  /// Effects in a condition or in a definition, as the texts for causal constraints have them.
  void over_effects() {
    const auto quantifier = open(true);
    auto some = effect();
    if (!some) return;
    RandomFormula caused{"&", {formulas_.occurrence(), *std::move(some)}};
    auto other = formulas_.formula(1);
    if (random_.chance(50)) {
      state(closed(quantifier, {"->", {std::move(caused), std::move(other)}}));
    } else {
      RandomFormula inner{"{event}", {std::move(caused)}};
      state(closed(quantifier, {"<->", {std::move(other), std::move(inner)}}));
    }
  }

  /// An effect that another brings with it, or that there is only without another; or an occurrence
  /// for which an effect is the reason.
  void effect_constraint() {
    auto quantifier = open(true);
    auto& scope = formulas_.scope();
    if (random_.chance(60) && std::find(scope.begin(), scope.end(), "event") == scope.end()) {
      scope.emplace_back("event");
      quantifier = quantifier.substr(0, quantifier.size() - 1) + ",event]";
    }
    auto cause = effect();
    auto head = random_.chance(25) ? formulas_.occurrence() : effect();
    if (!cause || !head) return;
    const auto roll = random_.below(100);
    if (roll < 20) {
      cause = RandomFormula{"&", {*std::move(cause), formulas_.formula(1)}};
    } else if (roll < 40) {
      auto inner = quantified_effect();
      if (inner) cause = std::move(inner);
    } else if (roll < 50) {
      cause = RandomFormula{"!", {*std::move(cause)}};
    } else if (roll < 62) {
      static const std::vector<std::string> kConnectives = {"|", "->", "<->"};
      auto other = random_.chance(50) ? effect() : std::nullopt;
      if (!other) other = formulas_.formula(1);
      cause = RandomFormula{random_.pick(kConnectives), {*std::move(other), *std::move(cause)}};
    }
    state(closed(quantifier, {"->", {*std::move(cause), *std::move(head)}}), 5);
  }

  std::optional<RandomFormula> quantified_effect() {
    const auto before = formulas_.scope().size();
    const auto name = formulas_.enter(formulas_.any_sort());
    auto inner = effect();
    formulas_.scope().resize(before);
    if (!inner) return std::nullopt;
    if (random_.chance(15)) inner = RandomFormula{"!", {*std::move(inner)}};
    return RandomFormula{random_.chance(50) ? "[" + name + "]" : "{" + name + "}",
                         {*std::move(inner)}};
  }

  /// Noninertial fluents and predicates are often tied to something.
  void definitions() {
    for (const auto& fluent : schema_.fluents) {
      if (std::find(schema_.noninertial.begin(), schema_.noninertial.end(), fluent.name) ==
              schema_.noninertial.end() ||
          random_.chance(30)) {
        continue;
      }
      const auto quantifier = open(true);
      const auto term = formulas_.apply(fluent, 2);
      if (!term) continue;
      RandomFormula head{"HoldsAt(" + *term + "," + effect_time() + ")", {}};
      state(closed(quantifier, {"<->", {std::move(head), formulas_.formula(2)}}));
    }
    for (const auto& predicate : schema_.predicates) {
      if (!random_.chance(60)) continue;
      const auto quantifier = open(random_.chance(60));
      const auto head = formulas_.apply(predicate, 2);
      if (!head) continue;
      state(closed(quantifier, under_condition({*head, {}}, 80)), 30);
    }
  }

  void trajectories() {
    if (!schema_.offsets || !random_.chance(75)) return;
    const auto quantifier = open(true);
    auto& scope = formulas_.scope();
    const bool bound = std::find(scope.begin(), scope.end(), "offset") != scope.end();
    const auto variables =
        bound ? quantifier : quantifier.substr(0, quantifier.size() - 1) + ",offset]";
    if (!bound) scope.emplace_back("offset");
    auto from = formulas_.term("fluent", 3);
    auto to = formulas_.term("fluent", 3);
    if (!from || !to) return;
    if (const auto& all = schema_.elements.at("fluent"); !all.empty() && random_.chance(75)) {
      from = random_.pick(all);
      to = random_.pick(all);
      change("Initiates(", *from);
      change("Terminates(", *from);
    }
    const auto* name = random_.chance(60) ? "Trajectory(" : "AntiTrajectory(";
    const auto* offset = random_.chance(92) ? ",offset)" : ",offset+1)";
    RandomFormula head{name + *from + "," + effect_time() + "," + *to + offset, {}};
    state(closed(variables, under_condition(std::move(head), 50)));
  }

  /// Some event always changes this fluent: a trajectory needs one to begin and one to end it.
  void change(const std::string& effect, const std::string& fluent) {
    const auto& events = schema_.elements.at("event");
    if (events.empty()) return;
    const auto& event = random_.pick(events);
    state({"[time]", {{effect + event + "," + fluent + ",time)", {}}}}, 0);
  }

  void exclusion() {
    if (!random_.chance(15)) return;
    const auto& symbols = random_.chance(60) ? schema_.events : schema_.fluents;
    std::string names;
    for (const auto& symbol : symbols) names += (names.empty() ? "" : ", ") + symbol.name;
    declare((random_.chance(60) ? "mutex " : "xor ") + names);
  }

  void completions() {
    const auto label = [&] { return std::string(random_.chance(75) ? "" : "Delta "); };
    if (random_.chance(45)) declare("completion " + label() + "Happens");
    if (random_.chance(3)) declare("completion Theta Happens");
    if (random_.chance(4)) declare("completion " + label() + "HoldsAt");
    for (const auto& predicate : schema_.predicates) {
      if (random_.chance(40)) declare("completion " + label() + predicate.name);
    }
  }

  FuzzRandom& random_;
  const RandomSchema schema_;
  RandomFormulas formulas_;
  const bool large_;
  std::vector<RandomStatement> statements_;
};

}  // namespace

std::uint64_t FuzzRandom::next() {
  state_ += 0x9e3779b97f4a7c15ULL;
  auto z = state_;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

std::string RandomFormula::print() const {
  if (parts.empty()) return text;
  if (parts.size() == 1) return text + "(" + parts[0].print() + ")" + tail;
  return "(" + parts[0].print() + ") " + text + " (" + parts[1].print() + ")";
}

std::string RandomStatement::print() const {
  if (!formula) return text;
  auto printed = formula->print();
  // A line that starts with a small letter is a declaration.
  if (std::islower(static_cast<unsigned char>(printed[0])) != 0) printed = "(" + printed + ")";
  return (label.empty() ? "" : label + ": ") + printed + ".";
}

std::string RandomModel::print() const {
  std::string text = "; seed " + std::to_string(seed) + "\n";
  for (const auto& statement : statements) text += statement.print() + "\n";
  return text;
}

RandomModel random_model(std::uint64_t seed, const ModelSize& size,
                         const RandomAdditions& additions) {
  FuzzRandom random(seed);
  const bool large = size.most > kBruteForceSize.most;
  RandomModel model;
  model.seed = seed;
  for (;;) {
    auto schema = random_schema(random, large);
    model.atoms = schema.atoms();
    if (model.atoms < size.least || model.atoms > size.most) continue;
    ModelMaker maker(random, std::move(schema), large, additions.aggregates);
    model.statements = maker.make();
    const auto add = [&](std::vector<RandomStatement> more) {
      for (auto& statement : more) model.statements.push_back(std::move(statement));
    };
    if (additions.effect_constraints) add(maker.make_effect_constraints());
    if (additions.exclusions) add(maker.make_exclusion());
    if (additions.aggregates) add(maker.make_aggregates());
    return model;
  }
}

}  // namespace parallax::test
