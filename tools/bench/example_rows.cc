// The examples of the Discrete Event Calculus Reasoner 1.0, where there is a copy of them.

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>

#include "tools/bench/bench.h"
#include "tools/bench/contestants.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

/// All model files below the folder, sorted; one without a recorded answer is part of others.
std::vector<fs::path> problems_below(const fs::path& folder) {
  std::vector<fs::path> problems;
  std::error_code error;
  for (fs::recursive_directory_iterator i(folder, error), end; !error && i != end;
       i.increment(error)) {
    auto answer = i->path();
    if (answer.extension() != ".e" || !fs::exists(answer.replace_extension(".txt"))) continue;
    problems.push_back(i->path());
  }
  std::sort(problems.begin(), problems.end());
  return problems;
}

}  // namespace

void measure_examples(Bench& bench) {
  bench.begin("the examples of the reasoner of 2005, each compiled and all its traces listed");
  const char* folder = std::getenv("PARALLAX_PEER_EXAMPLES");
  Row row{"", "all together", {{"parallax", "", {}, 0, "", ""}}, {}, ""};
  auto& all = row.sides.front();
  const auto problems = folder == nullptr ? std::vector<fs::path>{} : problems_below(folder);
  if (problems.empty()) {
    all.remark = "no copy of them: PARALLAX_PEER_EXAMPLES names none";
    return bench.add(std::move(row));
  }
  all.cost = Cost{};
  std::vector<std::pair<double, std::string>> dearest;
  for (const auto& problem : problems) {
    auto contestant = parallax_lists(problem.string());
    contestant.command.insert(contestant.command.end(), {"--compat", "decreasoner", "--quiet"});
    contestant.folder = folder;
    const auto side = bench.measured(contestant);
    if (!side.cost) {
      all.remark += fmt::format("{}: {}; ", problem.stem().string(), side.remark);
      continue;
    }
    all.cost->wall_s += side.cost->wall_s;
    all.cost->cpu_s += side.cost->cpu_s;
    all.cost->peak_mb = std::max(all.cost->peak_mb, side.cost->peak_mb);
    all.runs = side.runs;
    dearest.emplace_back(side.cost->cpu_s, problem.stem().string());
  }
  all.command = "parallax traces FILE --limit 0 --format jsonl --compat decreasoner";
  std::sort(dearest.rbegin(), dearest.rend());
  dearest.resize(std::min<std::size_t>(dearest.size(), 3));
  row.note = fmt::format("{} problems; dearest, cpu:", problems.size());
  for (const auto& [seconds, name] : dearest) {
    row.note += fmt::format(" {} {:.0f} ms", name, 1e3 * seconds);
  }
  if (!all.remark.empty()) row.note += "; without " + all.remark;
  bench.add(std::move(row));
}

}  // namespace parallax::tools
