#include "compiler/pipeline/pass_report.h"

#include <fmt/format.h>

#include "compiler/base/json.h"

namespace parallax::compiler {

std::string pass_table(const PassLog& log) {
  auto table = fmt::format("{:<18}{:>10}{:>12}{:>12}{:>13}{:>12}\n", "pass", "seconds", "atoms",
                           "nodes", "constraints", "clauses");
  for (const auto& run : log.runs) {
    const auto seconds = run.applied ? fmt::format("{:.3f}", run.seconds) : std::string("-");
    table += fmt::format("{:<18}{:>10}{:>12}{:>12}{:>13}{:>12}\n", run.pass.name, seconds,
                         run.size.atoms, run.size.nodes, run.size.constraints, run.size.clauses);
  }
  return table;
}

std::string pass_json(const PassLog& log) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& run : log.runs) {
    list.push_back({{"name", run.pass.name},
                    {"applied", run.applied},
                    {"atoms", run.size.atoms},
                    {"nodes", run.size.nodes},
                    {"constraints", run.size.constraints},
                    {"clauses", run.size.clauses},
                    {"timing", {{"seconds", run.seconds}}}});
  }
  return base::json_text(list);
}

}  // namespace parallax::compiler
