#pragma once

#include <filesystem>
#include <string>

#include "tests/tools/cli_fixture.h"
#include "tests/tools/lsp/editor_client.h"

namespace parallax::test {

/// An editor in a folder with a copy of scenarios/two_regions.
struct Desk : CliFixture {
  using Json = EditorClient::Json;

  Desk() { editor.ask("initialize", {{"capabilities", Json::object()}}); }
  std::string path(const std::string& name) const {
    return std::filesystem::canonical(folder() / name).string();
  }
  /// Opens a file with the text that it has on disk.
  void open(const std::string& name) { editor.open(path(name), read(name)); }
  /// The parameters of a question about an open file.
  Json document(const std::string& name) const {
    return {{"textDocument", {{"uri", uri(path(name))}}}};
  }
  /// The same about the place behind the first letter of a text's first occurrence.
  Json at(const std::string& name, const std::string& word) const {
    const auto text = read(name);
    auto out = document(name);
    out["position"] = place_in(text, text.find(word) + 1);
    return out;
  }

  EditorClient editor;
};

}  // namespace parallax::test
