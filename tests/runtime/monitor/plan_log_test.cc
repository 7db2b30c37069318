// Logs of plans, beside which other events happen, compared with an account of the same model by
// plain sets: the effect of a step on a state is computed here, event by event.

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <set>
#include <string>
#include <vector>

#include "runtime/enumerate/demanded_events.h"
#include "runtime/monitor/belief.h"
#include "tests/support/planned_model.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

using compiler::EventId;
using runtime::Admission;
using runtime::Belief;
using runtime::BeliefOptions;

constexpr int kFluents = 3, kEvents = 6;
/// A and B are the plan's; U and V happen by themselves, C and D where something demands them.
const std::array<std::string, kEvents> kNames = {"A()", "B()", "U()", "V()", "C()", "D()"};
constexpr unsigned kOfPlan = 0b000011, kByThemselves = 0b001100, kDemanded = 0b110000;

/// A fluent that is to hold, or not to; of nothing if `fluent` is negative.
struct Literal {
  int fluent = -1;
  bool holds = true;
  bool of(unsigned state) const {
    return fluent < 0 || ((state >> static_cast<unsigned>(fluent)) & 1U) == (holds ? 1U : 0U);
  }
  std::string print(const std::string& time = "time") const {
    return (holds ? "" : "!") + ("HoldsAt(F" + std::to_string(fluent) + "(),") + time + ")";
  }
};
struct Effect {
  int event;
  Literal condition, makes;
};
struct Demand {
  int event;  // negative: none
  Literal condition;
  unsigned any;  // of these events
};
struct Precondition {
  int event;
  Literal condition;
};

Literal literal(FuzzRandom& random, bool or_none = true) {
  if (or_none && random.chance(50)) return {};
  return {static_cast<int>(random.below(kFluents)), random.chance(50)};
}

struct World {
  std::vector<Effect> effects;
  std::vector<Demand> demands;
  std::vector<Precondition> preconditions;
  std::array<Literal, 2> never;  // never both, unless one is none
  std::array<Literal, 2> good;   // by action: the condition of its success
  std::vector<int> plan;         // events, in order
  int when = 0;                  // a timepoint at which `then` holds; 0: none
  Literal then;
  static constexpr int kOver = -1;

  explicit World(FuzzRandom& random) {
    for (auto n = 2 + random.below(5); n > 0; --n) {
      effects.push_back(
          {static_cast<int>(random.below(kEvents)), literal(random), literal(random, false)});
    }
    for (auto n = random.below(4); n > 0; --n) {
      const auto any = random.chance(30) ? kDemanded : random.chance(50) ? 0b010000U : 0b100000U;
      demands.push_back(
          {random.chance(70) ? static_cast<int>(random.below(kEvents)) : -1, literal(random), any});
    }
    for (auto n = random.below(3); n > 0; --n) {
      preconditions.push_back({static_cast<int>(random.below(kEvents)), literal(random, false)});
    }
    if (random.chance(40)) never = {literal(random, false), literal(random, false)};
    if (random.chance(40)) {
      when = 1 + static_cast<int>(random.below(3));
      then = literal(random, false);
    }
    good = {literal(random, false), literal(random, false)};
    for (auto n = 1 + random.below(3); n > 0; --n) plan.push_back(random.chance(50) ? 0 : 1);
  }

