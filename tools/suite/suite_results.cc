#include "tools/suite/suite_results.h"

#include <system_error>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"

namespace parallax::tools {
namespace fs = std::filesystem;

base::Result<EarlierResults> read_results(const fs::path& folder, base::DiagnosticSink& sink) {
  const auto path = folder / kResultsFile;
  base::DiagnosticSink unread;
  const auto text = base::read_file(path, unread);
  const auto json = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
  const bool usable = json.is_object() && json.contains("cases") && json["cases"].is_object();
  if (!usable) return sink.error_about(base::DiagnosticCode::kNoEarlierResults, path.string());
  EarlierResults results;
  for (const auto& [name, outcome] : json["cases"].items()) {
    results[name] = outcome.is_string() ? outcome.get<std::string>() : "";
  }
  return results;
}

base::Status write_results(const fs::path& folder, EarlierResults earlier,
                           const std::vector<SuiteCase>& cases,
                           const std::vector<CaseResult>& results, base::DiagnosticSink& sink) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (results[i].outcome == Outcome::kSkipped) continue;
    earlier[cases[i].name()] = to_string(results[i].outcome);
  }
  std::error_code error;
  fs::create_directories(folder, error);
  const nlohmann::json json = {{"schema_version", 1}, {"cases", earlier}};
  // Names are bytes of paths: what is no UTF-8 is replaced rather than refused.
  const auto text = base::json_text(json, 2) + '\n';
  return base::write_file_atomically(folder / kResultsFile, text, sink);
}

}  // namespace parallax::tools
