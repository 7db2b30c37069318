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

TEST_CASE("a definition has one sign in the place of the other") {
  const Lamp cli(Mistakes{{"HoldsAt(On(room),time) & HoldsAt(Fuse()",
                           "HoldsAt(On(room),time) | ; one & the other\n  HoldsAt(Fuse()"}});
  CHECK(mentions(cli.first(), "with `&` in the place of `|`"));
}

/// Three valves that are opened and closed, and a law about them.
struct Valves : MistakenWorld {
  Valves(const std::string& law, const Mistakes& mistakes)
      : MistakenWorld(
            "sort valve\nvalve left, right, main\n"
            "fluent Open(valve)\nfluent Flow()\n" +
                law +
                "event Turn(valve)\nevent Close(valve)\n\n"
                "[valve,time] Initiates(Turn(valve),Open(valve),time).\n"
                "[valve,time] Terminates(Close(valve),Open(valve),time).\n",
            "[valve] !HoldsAt(Open(valve),0).\n",
            {{"Turn(left)", "Open(left)"},
             {"Close(left)", "!Open(left)"},
             {"Turn(right)", "Open(right)"},
             {"Turn(main)", "Open(main)"},
             {"Turn(left)", "Open(left)"}},
            mistakes) {}
};

TEST_CASE("a constraint has one sign in the place of the other") {
  // One event at a time: else the world opens the main valve with the second one.
  const Valves cli(
      "[time] HoldsAt(Open(left),time) & HoldsAt(Open(right),time) -> HoldsAt(Open(main),time).\n"
      "[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.\n",
      Mistakes{{"(left),time) & ", "(left),time) | "}});
  CHECK(mentions(cli.first(), "with `&` in the place of `|`"));
}

TEST_CASE("a definition of three parts has one sign in the place of the other") {
  const std::string law =
      "noninertial Flow\n"
      "[time] HoldsAt(Flow(),time) <->\n"
      "  HoldsAt(Open(left),time) & HoldsAt(Open(right),time) | HoldsAt(Open(main),time).\n";
  const Valves cli(law, Mistakes{{"(left),time) & ", "(left),time) | "}});
  CHECK(mentions(cli.first(), "behind `HoldsAt(Open(left),time)`"));
}

/// Two boxes that spill what is in them when they are opened or thrown.
struct Boxes : MistakenWorld {
  explicit Boxes(const Mistakes& mistakes)
      : MistakenWorld(
            "sort box\nbox red, blue\n"
            "fluent Shut(box)\nfluent Full(box)\nfluent Wet()\n"
            "event Open(box)\nevent Throw(box)\nevent Fill(box)\nevent Dry()\n\n"
            "[box,time] Terminates(Open(box),Shut(box),time).\n"
            "[box,time] Terminates(Throw(box),Shut(box),time).\n"
            "[box,time] Initiates(Fill(box),Full(box),time).\n"
            "[box,time] Initiates(Fill(box),Shut(box),time).\n"
            "[time] Terminates(Dry(),Wet(),time).\n"
            "[event,box,time] Terminates(event,Shut(box),time) & HoldsAt(Full(box),time) -> "
            "Initiates(event,Wet(),time).\n"
            "[event,box,time] Terminates(event,Shut(box),time) -> "
            "Terminates(event,Full(box),time).\n",
            "[box] HoldsAt(Shut(box),0).\n[box] !HoldsAt(Full(box),0).\n!HoldsAt(Wet(),0).\n",
            {{"Fill(red)", "Full(red)"},
             {"Open(blue)", "!Shut(blue)"},
             {"Open(red)", "Wet()"},
             {"Dry()", "!Wet()"},
             {"Fill(blue)", "Full(blue)"},
             {"Throw(blue)", "Wet()"}},
            mistakes) {}
};

TEST_CASE("what follows from an effect has the other sign, or is of another fluent") {
  const std::string right = "Initiates(event,Wet(),time)";
  for (const std::string wrong :
       {"Terminates(event,Wet(),time)", "Initiates(event,Shut(box),time)"}) {
    CAPTURE(wrong);
    const Boxes cli(Mistakes{{right, wrong}});
    CHECK(mentions(cli.first(), "becomes `" + right + "`"));
  }
}

TEST_CASE("what follows from an effect lacks a condition") {
  const Boxes cli(Mistakes{{" & HoldsAt(Full(box),time) -> Initiates", " -> Initiates"}});
  CHECK(mentions(cli.first(), "only if `HoldsAt(Full(box),time)`"));
}

}  // namespace
}  // namespace parallax::test
