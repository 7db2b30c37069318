#include "tools/bench/measure.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

namespace parallax::tools {
namespace {

struct Runs {
  std::vector<ChildRun> runs;
  double spent_s = 0.0;
  std::string remark;  // it is not run again
};

std::string typed_command(const std::vector<std::string>& command) {
  std::string text;
  for (const auto& word : command) {
    const bool path = word.find('/') != std::string::npos;
    text +=
        (text.empty() ? "" : " ") + (path ? std::filesystem::path(word).filename().string() : word);
  }
  return text;
}

void run_once(const Contestant& contestant, const ChildOptions& child, Runs& so_far) {
  auto run = run_child(contestant.command, child);
  if (!run) {
    so_far.remark = "could not be started";
  } else if (run->stopped) {
    so_far.remark = fmt::format("no end within {:.0f} s of cpu, {:.0f} MB so far",
                                child.time_limit_s, run->cost.peak_mb);
  } else if (run->code == 127) {
    so_far.remark = "not installed";
  } else if (std::count(contestant.good_codes.begin(), contestant.good_codes.end(), run->code) ==
             0) {
    so_far.remark = fmt::format("ended with code {} after {:.1f} s, {:.0f} MB", run->code,
                                run->cost.wall_s, run->cost.peak_mb);
  } else {
    so_far.spent_s += run->cost.wall_s;
    so_far.runs.push_back(*std::move(run));
  }
}

double median_of(const std::vector<ChildRun>& runs, double Cost::*part) {
  std::vector<double> values;
  for (const auto& run : runs) values.push_back(run.cost.*part);
  return median(std::move(values));
}

Side side_of(const Contestant& contestant, const Runs& runs) {
  Side side;
  side.program = contestant.program;
  side.command = typed_command(contestant.command);
  side.remark = runs.remark;
  side.runs = static_cast<int>(runs.runs.size());
  if (!side.remark.empty()) return side;
  side.cost = Cost{median_of(runs.runs, &Cost::wall_s), median_of(runs.runs, &Cost::cpu_s),
                   median_of(runs.runs, &Cost::peak_mb), median_of(runs.runs, &Cost::output_mb)};
  if (contestant.answer) side.answer = contestant.answer(runs.runs.front());
  return side;
}

}  // namespace

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::vector<Side> measure(const std::vector<Contestant>& contestants, const std::string& output,
                          const MeasureOptions& options) {
  std::vector<Runs> runs(contestants.size());
  for (int round = 0; round < options.repetitions; ++round) {
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      if (!runs[i].remark.empty() || (round > 0 && runs[i].spent_s > options.enough_s)) continue;
      run_once(contestants[i], {output, contestants[i].folder, options.time_limit_s}, runs[i]);
    }
  }
  std::error_code ignored;
  std::filesystem::remove(output, ignored);
  std::vector<Side> sides;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    sides.push_back(side_of(contestants[i], runs[i]));
  }
  return sides;
}

}  // namespace parallax::tools
