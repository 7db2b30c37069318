#include "tools/app/earlier_runs.h"

#include <algorithm>

#include "compiler/base/diagnostic.h"
#include "compiler/base/file_io.h"
#include "harness/report/run_report.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostFolders = 10'000;
constexpr std::size_t kMostReportBytes = std::size_t{16} << 20U;

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return a == b || (fs::equivalent(a, b, error) && !error);
}

bool found_one(const fs::path& folder, const std::string& scenario, std::uint64_t seed) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(folder / "report.json", error))) return false;
  base::DiagnosticSink unread;
  const auto text = base::read_file_of(folder, "report.json", unread, kMostReportBytes);
  if (!text) return false;
  const auto report = harness::read_run_report(*text);
  return report && report->verdict == to_string(harness::CampaignVerdict::kDiscrepancy) &&
         report->seed == seed && is_same_file(report->scenario, scenario);
}

}  // namespace

std::vector<std::string> earlier_discrepancies(const fs::path& run_dir, const std::string& scenario,
                                               std::uint64_t seed) {
  std::vector<std::string> out;
  const auto parent = run_dir.lexically_normal().parent_path();
  std::error_code error;
  fs::directory_iterator folders(parent.empty() ? fs::path(".") : parent, error);
  for (std::size_t i = 0; !error && folders != fs::directory_iterator() && i < kMostFolders;
       folders.increment(error), ++i) {
    const auto name = folders->path().filename();
    std::error_code status_error;
    if (!fs::is_directory(folders->symlink_status(status_error))) continue;
    if (name == run_dir.lexically_normal().filename()) continue;
    if (found_one(folders->path(), scenario, seed)) out.push_back((parent / name).string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace parallax::tools
