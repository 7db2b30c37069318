#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/base/codes/files.h"
#include "compiler/base/json.h"
#include "compiler/base/suggest.h"
#include "tools/cli/command.h"
#include "tools/schema/schema.h"

namespace parallax::tools {
namespace {

struct SchemaOptions {
  std::string name;
  bool list = false;
};

int list_schemas(Invocation& invocation) {
  const auto schemas = schema_list();
  auto list = nlohmann::ordered_json::array();
  std::size_t width = 0;
  for (const auto& one : schemas) width = std::max(width, one.name.size());
  std::string text;
  for (const auto& one : schemas) {
    list.push_back({{"name", one.name}, {"version", one.version}, {"title", one.title}});
    text += fmt::format("{:<{}}  {:<4}  {}\n", one.name, width, one.version, one.title);
  }
  const nlohmann::ordered_json document = {{"status", "ok"}, {"schemas", std::move(list)}};
  invocation.options().json ? invocation.document(base::json_text(document) + '\n')
                            : invocation.result(text);
  return 0;
}

int show_schema(const SchemaOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  if (options.list != options.name.empty()) {
    sink.error_about(codes::kUsage, "", "name a command or a kind of file, or give --list");
    return 0;
  }
  if (options.list) return list_schemas(invocation);
  const auto text = schema_text(schema_name(options.name));
  if (text) {
    invocation.result(*text);
    return 0;
  }
  auto error = sink.error_about(codes::kUsage, options.name, "there is no schema of this name");
  if (const auto near = base::nearest_name(options.name, schema_names())) {
    error.fix(fmt::format("replace `{}` with `{}`", base::printable(options.name), *near));
  }
  error.note("`parallax schema --list` lists them");
  return 0;
}

}  // namespace

Command schema_command() {
  auto options = std::make_shared<SchemaOptions>();
  OptionTable command("schema",
                      "Print the JSON Schema of a command's --json document, or of a YAML file");
  command.footer(
      "Examples:\n"
      "  parallax schema traces > traces.schema.json\n"
      "  parallax schema scenario.yaml\n"
      "  parallax schema --list\n"
      "Schemas are of JSON Schema 2020-12 and have a version (docs/guide/python.md).");
  command.option("name", options->name, "A command, or a kind of file: scenario.yaml, suite.yaml")
      .offers(schema_names());
  command.flag("--list", options->list, "List all schemas with their versions");
  return command_of(std::move(command), options, show_schema);
}

}  // namespace parallax::tools
