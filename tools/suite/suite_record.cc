#include "tools/suite/suite_record.h"

#include <array>
#include <ctime>

#include "compiler/base/file_io.h"
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

}  // namespace parallax::tools
