// A model with triggers in open loop: nothing happens by itself that nothing demands.

#include <doctest/doctest.h>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kKettle =
    "fluent Filled()\nfluent On()\nfluent Hot()\n"
    "event Fill()\nevent SwitchOn()\nevent Boil()\nevent Wait()\n"
    "[time] Initiates(Fill(),Filled(),time).\n"
    "[time] HoldsAt(Filled(),time) -> Initiates(SwitchOn(),On(),time).\n"
    "[time] HoldsAt(On(),time) -> Happens(Boil(),time).\n"
    "[time] Initiates(Boil(),Hot(),time).\n"
    "[time] Terminates(Boil(),On(),time).\n"
    "!HoldsAt(Filled(),0).\n!HoldsAt(On(),0).\n!HoldsAt(Hot(),0).\n";

struct Kettle : CliFixture {
  Kettle() {
    write("truth.e", kKettle);
    write("kettle.e", kKettle);
    write("kettle.lisp",
          "(perform (an action (type filling)))\n(perform (an action (type switching)))\n"
          "(perform (an action (type waiting)))\n");
    write("kettle.bind",
          "action filling () -> Fill() ok: Filled() @t+1 else manipulation-goal-not-reached\n"
          "action switching () -> SwitchOn() ok: On() @t+1 else manipulation-goal-not-reached\n"
          "action waiting () -> Wait() ok: Hot() @t+1 else manipulation-goal-not-reached\n");
    write("kettle.yaml",
          "plan: kettle.lisp\nbind: kettle.bind\nhorizon: 3\nmodel: kettle.e\n"
          "simulator: {model: truth.e}\nconstraints: \"time=3\"\n");
  }
};

TEST_CASE("a model with triggers is not found wrong against itself") {
  const Kettle kettle;
  const auto same = kettle.parallax({"run", "kettle.yaml", "--epsilon", "0.5", "--out", "same"});
  CHECK_MESSAGE(same.code == 0, same.out, same.err);
  CHECK(has(same.out, "Fill(), SwitchOn(), Wait()"));
  CHECK(has(same.out, "1 trace"));
  // Without the switch nothing demands the event, so it never happens.
  kettle.replace("kettle.lisp", "(perform (an action (type switching)))\n", "");
  kettle.replace("kettle.bind", "ok: Hot() @t+1", "ok: Filled() @t+1");
  kettle.replace("kettle.yaml", "time=3", "time=2");
  const auto cold = kettle.parallax({"run", "kettle.yaml", "--epsilon", "0.5", "--out", "cold"});
  CHECK_MESSAGE(cold.code == 0, cold.out, cold.err);
}

TEST_CASE("events without a reason are not enumerated") {
  const Kettle kettle;
  // Ten bells ring when they are hot, which they never are: 2^30 executions, one of them closed.
  std::string bells;
  for (int i = 0; i < 10; ++i) {
    const auto n = std::to_string(i);
    bells += "fluent Warm" + n + "()\nevent Ring" + n + "()\n!HoldsAt(Warm" + n + "(),0).\n" +
             "[time] HoldsAt(Warm" + n + "(),time) -> Happens(Ring" + n + "(),time).\n";
  }
  kettle.write("kettle.e", kKettle + bells);
  kettle.write("truth.e", kKettle + bells);
  const auto same = kettle.parallax({"run", "kettle.yaml", "--epsilon", "0.5", "--out", "same"});
  CHECK_MESSAGE(same.code == 0, same.out, same.err);
  CHECK(has(same.out, "1 trace (all traces explored)"));
}

TEST_CASE("a world without the trigger is found, and the trace names the demanded event") {
  const Kettle kettle;
  kettle.replace("truth.e", "[time] HoldsAt(On(),time) -> Happens(Boil(),time).\n", "");
  const auto differs = kettle.parallax({"run", "kettle.yaml", "--out", "differs"});
  CHECK_MESSAGE(differs.code == 1, differs.out, differs.err);
  CHECK(has(differs.out, "Hot() is false, and the model says true"));
  const auto rates = kettle.parallax({"rates", "kettle.yaml", "--runs", "3", "--json"});
  CHECK_MESSAGE(has(rates.out, "Wait()+Boil()"), rates.out);
}

}  // namespace
}  // namespace parallax::test
