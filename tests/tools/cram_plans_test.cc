// tests/plans/cram: plans in the style and size of CRAM's packages, from the check to simulations.

#include <doctest/doctest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

const fs::path kPlans = fs::path(PARALLAX_SOURCE_DIR) / "tests" / "plans" / "cram";

/// The plans, and the number of ways in which each reaches its scenario's goal: by where things are
/// at the start, as there is one way only to each of these.
struct CramPlan {
  std::string name;
  int traces = 0;
};
const std::vector<CramPlan> kCramPlans = {
    {"fetch", 1},      // the milk is on the first cell
    {"deliver", 3},    // or on any of three
    {"search", 3},     // the spoon is in one of three drawers
    {"access", 1},     // the contents of the drawers make no difference
    {"seal", 2},       // the spoon is in the middle drawer or not
    {"transport", 3},  // as with search
    {"pour", 1},       // milk and bowl are where they are looked for
    {"relay", 6},      // milk and bowl on two different ones of three cells
    {"store", 3},      // the bowl on any cell
    {"table", 3},      // the milk on any cell
};

std::vector<std::string> words(const std::string& command, const std::string& plan) {
  return {command, (kPlans / (plan + ".yaml")).string(), "--allow-outside"};
}

TEST_CASE("plans in CRAM's style are checked, have their traces and are simulated") {
  const CliFixture cli;
  for (const auto& [name, traces] : kCramPlans) {
    CAPTURE(name);
    const auto checked = cli.parallax(words("check", name));
    CAPTURE(checked.err);
    CHECK(checked.err.find("error[") == std::string::npos);
    auto count = words("traces", name);
    count.insert(count.end(), {"--count", "--limit", "0"});
    const auto counted = cli.parallax(count);
    CHECK(counted.out == std::to_string(traces) + "\n");
    auto run = words("run", name);
    for (const char* word : {"--max-runs", "1", "--keep-going", "--jobs", "2", "--json", "--out"}) {
      run.emplace_back(word);
    }
    run.push_back("run-" + name);
    const auto ran = cli.parallax(run);
    CAPTURE(ran.err);
    REQUIRE(nlohmann::json::accept(ran.out));
    // So few simulations say nothing about the plan; the test is that each trace had one.
    const auto result = nlohmann::json::parse(ran.out);
    CHECK(result["traces"].size() == static_cast<std::size_t>(traces));
    CHECK(result["simulations"].get<int>() == traces);
    // Only what the plan leaves open stands in the way of a claim about all traces.
    bool is_open = false;
    for (const auto& bound : result.value("bounds", nlohmann::json::array())) {
      const auto text = bound.get<std::string>();
      is_open = is_open || text.starts_with("approximated: ") || text.starts_with("not explored: ");
    }
    const std::string explored = is_open ? "complete up to bound" : "all traces explored";
    CHECK(result["exploration"] == explored);
  }
}

/// The text of every Lisp file and system definition.
std::string all_text() {
  std::ostringstream out;
  for (const auto& entry : fs::recursive_directory_iterator(kPlans)) {
    const auto kind = entry.path().extension();
    if (kind != ".lisp" && kind != ".asd") continue;
    out << std::ifstream(entry.path()).rdbuf() << '\n';
  }
  return out.str();
}

TEST_CASE("plans in CRAM's style contain the forms that its packages are made of") {
  const auto text = all_text();
  for (const std::string form : {
           ". (:counter",
           "defsystem",
           "defpackage",
           "in-package",
           "cl-transforms:make-3d-vector",
           "cl-transforms-stamped:make-pose-stamped",
           "cl-transforms:origin",
           "(error \"",
           "listp",
           "typep",
           "stringp",
           "desig:equate",
           "desig:current-desig",
           "desig:newest-effective-designator",
           "desig:desig-prop-value",
           "desig:properties",
           "desig:copy-designator",
           "#'",
           "(funcall",
           "(apply",
           "(find ",
           "find-if",
           "remove-if-not",
           "(reduce",
           ":test",
           "mapc",
           "mapcar",
           "make-list",
           "(values",
           "multiple-value-bind",
           "prolog:prolog",
           "cut:var-value",
           "on-event",
           "ros-warn",
           "def-fact-group",
           "desig:action-grounding",
           "cpl:retry",
           "(:tag",
           "&allow-other-keys",
           "&rest",
           "make-condition",
           "(condition (e)",
           "handler-case",
           "defmacro",
           "cpl:pursue",
           "cpl:par",
           "try-each-in-order",
           "try-in-order",
           "unwind-protect",
       }) {
    CAPTURE(form);
    CHECK(text.find(form) != std::string::npos);
  }
}

}  // namespace
}  // namespace parallax::test
