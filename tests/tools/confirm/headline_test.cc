// What repetitions say of a discrepancy, in the headlines of page and suite.

#include "tests/tools/confirm/border_world.h"

namespace parallax::test {
namespace {

TEST_CASE("the headlines of page and suite have what the repetitions say") {
  const auto headline = [](const CliFixture& cli) {
    REQUIRE(cli.parallax({"report", "out"}).code == 0);
    const auto page = cli.read("out/report.html");
    const auto begin = page.find("<header"), end = page.find("<dl class=\"facts\"");
    REQUIRE(end != std::string::npos);
    return page.substr(begin, end - begin);
  };
  const BorderWorld always({"fails:cup.a>0.7"});
  CHECK(has(always.read("out/report.txt"), "verdict: discrepancy, not confirmed\n"));
  CHECK(has(headline(always), "<h1>Discrepancy, not confirmed</h1>"));
  CHECK(has(headline(always), "<code>parallax confirm out</code> repeats it with other seeds"));
  CHECK(always.confirm(1).at("standing").at("is") == "stands");
  CHECK(has(headline(always), "<h1>Discrepancy, confirmed</h1>"));
  CHECK(has(headline(always), "Confirmed: it happens in 5 of 5 runs with other seeds."));

  const BorderWorld chance({"fails:cup.a>0.5,seed%7"}, 1, {"--max-runs", "100"});
  CHECK(chance.confirm(4, {"--repeats", "10"}).at("verdict") == "seed");
  CHECK(has(headline(chance), "<header class=\"top open\">"));
  CHECK(has(headline(chance), "<h1>Discrepancy in doubt</h1>"));
  CHECK(has(headline(chance), "In doubt: it happens in "));

  chance.write("case.yaml", "include: s.yaml\nexpect: {verdict: no-discrepancy}\n");
  const auto suite = [&](Words more) {
    Words words = {"suite",      "case.yaml", "--allow-commands", "--junit",   "j.xml",
                   "--markdown", "m.md",      "--json",           "--no-cache"};
    words.insert(words.end(), more.begin(), more.end());
    return json_of(chance, words, 1).at("cases").at(0);
  };
  auto one = suite({});
  CHECK(one.at("standing") == "not-asked");
  CHECK(has(one.at("problems").at(0),
            "verdict discrepancy, expected no-discrepancy; the discrepancy "
            "is not confirmed: `parallax confirm out/suite/case.yaml` "));
  CHECK(has(chance.read("m.md"), "the discrepancy is not confirmed"));
  one = suite({"--confirm"});
  CHECK(one.at("standing") == "in-doubt");
  const std::string doubt = "the discrepancy is in doubt: it happens in ";
  CHECK(has(one.at("problems").at(0), doubt));
  CHECK(has(chance.read("m.md"), "the discrepancy is in doubt"));
  const auto junit = chance.read("j.xml");
  CHECK(has(junit.substr(junit.find("<failure message=")), doubt));
  const auto stored = Json::parse(chance.read("out/suite/results.json"));
  CHECK(stored.at("cases").at("case.yaml").at("standing") == "in-doubt");
}

}  // namespace
}  // namespace parallax::test
