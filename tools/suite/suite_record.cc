#include "tools/suite/suite_record.h"

#include <array>
#include <ctime>
#include <system_error>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "tools/suite/junit.h"

namespace parallax::tools {
namespace {

constexpr std::chrono::seconds kSaveInterval{1};

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  const auto length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return {text.data(), length};
}

}  // namespace

SuiteRecord::SuiteRecord(std::vector<SuiteCase> cases, const std::vector<bool>& skipped,
                         std::filesystem::path folder, std::filesystem::path junit,
                         EarlierResults earlier)
    : cases_(std::move(cases)),
      results_(cases_.size()),
      folder_(std::move(folder)),
      junit_(std::move(junit)),
      earlier_(std::move(earlier)),
      timestamp_(utc_now()) {
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    if (skipped[i]) results_[i].outcome = Outcome::kSkipped;
  }
}

void SuiteRecord::finish(std::size_t index, CaseResult result) {
  const std::lock_guard lock(mutex_);
  results_[index] = std::move(result);
  if (std::chrono::steady_clock::now() - last_save_ < kSaveInterval) return;
  base::DiagnosticSink unread;  // the last save reports
  (void)save(unread);
}

base::Status SuiteRecord::save(base::DiagnosticSink& sink) {
  last_save_ = std::chrono::steady_clock::now();
  auto saved = write_results(folder_, earlier_, cases_, results_, sink);
  if (!saved || junit_.empty()) return saved;
  return base::write_file_atomically(junit_, to_junit(cases_, results_, timestamp_), sink);
}

std::size_t SuiteRecord::count(Outcome outcome) const {
  std::size_t count = 0;
  for (const auto& result : results_) count += result.outcome == outcome ? 1 : 0;
  return count;
}

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
