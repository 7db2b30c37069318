// Random edits of a model, its plan, its binding table and its scenario, with questions in between.
// At sampled steps the messages are compared with those of `check` on the same texts.
// PARALLAX_DEEP: 20,000 edits.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/tools/lsp/editor_desk.h"

namespace parallax::test {
namespace {

using Json = EditorClient::Json;

/// An open file as the editor has it.
struct OpenFile {
  std::string name, original;
  std::size_t first = 0;  // edits begin behind this byte
  std::string text = {};
  int version = 1;
};

/// A message up to the first character that JSON output shows in another way, or to its first note.
std::string comparable(const std::string& message) {
  return message.substr(0, message.find_first_of("\n\t\r\\"));
}

/// Code, line, column and message of each message that has a place in the file.
std::set<std::string> told_about(const Json& diagnostics) {
  std::set<std::string> out;
  for (const auto& one : diagnostics) {
    const auto& start = one["range"]["start"];
    out.insert(one["code"].get<std::string>() + " " + std::to_string(start["line"].get<int>() + 1) +
               ":" + std::to_string(start["character"].get<int>() + 1) + " " +
               comparable(one["message"].get<std::string>()));
  }
  return out;
}

std::string lines(const std::set<std::string>& messages) {
  std::string out;
  for (const auto& message : messages) out += message + "\n";
  return out;
}

class Session {
 public:
  explicit Session(unsigned seed) : draws_(seed) {
    // A scenario stays one: its first lines say what it reads.
    const auto yaml = desk_.read("scenario.yaml");
    files_ = {{"domain.e", desk_.read("domain.e")},
              {"robot.bind", desk_.read("robot.bind")},
              {"fetch.lisp", desk_.read("fetch.lisp")},
              {"scenario.yaml", yaml, yaml.find("horizon:")}};
    for (auto& file : files_) {
      file.text = file.original;
      desk_.editor.open(desk_.path(file.name), file.text);
    }
  }

  void edit() {
    auto& file = files_[draws_() % files_.size()];
    const auto length = file.text.size() - file.first;
    const auto begin = file.first + draws_() % (length + 1);
    const auto end = std::min(file.text.size(), begin + draws_() % 12);
    replace(file, begin, end, piece());
    // Texts come back from time to time, so that not all of a check ends at the first line.
    if (file.text.size() > 3 * file.original.size() || draws_() % 12 == 0)
      replace(file, 0, file.text.size(), file.original);
  }

  void ask() {
    static constexpr const char* kQuestions[] = {
        "textDocument/hover",          "textDocument/definition",
        "textDocument/references",     "textDocument/documentHighlight",
        "textDocument/prepareRename",  "textDocument/completion",
        "textDocument/documentSymbol", "textDocument/formatting",
        "textDocument/codeLens",       "textDocument/semanticTokens/full",
        "textDocument/inlayHint",      "textDocument/codeAction",
        "textDocument/rename",         "no/such"};
    auto params = desk_.document(files_[draws_() % files_.size()].name);
    params["position"] = {{"line", draws_() % 60}, {"character", draws_() % 90}};
    params["range"] = {{"start", {{"line", draws_() % 60}, {"character", 0}}},
                       {"end", {{"line", draws_() % 90}, {"character", 3}}}};
    params["newName"] = "fresh";
    const auto answer = desk_.editor.ask(kQuestions[draws_() % std::size(kQuestions)], params);
    CHECK((answer.is_null() || answer.is_structured()));
  }

  /// Most edits break a file early. So that later errors and right texts are seen as well, two of
  /// three comparisons begin with texts that are whole again, and one edit or one edited file.
  void mend() {
    const auto how = draws_() % 3;
    const auto kept = draws_() % files_.size();
    for (std::size_t i = 0; how != 0 && i < files_.size(); ++i) {
      if (how == 1 || i != kept) replace(files_[i], 0, files_[i].text.size(), files_[i].original);
    }
    if (how == 1) edit();
  }

  /// Compares what was told about all files with what `check` says. Returns the number of messages.
  std::size_t compare() {
    // The file that changed last has a version that nothing was told about before.
    auto& file = files_[draws_() % files_.size()];
    replace(file, file.first, file.first, "");
    desk_.editor.diagnostics(desk_.path(file.name), file.version);
    desk_.editor.ask("no/such", Json::object());  // behind the last of the same check
    for (const auto& one : files_) desk_.write(one.name, one.text);
    std::map<std::string, std::set<std::string>> expected;
    for (const auto* root : {"edge.yaml", "scenario.yaml", "wrong_model.yaml"}) {
      const auto ran = desk_.parallax({"check", desk_.path(root), "--json"});
      for (const auto& one : Json::parse(ran.out).value("diagnostics", Json::array())) {
        if (!one.contains("path") || !one.contains("line")) continue;
        expected[one["path"].get<std::string>()].insert(
            one["code"].get<std::string>() + " " + one["line"].dump() + ":" + one["column"].dump() +
            " " + comparable(one["message"].get<std::string>()));
      }
    }
    std::size_t count = 0;
    for (const auto& one : files_) {
      CAPTURE(one.name);
      CAPTURE(one.text);
      const auto told = told_about(desk_.editor.last_diagnostics(desk_.path(one.name)));
      const auto& meant = expected[desk_.path(one.name)];
      CHECK(lines(told) == lines(meant));
      count += told.size();
    }
    return count;
  }

  int end() {
    desk_.editor.ask("shutdown", nullptr);
    desk_.editor.note("exit", nullptr);
    return desk_.editor.end();
  }

 private:
  std::string piece() {
    static constexpr const char* kPieces[] = {
        "",   " ",   ".",  "\n",        "region",  "BoxIn(", ")",     "; ", "!",
        "->", "x",   "[",  "Holding()", "{",       "\"",     "going", ": ", "- ",
        "#",  "(a ", "?p", "|",         "horizon", "r1",     "\t",    "'",  "12"};
    if (draws_() % 3 != 0) return kPieces[draws_() % std::size(kPieces)];
    std::string out;
    for (auto left = draws_() % 8; left > 0; --left)
      out += static_cast<char>(draws_() % 20 == 0 ? '\n' : ' ' + static_cast<char>(draws_() % 95));
    return out;
  }

  void replace(OpenFile& file, std::size_t begin, std::size_t end, const std::string& fresh) {
    desk_.editor.edit(desk_.path(file.name), file.text, begin, end, fresh, ++file.version);
    file.text.replace(begin, end - begin, fresh);
  }

  Desk desk_;
  std::mt19937 draws_;
  std::vector<OpenFile> files_;
};

TEST_CASE("after any edits the messages are those of check on the same texts") {
  const bool is_deep = std::getenv("PARALLAX_DEEP") != nullptr;
  const int edits = is_deep ? 20'000 : 1'000, between = is_deep ? 40 : 50;
  Session session(7);
  int with_messages = 0, compared = 0;
  for (int i = 1; i <= edits; ++i) {
    CAPTURE(i);
    session.edit();
    if (i % 4 == 0) session.ask();
    if (i % between != 0) continue;
    session.mend();
    with_messages += session.compare() > 0 ? 1 : 0;
    ++compared;
  }
  CHECK(with_messages > compared / 2);
  CHECK(with_messages < compared);
  MESSAGE(edits << " edits, compared at " << compared << ", with messages at " << with_messages);
  CHECK(session.end() == 0);
}

}  // namespace
}  // namespace parallax::test
