// The language server as an editor has it: a process and two pipes.

#include <doctest/doctest.h>

#include <set>
#include <string>

#include "tests/tools/lsp/editor_desk.h"

namespace parallax::test {
namespace {

using Json = EditorClient::Json;

TEST_CASE("a misspelled name is told with its fix while it is typed, and the fix mends it") {
  Desk desk;
  const auto path = desk.path("domain.e");
  auto text = desk.read("domain.e");
  desk.editor.open(path, text);
  CHECK(desk.editor.diagnostics(path, 1).empty());
  const auto place = text.find("HoldsAt(Holding()") + 8;
  desk.editor.edit(path, text, place, place + 7, "Holdng", 2);
  text.replace(place, 7, "Holdng");
  const auto wrong = desk.editor.diagnostics(path, 2);
  REQUIRE(wrong.size() == 1);
  CHECK(wrong[0]["code"] == "E2101");
  CHECK(wrong[0]["range"]["start"] == place_in(text, place));
  const auto actions =
      desk.editor.ask("textDocument/codeAction", {{"textDocument", {{"uri", uri(path)}}},
                                                  {"range", wrong[0]["range"]},
                                                  {"context", {{"diagnostics", wrong}}}});
  REQUIRE(actions.size() == 1);
  const auto edit = actions[0]["edit"]["changes"][uri(path)][0];
  CHECK(edit["newText"] == "Holding");
  desk.editor.note(
      "textDocument/didChange",
      {{"textDocument", {{"uri", uri(path)}, {"version", 3}}},
       {"contentChanges", Json::array({{{"range", edit["range"]}, {"text", edit["newText"]}}})}});
  CHECK(desk.editor.diagnostics(path, 3).empty());
}

TEST_CASE("an error in a file is told there when another file is open that reads it") {
  Desk desk;
  desk.replace("domain.e", "Initiates(Go(region),RobotIn(region),time)",
               "Initiates(Go(region),RobotAt(region),time)");
  const auto scenario = desk.path("scenario.yaml");
  desk.editor.open(scenario, desk.read("scenario.yaml"));
  CHECK(desk.editor.diagnostics(scenario, 1).empty());
  // It is not open, so it has no version.
  const auto told = desk.editor.diagnostics(desk.path("domain.e"), -1);
  REQUIRE(!told.empty());
  CHECK(told[0]["code"] == "E2101");
}

TEST_CASE("hover, definition and references know every file of the scenario") {
  Desk desk;
  const auto path = desk.path("domain.e");
  desk.editor.open(path, desk.read("domain.e"));
  const auto at = desk.at("domain.e", "BoxIn(region)");
  const auto hover =
      desk.editor.ask("textDocument/hover", at)["contents"]["value"].get<std::string>();
  CHECK(hover.find("fluent BoxIn(region)") != std::string::npos);
  CHECK(hover.find("Initiates(Place(region),BoxIn(region),time)") != std::string::npos);
  CHECK(desk.editor.ask("textDocument/hover", desk.at("domain.e", "Initiates"))["contents"]["value"]
            .get<std::string>()
            .find("`Initiates(event, fluent, time)`") == 0);
  const auto definition = desk.editor.ask(
      "textDocument/definition",
      desk.at("domain.e", "HoldsAt(RobotIn(region1)") /* in HoldsAt: nothing of the model */);
  CHECK(definition.is_null());
  std::set<std::string> files;
  for (const auto& place : desk.editor.ask("textDocument/references", at)) {
    const auto text = place["uri"].get<std::string>();
    files.insert(text.substr(text.rfind('/') + 1));
  }
  CHECK(files == std::set<std::string>{"common.yaml", "domain.e", "edge.yaml", "robot.bind",
                                       "scenario.yaml", "start.e"});
}

/// Applies the edits of a rename to the files on disk.
void apply_edits(const Desk& desk, const Json& changes) {
  for (const auto& [where, edits] : changes.items()) {
    const auto name = where.substr(where.rfind('/') + 1);
    const auto text = desk.read(name);
    std::vector<std::size_t> lines = {0};
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') lines.push_back(i + 1);
    }
    auto renamed = text;
    std::vector<Json> ordered(edits.begin(), edits.end());
    for (auto edit = ordered.rbegin(); edit != ordered.rend(); ++edit) {
      const auto offset = [&](const char* end) {
        const auto& place = (*edit)["range"][end];
        return lines[place["line"].get<std::size_t>()] + place["character"].get<std::size_t>();
      };
      renamed.replace(offset("start"), offset("end") - offset("start"),
                      (*edit)["newText"].get<std::string>());
    }
    desk.write(name, renamed);
  }
}

TEST_CASE("a renamed sort, constant, fluent and event give scenarios that say the same") {
  for (const auto& [old, fresh] : {std::pair{"sort region", "place"},
                                   {"region r1", "left"},
                                   {"fluent BoxIn", "CrateIn"},
                                   {"event PickUp", "Grasp"}}) {
    Desk desk;
    const auto before = desk.parallax({"traces", "scenario.yaml", "--json"}).out;
    desk.editor.open(desk.path("domain.e"), desk.read("domain.e"));
    const auto text = desk.read("domain.e");
    const auto word = std::string(old).substr(std::string(old).find(' ') + 1);
    auto at = desk.at("domain.e", old);
    at["position"] = place_in(text, text.find(old) + std::string(old).find(' ') + 1);
    at["newName"] = fresh;
    const auto answer = desk.editor.ask("textDocument/rename", at);
    REQUIRE(answer.contains("changes"));
    apply_edits(desk, answer["changes"]);
    for (const auto* scenario : {"scenario.yaml", "edge.yaml", "wrong_model.yaml"}) {
      CAPTURE(fresh);
      CHECK(desk.parallax({"check", scenario}).code == 0);
    }
    const auto count = [](const std::string& traces) { return Json::parse(traces)["list"].size(); };
    CHECK(count(desk.parallax({"traces", "scenario.yaml", "--json"}).out) == count(before));
    CHECK(desk.read("domain.e").find(word + "(") == std::string::npos);
  }
}

TEST_CASE("a name that is taken, or is none, is refused and nothing changes") {
  Desk desk;
  desk.editor.open(desk.path("domain.e"), desk.read("domain.e"));
  auto at = desk.at("domain.e", "BoxIn(region)");
  for (const auto* name : {"Holding", "9x", "a b", ""}) {
    at["newName"] = name;
    const auto answer = desk.editor.ask("textDocument/rename", at);
    CAPTURE(name);
    CHECK(answer.value("code", 0) == -32803);
  }
}

TEST_CASE("places count UTF-16 units, or bytes where the editor offers them") {
  for (const bool bytes : {false, true}) {
    CliFixture files;
    EditorClient editor;
    const Json units = bytes ? Json::array({"utf-16", "utf-8"}) : Json::array({"utf-16"});
    editor.ask("initialize", {{"capabilities", {{"general", {{"positionEncodings", units}}}}}});
    files.write("accents.e",
                "; \xF0\x9F\xA4\x96 \xC3\xA9 Up\nsort room\nfluent Up()\n[time] /* "
                "\xF0\x9F\xA4\x96 */ HoldsAt(Down(),time).\nrange time 0 1\n");
    const auto path = std::filesystem::canonical(files.folder() / "accents.e").string();
    editor.open(path, files.read("accents.e"));
    for (const auto& one : editor.diagnostics(path, 1)) {
      if (one["code"] != "E2101") continue;
      const auto line = std::string("[time] /* \xF0\x9F\xA4\x96 */ HoldsAt(");
      CHECK(one["range"]["start"]["character"] == (bytes ? line.size() : line.size() - 2));
    }
  }
}

}  // namespace
}  // namespace parallax::test
