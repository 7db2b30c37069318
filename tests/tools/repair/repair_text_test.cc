// Texts about proposals that experiments have dropped, or that others have displaced.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tools/repair/repair.h"

namespace parallax::tools {
namespace {

RepairResult with_one_proposal() {
  RepairResult result;
  result.runs = 3;
  result.failed = 1;
  result.experiments = 2;
  RunParting parting;
  parting.ids = {"1.1"};
  parting.after = 1;
  parting.step.event = "Pull()";
  parting.seen = {{"Open()", false}};
  result.partings.push_back(parting);
  Proposal proposal;
  proposal.size = 1;
  proposal.words = "an effect is missing";
  proposal.verdict.runs_consistent = proposal.verdict.runs_whole = 3;
  result.proposals.push_back(proposal);
  result.tied = 1;
  result.founded = {0};
  return result;
}

TEST_CASE("refuted, crowded out, not compared: each by itself, in JSON and in words") {
  auto result = with_one_proposal();
  const auto json = [&] { return nlohmann::json::parse(repair_json(result)); };
  const auto text = [&] { return repair_text(result, {}); };
  CHECK(json().at("refuted").empty());
  CHECK(json().at("crowded_out").empty());
  CHECK(json().at("not_compared") == 0);
  CHECK(text().find("efuted") == std::string::npos);
  CHECK(text().find("in its place") == std::string::npos);
  CHECK(text().find("compared") == std::string::npos);

  result.crowded_out = {"an axiom is dropped"};
  CHECK(json().at("crowded_out") == nlohmann::json::array({"an axiom is dropped"}));
  CHECK(json().at("refuted").empty());
  CHECK(text().find("No run refutes it, but others are shown in its place: an axiom is dropped.") !=
        std::string::npos);
  CHECK(text().find("Refuted by a run") == std::string::npos);

  result.refuted = {"a condition is added"};
  CHECK(json().at("refuted") == nlohmann::json::array({"a condition is added"}));
  CHECK(text().find("Refuted by a run: a condition is added.") != std::string::npos);

  result.not_compared = 1;
  CHECK(json().at("not_compared") == 1);
  CHECK(text().find("1 further proposal as likely as the first was not compared with it") !=
        std::string::npos);
  result.not_compared = 4;
  CHECK(text().find("4 further proposals as likely as the first were not compared with it") !=
        std::string::npos);
}

TEST_CASE("what random sequences say, of which events, and what decided the rank") {
  auto result = with_one_proposal();
  const auto json = [&] {
    return nlohmann::json::parse(repair_json(result)).at("proposals").at(0);
  };
  const auto says = [&](const std::string& part) {
    return repair_text(result, {}).find(part) != std::string::npos;
  };
  auto& proposal = result.proposals.front();
  proposal.text = "";
  result.sequences = 38;
  result.choosing = 40;
  proposal.verdict.fresh_right = 38;
  proposal.verdict.validated = 40;
  CHECK(says("Also right on 38 fresh random sequences of events."));
  CHECK(json().at("sequences_right") == 38);
  result.sequences_of_plan = true;
  CHECK(says("Also right on 38 fresh random sequences of the plan's events."));
  proposal.verdict.validated = 37;
  proposal.verdict.refuted_by = "Pull()";
  CHECK(
      says("Right on 38 of 38 fresh random sequences of the plan's events, and on 37 of the 40 "
           "that ordered the proposals; refuted by Pull()."));
  CHECK(is_refuted_by_sequence(proposal, result));

  CHECK_FALSE(says("only if events happen that nothing demands"));
  proposal.verdict.runs_undemanded = 2;
  CHECK(says("It follows 2 runs only if events happen that nothing demands"));
  CHECK(json().at("runs_undemanded") == 2);
  proposal.agrees_less = true;
  CHECK(says("The unchanged model agrees with more runs"));
  CHECK(json().at("agrees_less") == true);

  // An open outcome admits either one.
  proposal.open = true;
  CHECK_FALSE(says("random sequence"));
  CHECK_FALSE(json().contains("sequences_right"));
  CHECK_FALSE(is_refuted_by_sequence(proposal, result));
}

}  // namespace
}  // namespace parallax::tools
