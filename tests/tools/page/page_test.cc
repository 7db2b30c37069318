// Pages as they are written from data, without a run: hashes, hostile names, many simulations.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "harness/confidence/clean_runs.h"
#include "harness/confidence/rounding.h"
#include "harness/recording/recording.h"
#include "tests/tools/page/html_check.h"
#include "tools/page/csp_hash.h"
#include "tools/page/gather.h"
#include "tools/page/markup.h"
#include "tools/page/plot.h"
#include "tools/page/rates_page.h"
#include "tools/page/write_page.h"

namespace parallax::test {
namespace {

using namespace parallax::tools;  // NOLINT: the namespace under test

TEST_CASE("the hash of an empty script as browsers write it") {
  CHECK(csp_hash("") == "sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=");
}

/// A page with everything in it, whose names are `name`.
PageData page_named(const std::string& name, std::int64_t samples) {
  PageData page;
  page.folder = page.scenario = page.simulator = page.criterion = page.exploration = name;
  page.tool_version = name;
  page.verdict = "discrepancy";
  page.banners = {name};
  page.simulations = samples;
  PageTrace trace;
  trace.number = 1;
  trace.verdict = "discrepancy";
  trace.claim = trace.paper_variant = name;
  trace.caveats = trace.not_covered = {name};
  trace.simulations = samples;
  trace.clean = samples - 1;
  trace.steps = {{name, name + ":1", {}, {}, {}}};
  trace.causes = {{name, 1, 0.1, 0.0, 0.2}};
  page.traces = {trace};
  auto& reported = page.discrepancies.emplace_back();
  reported.words = name;
  auto& found = reported.found;
  found.trace = found.sample = 1;
  found.first_divergence = 1;
  found.cause.text = found.cause.reason = name;
  found.first = {{name, 1, true, false}};
  found.record.initial = {{name, name}};
  page.coverage = {{name, "1", "2"}};
  PageTimeline timeline;
  timeline.trace = timeline.sample = 1;
  timeline.verdict = PageVerdict::kDiscrepancy;
  timeline.steps = {{name, "plan.lisp:2", "failed", name, 1.0}};
  timeline.rows = {{name, "11", "10", TimelineRow::Role::kFirst, true},
                   {name + "2", "00", "00", TimelineRow::Role::kAgrees, false}};
  timeline.parting = 1;
  page.timelines = {timeline};
  page.variables = {name, "b.mass"};
  page.bodies = {name};
  for (std::int64_t i = 1; i <= samples; ++i) {
    PageSample sample;
    sample.trace = 1;
    sample.sample = i;
    sample.verdict = i == 1 ? PageVerdict::kDiscrepancy : PageVerdict::kClean;
    sample.cause = i == 1 ? name : "";
    const auto at = static_cast<float>(i) / 100.0F;
    sample.start = {static_cast<double>(i), 1.0 / static_cast<double>(i)};
    sample.ways = {{{at, 0.0F}, {at, 1.0F}, {0.0F, at}}};
    page.samples.push_back(sample);
  }
  PageRegion region;
  region.name = name;
  region.x = {0.0, 1.0};
  page.regions = {region};
  page.sources = {{name + ".lisp", name + "\n"},
                  {"plan.lisp", "; one\n(perform \"" + name + "\")\n"}};
  page.axioms = {{name, {{"plan.lisp:1", name}}}};
  PageBlame blame;
  blame.words = blame.more = blame.cause = name;
  blame.axioms = {{"plan.lisp:1", name}};
  page.blame = blame;
  page.rule = PageRule{{{"b.mass", 0.5, true}}, 9, 10, 1, 20};
  page.proposals = {
      {name, "--- a\n+++ b\n-" + name + "\n+" + name + "\n", {name}, {2}, true, name}};
  page.repair_notes = {name};
  PageProofMap map{name, "b.mass", {0.0, 30.0}, {0.0, 1.0}, true, {}};
  map.parts = {{{0.0, 15.0}, {0.0, 1.0}, 1.0, 0.0}, {{15.0, 30.0}, {0.0, 1.0}, 0.0, 1.0}};
  page.proofs = {
      {name,
       name,
       1,
       2,
       name,
       true,
       {{name, "", {{name, name, name, {name}, 0.5, 0.5, 0.0, map, {}}}}, {name, name, {}}}}};
  return page;
}

TEST_CASE("names of a run folder are text on the page, whatever they hold") {
  const std::string names[] = {
      "<script>alert(1)</script>",
      "</script></style></title><img src=x onerror=alert(1)>",
      "\" onclick=\"alert(1)\" x='",
      "<!-- ]]> <![CDATA[ &lt;script&gt;",
      "\xE2\x80\xAE\xE2\x81\xA6 turned \xD8\x9C\xE2\x80\x8F",
      std::string("\0\x01\x1b[31m\x7f\xff\xc0\x80", 11),
      std::string(1 << 20, 'x') + "</section>",
      "javascript:alert(1)",
  };
  const auto plain = check_html(run_page(page_named("plain", 30)));
  for (const auto& name : names) {
    CAPTURE(name.substr(0, 60));
    const auto page = page_named(name, 30);
    for (const auto& text : {run_page(page), comparison_page({page, page_named("other", 3)})}) {
      const auto shown = check_html(text);
      for (const auto& fault : shown.faults) FAIL_CHECK(fault);
      CHECK(shown.elements.at("script") <= 2);
      CHECK(shown.elements.at("style") == 1);
      // Nothing turns the direction of writing, as characters or as references to them.
      for (const auto* turning :
           {"\xE2\x80\xAE", "\xE2\x81\xA6", "\xE2\x80\x8F", "\xD8\x9C", "&#x20"}) {
        CHECK(text.find(turning) == std::string::npos);
      }
      CHECK(text.size() < 16'000'000);
    }
    const auto shown = check_html(run_page(page));
    CHECK(shown.text.find("Simulations") != std::string::npos);
    CHECK(shown.style == plain.style);
    CHECK(shown.script == plain.script);
    CHECK(shown.policy == plain.policy);
    CHECK(nlohmann::json::accept(shown.data));
  }
}

/// A simulation in which something moves, everything of which is called `name`.
std::shared_ptr<const harness::Recording> recording_named(const std::string& name) {
  auto out = std::make_shared<harness::Recording>();
  out->trace = out->sample = 1;
  out->missing = name;
  out->interval_s = 0.1;
  harness::RecordedBody body;
  body.name = name;
  body.moves = true;
  body.shapes = {{harness::ShapeKind::kBox, {0.1, 0.2, 0.3}, {}}};
  out->scene.bodies = {body};
  out->scene.grippers = {name};
  out->scene.arms = {{name, 0, 0, {0.0, 0.0, 1.0}, 0.2, 0.9}};
  out->events = {{name, 0.0, 1.0, name, name, {{name, 0.5}}}};
  out->observations = {{}, {}};
  harness::MotionWriter frames({1, 1});
  const harness::Pose poses[] = {{{1.0, 2.0, 3.0}}};
  CHECK(frames.add(0.0, poses, {}));
  out->frames = frames.take();
  return out;
}

TEST_CASE("motion brings its scripts, and nothing in it is markup") {
  for (const auto& name : {std::string("plain"), std::string("</script><img src=x>\" \xE2\x80\xAE"),
                           std::string(1 << 20, 'x')}) {
    CAPTURE(name.substr(0, 60));
    auto page = page_named("plain", 3);
    page.motion = {{1, 1, PageVerdict::kDiscrepancy, name, 1, recording_named(name)},
                   {1, 2, PageVerdict::kClean, name, {}, recording_named(name)}};
    const auto text = run_page(page);
    const auto shown = check_html(text);
    for (const auto& fault : shown.faults) FAIL_CHECK(fault);
    CHECK(shown.elements.at("script") == 5);
    CHECK(text.find("\xE2\x80\xAE") == std::string::npos);
    std::size_t hashes = 0;
    for (auto at = shown.policy.find("sha256-"); at != std::string::npos;
         at = shown.policy.find("sha256-", at + 1)) {
      ++hashes;
    }
    CHECK(hashes == 4);
    const auto motion = nlohmann::json::parse(shown.motion);
    REQUIRE(motion["runs"].size() == 2);
    CHECK(motion["scenes"].size() == 1);
    CHECK(motion["runs"][0]["beside"] == 1);
    CHECK(motion["runs"][0]["parting"] == 0);
    CHECK(shown.text.find("Recorded motion of 2 simulations") != std::string::npos);
    CHECK(text.find("The MIT License") != std::string::npos);
  }
  // Where there is none, there are no scripts for it either.
  CHECK(run_page(page_named("plain", 3)).find("The MIT License") == std::string::npos);
}

TEST_CASE("the policy lets run what is in the page, by its hash, and nothing else") {
  const auto page = check_html(run_page(page_named("plain", 3)));
  CHECK(page.policy == "default-src 'none'; style-src '" + csp_hash(page.style) +
                           "'; script-src '" + csp_hash(page.script) +
                           "'; base-uri 'none'; form-action 'none'");
  // No address but that of the name space of SVG.
  CHECK(page.style.find("url(") == std::string::npos);
  CHECK(page.style.find("@import") == std::string::npos);
  auto script = page.script;
  const std::string name_space = "http://www.w3.org/2000/svg";
  REQUIRE(script.find(name_space) != std::string::npos);
  script.erase(script.find(name_space), name_space.size());
  for (const auto* word :
       {"http:", "https:", "fetch(", "XMLHttpRequest", "import(", "eval(", "innerHTML"}) {
    CHECK_MESSAGE(script.find(word) == std::string::npos, word);
  }
}

TEST_CASE("a page without scripts has verdict, timeline, table and the decisive rule") {
  const auto page = check_html(run_page(page_named("some name", 30)));
  for (const auto* part : {"discrepancy", "timeline", "map", "starts", "confidence", "blame",
                           "samples", "coverage", "traces", "sources"}) {
    CHECK_MESSAGE(page.ids.contains(part), part);
  }
  CHECK(page.text.find("Discrepancy, not confirmed\n") != std::string::npos);
  CHECK(page.text.find("differs first") != std::string::npos);
  CHECK(page.text.find("Simulations fail where b.mass > 0.5") != std::string::npos);
  CHECK(page.text.find("parallax replay 'some name' --sample 1.30") != std::string::npos);
}

/// Executions of which every second one began where the start was chosen, and failed there.
PageData executions(std::int64_t samples) {
  auto page = page_named("plain", samples);
  page.closed_loop = true;
  page.confidence = 0.99;
  auto& trace = page.traces.front();
  trace.paths = {{"Go(r1), Go(r2): too-far", "failed: too-far", 3, 2}};
  trace.certified_confidence = 0.99;
  trace.certified_epsilon = harness::bound_after(samples / 2, 0.99);
  for (auto& sample : page.samples) {
    const bool chosen = sample.sample % 2 == 0;
    sample.origin = chosen ? SampleOrigin::kChosen : SampleOrigin::kDrawn;
    sample.verdict = chosen ? PageVerdict::kDiscrepancy : PageVerdict::kClean;
  }
  return page;
}

TEST_CASE("confidence is that of the runs whose starts were drawn") {
  auto page = executions(60);
  page.proofs.clear();
  const auto shown = check_html(run_page(page)).text;
  CHECK(shown.find("Executions: 30 runs, 0 not clean. Not counted: 30 with starts") !=
        std::string::npos);
  CHECK(shown.find("stop after 30: " + harness::percent_up(harness::bound_after(30, 0.99))) !=
        std::string::npos);
  CHECK(shown.find("Certified with 99 % confidence: fewer than " +
                   harness::percent_up(harness::bound_after(30, 0.99))) != std::string::npos);
  CHECK(shown.find("Trace 1") == std::string::npos);
  CHECK(shown.find("Go(r1), Go(r2): too-far") != std::string::npos);
  // With failures the certified level is another one, and that one is shown.
  for (auto& sample : page.samples) {
    if (sample.sample < 5) sample.verdict = PageVerdict::kDiscrepancy;
  }
  page.traces.front().certified_confidence = 0.98;
  page.traces.front().certified_epsilon = harness::mixture_upper(2, 30, 0.99);
  const auto failing = check_html(run_page(page)).text;
  CHECK(failing.find("stop after 30: " + percent(harness::mixture_upper(2, 30, 0.99))) !=
        std::string::npos);
  CHECK(failing.find("Certified with 98 % confidence") != std::string::npos);
  // An execution that did not end: nothing is claimed, and no curve says otherwise.
  page.samples[10].verdict = PageVerdict::kClean;
  page.samples[10].unfinished = true;
  const auto unfinished = check_html(run_page(page)).text;
  CHECK(unfinished.find("Nothing is claimed: an execution did not end") != std::string::npos);
  CHECK(unfinished.find("stop after") == std::string::npos);
  CHECK(unfinished.find("did not end") != std::string::npos);
  // Nor where not every execution was judged.
  page.samples[10].unfinished = false;
  page.samples[12].verdict = PageVerdict::kNotJudged;
  const auto open = check_html(run_page(page)).text;
  CHECK(open.find("1 are not judged one by one, so there is no curve") != std::string::npos);
  CHECK(open.find("stop after") == std::string::npos);
}

TEST_CASE("simulations that no claim is about are told from others in map and table") {
  auto page = page_named("plain", 6);
  page.samples[1].origin = SampleOrigin::kSearch;
  page.samples[2].origin = SampleOrigin::kChosen;
  page.samples[3].origin = SampleOrigin::kFurther;
  const auto text = run_page(page);
  const auto shown = check_html(text);
  for (const auto* word : {"search", "chosen start", "made afterwards", "pale: 3 whose starts"}) {
    CHECK_MESSAGE(shown.text.find(word) != std::string::npos, word);
  }
  CHECK(text.find("class=\"dot clean aside ring\"") != std::string::npos);
  const auto data = nlohmann::json::parse(shown.data);
  CHECK(data["samples"][0][4] == 0);
  CHECK(data["samples"][1][4] == 2);
}

TEST_CASE("what is claimed is told of the trace that decided the verdict first") {
  auto page = page_named("plain", 3);
  page.traces.push_back(page.traces.front());
  page.traces[0].verdict = "no-discrepancy";
  page.traces[0].claim = "the claim of one";
  page.traces[1].number = 2;
  page.traces[1].claim = "the claim of two";
  page.discrepancies[0].found.trace = 2;
  for (const auto& text : {run_page(page), comparison_page({page, page_named("other", 3)})}) {
    const auto shown = check_html(text).text;
    const auto two = shown.find("the claim of two"), one = shown.find("the claim of one");
    CHECK(two != std::string::npos);
    CHECK(two < one);
  }
}

TEST_CASE("traces with the same events and other starts stay apart when runs are compared") {
  auto first = page_named("plain", 3), second = first;
  first.traces.front().initial_state = {"At(r1)", "Box(b)"};
  first.traces.push_back(first.traces.front());
  first.traces[1].number = 2;
  first.traces[1].initial_state = {"At(r2)", "Box(b)"};
  second.traces.front().initial_state = {"At(r2)", "Box(b)"};
  const auto shown = check_html(comparison_page({first, second})).text;
  CHECK(shown.find("1 in all runs, 1 lost (the first has them), 0 gained") != std::string::npos);
  CHECK(shown.find("from At(r1)") != std::string::npos);
  CHECK(shown.find("from At(r2)") != std::string::npos);
  // Where the events say it all, another way to begin is no other trace.
  first.traces.pop_back();
  const auto same = check_html(comparison_page({first, second})).text;
  CHECK(same.find("1 in all runs, 0 lost") != std::string::npos);
}

TEST_CASE("proposals come with their evidence, their ties, and the word precaution") {
  auto page = page_named("plain", 3);
  page.proposals = {{"one", "", {"Consistent with 3 of 4 runs."}, {2}, true, "model"},
                    {"two", "", {"Other facts."}, {1}, false, "plan"}};
  page.repair_notes = {"A tie: proposals 1 to 2 are of one rank."};
  const auto shown = check_html(run_page(page)).text;
  for (const auto* words : {"Consistent with 3 of 4 runs.", "tied with 2", "precaution",
                            "of the plan", "A tie: proposals 1 to 2 are of one rank."}) {
    CHECK_MESSAGE(shown.find(words) != std::string::npos, words);
  }
}

TEST_CASE("that runs from one start contradict each other is told before what to change") {
  auto page = page_named("plain", 3);
  page.blame->words = "The model says otherwise.";
  page.blame->cause = "It is chance.";
  const auto at = [&](const std::string& words) {
    const auto place = check_html(run_page(page)).text.find(words);
    CHECK(place != std::string::npos);
    return place;
  };
  CHECK(at(page.blame->words) < at(page.blame->cause));
  page.blame->cause_first = true;
  CHECK(at(page.blame->cause) < at(page.blame->words));
}

TEST_CASE("the dots of very many simulations are a canvas's to draw") {
  const auto page = page_named("plain", 5000);
  const auto text = run_page(page);
  CHECK(text.size() < 12'000'000);
  const auto shown = check_html(text);
  for (const auto& fault : shown.faults) FAIL_CHECK(fault);
  std::size_t dots = 0;
  for (auto at = text.find("h0M"); at != std::string::npos; at = text.find("h0M", at + 1)) ++dots;
  CHECK(dots < 10 * kMostDots);
  CHECK(text.find("data-dots=\"map\"") != std::string::npos);
  CHECK(text.find("data-dots=\"starts\"") != std::string::npos);
  CHECK(shown.text.find("Of 5000 simulations 1000 are drawn") != std::string::npos);
  CHECK(shown.elements.at("script") == 3);
  const auto data = nlohmann::json::parse(shown.data);
  REQUIRE(data["samples"].size() == 5000);
  CHECK(data["samples"][4999][5].size() == 2);
  CHECK(check_html(run_page(page_named("plain", 30))).elements.at("script") == 2);
}

TEST_CASE("an empty page is one, too") {
  PageData page;
  page.banners = {"nothing is there"};
  const auto shown = check_html(run_page(page));
  for (const auto& fault : shown.faults) FAIL_CHECK(fault);
  CHECK(shown.text.find("nothing is there") != std::string::npos);
}

TEST_CASE("thousands of simulations stay within the size that is promised") {
  const auto text = run_page(page_named("cup", 5000));
  CHECK(text.size() < 12'000'000);
  const auto page = check_html(text);
  for (const auto& fault : page.faults) FAIL_CHECK(fault);
  CHECK(page.elements.at("tr") > 5000);
  CHECK(nlohmann::json::parse(page.data)["samples"].size() == 5000);
}

TEST_CASE("a report of any kind of damage gives what it has") {
  PageData page;
  CHECK_FALSE(add_report("", page));
  CHECK_FALSE(add_report("{\"traces\": [", page));
  CHECK_FALSE(add_report("[]", page));
  CHECK_FALSE(add_report("{}", page));
  // Every field of a wrong type, and none at all.
  const std::string wrong =
      R"x({"traces": [{"trace": "x", "events": [1, "Go()"], "sources": 3, "certified": 1, )x"
      R"x("paper": [], "causes": {}}, 7], "discrepancies": [3, {"first": [1], "start": 2, "cause": []}], )x"
      R"x("coverage": {"performs": 1}, "criterion": {"confidence": 7, "epsilon": -1}, "simulator": ""})x";
  CHECK(add_report(wrong, page));
  CHECK(page.traces.size() == 2);
  CHECK(page.traces[0].steps.size() == 1);
  const auto shown = check_html(run_page(page));
  for (const auto& fault : shown.faults) FAIL_CHECK(fault);
}

TEST_CASE("the charts of rates are no wider than what a narrow screen can show") {
  harness::RatesResult result;
  auto& trace = result.traces.emplace_back();
  trace.number = 1;
  trace.runs = 60;
  trace.any.cause = "any";
  trace.any.upper = 0.4;
  harness::CauseRate rate;
  rate.cause =
      "PutDown(cup1,table): first not At(cup1,table), then a reason of many words that ends";
  rate.count = 18;
  rate.upper = 0.4;
  trace.causes = {rate};
  const auto page = rates_page(result, {});
  const std::regex view("<svg[^>]*viewBox=\"0 0 ([0-9]+)");
  std::size_t charts = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), view), end; at != end; ++at) {
    ++charts;
    CHECK(std::stoi((*at)[1]) <= 460);
  }
  CHECK(charts > 0);
  // A long name takes several lines, none of which leaves the chart.
  CHECK(page.find(">PutDown(cup1,table): first not At(cup1,table), then a</text>") !=
        std::string::npos);
  CHECK(page.find(">reason of many words that ends</text>") != std::string::npos);
}

TEST_CASE("ticks are round, within the axis, and few") {
  CHECK(ticks(0.0, 1.0, 5) == std::vector<double>{0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0});
  CHECK(ticks(1.0, 1.0, 5).empty());
  CHECK(ticks(0.0, INFINITY, 5).empty());
  CHECK(ticks(-1e300, 1e300, 5).size() < 50);
}

TEST_CASE("source lines are coloured by their language and stay what they say") {
  CHECK(coloured("Go(r2) ; \"why\"", "a.e") == "Go(r2) <b class=\"sc\">; &quot;why&quot;</b>");
  CHECK(coloured("sort region", "a.e") == "<b class=\"sk\">sort</b> region");
  CHECK(coloured("(\"open", "a.lisp") == "(<b class=\"ss\">&quot;open</b>");
  CHECK(coloured("(\"a\\", "a.lisp") == "(<b class=\"ss\">&quot;a\\</b>");
}

}  // namespace
}  // namespace parallax::test
