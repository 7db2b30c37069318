#include "tools/app/earlier_runs.h"

#include <algorithm>
#include <optional>

#include "compiler/base/diagnostic.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostFolders = 10'000;
constexpr std::size_t kMostReportBytes = std::size_t{16} << 20U;

template <typename T>
std::optional<T> report_member(const nlohmann::json& object, const char* name) {
  const auto* member = base::json_member(object, name);
  return member == nullptr ? std::nullopt : base::json_as<T>(*member);
}

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
  const auto report = base::parse_json(*text);
  const auto of = report_member<std::string>(report, "scenario");
  return of && report_member<std::string>(report, "verdict") == "discrepancy" &&
         report_member<std::uint64_t>(report, "seed") == seed && is_same_file(*of, scenario);
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
