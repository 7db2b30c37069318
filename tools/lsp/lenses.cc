// Commands above the first line of a file. A scenario can be run, listed and explained. A model
// offers the same of the scenarios that read it; where there is none, its traces and why there are
// none. The server starts nothing: an editor knows where its terminal is.

#include "tools/lsp/lenses.h"

#include <array>
#include <filesystem>
#include <string>

#include "tools/lsp/file_text.h"
#include "tools/lsp/project.h"

namespace parallax::tools::lsp {

Json lenses(Documents& documents, const Json& params) {
  const auto path = documents.asked_path(params);
  Json out = Json::array();
  if (!is_yaml(path) && !is_model(path)) return out;
  const Json range = range_of(documents.positions(path), 0, 0);
  for (const auto& root : roots_of(path, documents.text_of())) {
    for (const std::string command : {"run", "traces", "explain"}) {
      if (command == "run" && !is_yaml(root)) continue;
      const auto title =
          root == path ? command : command + " " + std::filesystem::path(root).filename().string();
      out.push_back({{"range", range},
                     {"command",
                      {{"title", title},
                       {"command", "parallax." + command},
                       {"arguments", Json::array({root})}}}});
    }
  }
  return out;
}

}  // namespace parallax::tools::lsp