  std::string model() const {
    std::string out = "range time 0 3\n";
    for (int f = 0; f < kFluents; ++f) out += "fluent F" + std::to_string(f) + "()\n";
    for (const auto& name : kNames) out += "event " + name + "\n";
    const auto provided = [](const Literal& condition) {
      return condition.fluent < 0 ? std::string() : condition.print() + " -> ";
    };
    for (const auto& effect : effects) {
      auto made = effect.makes;
      made.holds = true;
      const auto text = made.print();
      out += "[time] " + provided(effect.condition) +
             (effect.makes.holds ? "Initiates(" : "Terminates(") +
             kNames[static_cast<std::size_t>(effect.event)] + "," +
             text.substr(8, text.find(',') - 8) + ",time).\n";
    }
    for (const auto& demand : demands) {
      std::string from;
      if (demand.event >= 0) from = happens(demand.event);
      if (demand.condition.fluent >= 0)
        from += (from.empty() ? "" : " & ") + demand.condition.print();
      std::string to;
      for (int e = 0; e < kEvents; ++e) {
        if ((demand.any >> static_cast<unsigned>(e) & 1U) != 0) {
          to += (to.empty() ? "" : " | ") + happens(e);
        }
      }
      out += "[time] " + (from.empty() ? to : from + " -> " + to) + ".\n";
    }
    for (const auto& needs : preconditions) {
      out += "[time] " + happens(needs.event) + " -> " + needs.condition.print() + ".\n";
    }
    if (when > 0) out += then.print(std::to_string(when)) + ".\n";
    if (never[0].fluent >= 0) {
      out += "[time] !(" + never[0].print() + " & " + never[1].print() + ").\n";
    }
    return out;
  }
  std::string binding() const {
    std::string out;
    for (std::size_t i = 0; i < 2; ++i) {
      out += std::string("action doing-") + (i == 0 ? "a" : "b") + " () -> " + kNames[i] +
             "  ok: " + (good[i].holds ? "" : "!") + "F" + std::to_string(good[i].fluent) +
             "() @t+1 else manipulation-low-level-failure\n";
    }
    return out;
  }
  std::string lisp() const {
    std::string out;
    for (const int event : plan) {
      out += std::string("(perform (an action (type doing-") + (event == 0 ? "a" : "b") + ")))\n";
    }
    return out;
  }

  static std::string happens(int event) {
    return "Happens(" + kNames[static_cast<std::size_t>(event)] + ",time)";
  }
  bool is_state(unsigned state, int time) const {
    if (time == when && when > 0 && !then.of(state)) return false;
    return never[0].fluent < 0 || !(never[0].of(state) && never[1].of(state));
  }
  /// The state behind; none: they cannot happen together here.
  std::optional<unsigned> after(unsigned state, unsigned events, int time) const {
    const auto happens = [&](int e) {
      return e < 0 || (events >> static_cast<unsigned>(e) & 1U) != 0;
    };
    for (const auto& demand : demands) {
      if (happens(demand.event) && demand.condition.of(state) && (events & demand.any) == 0)
        return {};
    }
    for (const auto& needs : preconditions) {
      if (happens(needs.event) && !needs.condition.of(state)) return {};
    }
    unsigned made = 0, ended = 0;
    for (const auto& effect : effects) {
      if (!happens(effect.event) || !effect.condition.of(state)) continue;
      (effect.makes.holds ? made : ended) |= 1U << static_cast<unsigned>(effect.makes.fluent);
    }
    if ((made & ended) != 0) return {};
    const auto out = (state | made) & ~ended;
    return is_state(out, time + 1) ? std::optional(out) : std::nullopt;
  }
};

/// A state, the next perform of the plan or kOver, and the timepoint as far as it matters.
struct Place {
  unsigned state = 0;
  int next = 0, time = 0;
  auto operator<=>(const Place&) const = default;
};
constexpr int kLate = 4;  // no axiom is about a single timepoint from here on
using Places = std::set<Place>;

struct Line {
  bool is_step = false;
  unsigned told = 0;
  std::optional<bool> ok;
  runtime::Observation seen;
};

class Account {
 public:
  Account(const World& world, unsigned unobserved, unsigned demanded)
      : world_(world), unobserved_(unobserved), demanded_(demanded) {}

