#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "compiler/base/codes/files.h"
#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "harness/report/text_layout.h"
#include "tools/cli/command.h"
#include "tools/scaffold/scaffold.h"

namespace parallax::tools {
namespace {

struct NewOptions {
  std::string folder;
  std::string world = "line";
  std::string robot;  // empty: the one that the world is made for
};

int make_new(const NewOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  auto folder = options.folder;
  while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
  const auto name = std::filesystem::path(folder).filename().string();
  if (const auto wrong = wrong_scenario_name(name); !wrong.empty()) {
    sink.error_about(codes::kUsage, folder, wrong);
    return 0;
  }
  const auto& kinds = scaffold_kinds();
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const ScaffoldKind& one) {
    return one.world == options.world && (options.robot.empty() || one.robot == options.robot);
  });
  if (kind == kinds.end()) {
    std::string known;
    for (const auto& one : kinds) {
      known += fmt::format("{}{} for the {}", known.empty() ? "" : ", ", one.world, one.robot);
    }
    sink.error_about(codes::kUsage, "--robot",
                     fmt::format("there is no world `{}` for the robot `{}`; there are {}",
                                 options.world, options.robot, known));
    return 0;
  }
  const auto files = scaffold_files(name, *kind);
  if (!write_scaffold(folder, files, invocation.files(), sink)) return 0;
  const auto scenario = (std::filesystem::path(folder) / "scenario.yaml").string();
  if (invocation.options().json) {
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const auto& file : files) names.push_back(file.name);
    const nlohmann::ordered_json document{{"status", "ok"},
                                          {"folder", folder},
                                          {"world", kind->world},
                                          {"robot", kind->robot},
                                          {"files", std::move(names)}};
    invocation.document(base::json_text(document) + "\n");
    return 0;
  }
  std::string text = base::printable(folder) + '\n';
  for (const auto& file : files) text += "  " + file.name + '\n';
  const auto word = base::printable(harness::shell_word(scenario));
  invocation.result(
      fmt::format("{}next\n  parallax check {}\n  parallax run {}\n", text, word, word));
  return 0;
}

}  // namespace

Command new_command() {
  auto options = std::make_shared<NewOptions>();
  OptionTable command("new", "Make a scenario that runs: model, plan, world and what ties them");
  command.footer(
      "Examples:\n"
      "  parallax new fetch\n"
      "  parallax new tidy --world kitchen\n"
      "Worlds and their robots: line (line), room (mobile), kitchen (mobile).\n"
      "Exit codes: 0, 2 for a name that is taken or none, or a place that cannot be written.");
  command.option("name", options->folder, "Folder to make; its last part is the scenario's name")
      .required()
      .folder();
  command
      .option("--world", options->world,
              "line (two regions, a box), room (table, shelf) or kitchen (counter, drawer)")
      .check(OneOf{{"line", "room", "kitchen"}})
      .show_default();
  command
      .option("--robot", options->robot,
              "line (on rails) or mobile (drives, sees, one arm); default: the one of the world")
      .check(OneOf{{"line", "mobile"}});
  return command_of(std::move(command), options, make_new);
}

}  // namespace parallax::tools
