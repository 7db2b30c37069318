// Names of plans and tables, kinds of words, and the commands above a file.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "tests/tools/lsp/editor_desk.h"

namespace parallax::test {
namespace {

using Json = EditorClient::Json;

/// "robot.bind:3" for every place, lines from 1.
std::multiset<std::string> lines_of(const Json& locations) {
  std::multiset<std::string> out;
  for (const auto& one : locations) {
    const auto address = one["uri"].get<std::string>();
    out.insert(address.substr(address.rfind('/') + 1) + ":" +
               std::to_string(one["range"]["start"]["line"].get<int>() + 1));
  }
  return out;
}

TEST_CASE("what a plan performs leads to the table's entry and to the model's event") {
  Desk desk;
  desk.open("fetch.lisp");
  const auto at = desk.at("fetch.lisp", "picking-up");
  CHECK(lines_of(desk.editor.ask("textDocument/definition", at)) ==
        std::multiset<std::string>{"domain.e:12", "robot.bind:5"});
  CHECK(lines_of(desk.editor.ask("textDocument/references", at)) ==
        std::multiset<std::string>{"fetch.lisp:12", "robot.bind:5"});
  const auto hover =
      desk.editor.ask("textDocument/hover", at)["contents"]["value"].get<std::string>();
  CHECK(hover.find("action picking-up (:object ?o) -> PickUp()") != std::string::npos);
  CHECK(hover.find("event PickUp()") != std::string::npos);
}

TEST_CASE("references of an event are also the performs of plans, which a rename leaves alone") {
  Desk desk;
  desk.open("domain.e");
  auto at = desk.at("domain.e", "PickUp()");
  const auto references = lines_of(desk.editor.ask("textDocument/references", at));
  for (const auto* place : {"domain.e:12", "robot.bind:5", "fetch.lisp:12"}) {
    CAPTURE(place);
    CHECK(references.count(place) == 1);
  }
  at["newName"] = "Grasp";
  for (const auto& [where, edits] : desk.editor.ask("textDocument/rename", at)["changes"].items())
    CHECK(!where.ends_with(".lisp"));
}

TEST_CASE("a table's entry knows the plans that perform it, and a function its calls") {
  Desk desk;
  desk.open("robot.bind");
  CHECK(lines_of(desk.editor.ask("textDocument/references", desk.at("robot.bind", "going"))) ==
        std::multiset<std::string>{"edge.lisp:14", "edge.lisp:16", "fetch.lisp:11", "fetch.lisp:13",
                                   "hasty.lisp:9", "robot.bind:3"});
  desk.open("fetch.lisp");
  CHECK(lines_of(desk.editor.ask("textDocument/references", desk.at("fetch.lisp", "fetch-box"))) ==
        std::multiset<std::string>{"fetch.lisp:17", "fetch.lisp:8"});
  const auto outline = desk.editor.ask("textDocument/documentSymbol", desk.document("fetch.lisp"));
  REQUIRE(outline.size() == 1);
  CHECK(outline[0]["name"] == "fetch-box");
}

TEST_CASE("packages, aliases, questions and goals are followed, also where brackets are open") {
  Desk desk;
  desk.write(
      "robot.bind",
      "motion going (:target ?p) -> Go(region(?p)) ok: always\n"
      "action navigating|driving = going ; action fetching (:object ?o) -> plan fetch-it(?o)\n"
      "query box-there (?r) ok: BoxIn(?r) @t\n"
      "goal (held ?o) -> Holding()\n"
      "action half-typed (:ob");
  desk.write(
      "fetch.lisp",
      "(defun fetch-it (?o) \"(type going)\" #| (a motion (type going)) |#\n"
      "  (exe:perform (desig:an action (type NAVIGATING) (target (the object (type going)))))\n"
      "  (cram-utilities:prolog '(box-there ?r))\n"
      "  (perform (an action (type fetching) (goal (held ?o))))\n"
      "  (mapcar #'fetch-it (list 'fetch-it");
  desk.open("robot.bind");
  desk.open("fetch.lisp");
  const auto references = [&](const std::string& word) {
    auto out = lines_of(desk.editor.ask("textDocument/references", desk.at("robot.bind", word)));
    std::erase_if(out, [](const auto& line) {
      return line.starts_with("edge") || line.starts_with("hasty");
    });
    return out;
  };
  CHECK(references("navigating") == std::multiset<std::string>{"fetch.lisp:2", "robot.bind:2"});
  CHECK(references("fetch-it") ==
        std::multiset<std::string>{"fetch.lisp:1", "fetch.lisp:5", "fetch.lisp:5", "robot.bind:2"});
  CHECK(references("box-there") == std::multiset<std::string>{"fetch.lisp:3", "robot.bind:3"});
  CHECK(references("held") == std::multiset<std::string>{"fetch.lisp:4", "robot.bind:4"});
  CHECK(references("going") == std::multiset<std::string>{"robot.bind:1", "robot.bind:2"});
  // An alias performs what its entry performs.
  CHECK(lines_of(desk.editor.ask("textDocument/definition", desk.at("fetch.lisp", "NAVIGATING"))) ==
        std::multiset<std::string>{"domain.e:11", "robot.bind:2"});
}

TEST_CASE("an action has another name in the table and in every plan, or none at all") {
  Desk desk;
  desk.open("robot.bind");
  auto at = desk.at("robot.bind", "placing");
  at["newName"] = "putting-down";
  const auto answer = desk.editor.ask("textDocument/rename", at);
  REQUIRE(answer.contains("changes"));
  std::set<std::string> files;
  for (const auto& [where, edits] : answer["changes"].items()) {
    files.insert(where.substr(where.rfind('/') + 1));
    for (const auto& edit : edits) CHECK(edit["newText"] == "putting-down");
  }
  CHECK(files == std::set<std::string>{"edge.lisp", "fetch.lisp", "hasty.lisp", "robot.bind"});
  for (const auto* name : {"picking-up", "", "a b", "Upper", "x)"}) {
    at["newName"] = name;
    CAPTURE(name);
    CHECK(desk.editor.ask("textDocument/rename", at).value("code", 0) == -32803);
  }
}

/// "word type" of every token of an open file.
std::vector<std::string> tokens_of(Desk& desk, const std::string& name) {
  EditorClient other;
  const auto legend =
      other.ask("initialize",
                Json::object())["capabilities"]["semanticTokensProvider"]["legend"]["tokenTypes"];
  std::vector<std::string> lines = {""};
  for (const char c : desk.read(name)) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  const auto data =
      desk.editor.ask("textDocument/semanticTokens/full", desk.document(name))["data"];
  REQUIRE(data.size() % 5 == 0);
  std::vector<std::string> out;
  std::size_t line = 0, column = 0;
  for (std::size_t i = 0; i < data.size(); i += 5) {
    const auto lines_on = data[i].get<std::size_t>(), columns_on = data[i + 1].get<std::size_t>();
    line += lines_on;
    column = lines_on == 0 ? column + columns_on : columns_on;
    REQUIRE(line < lines.size());
    const auto length = data[i + 2].get<std::size_t>();
    REQUIRE(column + length <= lines[line].size());
    out.push_back(lines[line].substr(column, length) + " " +
                  legend[data[i + 3].get<std::size_t>()].get<std::string>());
  }
  return out;
}

TEST_CASE("words are told by their kind: model, table, plan and scenario") {
  Desk desk;
  desk.write("small.e",
             "sort room ; rooms\n"
             "room hall\n"
             "fluent In(room)\n"
             "event Go(room)\n"
             "predicate Door(room,room)\n"
             "range time 0 2\n"
             "[room1,time] Door(room1,hall) & time>1.5 -> Initiates(Go(room1),In(room1),time).\n");
  desk.open("small.e");
  CHECK(tokens_of(desk, "small.e") ==
        std::vector<std::string>{
            "sort keyword",    "room type",      "; rooms comment",   "room type",
            "hall enumMember", "fluent keyword", "In property",       "room type",
            "event keyword",   "Go event",       "room type",         "predicate keyword",
            "Door function",   "room type",      "room type",         "range keyword",
            "time type",       "0 number",       "2 number",          "room1 variable",
            "time variable",   "Door function",  "room1 variable",    "hall enumMember",
            "time variable",   "1.5 number",     "Initiates keyword", "Go event",
            "room1 variable",  "In property",    "room1 variable",    "time variable"});
  desk.open("robot.bind");
  const auto table = tokens_of(desk, "robot.bind");
  const auto has = [](const std::vector<std::string>& tokens, const std::string& token) {
    CAPTURE(token);
    return std::find(tokens.begin(), tokens.end(), token) != tokens.end();
  };
  CHECK(table.front() == "; What the plan's designators mean in the model. comment");
  for (const auto* token :
       {"motion keyword", "going event", "?p variable", "Go event", "ok keyword",
        "RobotIn property", "1 number", "else keyword", "picking-up event"})
    CHECK(has(table, token));
  desk.open("fetch.lisp");
  const auto plan = tokens_of(desk, "fetch.lisp");
  for (const auto* token :
       {"defparameter keyword", "\"map\" string", "0.0 number", "?there variable",
        "def-cram-function keyword", "fetch-box function", "going event"})
    CHECK(has(plan, token));
  CHECK(plan.front().ends_with(" comment"));
  desk.open("common.yaml");
  const auto yaml = tokens_of(desk, "common.yaml");
  CHECK(yaml.front().ends_with(" comment"));
  for (const auto* token : {"r1 enumMember", "0 number", "RobotIn property", "Go event"})
    CHECK(has(yaml, token));
}

TEST_CASE("a file offers the commands of the scenarios that read it, and of itself") {
  Desk desk;
  const auto commands = [&](const std::string& name) {
    desk.open(name);
    std::vector<std::string> out;
    for (const auto& lens : desk.editor.ask("textDocument/codeLens", desk.document(name))) {
      const auto& command = lens["command"];
      const auto file = command["arguments"][0].get<std::string>();
      out.push_back(command["command"].get<std::string>() + " " + file.substr(file.rfind('/') + 1) +
                    " '" + command["title"].get<std::string>() + "'");
    }
    return out;
  };
  CHECK(commands("scenario.yaml") ==
        std::vector<std::string>{"parallax.run scenario.yaml 'run'",
                                 "parallax.traces scenario.yaml 'traces'",
                                 "parallax.explain scenario.yaml 'explain'"});
  CHECK(commands("wrong_domain.e") ==
        std::vector<std::string>{"parallax.run wrong_model.yaml 'run wrong_model.yaml'",
                                 "parallax.traces wrong_model.yaml 'traces wrong_model.yaml'",
                                 "parallax.explain wrong_model.yaml 'explain wrong_model.yaml'"});
  desk.write("alone.e", "sort room\nrange time 0 1\n");
  CHECK(commands("alone.e") == std::vector<std::string>{"parallax.traces alone.e 'traces'",
                                                        "parallax.explain alone.e 'explain'"});
  CHECK(commands("fetch.lisp").empty());
}

}  // namespace
}  // namespace parallax::test