  Places begin() const {
    Places out;
    for (unsigned state = 0; state < (1U << kFluents); ++state) {
      if (world_.is_state(state, 0)) out.insert({state, 0, 0});
    }
    return out;
  }
  /// Adds the places reached by unseen events before the next line.
  Places closed(Places places) const {
    std::vector<Place> todo(places.begin(), places.end());
    while (!todo.empty()) {
      const auto [state, next, time] = todo.back();
      todo.pop_back();
      for (const auto events : subsets(unobserved_)) {
        if (events == 0) continue;
        for (const auto to : least(state, events, time)) {
          const Place place{to, next, std::min(time + 1, kLate)};
          if (places.insert(place).second) todo.push_back(place);
        }
      }
    }
    return places;
  }
  Places follow(const Places& places, const Line& line) const {
    Places out;
    for (const auto& place : places) {
      if (line.is_step) {
        step(place, line, out);
      } else if (agrees(place.state, line.seen)) {
        out.insert(place);
      }
    }
    return out;
  }
  /// Successor states after these events together with each least set of demanded events that can
  /// accompany them.
  std::vector<unsigned> least(unsigned state, unsigned events, int time) const {
    std::vector<unsigned> sets, out;
    for (const auto demanded : subsets(demanded_ & ~events)) {
      if (world_.after(state, events | demanded, time)) sets.push_back(demanded);
    }
    for (const auto set : sets) {
      bool is_least = true;
      for (const auto other : sets) is_least = is_least && (other == set || (other & ~set) != 0);
      if (is_least) out.push_back(*world_.after(state, events | set, time));
    }
    return out;
  }
  static std::vector<unsigned> subsets(unsigned of) {
    std::vector<unsigned> out;
    for (unsigned events = 0; events < (1U << kEvents); ++events) {
      if ((events & ~of) == 0) out.push_back(events);
    }
    return out;
  }

 private:
  static bool agrees(unsigned state, const runtime::Observation& seen) {
    for (unsigned f = 0; f < kFluents; ++f) {
      if (seen[f] != 0 && ((state >> f) & 1U) != (seen[f] > 0 ? 1U : 0U)) return false;
    }
    return true;
  }
  void step(const Place& place, const Line& line, Places& out) const {
    const auto [state, next, time] = place;
    const int later = std::min(time + 1, kLate);
    const int performed = next == World::kOver ? -1 : world_.plan[static_cast<std::size_t>(next)];
    if ((line.told & kOfPlan) != (performed < 0 ? 0U : 1U << static_cast<unsigned>(performed)))
      return;
    for (const auto more : subsets(unobserved_ & ~line.told)) {
      for (const auto to : least(state, line.told | more, time)) {
        if (performed < 0) {
          out.insert({to, next, later});
          continue;
        }
        const bool ok = world_.good[static_cast<std::size_t>(performed)].of(to);
        if (line.ok && *line.ok != ok) continue;
        const bool is_last = static_cast<std::size_t>(next) + 1 == world_.plan.size();
        out.insert({to, ok && !is_last ? next + 1 : World::kOver, later});
      }
    }
  }
  const World& world_;
  unsigned unobserved_, demanded_;
};

std::vector<Line> random_log(const Account& account, const World& world, unsigned unobserved,
                             FuzzRandom& random) {
  std::vector<Line> out;
  auto places = account.begin();
  for (auto n = 2 + random.below(8); n > 0 && !places.empty(); --n) {
    const auto all = account.closed(places);
    auto it = all.begin();
    std::advance(it, static_cast<std::ptrdiff_t>(random.below(all.size())));
    Line line;
    line.is_step = random.chance(50);
    line.seen.assign(kFluents, 0);
    if (!line.is_step) {
      for (unsigned f = 0; f < kFluents; ++f) {
        if (random.chance(50)) line.seen[f] = ((it->state >> f) & 1U) != 0 ? 1 : -1;
      }
    } else {
      const auto next = it->next;
      if (next != World::kOver)
        line.told = 1U << static_cast<unsigned>(world.plan[static_cast<std::size_t>(next)]);
      if (random.chance(15))
        line.told |= kByThemselves & ~unobserved & (1U << random.below(kEvents));
      if (random.chance(10)) line.told |= kDemanded & (1U << random.below(kEvents));
      if (random.chance(40)) line.ok = random.chance(70);
    }
    if (random.chance(8)) line.told ^= line.is_step ? 1U << random.below(kEvents) : 0U;
    if (random.chance(8) && !line.is_step)
      line.seen[random.below(kFluents)] = random.chance(50) ? 1 : -1;
    places = account.follow(all, line);
    out.push_back(std::move(line));
  }
  return out;
}

