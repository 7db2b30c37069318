#include "tests/fuzz/random_bodies.h"

#include <fmt/core.h>

#include <algorithm>

namespace parallax::test {
namespace {

class BodiesMaker {
 public:
  explicit BodiesMaker(FuzzRandom& random) : random_(random) {}

  std::vector<RandomStatement> make() {
    horizon_ = 1 + random_.below(3);
    bodies_ = 1 + random_.below(2);
    places_ = 2 + random_.below(2);
    if (horizon_ == 3) bodies_ = 1;
    hops_ = random_.chance(30);
    doors_ = random_.chance(50);
    declarations();
    nearness();
    effects();
    preconditions();
    exclusions();
    wide_axioms();
    start_and_goal();
    if (random_.chance(15)) say("completion Happens");
    return std::move(statements_);
  }

 private:
  void say(std::string text) { statements_.push_back({std::move(text), "", std::nullopt}); }
  void maybe(std::size_t percent, std::string text) {
    if (random_.chance(percent)) say(std::move(text));
  }
  std::string some_body() { return random_.chance(50) && bodies_ > 1 ? "Ball" : "Cart"; }
  std::size_t some_place() { return 1 + random_.below(places_); }

  void declarations() {
    say(fmt::format("range time 0 {}", horizon_));
    say("sort body");
    say(bodies_ == 1 ? "body Cart" : "body Cart, Ball");
    say("sort place: integer");
    say(fmt::format("range place 1 {}", places_));
    say("predicate Near(place,place)");
    say("fluent At(body,place)");
    say("event Go(body,place)");
    if (hops_) say("event Hop(body,place,place)");
    if (!doors_) return;
    say("fluent Open(place)");
    say("event Push(place)");
  }

  void nearness() {
    switch (random_.below(3)) {
      case 0:
        return say("[place1,place2] Near(place1,place2) <-> (place2=place1+1 | place1=place2+1).");
      case 1:
        say("Near(1,2).");
        say("Near(2,1).");
        return say("completion Near");
      default:
        say("Near(1,2).");
        return maybe(50, "!Near(2,2).");
    }
  }

  void effects() {
    const std::string door = doors_ && random_.chance(15) ? "HoldsAt(Open(place),time) -> " : "";
    say("[body,place,time] " + door + "Initiates(Go(body,place),At(body,place),time).");
    const auto kind = random_.below(10);
    if (kind < 6) {
      say("[body,place1,place2,time] HoldsAt(At(body,place1),time) & place1!=place2 -> "
          "Terminates(Go(body,place2),At(body,place1),time).");
    } else if (kind < 8) {
      say("[body,place1,place2,time] place1!=place2 -> "
          "Terminates(Go(body,place2),At(body,place1),time).");
    } else if (kind < 9) {
      say("[body,place1,place2,time] HoldsAt(At(body,place1),time) & Near(place1,place2) -> "
          "Terminates(Go(body,place2),At(body,place1),time).");
    }
    if (hops_) {
      say("[body,place1,place2,time] place1!=place2 -> "
          "Initiates(Hop(body,place1,place2),At(body,place2),time).");
      say("[body,place1,place2,time] place1!=place2 -> "
          "Terminates(Hop(body,place1,place2),At(body,place1),time).");
    }
    if (!doors_) return;
    say("[place,time] !HoldsAt(Open(place),time) -> Initiates(Push(place),Open(place),time).");
    maybe(70,
          "[place,time] HoldsAt(Open(place),time) -> Terminates(Push(place),Open(place),time).");
    maybe(20, "[body,place,time] Releases(Go(body,place),Open(place),time).");
    maybe(15,
          "[body,place1,place2,time] !HoldsAt(At(body,place2),time) & place1!=place2 -> "
          "Initiates(Go(body,place1),Open(place2),time).");
    maybe(8,
          "[event,place,time] Initiates(event,Open(place),time) & HoldsAt(At(Cart,place),time) -> "
          "Terminates(event,At(Cart,place),time).");
  }

