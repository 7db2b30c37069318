// Mistakes in what a model says of states: constraints and definitions.

#include "tests/tools/repair/mistaken_world.h"

namespace parallax::test {
namespace {

using Mistakes = MistakenWorld::Mistakes;

/// A lamp whose light follows from its switch and its fuse.
struct Lamp : MistakenWorld {
  explicit Lamp(const Mistakes& mistakes)
      : MistakenWorld(
            "sort room\nroom hall, attic\n"
            "fluent On(room)\nfluent Fuse()\nfluent Light(room)\nnoninertial Light\n"
            "event Push(room)\nevent Screw()\nevent Unscrew()\n\n"
            "[room,time] Initiates(Push(room),On(room),time).\n"
            "[time] Initiates(Screw(),Fuse(),time).\n"
            "[time] Terminates(Unscrew(),Fuse(),time).\n"
            "[room,time] HoldsAt(Light(room),time) <-> HoldsAt(On(room),time) & "
            "HoldsAt(Fuse(),time).\n",
            "[room] !HoldsAt(On(room),0).\n!HoldsAt(Fuse(),0).\n",
            {{"Push(hall)", "On(hall)"},
             {"Screw()", "Fuse()"},
             {"Push(attic)", "Light(attic)"},
             {"Unscrew()", "!Fuse()"}},
            mistakes) {}
};

TEST_CASE("a constraint that the world does not have is dropped") {
  const Lamp cli(Mistakes{{"[room,time] HoldsAt(Light(room)",
                           "[time] !(HoldsAt(Light(hall),time) & HoldsAt(On(attic),time)).\n"
                           "[room,time] HoldsAt(Light(room)"}});
  CHECK(mentions(cli.first(), "is dropped"));
}

TEST_CASE("a definition lacks a part") {
  const Lamp cli(Mistakes{{" & HoldsAt(Fuse(),time)", ""}});
  CHECK(mentions(cli.first(), "only if `HoldsAt(Fuse(),time)`"));
}

TEST_CASE("a definition has a part too many") {
  const Lamp cli(
      Mistakes{{"& HoldsAt(Fuse(),time).", "& HoldsAt(Fuse(),time) & !HoldsAt(On(attic),time)."}});
  CHECK(mentions(cli.first(), "without `!HoldsAt(On(attic),time)`"));
}

TEST_CASE("a definition names another fluent, another argument, or the opposite") {
  const std::string right = "<-> HoldsAt(On(room),time) & HoldsAt(Fuse(),time)";
  for (const std::string wrong : {"<-> HoldsAt(On(attic),time) & HoldsAt(Fuse(),time)",
                                  "<-> HoldsAt(On(room),time) & !HoldsAt(Fuse(),time)"}) {
    CAPTURE(wrong);
    Lamp(Mistakes{{right, wrong}}).first();
  }
}

}  // namespace
}  // namespace parallax::test
