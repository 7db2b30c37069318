#pragma once

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {

/// A world, and a model of it in which texts are replaced: "right", "wrong".
struct MistakenWorld : CliFixture {
  using Mistakes = std::vector<std::pair<std::string, std::string>>;
  /// The plan's events with what makes each succeed: {"Fill()", "Filled()"}.
  using Plan = std::vector<std::pair<std::string, std::string>>;

  MistakenWorld(const std::string& truth, const std::string& start, const Plan& plan,
                const Mistakes& mistakes) {
    write("truth.e", truth);
    write("model.e", truth);
    for (const auto& [right, wrong] : mistakes) replace("model.e", right, wrong);
    write("start.e", start);
    std::string lisp, bind;
    for (std::size_t i = 0; i < plan.size(); ++i) {
      const auto type = std::string("acting-") + static_cast<char>('a' + i);
      lisp += "(perform (an action (type " + type + ")))\n";
      bind += "action " + type + " () -> " + plan[i].first + " ok: " + plan[i].second +
              " @t+1 else manipulation-goal-not-reached\n";
    }
    write("plan.lisp", lisp);
    write("robot.bind", bind);
    const auto last = std::to_string(plan.size());
    write("open.yaml", "plan: plan.lisp\nbind: robot.bind\nhorizon: " + last +
                           "\nmodel: [model.e, start.e]\nsimulator: {model: truth.e}\n"
                           "constraints: \"time=" +
                           last + "\"\n");
    write("own.yaml", "include: open.yaml\nexecution: closed-loop\n");
  }

  nlohmann::json repaired() const {
    json_of(*this, {"run", "own.yaml", "--out", "out"}, 1);
    return json_of(*this, {"repair", "out"}, 1);
  }

  /// The words of the first proposal, which follows all runs; applied, the model is the true one:
  /// it has the same traces, of any plan, as the truth without `unseen`, which no run can show.
  std::string first(const std::string& unseen = "") const {
    const auto report = repaired();
    CAPTURE(report.dump(1));
    const auto& best = report.at("proposals").at(0);
    CHECK(best.at("runs_to_the_end") == best.at("runs"));
    CHECK(best.at("only_begins") == false);
    CHECK(parallax({"repair", "out", "--apply", "1"}).code == 0);
    write("expected.e", read("truth.e"));
    if (!unseen.empty()) replace("expected.e", unseen, "");
    const auto differs = parallax(
        {"diff", "model.e", "expected.e", "--with", "start.e", "--horizon", "3", "--traces-only"});
    CAPTURE(differs.out);
    CAPTURE(read("model.e"));
    CHECK(differs.code == 0);
    return best.at("words");
  }
};

inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace parallax::test