  void preconditions() {
    maybe(60,
          "[body,place,time] Happens(Go(body,place),time) -> "
          "({place1} HoldsAt(At(body,place1),time) & Near(place1,place)).");
    maybe(25, "[body,place,time] Happens(Go(body,place),time) -> !HoldsAt(At(body,place),time).");
    maybe(20, fmt::format("[body,time] Happens(Go(body,{}),time) -> HoldsAt(At(body,{}),time).",
                          some_place(), some_place()));
    maybe(20, fmt::format("[body,time] Happens(Go(body,{}),time) -> HoldsAt(At(body,{}),time) | "
                          "HoldsAt(At(body,{}),time).",
                          some_place(), some_place(), some_place()));
    if (hops_) {
      maybe(70,
            "[body,place1,place2,time] Happens(Hop(body,place1,place2),time) -> "
            "HoldsAt(At(body,place1),time).");
    }
    if (!doors_) return;
    maybe(30, "[body,place,time] Happens(Go(body,place),time) -> HoldsAt(Open(place),time).");
    maybe(20,
          "[body,place,time] Happens(Push(place),time) -> "
          "({place1} HoldsAt(At(Cart,place1),time) & place1!=place).");
  }

  void exclusions() {
    switch (random_.below(4)) {
      case 0:
        return say(
            "[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.");
      case 1:
      case 2:
        return say(
            "[body,place1,place2,time] Happens(Go(body,place1),time) & "
            "Happens(Go(body,place2),time) -> place1=place2.");
      default:
        return;
    }
  }

  void wide_axioms() {
    maybe(40,
          "[body1,body2,place1,place2,time] Happens(Go(body1,place2),time) & "
          "HoldsAt(At(body1,place1),time) & Happens(Go(body2,place1),time) & "
          "HoldsAt(At(body2,place2),time) -> body1=body2.");
    maybe(40,
          "[body1,body2,place,time] HoldsAt(At(body1,place),time) & HoldsAt(At(body2,place),time) "
          "-> body1=body2.");
    maybe(25,
          "[body1,body2,place1,place2,time] Happens(Go(body1,place1),time) & "
          "HoldsAt(At(body1,place2),time) & HoldsAt(At(body2,place1),time+1) -> "
          "body1=body2 | place2=1.");
    maybe(15,
          "[body,place1,place2,time] {place} Happens(Go(body,place1),time) & "
          "HoldsAt(At(body,place2),time) & HoldsAt(At(body,place),time) -> place2<=place1.");
    if (!doors_) return;
    maybe(30,
          "[body,place1,place2,time] Happens(Go(body,place2),time) & "
          "HoldsAt(At(body,place1),time) & HoldsAt(Open(place2),time) -> "
          "HoldsAt(Open(place1),time).");
    maybe(20,
          "[body,place1,place2,time] Happens(Go(body,place2),time) & "
          "HoldsAt(At(body,place1),time) & HoldsAt(Open(place1),time) -> "
          "Happens(Push(place1),time).");
    maybe(8,
          "[event,place1,place2,time] Initiates(event,At(Cart,place1),time) & "
          "HoldsAt(At(Cart,place2),time) & Happens(event,time) -> HoldsAt(Open(place1),time).");
  }

  void start_and_goal() {
    for (std::size_t i = 0; i < bodies_; ++i) {
      const std::string body = i == 0 ? "Cart" : "Ball";
      const auto kind = random_.below(20);
      if (kind < 16) {
        say(fmt::format("[place] HoldsAt(At({},place),0) <-> place={}.", body, some_place()));
      } else if (kind < 18) {
        say(fmt::format("HoldsAt(At({},{}),0).", body, some_place()));
      } else if (kind < 19) {
        say(fmt::format("[place] !HoldsAt(At({},place),0).", body));
      }
    }
    if (doors_) maybe(60, "[place] HoldsAt(Open(place),0) <-> place=1.");
    maybe(30, fmt::format("HoldsAt(At({},{}),{}).", some_body(), some_place(), horizon_));
  }

  FuzzRandom& random_;
  std::size_t horizon_ = 1, bodies_ = 1, places_ = 2;
  bool hops_ = false, doors_ = false;
  std::vector<RandomStatement> statements_;
};

}  // namespace

RandomModel random_bodies(std::uint64_t seed) {
  FuzzRandom random(seed);
  RandomModel model;
  model.seed = seed;
  model.statements = BodiesMaker(random).make();
  return model;
}

}  // namespace parallax::test
