#include "tests/runtime/induction/step_worlds.h"

#include <algorithm>
#include <set>

#include "compiler/reference/reference_evaluator.h"
#include "compiler/sema/check.h"
#include "compiler/syntax/loader.h"

namespace parallax::test {
namespace {

using Place = StepLiteral::Place;

/// A text, checked, and the evaluator of it.
struct Evaluated {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::optional<compiler::TypedModel> typed;
  std::optional<compiler::ReferenceEvaluator> evaluator;

  explicit Evaluated(const std::string& text) {
    const auto file = files.add("step.e", text);
    const auto ast = compiler::load_model_text(file, ".", {}, files, sink);
    if (!ast) return;
    auto checked = compiler::check_model(*ast, files, sink);
    if (!checked) return;
    typed.emplace(*std::move(checked));
    evaluator.emplace(*typed);
  }
};

}  // namespace

StepWorld::StepWorld(std::uint64_t seed) : random_(seed) {
  fluents_ = 2 + random_.below(2);
  events_ = 1 + random_.below(2);
  releases_ = random_.chance(25);
  completed_ = random_.chance(40);
  predicate_ = random_.chance(30);
  noninertial_ = random_.chance(20);
  const auto count = 3 + random_.below(5);
  for (std::size_t i = 0; i < count; ++i) rule();
  for (std::size_t f = 0; f < fluents_; ++f) {
    if (!random_.chance(80)) continue;
    facts_.push_back(
        {0, false,
         (random_.chance(70) ? "!" : "") + std::string("HoldsAt(F") + std::to_string(f) + "(),"});
  }
  for (int t = 0; t < 3; ++t) {
    if (random_.chance(15)) facts_.push_back({t, false, literal("")});
    if (random_.chance(completed_ ? 40 : 10)) facts_.push_back({t, true, event_literal("")});
  }
  make_property();
}

/// Without a time: up to the place where it stands.
std::string StepWorld::literal(const char* time) {
  auto out = (random_.chance(50) ? "!" : "") + std::string("HoldsAt(F") +
             std::to_string(random_.below(fluents_)) + "(),";
  return *time == 0 ? out : out + time + ")";
}

std::string StepWorld::event_literal(const char* time) {
  auto out = (random_.chance(20) ? "!" : "") + std::string("Happens(E") +
             std::to_string(random_.below(events_)) + "(),";
  return *time == 0 ? out : out + time + ")";
}

std::string StepWorld::condition() {
  auto out = literal("time");
  if (random_.chance(40)) out += (random_.chance(70) ? " & " : " | ") + literal("time");
  if (random_.chance(15)) out += " & " + event_literal("time");
  if (predicate_ && random_.chance(30))
    out += std::string(" & ") + (random_.chance(50) ? "!" : "") + "Q()";
  return out;
}

void StepWorld::rule() {
  const auto event = "E" + std::to_string(random_.below(events_)) + "()";
  const auto fluent = "F" + std::to_string(random_.below(fluents_)) + "()";
  const auto roll = random_.below(100);
  std::string head;
  if (roll < 60) {
    const bool releases = releases_ && random_.chance(25);
    head = (releases             ? "Releases("
            : random_.chance(55) ? "Initiates("
                                 : "Terminates(") +
           event + "," + fluent + ",time)";
    if (random_.chance(55)) head = condition() + " -> " + head;
  } else if (roll < 70) {
    head = "Happens(" + event + ",time) -> " + condition();
  } else if (roll < 78) {
    head = condition() + " -> Happens(" + event + ",time)";
  } else if (roll < 86) {
    head = literal("time") + " | " + literal("time");
  } else if (roll < 90) {
    head = literal("time") + " & " + literal("time") + " -> " + literal("time+1");
  } else if (roll < 94) {
    head = literal("time-1") + " -> " + literal("time") + " | " + literal("time");
  } else if (roll < 97) {
    head = "Happens(E0(),time) & Happens(" + event + ",time) -> " + literal("time+1");
  } else {
    head = "HoldsAt(F0(),time) <-> !HoldsAt(F1(),time)";
  }
  rules_.push_back("[time] " + head + ".\n");
}

void StepWorld::make_property() {
  const auto roll = random_.below(100);
  always_ = roll >= 60;
  const auto add = [&](Place place, std::size_t of, std::size_t percent) {
    for (std::size_t i = 0; i < of; ++i) {
      if (random_.chance(percent)) broken_.push_back({place, i, random_.chance(60)});
    }
  };
  if (roll < 40) {
    add(Place::kAfter, fluents_, 60);
    if (broken_.empty()) broken_.push_back({Place::kAfter, 0, true});
    return;
  }
  add(Place::kBefore, fluents_, 40);
  // Nothing happens at the end: the property must not ask for an event.
  broken_.push_back({Place::kEvent, random_.below(events_), true});
  if (!always_) add(Place::kAfter, fluents_, 50);
}

bool StepWorld::about_one_state() const {
  return std::all_of(broken_.begin(), broken_.end(),
                     [](const StepLiteral& one) { return one.place == Place::kAfter; });
}

std::string StepWorld::property() const {
  const char* before = always_ ? "time" : "time-1";
  std::string out;
  for (const auto& one : broken_) {
    out += out.empty() ? "" : " & ";
    if (!one.positive) out += '!';
    out += one.place == Place::kEvent ? "Happens(E" : "HoldsAt(F";
    out +=
        std::to_string(one.number) + "()," + (one.place == Place::kAfter ? "time" : before) + ")";
  }
  return (always_ ? "always !(" : "!(") + out + ")";
}

std::string StepWorld::declarations() const {
  std::string out;
  for (std::size_t f = 0; f < fluents_; ++f) out += "fluent F" + std::to_string(f) + "()\n";
  for (std::size_t e = 0; e < events_; ++e) out += "event E" + std::to_string(e) + "()\n";
  if (predicate_) out += "predicate Q()\n";
  if (noninertial_) out += "noninertial F1\n";
  for (const auto& text : rules_) out += text;
  if (completed_) out += "completion Happens\n";
  return out;
}

std::string StepWorld::facts(int first, int last, int shift) const {
  std::string out;
  for (const auto& fact : facts_) {
    if (fact.time < first || fact.time > last || (fact.event && fact.time == last && first != last))
      continue;
    out += fact.atom + std::to_string(fact.time - shift) + ").\n";
  }
  return out;
}

std::string StepWorld::text(int horizon) const {
  return "range time 0 " + std::to_string(horizon) + "\n" + declarations() + facts(0, horizon, 0);
}

std::vector<StepWorld::State> StepWorld::starts(const std::string& given,
                                                std::string& error) const {
  std::vector<State> out;
  std::string facts_of_states;
  for (const auto& fact : facts_) {
    if (fact.time == 0 && !fact.event) facts_of_states += fact.atom + "0).\n";
  }
  const Evaluated at("range time 0 0\n" + declarations() + given + facts_of_states);
  if (!at.evaluator) {
    error = "start";
    return out;
  }
  const auto& expanded = at.evaluator->expanded();
  std::vector<std::uint8_t> values(expanded.atom_count(), 0);
  const auto every = 1U << fluents_;
  if (const auto q = expanded.predicate("Q()")) values[*q] = given == "Q().\n" ? 1 : 0;
  for (std::uint32_t bits = 0; bits < every * every; ++bits) {
    const State state{bits % every, bits / every};
    for (std::uint32_t f = 0; f < fluents_; ++f) {
      values[expanded.holds(f, 0)] = (state.holds >> f) & 1U;
      values[expanded.released(f, 0)] = (state.released >> f) & 1U;
    }
    if (at.evaluator->accepts(values)) out.push_back(state);
  }
  return out;
}

std::vector<StepWorld::Step> StepWorld::steps(const std::string& given, int t,
                                              std::string& error) const {
  std::vector<Step> out;
  // Releases are open at the beginning of a step, and only those of these fluents.
  std::string text = "range time 0 1\n" + declarations() + given + facts(t, t, t);
  for (std::size_t f = 0; f < fluents_; ++f) text += "manualrelease F" + std::to_string(f) + "\n";
  const Evaluated at(text);
  if (!at.evaluator) {
    error = "step";
    return out;
  }
  const auto& expanded = at.evaluator->expanded();
  std::vector<std::uint8_t> values(expanded.atom_count(), 0);
  if (const auto q = expanded.predicate("Q()")) values[*q] = given == "Q().\n" ? 1 : 0;
  // Fluents that nothing releases never are.
  const auto releasable = releases_ || noninertial_ ? (1U << fluents_) : 1U;
  const auto every = 1U << fluents_, happen = 1U << events_;
  for (std::uint32_t bits = 0; bits < every * every * releasable * releasable * happen; ++bits) {
    auto rest = bits;
    const auto take = [&](std::uint32_t of) {
      const auto value = rest % of;
      rest /= of;
      return value;
    };
    Step step;
    step.before = {take(every), take(releasable)};
    step.after = {take(every), take(releasable)};
    step.events = take(happen);
    for (std::uint32_t f = 0; f < fluents_; ++f) {
      values[expanded.holds(f, 0)] = (step.before.holds >> f) & 1U;
      values[expanded.holds(f, 1)] = (step.after.holds >> f) & 1U;
      values[expanded.released(f, 0)] = (step.before.released >> f) & 1U;
      values[expanded.released(f, 1)] = (step.after.released >> f) & 1U;
    }
    for (std::uint32_t e = 0; e < events_; ++e) {
      values[expanded.happens(e, 0)] = (step.events >> e) & 1U;
    }
    if (at.evaluator->accepts(values)) out.push_back(step);
  }
  return out;
}

bool StepWorld::breaks(const State& before, std::uint32_t events, const State& after) const {
  return std::all_of(broken_.begin(), broken_.end(), [&](const StepLiteral& one) {
    const auto bits = one.place == Place::kBefore  ? before.holds
                      : one.place == Place::kEvent ? events
                                                   : after.holds;
    return (((bits >> one.number) & 1U) != 0) == one.positive;
  });
}

/// False: the model is not well-formed.
bool StepWorld::search(const std::string& given, std::optional<int>& found,
                       std::string& error) const {
  const auto note = [&](int t) {
    if (!found || t < *found) found = t;
  };
  const auto first = starts(given, error);
  std::set<State> layer(first.begin(), first.end());
  if (!error.empty()) return false;
  for (const auto& state : layer) {
    if (about_one_state() && breaks(state, 0, state)) note(0);
  }
  constexpr int kLastFact = 2;
  std::set<State> seen;
  std::vector<Step> all;
  for (int t = 0; !layer.empty(); ++t) {
    if (t <= kLastFact + 1) all = steps(given, t, error);
    if (!error.empty()) return false;
    std::set<State> next;
    for (const auto& step : all) {
      if (!layer.contains(step.before) || !satisfies(step.after, t + 1)) continue;
      // A property of the step is about `time`, its beginning, with `always`, else about its end.
      if (!about_one_state() && breaks(step.before, step.events, step.after)) {
        note(always_ ? t : t + 1);
      }
      if (about_one_state() && breaks(step.after, 0, step.after)) note(t + 1);
      if (t <= kLastFact || seen.insert(step.after).second) next.insert(step.after);
    }
    layer = std::move(next);
  }
  return true;
}

bool StepWorld::satisfies(const State& state, int t) const {
  return std::all_of(facts_.begin(), facts_.end(), [&](const Fact& fact) {
    if (fact.time != t || fact.event) return true;
    const bool positive = fact.atom[0] != '!';
    const auto number = static_cast<std::uint32_t>(fact.atom[fact.atom.find("(F") + 2] - '0');
    return (((state.holds >> number) & 1U) != 0) == positive;
  });
}

StepWorld::Answer StepWorld::answer() const {
  Answer out;
  for (const std::string given : {"Q().\n", "!Q().\n"}) {
    if (!search(predicate_ ? given : "", out.broken_at, out.error) || !predicate_) break;
  }
  return out;
}

}  // namespace parallax::test
