// Hovers, beyond declarations: clauses and their cost, and values in the last run. The
// oracles are `compile --stats --json` and the journal of the run.

#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/lsp/editor_desk.h"

namespace parallax::test {
namespace {

using Json = EditorClient::Json;

std::string hover_at(Desk& desk, const Json& place) {
  const auto answer = desk.editor.ask("textDocument/hover", place);
  return answer.is_null() ? "" : answer["contents"]["value"].get<std::string>();
}

/// The place behind the first letter of a line.
Json at_line(const Desk& desk, const std::string& name, int line) {
  auto out = desk.document(name);
  out["position"] = {{"line", line - 1}, {"character", 1}};
  return out;
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

TEST_CASE("a hover on an axiom has the clauses, literals and instances that compile counts") {
  Desk desk;
  const auto path = desk.path("domain.e");
  desk.open("domain.e");
  const auto compiled = desk.parallax({"compile", desk.path("edge.yaml"), "--stats", "--json", "-o",
                                       (desk.folder() / "edge.dec.cnf").string()});
  REQUIRE(compiled.code == 0);
  std::size_t seen = 0, with_clauses = 0;
  const auto document = Json::parse(compiled.out);
  for (const auto& cost : document["axioms"]) {
    const auto place = cost["place"].get<std::string>();
    const auto colon = place.rfind(':');
    if (std::filesystem::weakly_canonical(desk.folder() / place.substr(0, colon)) != path) continue;
    auto where = at_line(desk, "domain.e", std::stoi(place.substr(colon + 1)));
    // A frame axiom belongs to the declared name.
    if (cost["what"] == "frame axiom")
      where["position"]["character"] = std::string("fluent ").size() + 1;
    const auto words = hover_at(desk, where);
    CAPTURE(place);
    CAPTURE(words);
    auto expected = cost["what"].get<std::string>() + ": " +
                    counted(cost["clauses"].get<std::size_t>(), "clause") + ", " +
                    counted(cost["literals"].get<std::size_t>(), "literal");
    if (cost["full_expansion"].get<std::size_t>() > 0) {
      expected += "; " + cost["instances"].dump() + " of " + cost["full_expansion"].dump() +
                  " instances grounded";
    }
    CHECK(words.find(expected + "\n") != std::string::npos);
    ++seen;
    if (cost["clauses"].get<std::size_t>() > 0 && cost["full_expansion"].get<std::size_t>() > 0) {
      ++with_clauses;
      CHECK(words.find("\n```\n") != std::string::npos);
    }
  }
  CHECK(seen > 5);
  CHECK(with_clauses > 0);
}

TEST_CASE("the clauses are those of the text as it is edited; with an error there are none") {
  Desk desk;
  const std::string text =
      "sort agent\nagent James\nfluent On()\nevent Press(agent)\nrange time 0 2\n"
      "[agent,time] Initiates(Press(agent),On(),time).\n!HoldsAt(On(),0).\n";
  desk.write("lamp.e", text);
  desk.open("lamp.e");
  const auto hover = [&] { return hover_at(desk, at_line(desk, "lamp.e", 6)); };
  const auto one = hover();
  CHECK(one.find("effect axiom: ") != std::string::npos);
  CHECK(one.find("; 1 of 1 instances grounded") == std::string::npos);
  const auto more = text.find("James") + 5;
  desk.editor.edit(desk.path("lamp.e"), text, more, more, ", Mary", 2);
  const auto two = hover();
  CHECK(two != one);
  CHECK(two.find("Press(Mary)") != std::string::npos);
  auto edited = text;
  edited.insert(more, ", Mary");
  const auto wrong = edited.find("On(),time");
  desk.editor.edit(desk.path("lamp.e"), edited, wrong, wrong + 2, "Off", 3);
  CHECK(hover().find("clause") == std::string::npos);
}

/// The timepoints of a list such as `0-2, 4`.
std::vector<std::size_t> timepoints(const std::string& list) {
  std::vector<std::size_t> out;
  std::istringstream in(list);
  for (std::string span; std::getline(in, span, ',');) {
    const auto first = std::stoul(span);
    const auto dash = span.find('-');
    const auto last = dash == std::string::npos ? first : std::stoul(span.substr(dash + 1));
    for (auto t = first; t <= last; ++t) out.push_back(t);
  }
  return out;
}

TEST_CASE("a hover on a fluent has its values in the last trace of the newest run") {
  Desk desk;
  desk.open("domain.e");
  const auto at = desk.at("domain.e", "BoxIn(region)");
  CHECK(hover_at(desk, at).find("in trace ") == std::string::npos);
  const auto run = [&](const char* scenario, const std::string& folder) {
    desk.parallax({"run", scenario, "--out", folder, "--quiet"});
  };
  run("scenario.yaml", "out/clean");
  run("edge.yaml", "out/edge");
  // A broken journal is passed over.
  std::filesystem::create_directories(desk.folder() / "out/broken");
  desk.write("out/broken/journal.ndjson", "{\"journal\":");
  Json last;
  std::istringstream journal(desk.read("out/edge/journal.ndjson"));
  for (std::string line; std::getline(journal, line);) {
    auto parsed = Json::parse(line);
    if (parsed.contains("holds")) last = std::move(parsed);
  }
  REQUIRE(last.is_object());
  std::map<std::string, std::vector<std::size_t>> expected;
  for (std::size_t t = 0; t < last["holds"].size(); ++t) {
    for (const auto& name : last["holds"][t]) {
      if (name.get<std::string>().starts_with("BoxIn("))
        expected[name.get<std::string>()].push_back(t);
    }
  }
  REQUIRE(!expected.empty());
  const auto words = hover_at(desk, at);
  CAPTURE(words);
  CHECK(words.find("in trace " + last["trace"].dump() + " of `edge`, 0-" +
                   std::to_string(last["holds"].size() - 1) + ": true at\n") != std::string::npos);
  for (const auto& [name, times] : expected) {
    const auto begin = words.find("\n" + name + ": ");
    REQUIRE(begin != std::string::npos);
    const auto list = begin + name.size() + 3;
    CHECK(timepoints(words.substr(list, words.find('\n', list) - list)) == times);
  }
  // Another scenario of the same model was run last.
  run("scenario.yaml", "out/newest");
  CHECK(hover_at(desk, at).find(" of `newest`, ") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
