// Documents of runs, rates and explanations, judged by an expectation.

#include "tools/suite/expectation.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

namespace parallax::tools {
namespace {

using Json = nlohmann::json;

std::string rates_document(int runs, int count, int lost) {
  const Json any = {{"count", count}, {"rate", 0.5}, {"lower", 0.4}, {"upper", 0.6}};
  const Json trace = {{"runs", runs}, {"lost", lost}, {"any", any}, {"causes", Json::array()}};
  return Json{{"status", "ok"}, {"traces", {trace}}}.dump();
}

TEST_CASE("runs that the simulator lost count against the claim, either way") {
  harness::RateExpectation rare;
  rare.upper = 0.05;
  rare.confidence = 0.99;
  CHECK(unmet(rare, rates_document(100, 0, 0)).empty());
  const auto lost = unmet(rare, rates_document(98, 0, 2));
  REQUIRE(lost.size() == 1);
  CHECK(lost.front().find("0 of 98 runs") != std::string::npos);
  CHECK(lost.front().find("2 more lost") != std::string::npos);
  CHECK(lost.front().find("not enough evidence") != std::string::npos);
  // Where all of them may have failed it is still not known that they did.
  CHECK(unmet(rare, rates_document(50, 0, 50)).front().find("not enough") != std::string::npos);
  CHECK(unmet(rare, rates_document(100, 50, 0)).front().find("not below") != std::string::npos);
  // No number of runs tells while half of them are lost.
  CHECK(unmet(rare, rates_document(50, 0, 50)).front().find("would not tell either") !=
        std::string::npos);
}

TEST_CASE("a document that is no result is not taken for one") {
  harness::RateExpectation any;
  any.upper = 0.5;
  any.confidence = 0.9;
  for (const auto* text : {"", "[]", "{}", R"({"status":"ok","traces":[]})",
                           R"({"status":"error","traces":[{"any":{}}]})"}) {
    CHECK(unmet(any, text).size() == 1);
    CHECK(frequent_causes(text).empty());
    CHECK(blame(text).empty());
  }
}

TEST_CASE("the blame is the words of the first set and its first axioms") {
  auto axioms = Json::array();
  for (int i = 1; i <= 7; ++i) {
    axioms.push_back(
        {{"file", "m.e"}, {"line", i}, {"what", "axiom"}, {"text", "no. " + std::to_string(i)}});
  }
  const Json document = {{"sets", {{{"words", "It fell."}, {"axioms", axioms}}}}};
  const auto text = blame(document.dump());
  CHECK(text.starts_with("It fell.\n  m.e:1  axiom: no. 1\n"));
  CHECK(text.ends_with("  m.e:5  axiom: no. 5\n  and 2 more"));
}

}  // namespace
}  // namespace parallax::tools
