// The plans of the kitchen executed up to the first drive: a handler that the model has no use for
// runs where a drawer stands in the way, and the plan that closes its drawers stays clean.

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/cli_json.h"
#include "tests/tools/kitchen_copy.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// The plan's file up to `deliver`, and what comes instead.
std::string up_to_deliver(const CliFixture& cli, const std::string& plan, const std::string& rest) {
  const auto text = cli.read(plan);
  const auto at = text.find("(def-cram-function deliver");
  REQUIRE(at != std::string::npos);
  return text.substr(0, at) + rest;
}

TEST_CASE("the open drawer is met, the handler runs, and the model has no path like that") {
  const KitchenCopy cli;
  cli.write("kitchen/handled.lisp", up_to_deliver(cli, "kitchen/plan2.lisp", R"(
(def-cram-function drive-past (?pose)
  (cpl:with-retry-counters ((tries 1))
    (cpl:with-failure-handling
        ((common-fail:navigation-low-level-failure (e)
           (cpl:do-retry tries
             (dolist (?drawer '(:d-low :d-mid :d-top))
               (exe:perform (desig:an action (type closing) (arm right)
                                      (object (desig:an object (name ?drawer))))))
             (park-arms)
             (cpl:retry))))
      (drive-to ?pose))))
(def-cram-function fetch-spoon ()
  (pick-up (find-in-drawers :spoon))
  (park-arms)
  (drive-past *table-pose*))
(fetch-spoon)
)"));
  cli.write("kitchen/handled.yaml",
            "include: plan2.yaml\nplan: handled.lisp\nexecution: closed-loop\nexpect:\n");
  const auto report =
      json_of(cli, {"run", "kitchen/handled.yaml", "--out", "out", "--jobs", "2"}, 1);
  const auto& found = report.at("discrepancies").at(0);
  CHECK(found.at("cause").at("text") == "Go(bTable): navigation-pose-unreachable");
  CHECK(found.at("differs").at("outcome") == true);
  CHECK(found.at("repeated") == "bit-equal");
  const auto& path = found.at("path");
  const auto event = found.at("differs").at("event").get<std::size_t>();
  CHECK(path.at(event).at("condition") == "navigation-pose-unreachable");
  REQUIRE(path.size() > event + 1);
  CHECK(path.at(event + 1).at("event") == "CloseDrawer(right,dLow)");
  const auto& fluents = found.at("first");
  CHECK(std::any_of(fluents.begin(), fluents.end(), [](const Json& fluent) {
    return fluent.at("fluent") == "RobotAt(bTable)" && fluent.at("observed") == false;
  }));
  CHECK(report.at("traces").at(0).at("initial_states") == 18);
  CHECK(cli.parallax({"replay", "out"}).code == 0);
}

TEST_CASE("the plan that closes every drawer before it drives stays clean") {
  const KitchenCopy cli;
  cli.write("kitchen/closing.lisp", up_to_deliver(cli, "kitchen/plan2_modified.lisp", R"(
(def-cram-function fetch-spoon ()
  (fetch-from-drawers :spoon)
  (park-arms)
  (drive-to *table-pose*))
(fetch-spoon)
)"));
  cli.write("kitchen/closing.yaml",
            "include: plan2_modified.yaml\nplan: closing.lisp\nexecution: closed-loop\nexpect:\n");
  const auto report = json_of(cli, {"run", "kitchen/closing.yaml", "--epsilon", "0.5"});
  CHECK(report.at("verdict") == "no-discrepancy");
  CHECK(report.at("traces").at(0).at("paths").size() > 1);
}

}  // namespace
}  // namespace parallax::test
