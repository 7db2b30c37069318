// Mistakes in effects and conditions with numbers.

#include "tests/tools/repair/mistaken_world.h"

namespace parallax::test {
namespace {

using Mistakes = MistakenWorld::Mistakes;

/// A tank that is filled and emptied by steps, and a pump that takes as much as a table says.
struct Tank : MistakenWorld {
  explicit Tank(const Mistakes& mistakes)
      : MistakenWorld(
            "sort tank\ntank red, blue\nsort level: integer\nrange level 0 4\n"
            "function Draught(tank): level\nDraught(red)=1.\nDraught(blue)=2.\n"
            "fluent Level(tank,level)\nevent Fill(tank)\nevent Pump(tank)\n\n"
            "[tank,level1,level2,time] HoldsAt(Level(tank,level1),time) & level2=level1+1 -> "
            "Initiates(Fill(tank),Level(tank,level2),time).\n"
            "[tank,level,time] HoldsAt(Level(tank,level),time) & level<4 -> "
            "Terminates(Fill(tank),Level(tank,level),time).\n"
            "[tank,level1,level2,level3,time] HoldsAt(Level(tank,level1),time) & "
            "level3=Draught(tank) & level2=level1-level3 -> "
            "Initiates(Pump(tank),Level(tank,level2),time).\n"
            "[tank,level,time] HoldsAt(Level(tank,level),time) & level>=Draught(tank) -> "
            "Terminates(Pump(tank),Level(tank,level),time).\n"
            "[tank,level1,level2,time] HoldsAt(Level(tank,level1),time) & "
            "HoldsAt(Level(tank,level2),time) -> level1=level2.\n",
            "[tank,level] HoldsAt(Level(tank,level),0) <-> level=1.\n",
            {{"Fill(red)", "Level(red,2)"},
             {"Fill(blue)", "Level(blue,2)"},
             {"Fill(red)", "Level(red,3)"},
             {"Pump(blue)", "Level(blue,0)"},
             {"Pump(red)", "Level(red,2)"}},
            mistakes) {}
};

TEST_CASE("an effect that counts is missing: it is said by the number before") {
  const Tank cli(
      Mistakes{{"[tank,level1,level2,time] HoldsAt(Level(tank,level1),time) & level2=level1+1 -> "
                "Initiates(Fill(tank),Level(tank,level2),time).\n",
                ""}});
  const auto words = cli.first();
  CHECK(mentions(words, "level2=level1+1"));
  CHECK(mentions(words, "Initiates(Fill(tank),Level(tank,level2),time)"));
}

TEST_CASE("an effect by a table is missing") {
  const Tank cli(
      Mistakes{{"[tank,level1,level2,level3,time] HoldsAt(Level(tank,level1),time) & "
                "level3=Draught(tank) & level2=level1-level3 -> "
                "Initiates(Pump(tank),Level(tank,level2),time).\n",
                ""}});
  CHECK(mentions(cli.first(), "level1-Draught(tank)"));
}

TEST_CASE("a wrong number, sign or relation") {
  Tank(Mistakes{{"level2=level1+1", "level2=level1+2"}}).first();
  Tank(Mistakes{{"level2=level1+1", "level2=level1-1"}}).first();
  Tank(Mistakes{{"level<4", "level<2"}}).first();
  Tank(Mistakes{{"level>=Draught(tank)", "level<Draught(tank)"}}).first();
}

TEST_CASE("a numeral takes the place of a variable") {
  Tank(Mistakes{{"Initiates(Fill(tank),Level(tank,level2),time)",
                 "Initiates(Fill(tank),Level(tank,2),time)"}})
      .first();
}

}  // namespace
}  // namespace parallax::test
