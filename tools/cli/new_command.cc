#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "compiler/base/codes/files.h"
#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "harness/report/text_layout.h"
#include "tools/cli/command.h"
#include "tools/scaffold/robot_scaffold.h"
#include "tools/scaffold/scaffold.h"

namespace parallax::tools {
namespace {

struct NewOptions {
  std::string folder;
  std::string world = "line";
  std::string robot;  // empty: the one that the world is made for
  std::vector<std::string> packages;
  bool world_given = false;
};

/// Is it a file, not the name of a robot?
bool is_description(const std::string& robot) {
  return std::filesystem::path(robot).extension() == ".urdf";
}

/// The files for the robot that the description at `options.robot` describes.
base::Result<std::vector<ScaffoldFile>> described_files(const std::string& name,
                                                        const NewOptions& options,
                                                        base::DiagnosticSink& sink) {
  if (options.world_given) {
    return sink.error_about(codes::kUsage, "--world",
                            "a robot of your own stands at a table; no other world is made for it");
  }
  RobotRequest request{options.robot, {}};
  for (const std::string& package : options.packages) {
    const auto equals = package.find('=');
    if (equals == 0 || equals == package.npos || equals + 1 == package.size()) {
      return sink.error_about(codes::kUsage, "--package",
                              fmt::format("`{}` is not NAME=DIR", package));
    }
    request.packages[package.substr(0, equals)] = package.substr(equals + 1);
  }
  return robot_scaffold(name, request, sink);
}

int make_files(const std::string& folder, const std::vector<ScaffoldFile>& files,
               const ScaffoldKind& kind, Invocation& invocation) {
  if (!write_scaffold(folder, files, invocation.files(), invocation.sink())) return 0;
  const auto scenario = (std::filesystem::path(folder) / "scenario.yaml").string();
  if (invocation.options().json) {
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const auto& file : files) names.push_back(file.name);
    const nlohmann::ordered_json document{{"status", "ok"},
                                          {"folder", folder},
                                          {"world", kind.world},
                                          {"robot", kind.robot},
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

int make_new(const NewOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  auto folder = options.folder;
  while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
  const auto name = std::filesystem::path(folder).filename().string();
  if (const auto wrong = wrong_scenario_name(name); !wrong.empty()) {
    sink.error_about(codes::kUsage, folder, wrong);
    return 0;
  }
  if (is_description(options.robot)) {
    const auto files = described_files(name, options, sink);
    if (!files) return 0;
    return make_files(folder, *files, {"table", options.robot}, invocation);
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
  return make_files(folder, scaffold_files(name, *kind), *kind, invocation);
}

}  // namespace

Command new_command() {
  auto options = std::make_shared<NewOptions>();
  OptionTable command("new", "Make a scenario that runs: model, plan, world and what ties them");
  command.footer(
      "Examples:\n"
      "  parallax new fetch\n"
      "  parallax new tidy --world kitchen\n"
      "  parallax new arm --robot panda.urdf --package panda_description=../panda_description\n"
      "Worlds and their robots: line (line), room (mobile), kitchen (mobile).\n"
      "Exit codes: 0, 2 for a name that is taken or none, or a place that cannot be written, 3 "
      "for\n"
      "a robot that cannot be taken over.");
  command.option("name", options->folder, "Folder to make; its last part is the scenario's name")
      .required()
      .folder();
  command
      .option("--world", options->world,
              "line (two regions, a box), room (table, shelf) or kitchen (counter, drawer)")
      .check(OneOf{{"line", "room", "kitchen"}})
      .show_default()
      .given(options->world_given);
  command
      .option("--robot", options->robot,
              "line, mobile (default: the one of the world), or FILE.urdf: an arm with a gripper")
      .offers({"line", "mobile"})
      .file({"urdf"})
      .details(
          "The arm of a robot description carries a box over a table: description and meshes are "
          "copied, the gripper is found, and a posture in which it points down. What is guessed is "
          "said in robot.yaml.");
  command
      .option("--package", options->packages,
              "NAME=DIR: where a package:// of the description lies (else: in a folder above)")
      .list(ListForm::kOneEachTime)
      .named_value("NAME=DIR")
      .needs("--robot");
  return command_of(std::move(command), options, make_new);
}

}  // namespace parallax::tools