TEST_CASE("what happens beside a plan: unseen events at any time, demanded ones where they must") {
  std::size_t cases = 0, refused = 0, late = 0, demanded = 0, unseen = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    FuzzRandom random(seed);
    const World world(random);
    const PlannedModel planned(world.model(), world.lisp(), world.binding(), "HoldsAt(F0(),time)",
                               static_cast<std::int64_t>(world.plan.size()) + 4);
    CAPTURE(world.model());
    CAPTURE(world.lisp());
    CAPTURE(world.binding());
    if (!planned.compiles()) continue;
    auto made = runtime::step_windows(planned.compiled());
    REQUIRE(std::holds_alternative<std::unique_ptr<runtime::StepWindows>>(made));
    const auto windows = std::get<std::unique_ptr<runtime::StepWindows>>(std::move(made));
    REQUIRE(windows->goes_on());
    const compiler::SymbolTable symbols(planned.compiled());
    const auto id = [&](std::size_t e) { return *symbols.event(kNames[e]); };
    const unsigned unobserved =
        random.chance(50) ? 0 : kByThemselves & static_cast<unsigned>(random.below(64));
    BeliefOptions options;
    if (random.chance(20)) options.remembered = 3;
    for (unsigned e = 0; e < kEvents; ++e) {
      if ((kOfPlan >> e & 1U) != 0) options.performed.push_back(id(e));
      if ((unobserved >> e & 1U) != 0) options.unobserved.push_back(id(e));
    }
    unsigned can_be = 0, heads = 0;
    for (const auto& demand : world.demands) heads |= demand.any;
    for (const auto event : runtime::demandable_events(windows->model)) {
      for (unsigned e = 0; e < kEvents; ++e) {
        if (id(e) == event) can_be |= 1U << e;
      }
      options.demanded.push_back(event);
      ++demanded;
    }
    REQUIRE((can_be & ~heads) == 0);
    const Account account(world, unobserved, can_be);
    Belief belief(*windows, options);
    for (int i = 0; i < 4; ++i) {
      const auto log = random_log(account, world, unobserved, random);
      belief.restart();
      auto places = account.begin();
      for (std::size_t line = 0; line < log.size(); ++line) {
        places = account.follow(account.closed(std::move(places)), log[line]);
        runtime::ToldStep told;
        for (std::uint32_t e = 0; e < kEvents; ++e) {
          if ((log[line].told >> e & 1U) != 0) told.events.push_back(id(e));
        }
        std::sort(told.events.begin(), told.events.end());
        told.succeeded = log[line].ok;
        const auto admission =
            log[line].is_step ? belief.step(told) : belief.observe(log[line].seen);
        CAPTURE(line);
        REQUIRE(admission == (places.empty() ? Admission::kRefused : Admission::kAdmitted));
        if (!places.empty()) continue;
        ++refused;
        if (line > 1) ++late;
        break;
      }
      ++cases;
      if (unobserved != 0) ++unseen;
    }
  }
  MESSAGE(cases, " logs, ", refused, " refused, ", late, " of them late, ", unseen,
          " with unobserved events, ", demanded, " demanded events");
  CHECK(cases > 1000);
  CHECK(refused > 200);
  CHECK(late > 100);
  CHECK(demanded > 100);
}

}  // namespace
}  // namespace parallax::test
