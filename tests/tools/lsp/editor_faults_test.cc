// Clients that break the protocol, go away, or open files that no editor should.

#include <doctest/doctest.h>
#include <signal.h>

#include <cstdint>
#include <string>

#include "tests/tools/lsp/editor_desk.h"

namespace parallax::test {
namespace {

using Json = EditorClient::Json;

TEST_CASE("files outside of the folder, folders, devices and addresses that are no files") {
  Desk desk;
  auto& editor = desk.editor;
  const auto open = [&](const std::string& address, const std::string& text) {
    editor.note("textDocument/didOpen",
                {{"textDocument",
                  {{"uri", address}, {"languageId", "dec"}, {"version", 1}, {"text", text}}}});
  };
  // Ignored: questions about them are refused.
  for (const std::string address : {"untitled:Untitled-1", "http://example.org/domain.e",
                                    "file://host/domain.e", "", "file:///%00"}) {
    open(address, "sort s\n");
    const auto answer =
        editor.ask("textDocument/documentSymbol", {{"textDocument", {{"uri", address}}}});
    CAPTURE(address);
    CHECK(answer.value("code", 0) == -32602);
  }
  // Texts of their own, whatever lies there.
  for (const std::string address : {"file:///proc/nobody/wrong.e", "file:///dev/zero",
                                    "file:///dev", "file:///etc/../dev/x.e"}) {
    open(address, "sort s\n");
    const auto answer =
        editor.ask("textDocument/documentSymbol", {{"textDocument", {{"uri", address}}}});
    CAPTURE(address);
    CHECK(answer.is_array());
    editor.note("textDocument/didClose", {{"textDocument", {{"uri", address}}}});
  }
  // A model may not load what lies outside, also in an editor.
  desk.write("outside.e", "load ../../../../../../etc/hostname\nload /dev/zero\nsort s\n");
  desk.open("outside.e");
  const auto told = editor.diagnostics(desk.path("outside.e"), 1);
  REQUIRE(told.size() >= 2);
  for (const auto& one : told) CHECK(one["code"].get<std::string>().starts_with("E"));
}

TEST_CASE("a text that changes while it is checked is told about as it is in the end") {
  Desk desk;
  desk.replace("scenario.yaml", "horizon: 6", "horizon: 60");  // so that a check takes a moment
  const auto path = desk.path("domain.e");
  auto text = desk.read("domain.e");
  desk.open("domain.e");
  int version = 1;
  for (int round = 0; round < 60; ++round) {
    // A letter is typed and taken away, sometimes with a question in between.
    const auto place = text.find("Holding()");
    desk.editor.edit(path, text, place, place, "x", ++version);
    text.insert(place, "x");
    if (round % 7 == 0) desk.editor.ask("textDocument/hover", desk.at("domain.e", "Go(region)"));
    if (round % 3 == 0) desk.editor.note("textDocument/didSave", desk.document("domain.e"));
    desk.editor.edit(path, text, place, place + 1, "", ++version);
    text.erase(place, 1);
  }
  CHECK(desk.editor.diagnostics(path, version).empty());
  desk.editor.edit(path, text, text.find("fluent Holding()"), text.find("fluent Holding()"), "x",
                   ++version);
  CHECK(!desk.editor.diagnostics(path, version).empty());
}

TEST_CASE("what is no message, or comes at the wrong time, is refused or ends the server cleanly") {
  SUBCASE("before initialize, after shutdown, unknown and malformed requests") {
    EditorClient editor;
    CHECK(editor.ask("textDocument/hover", Json::object())["code"] == -32002);
    editor.raw("Content-Length: 7\r\n\r\nnothing");
    CHECK(editor.read()["error"]["code"] == -32700);
    editor.ask("initialize", {{"capabilities", Json::array()}});
    CHECK(editor.ask("nothing/known", Json::object())["code"] == -32601);
    CHECK(editor.ask("textDocument/hover", {{"textDocument", 3}})["code"] == -32602);
    editor.note("textDocument/didChange", {{"contentChanges", "no"}});
    editor.note("nothing/known", nullptr);
    editor.ask("shutdown", nullptr);
    CHECK(editor.ask("textDocument/hover", Json::object())["code"] == -32600);
    editor.note("exit", nullptr);
    CHECK(editor.end() == 0);
  }
  SUBCASE("exit without shutdown") {
    EditorClient editor;
    editor.note("exit", nullptr);
    CHECK(editor.end() == 1);
  }
  SUBCASE("the client goes away in the middle of a message") {
    EditorClient editor;
    editor.raw("Content-Length: 500\r\n\r\n{\"jsonrpc\":");
    editor.close_input();
    CHECK(editor.end() == 1);
  }
  SUBCASE("the client goes away while a text is checked") {
    Desk desk;
    desk.open("domain.e");
    desk.editor.close_input();
    CHECK(desk.editor.end() == 1);
  }
  SUBCASE("the client reads no more, asks on and goes away") {
    Desk desk;
    desk.open("domain.e");
    desk.editor.close_output();
    for (int i = 0; i < 100; ++i)
      desk.editor.note("textDocument/didSave", desk.document("domain.e"));
    desk.editor.close_input();
    CHECK(desk.editor.end() == 1);
  }
  SUBCASE("the client closes both pipes while a text is checked") {
    Desk desk;
    desk.open("domain.e");
    desk.editor.close_input();
    desk.editor.close_output();
    CHECK(desk.editor.end() == 1);
  }
  SUBCASE("headers whose length is no number, negative, or larger than any message") {
    for (const auto* length : {"x", "-1", "99999999999999999999999"}) {
      EditorClient editor;
      editor.raw(std::string("Content-Length: ") + length + "\r\n\r\n{}");
      CHECK(editor.end() == 1);
    }
    EditorClient editor;
    editor.raw("Content-Length: 900000000000\r\n\r\n{}");
    editor.close_input();
    CHECK(editor.end() == 1);
  }
  SUBCASE("JSON that is nested deeply, a list of messages, numbers and texts out of range") {
    Desk desk;
    auto& editor = desk.editor;
    const auto deep = std::string(200'000, '[') + std::string(200'000, ']');
    const auto body = "{\"jsonrpc\":\"2.0\",\"id\":" + deep + ",\"method\":\"shutdown\"}";
    editor.raw("Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    CHECK(editor.read()["error"]["code"] == -32600);
    editor.raw("Content-Length: 2\r\n\r\n[]");
    CHECK(editor.read()["error"]["code"] == -32700);
    const std::string surrogate = "{\"id\":7,\"method\":\"\\ud800\"}";
    editor.raw("Content-Length: " + std::to_string(surrogate.size()) + "\r\n\r\n" + surrogate);
    CHECK(editor.read()["error"]["code"] == -32700);
    desk.open("domain.e");
    auto at = desk.document("domain.e");
    for (const Json& line : {Json(-5), Json(1e300), Json(INT64_MAX), Json("1"), Json(nullptr)}) {
      at["position"] = {{"line", line}, {"character", line}};
      const auto answer = editor.ask("textDocument/hover", at);
      CHECK((answer.is_null() || answer.contains("contents") || answer["code"] == -32602));
    }
  }
  SUBCASE("a change that is malformed behind a good one changes nothing") {
    Desk desk;
    desk.open("domain.e");
    const auto path = desk.path("domain.e");
    CHECK(desk.editor.diagnostics(path, 1).empty());
    desk.editor.note("textDocument/didChange",
                     {{"textDocument", {{"uri", uri(path)}, {"version", 2}}},
                      {"contentChanges", Json::array({{{"text", "wrong"}}, {{"text", 3}}})}});
    CHECK(desk.editor.ask("textDocument/documentSymbol", desk.document("domain.e")).size() == 9);
  }
  SUBCASE("a header without end") {
    EditorClient editor;
    editor.raw(std::string(100'000, 'x'));
    CHECK(editor.end() == 1);
  }
  SUBCASE("a message of 100 MB is dropped, and the next one is answered") {
    EditorClient editor;
    const std::size_t size = 100'000'000;
    editor.raw("Content-Length: " + std::to_string(size) + "\r\n\r\n");
    const std::string piece(1'000'000, ' ');
    for (std::size_t sent = 0; sent < size; sent += piece.size()) editor.raw(piece);
    CHECK(editor.ask("initialize", Json::object()).contains("capabilities"));
  }
}

TEST_CASE("a server that waits for its client ends at the first signal") {
  for (const int signal : {SIGTERM, SIGINT}) {
    Desk desk;
    desk.open("domain.e");
    CHECK(desk.editor.diagnostics(desk.path("domain.e"), 1).is_array());
    REQUIRE(::kill(desk.editor.process(), signal) == 0);
    CHECK(desk.editor.end() == 128 + signal);
  }
}

}  // namespace
}  // namespace parallax::test
