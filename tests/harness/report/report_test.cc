#include "harness/report/report.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "compiler/base/utf8.h"
#include "harness/campaign/second_opinion.h"
#include "harness/report/text_layout.h"
#include "tests/harness/campaign/named_trace.h"

namespace parallax::harness {
namespace {

using Json = nlohmann::json;

CampaignResult sample_result() {
  CampaignResult result;
  result.scenario = "scenarios/two.yaml";
  result.title = "two traces";
  result.seed = 7;
  result.verdict = CampaignVerdict::kDiscrepancy;
  result.exploration = "all traces explored";
  result.simulator = {"ode", "0.16.2", "bitwise", true, {}, {}, 0.002};
  result.tool_version = "0.1.0";
  result.replay_folder = "out/two";
  result.simulations = 11;
  using How = ComparedFluents::How;
  result.compared = {{"BoxIn(..)", How::kEveryStep, ""},
                     {"LookingAt(..)", How::kIgnored, ""},
                     {"Happy()", How::kIgnored, "a matter of taste"},
                     {"RobotIn(..)", How::kAtTheEnd, ""},
                     {"Tired()", How::kIgnored, ""}};
  TraceResult clean;
  const auto trace = [](std::int64_t number) {
    return std::make_shared<const CampaignTrace>(
        test::named_trace(number, {}, {{"RobotIn(r1)", "BoxIn(r2)"}, {"BoxIn(r2)"}, {}},
                          {{"Go(r2)", {"fetch.lisp:4", {}}}, {"PickUp()", {"fetch.lisp:10", {}}}}));
  };
  clean.trace = trace(1);
  clean.verdict = CampaignVerdict::kNoDiscrepancy;
  clean.start_region = {{"box.x", {1.0, 2.0, false}}, {"robot.yaw", {0.5, 0.5, true}}};
  clean.start_shares = {{"box", "r2", 0.25, {{"x", 0.25, 1.0}}, {"yaw"}}};
  clean.simulations = clean.clean = 7;
  clean.certified_level = 0.99;
  clean.certified_epsilon = 0.482053;
  clean.paper_stopped_at = 3;
  clean.paper_variant = "paper-literal, n = 2";
  clean.claim =
      "with 99 % confidence, fewer than 48.3 % of start states drawn uniformly from the "
      "start region give a discrepancy (7 clean runs of 7)";
  clean.caveats = {"3 of 10 drawn were rejected (30 %)"};
  auto diverging = clean;
  diverging.trace = trace(2);
  diverging.verdict = CampaignVerdict::kDiscrepancy;
  diverging.simulations = 4;
  diverging.clean = 3;
  diverging.paper_stopped_at.reset();
  diverging.claim = "1 of 4 runs gave a discrepancy";
  diverging.caveats.clear();
  result.traces = {clean, diverging};
  Discrepancy found;
  found.trace = 2;
  found.sample = 4;
  found.seed = 123;
  found.first_divergence = 1;
  found.first = {{"RobotIn(r2)", 1, true, false}};
  found.fluents = {{"BoxIn(r1)", 2, true, false}, {"BoxIn(r2)", 2, false, true}};
  found.cause = {
      "Place(r1): box-lost", "box-lost: nothing in the gripper", "Place(r1)", {"BoxIn(r1)"}};
  found.record.initial = {{"box.x", 1.25}};
  found.end = {{"box.held", false}, {"box.x", 1.0055}};
  found.record.outcomes = {{SimStatus::kOk, "", 2.0},
                           {SimStatus::kFailed, "nothing between the pads\n\x1b[31m", 1.5}};
  result.discrepancies = {found};
  result.timing = {1.5, 30.0, 11};
  return result;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST_CASE("the text fits 100 columns and carries no colour unless asked for") {
  const auto result = sample_result();
  const auto text = campaign_text(result, {});
  for (const auto& line : lines_of(text)) {
    CAPTURE(line);
    CHECK(base::count_code_points(line) <= 100);
    CHECK(line.find_last_not_of(' ') + 1 == line.size());
  }
  CHECK(text.find('\x1b') == std::string::npos);
  CHECK(text.ends_with('\n'));
  const auto colored = campaign_text(result, {true});
  CHECK(colored.find("\x1b[1;31mdiscrepancy\x1b[0m") != std::string::npos);
  CHECK(colored.find("verdict: \x1b[1;31mdiscrepancy, not confirmed\x1b[0m") != std::string::npos);
}

TEST_CASE("the text says events with places, both figures, the claim, and how to repeat") {
  const auto text = campaign_text(sample_result(), {});
  for (const std::string part :
       {"1  PickUp()  fetch.lisp:10\n",
        "of the cells box in r2  25 %  x 0.25 of 1, fixed yaw\n",
        "with 99 % confidence p < 48.3 %",
        "satisfied after 3 runs",
        "[not a probability of error]",
        "start region give a discrepancy (7 clean runs of 7)",
        "in simulation 2.4, seed 123, repeated bit for bit\n",
        "    BoxIn(r1)    2          true       false\n",
        "at timepoint 1, after Go(r2) (fetch.lisp:4): RobotIn(r2) is false instead of true",
        "PickUp(), failed after 1.500 s: nothing between the pads \\u001b[31m",
        "box.x = 1.25",
        "parallax replay out/two --sample 2.4",
        "verdict: discrepancy",
        "about        two traces",
        "3 of 10 drawn were rejected (30 %)",
        "  start state  BoxIn(r2), RobotIn(r1)\n",
        "  start region box.x      1 to 2\n               robot.yaw  0.5\n",
        "  every step   BoxIn(..)\n",
        "  only the end RobotIn(..)\n",
        "  not compared LookingAt(..), Tired()\n",
        "  not compared Happy(): a matter of taste\n",
        "    RobotIn(r2)  1          true       false\n",
        "    end        box.held = false, box.x = 1.0055\n"}) {
    CAPTURE(part);
    CHECK(text.find(part) != std::string::npos);
  }
}

/// The text with one blank wherever it has blanks or begins a new line.
std::string unwrapped(const std::string& text) {
  std::istringstream stream(text);
  std::string out;
  for (std::string word; stream >> word;) out += (out.empty() ? "" : " ") + word;
  return out;
}

TEST_CASE("the summary says first what parted them, then where and how often") {
  auto result = sample_result();
  result.journal_open = true;
  result.simulator.parameters = {{"box.x", "m", true}};
  const auto summary = [&] { return campaign_summary(result, {}); };
  const auto text = summary();
  CHECK(
      text.starts_with("discrepancy, not confirmed: at the start RobotIn(r2) is false, and the "
                       "model says true\n"));
  for (const std::string part :
       {"     0  Go(r2)    fetch.lisp:4   ok\n", "     1  PickUp()  fetch.lisp:10  ",
        "    RobotIn(r2)  true       false     at the start\n",
        "      BoxIn(r1)  true       false     and so at the end\n", "  start     box.x = 1.25 m\n",
        "  trace 1  no discrepancy found  7 clean of 7  p < 48.3 % with 99 % confidence\n",
        "  trace 2  discrepancy           3 clean of 4\n",
        "trace 1: 3 of 10 drawn were rejected (30 %)", "seed 7, compared",
        "  next      parallax report out/two\n",
        "            parallax replay out/two --sample 2.4\n",
        "            parallax explain out/two\n"}) {
    CAPTURE(part);
    CHECK(text.find(part) != std::string::npos);
  }
  auto& found = result.discrepancies[0];
  found.cause = {"PickUp(): box-lost", "box-lost: nothing in the gripper"};
  found.first_divergence = 2;
  found.first = found.fluents;
  // The headline is one line, and the reason stands below it where that is long.
  CHECK(summary().starts_with(
      "discrepancy, not confirmed: PickUp() fails, and the model says that it succeeds\n"
      "  reason    nothing between the pads \\u001b[31m\n"));
  CHECK(summary().find("  *  1  PickUp()  fetch.lisp:10  failed: nothing between the pads") !=
        std::string::npos);
  found.record.outcomes[1].reason = "box-lost: " + std::string(200, 'x') + " twice";
  CHECK(summary().starts_with(
      "discrepancy, not confirmed: PickUp() fails (box-lost), and the model says that it succeeds\n"
      "  reason    box-lost:\n            xxx"));
  CHECK(summary().find("and so at the end") == std::string::npos);
  // No action failed: the summary names an effect that the event should have had.
  found.record.outcomes[1] = {SimStatus::kOk, "", 1.5};
  CHECK(
      unwrapped(summary()).starts_with("discrepancy, not confirmed: after PickUp() BoxIn(r1) is "
                                       "false, and the model says true (1 other fluent differs) "));
  found.kind = DiscrepancyKind::kTransient;

  CHECK(unwrapped(summary()).find("; it ends as predicted 0 Go(r2)") != std::string::npos);
  result.comparison = Comparison::kFinal;
  CHECK(unwrapped(summary()).find("seed 7, compared at the end ") != std::string::npos);
  // Without differences everything is claimed first.
  result = sample_result();
  result.verdict = CampaignVerdict::kNoDiscrepancy;
  result.traces.pop_back();
  result.discrepancies.clear();
  CHECK(summary().starts_with("no discrepancy found\n  claim     with 99 % confidence, fewer"));
  CHECK(summary().find("  events    Go(r2), PickUp()\n") != std::string::npos);
}

TEST_CASE("a discrepancy that another simulator does not show is in doubt in every headline") {
  auto result = sample_result();
  result.journal_open = true;
  auto opinion = std::make_shared<SecondOpinion>();
  opinion->first = "ode 0.16.2";
  opinion->other = "mujoco 2.2.2";
  opinion->opinions = {{2, 4, true, "Place(r1): box-lost", OpinionAnswer::kClean, ""}};
  result.second_opinion = opinion;
  auto summary = unwrapped(campaign_summary(result, {}));
  CHECK(
      summary.starts_with("discrepancy in doubt: at the start RobotIn(r2) is false, and the model "
                          "says true standing in doubt: mujoco agrees with the model "));
  CHECK(campaign_text(result, {}).find("\nverdict: discrepancy in doubt\n") != std::string::npos);
  CHECK(campaign_text(result, {}).find("    standing   in doubt: mujoco agrees with the model\n") !=
        std::string::npos);
  CHECK(Json::parse(campaign_json(result, false)).at("discrepancies").at(0).at("standing") ==
        Json({{"is", "in-doubt"}, {"words", "in doubt: mujoco agrees with the model"}}));
  // Another one that both show is told in its place, and the commands name it.
  auto other = result.discrepancies[0];
  other.sample = 9;
  other.first = {{"RobotIn(r9)", 1, true, false}};
  result.discrepancies.push_back(other);
  opinion->opinions.push_back({2, 9, true, "other", OpinionAnswer::kDiscrepancy, "the same"});
  const auto text = campaign_summary(result, {});
  summary = unwrapped(text);
  CHECK(
      summary.starts_with("discrepancy, confirmed: at the start RobotIn(r9) is false, and the "
                          "model says true standing confirmed: mujoco disagrees with the model as "
                          "well "));
  CHECK(text.find("  2.4       in doubt: at the start RobotIn(r2)") != std::string::npos);
  CHECK(text.find("parallax confirm out/two --sample 2.9\n") != std::string::npos);
  CHECK(campaign_text(result, {}).find("\nverdict: discrepancy, confirmed\n") != std::string::npos);
  // No answer is none.
  opinion->opinions = {{2, 4, true, "Place(r1): box-lost", OpinionAnswer::kNone, "lost"}};
  result.discrepancies.pop_back();
  CHECK(campaign_summary(result, {}).starts_with("discrepancy, not confirmed: "));
  CHECK(unwrapped(campaign_text(result, {})).find("the step; mujoco gave no answer") !=
        std::string::npos);
}

TEST_CASE("what was lost is told by reason") {
  auto result = sample_result();
  result.traces[0].lost = 3;
  result.traces[0].losses = {{"of the solver", 2, 4}, {"it ended during `act`", 1, 6}};
  result.traces[1].lost = 1;
  result.traces[1].losses = {{"of the solver", 1, 2}};
  const auto text = campaign_text(result, {});
  CHECK(text.find("  lost         2 runs: of the solver, first in 1.4\n") != std::string::npos);
  CHECK(text.find("  lost         1 run: it ended during `act`, first in 1.6\n") !=
        std::string::npos);
  CHECK(campaign_summary(result, {})
            .find("  lost      of the solver (3), it ended during `act` (1)\n") !=
        std::string::npos);
  const auto json = Json::parse(campaign_json(result, false));
  CHECK(json.at("traces").at(0).at("losses") ==
        Json({{{"reason", "of the solver"}, {"count", 2}, {"example", 4}},
              {{"reason", "it ended during `act`"}, {"count", 1}, {"example", 6}}}));
  CHECK_FALSE(
      Json::parse(campaign_json(sample_result(), false)).at("traces").at(0).contains("losses"));
}

TEST_CASE("the summary fits a screen whatever there is to say") {
  auto result = sample_result();
  result.journal_open = true;
  auto found = result.discrepancies[0];
  found.first_divergence = 60;
  found.cause = {"Go(r30): not BoxIn(r30)", {}};
  std::vector<test::NamedEvent> events;
  for (int i = 0; i < 80; ++i) {
    events.push_back({"Go(r" + std::to_string(i) + ")", {"a/folder/fetch.lisp:4", {}}});
    found.record.initial["body" + std::to_string(i) + ".x"] = 1.0 / (i + 3);
    found.first.push_back({"BoxIn(r" + std::to_string(i) + ")", 60, true, false});
    found.fluents.push_back({"RobotIn(r" + std::to_string(i) + ")", 80, true, false});
  }
  found.record.outcomes.assign(80, {SimStatus::kOk, "", 1.0});
  auto long_one = result.traces[1];
  for (int i = 0; i < 80; ++i) {
    long_one.start_region.push_back({"body" + std::to_string(i) + ".x", {0.0, 1.0, false}});
  }
  std::vector<std::vector<std::string>> states(events.size() + 1);
  result.traces.clear();
  result.discrepancies.clear();
  for (int i = 1; i <= 50; ++i) {
    long_one.trace =
        std::make_shared<const CampaignTrace>(test::named_trace(i, {}, states, events));
    long_one.caveats = {std::string(2000, 'x') + " " + std::to_string(i), "a common one"};
    result.traces.push_back(long_one);
    found.trace = i;
    result.discrepancies.push_back(found);
  }
  const auto lines = lines_of(campaign_summary(result, {}));
  CHECK(lines.size() < 50);
  for (const auto& line : lines) {
    CAPTURE(line);
    CHECK(base::count_code_points(line) <= 100);
  }
}

TEST_CASE("the paper's figure stands in a trace's account once") {
  const auto text = campaign_text(sample_result(), {});
  const auto first = text.find("satisfied after 3 runs");
  REQUIRE(first != std::string::npos);
  CHECK(text.find("paper's rule", first) > text.find("trace 2"));
}

TEST_CASE("a discrepancy begins with its cause") {
  auto result = sample_result();
  CHECK(campaign_text(result, {})
            .find("    cause      Place(r1): box-lost: nothing in the gripper\n    first seen ") !=
        std::string::npos);
  const auto json = Json::parse(campaign_json(result, true));
  CHECK(json.at("discrepancies").at(0).at("cause") ==
        Json({{"text", "Place(r1): box-lost"},
              {"reason", "box-lost: nothing in the gripper"},
              {"event", "Place(r1)"},
              {"fluents", {"BoxIn(r1)"}}}));
  result.discrepancies[0].cause = {"Place(r1): not BoxIn(r1)", {}};
  CHECK(campaign_text(result, {}).find("    cause      Place(r1): not BoxIn(r1)\n") !=
        std::string::npos);
}

TEST_CASE("actions that ended otherwise than predicted are listed, and what follows is marked") {
  auto result = sample_result();
  const std::string failure = "event 1, PickUp(), failed after 1.500 s: nothing between the pads";
  const std::string mark = "(follows from what differed before)";
  const auto text = [&] {
    std::string joined;  // wrapped lines as one
    for (const auto& line : lines_of(campaign_text(result, {}))) {
      joined += " " + line.substr(std::min(line.find_first_not_of(' '), line.size()));
    }
    return joined;
  };
  CHECK(text().find(failure) != std::string::npos);
  CHECK(text().find(mark) != std::string::npos);
  result.discrepancies[0].first_divergence = 2;  // it is what led away
  CHECK(text().find(failure) != std::string::npos);
  CHECK(text().find(mark) == std::string::npos);
  for (auto& trace : result.traces) {  // the model says so
    auto predicted = *trace.trace;
    predicted.points[1].plan_step = 1;
    predicted.points[1].succeeded = false;
    trace.trace = std::make_shared<const CampaignTrace>(std::move(predicted));
  }
  CHECK(text().find(failure) == std::string::npos);
  result.discrepancies[0].record.outcomes[1] = {SimStatus::kOk, "", 1.5};
  CHECK(text().find("event 1, PickUp(), ok after 1.500 s, though the model lets it fail") !=
        std::string::npos);
  // No model predicts that an action takes too long.
  result.discrepancies[0].record.outcomes[1] = {SimStatus::kTruncated, "", 9.0};
  CHECK(text().find("event 1, PickUp(), truncated after") != std::string::npos);
}

TEST_CASE("a divergence at the last timepoint is told once") {
  auto result = sample_result();
  auto& found = result.discrepancies[0];
  CHECK(campaign_text(result, {}).find("first seen") != std::string::npos);
  found.first_divergence = 2;
  found.first = found.fluents;
  CHECK(campaign_text(result, {}).find("first seen") == std::string::npos);
}

TEST_CASE("the command that repeats a discrepancy names the folder as it was given") {
  auto result = sample_result();
  const auto& found = result.discrepancies[0];
  CHECK(replay_command("out/two", found) == "parallax replay out/two --sample 2.4");
  CHECK(replay_command("my runs/it's", found) == "parallax replay 'my runs/it'\\''s' --sample 2.4");
  CHECK(shell_word("") == "''");
  CHECK(shell_word("-x") == "'-x'");
  CHECK(shell_word("$(rm)") == "'$(rm)'");
  result.replay_folder = std::string(120, 'd');
  CHECK(campaign_text(result, {})
            .find("parallax replay " + result.replay_folder + " --sample 2.4\n") !=
        std::string::npos);
}

TEST_CASE("the document has the fields that scripts read") {
  const auto line = campaign_json(sample_result(), true);
  CHECK(std::count(line.begin(), line.end(), '\n') == 1);
  const auto json = Json::parse(line);
  CHECK(json.at("status") == "ok");
  CHECK(json.at("scenario") == "scenarios/two.yaml");
  CHECK(json.at("seed") == 7);
  CHECK(json.at("verdict") == "discrepancy");
  CHECK(json.at("iterations") == 2);
  CHECK(json.at("simulations") == 11);
  CHECK(json.at("exploration") == "all traces explored");
  const auto& trace = json.at("traces").at(0);
  CHECK(trace.at("trace") == 1);
  CHECK(trace.at("verdict") == "no-discrepancy");
  CHECK(trace.at("events") == Json({"Go(r2)", "PickUp()"}));
  CHECK(trace.at("simulations") == 7);
  CHECK(trace.at("guided") == 0);
  CHECK(trace.at("certified") == Json({{"confidence", 0.99}, {"epsilon", 0.482053}}));
  CHECK(trace.at("paper").at("stopped_at") == 3);
  CHECK(json.at("traces").at(1).at("paper").at("stopped_at").is_null());
  CHECK(trace.at("lost") == 0);
  CHECK(trace.at("rejected") == 0);
  CHECK(trace.at("retried") == 0);
  CHECK(trace.at("admitted") == 0);
  CHECK(trace.at("initial_state") == Json({"BoxIn(r2)", "RobotIn(r1)"}));
  CHECK(trace.at("start_region") == Json({{"box.x", {1.0, 2.0}}, {"robot.yaw", 0.5}}));
  CHECK(trace.at("start_shares") == Json::array({Json{{"body", "box"},
                                                      {"region", "r2"},
                                                      {"share", 0.25},
                                                      {"axes", {{"x", {0.25, 1.0}}}},
                                                      {"fixed", {"yaw"}}}}));
  CHECK(trace.at("not_compared") == Json({"LookingAt(..)", "Happy()", "Tired()"}));
  CHECK(json.at("compare") == "every-step");
  CHECK(json.at("compared").at(2) ==
        Json({{"fluent", "Happy()"}, {"compared", "ignored"}, {"why", "a matter of taste"}}));
  CHECK(json.at("compared").at(3) == Json({{"fluent", "RobotIn(..)"}, {"compared", "final"}}));
  const auto& found = json.at("discrepancies").at(0);
  CHECK(found.at("trace") == 2);
  CHECK(found.at("sample") == 4);
  CHECK(found.at("seed") == 123);
  CHECK(found.at("kind") == "lasting");
  CHECK(found.at("first_divergence") == 1);
  CHECK(
      found.at("fluents").at(0) ==
      Json({{"fluent", "BoxIn(r1)"}, {"timepoint", 2}, {"predicted", true}, {"observed", false}}));
  CHECK(found.at("end") == Json({{"box.held", false}, {"box.x", 1.0055}}));
  CHECK(found.at("replay") == "parallax replay out/two --sample 2.4");
  CHECK(json.at("timing").at("runs_made") == 11);
}

TEST_CASE("only `timing` depends on the clock") {
  auto one = sample_result();
  auto two = one;
  two.timing = {99.0, 1.0, 3};
  CHECK(campaign_json(one, true) != campaign_json(two, true));
  CHECK(campaign_json(one, false) == campaign_json(two, false));
  CHECK_FALSE(Json::parse(campaign_json(one, false)).contains("timing"));
  CHECK(campaign_text(one, {}) == campaign_text(two, {}));
}

TEST_CASE("exit codes follow the verdict") {
  auto result = sample_result();
  CHECK(exit_code(result) == 1);
  result.verdict = CampaignVerdict::kInconclusive;
  CHECK(exit_code(result) == 4);
  result.verdict = CampaignVerdict::kNoDiscrepancy;
  CHECK(exit_code(result) == 0);
}

TEST_CASE("wrapping breaks at blanks, keeps long words whole and counts code points") {
  CHECK(wrapped("ab ", "", 3) == "ab \n");
  CHECK(wrapped("", "one  two\nthree", 0) == "one two three\n");
  std::string words;
  for (int i = 0; i < 30; ++i) words += "w\xc3\xb6rter ";
  for (const auto& line : lines_of(wrapped("label ", words, 6)))
    CHECK(base::count_code_points(line) <= 100);
  const std::string word(150, 'x');
  CHECK(wrapped("  ", word, 2) == "  " + word + "\n");
  CHECK(wrapped("  ", "a " + word, 2) == "  a\n  " + word + "\n");
}

TEST_CASE("tables align on the widest cell") {
  CHECK(table({{"a", "bb"}, {"c\xc3\xa4sar", "d"}}, 1) == " a      bb\n c\xc3\xa4sar  d\n");
}

}  // namespace
}  // namespace parallax::harness
