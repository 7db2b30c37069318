// Values of a fluent in the last run, found as an editor's user keeps runs: beside the scenario, or
// in a folder `out`. The journal's header says which scenario was run, and the line of a trace
// which fluents hold when. Only the newest run is read whole, and none of more than 16 MB.

#include "tools/lsp/last_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <variant>

#include "compiler/base/diagnostic.h"
#include "compiler/base/ground_name.h"
#include "compiler/base/source_file.h"
#include "harness/campaign/journal.h"
#include "tools/app/recorded_run.h"

namespace parallax::tools::lsp {
namespace {

namespace fs = std::filesystem;

constexpr int kLevels = 4;
constexpr std::size_t kMostFolders = 500, kMostInstances = 8, kMostHeaderBytes = 1U << 20U;
constexpr std::uintmax_t kMostJournalBytes = std::uintmax_t{16} << 20U;

/// A run folder, and when its journal was written last.
using FoundRun = std::pair<fs::file_time_type, fs::path>;

void add_runs(const fs::path& folder, std::vector<FoundRun>& out) {
  std::error_code error;
  std::size_t seen = 0;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (++seen > kMostFolders) break;
    const auto journal = at->path() / harness::kJournalName;
    std::error_code missing;
    const auto time = fs::last_write_time(journal, missing);
    if (!missing) out.emplace_back(time, at->path());
  }
}

bool is_run_of(const fs::path& folder, const std::set<std::string>& scenarios) {
  std::ifstream in(folder / harness::kJournalName);
  std::string line(kMostHeaderBytes, '\0');
  in.getline(line.data(), static_cast<std::streamsize>(line.size()));
  if (in.gcount() <= 1 || in.fail()) return false;
  line.resize(static_cast<std::size_t>(in.gcount()) - 1);
  const auto read = harness::decode_header(line);
  const auto* header = std::get_if<harness::JournalHeader>(&read);
  if (header == nullptr) return false;
  std::error_code error;
  const auto path = fs::weakly_canonical(scenario_path(*header), error);
  return !error && scenarios.contains(path.string());
}

std::optional<fs::path> newest_run(const std::vector<std::string>& scenarios) {
  std::set<fs::path> folders;
  std::set<std::string> wanted;
  std::error_code error;
  for (const auto& scenario : scenarios) {
    wanted.insert(fs::weakly_canonical(scenario, error).string());
    auto folder = fs::path(scenario).parent_path();
    folders.insert(folder);
    for (int i = 0; i < kLevels && folder.has_relative_path(); ++i, folder = folder.parent_path())
      folders.insert(folder / "out");
  }
  std::vector<FoundRun> runs;
  for (const auto& folder : folders) add_runs(folder, runs);
  std::sort(runs.rbegin(), runs.rend());
  for (const auto& [time, folder] : runs) {
    if (is_run_of(folder, wanted)) return folder;
  }
  return std::nullopt;
}

/// Timepoints as `0-2, 4`.
std::string spans(const std::vector<std::size_t>& times) {
  std::string out;
  for (std::size_t i = 0; i < times.size();) {
    auto last = i;
    while (last + 1 < times.size() && times[last + 1] == times[last] + 1) ++last;
    out += fmt::format("{}{}", out.empty() ? "" : ", ", times[i]);
    if (last > i) out += fmt::format("-{}", times[last]);
    i = last + 1;
  }
  return out;
}

}  // namespace

std::string last_values(std::string_view fluent, const std::vector<std::string>& scenarios) {
  const auto run = newest_run(scenarios);
  std::error_code error;
  if (!run || fs::file_size(*run / harness::kJournalName, error) > kMostJournalBytes || error)
    return {};
  base::SourceFiles files;
  base::DiagnosticSink unread;
  const auto journal = harness::read_journal(*run, files, unread);
  if (!journal || journal->traces.empty()) return {};
  const auto& trace = *journal->traces.rbegin()->second.trace;
  std::map<std::string, std::vector<std::size_t>> held;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    for (const auto& name : trace.holds(t)) {
      if (base::symbol_of(name) == fluent) held[std::string(name)].push_back(t);
    }
  }
  auto out = fmt::format("in trace {} of `{}`, 0-{}: ", trace.number, run->filename().string(),
                         trace.points.size() - 1);
  if (held.empty()) return out + "never true\n";
  out += "true at\n```\n";
  std::size_t shown = 0;
  for (const auto& [name, times] : held) {
    if (++shown > kMostInstances) break;
    out += fmt::format("{}: {}\n", name, spans(times));
  }
  return out + (held.size() > kMostInstances ? "...\n" : "") + "```\n";
}

}  // namespace parallax::tools::lsp
