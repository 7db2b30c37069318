#pragma once

#include <string>

#include "tests/tools/cli_json.h"

namespace parallax::test {

/// Gates that are shut or not at the start, and a way through that needs the first one open. The
/// model `wrong.e` forgets that; the world is `world`.
class Gates : public CliFixture {
 public:
  explicit Gates(int gates, const std::string& world = "wrong.e") {
    std::string names = "g0";
    for (int i = 1; i < gates; ++i) names += ", g" + std::to_string(i);
    const auto common = "sort gate\ngate " + names +
                        "\nfluent Shut(gate)\nfluent There()\nfluent Waved()\nevent Go()\n"
                        "event Wave()\n!HoldsAt(There(),0).\n!HoldsAt(Waved(),0).\n"
                        "[time] Initiates(Wave(),Waved(),time).\n";
    write("wrong.e", common + "[time] Initiates(Go(),There(),time).\n");
    write("truth.e", common + "[time] !HoldsAt(Shut(g0),time) -> Initiates(Go(),There(),time).\n");
    write("go.lisp", "(perform (an action (type going)))\n(perform (an action (type waving)))\n");
    write("go.bind",
          "action going -> Go() ok: There() @t+1 else plan-failure\n"
          "action waving -> Wave() ok: Waved() @t+1 else plan-failure\n");
    scenario("gates.yaml", "wrong.e", world, "");
  }
  void scenario(const std::string& name, const std::string& model, const std::string& world,
                const std::string& more) const {
    write(name, common(model) +
                    "mapping: {Shut(g): {flag: \"Shut({g})\", drawn: true}}\nsimulator: {model: " +
                    world + "}\n" + more);
  }
  /// The same with a simulator of its own (gates_simulator) instead of a model.
  void simulated(const std::string& name, int lost, int wrong, const std::string& more = "") const {
    write(name, common("wrong.e") +
                    "mapping: {Shut(g): {flag: \"Shut({g})\", drawn: true}, There(): {flag: "
                    "\"There()\"}, Waved(): {flag: \"Waved()\"}}\n"
                    "regions: {cells: {nowhere: {x: [0, 1]}}}\n"
                    "actions: {Go(): {controller: go}, Wave(): {controller: wave}}\n"
                    "simulator: {command: [" PARALLAX_GATES_SIMULATOR ", " +
                    std::to_string(lost) + ", " + std::to_string(wrong) + "]}\n" + more);
  }
  /// `more`, as further lines of the scenario, is refused.
  void refuses(const std::string& more, const std::string& code) const {
    CAPTURE(more);
    scenario("refused.yaml", "wrong.e", "wrong.e", more);
    const auto ran = parallax({"run", "refused.yaml", "--out", "refused"});
    CAPTURE(ran.err);
    CHECK(ran.code == 3);
    CHECK(ran.err.find(code) != std::string::npos);
  }

 private:
  static std::string common(const std::string& model) {
    return "model: " + model +
           "\nplan: go.lisp\nbind: go.bind\nhorizon: 2\n"
           "constraints: [\"Happens(Wave(),time-1) | Happens(Go(),time-1) & "
           "!HoldsAt(There(),time)\"]\n"
           "criterion: {kind: clean-runs, epsilon: 0.2}\n";
  }
};

}  // namespace parallax::test
