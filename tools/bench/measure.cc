#include "tools/bench/measure.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "compiler/base/json.h"

namespace parallax::tools {
namespace {

std::string duration(double seconds) {
  if (seconds < 0.1) return fmt::format("{:.1f} ms", 1e3 * seconds);
  return fmt::format("{:.2f} s", seconds);
}

std::string line_of(const Side& side) {
  if (!side.cost) return fmt::format("{:<17}{}", side.program, side.remark);
  auto line =
      fmt::format("{:<17}{:>8} {:>8} {:>8.1f} MB", side.program, duration(side.cost->wall_s),
                  duration(side.cost->cpu_s), side.cost->peak_mb);
  if (!side.answer.empty()) line += fmt::format("   {}", side.answer);
  if (side.cost->output_mb >= 0.1) line += fmt::format("   wrote {:.1f} MB", side.cost->output_mb);
  return line;
}

nlohmann::ordered_json document(const Side& side) {
  nlohmann::ordered_json json = {{"program", side.program}, {"command", side.command}};
  if (side.cost) {
    json["wall_s"] = side.cost->wall_s;
    json["cpu_s"] = side.cost->cpu_s;
    json["peak_mb"] = side.cost->peak_mb;
    json["output_mb"] = side.cost->output_mb;
    json["runs"] = side.runs;
  }
  if (!side.answer.empty()) json["answer"] = side.answer;
  if (!side.remark.empty()) json["remark"] = side.remark;
  return json;
}

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

std::optional<double> Row::ratio(std::size_t side) const {
  if (side == 0 || side >= sides.size()) return std::nullopt;
  if (!sides[0].cost || !sides[side].cost) return std::nullopt;
  return sides[side].cost->cpu_s / sides[0].cost->cpu_s;
}

bool Row::agrees() const {
  std::optional<std::string> known = expected;
  for (const auto& side : sides) {
    if (!side.cost || side.answer.empty()) continue;
    if (known && *known != side.answer) return false;
    known = side.answer;
  }
  return true;
}

std::string to_text(const Row& row) {
  std::string text;
  std::string label = row.name;
  for (std::size_t i = 0; i < row.sides.size(); ++i) {
    text += fmt::format("  {:<26}{}", label, line_of(row.sides[i]));
    if (const auto ratio = row.ratio(i)) text += fmt::format("   = {:.2f} x ours", *ratio);
    text += '\n';
    label.clear();
  }
  if (!row.note.empty()) {
    text += fmt::format("  {:<26}{}\n", label, row.note);
  }
  if (!row.agrees()) {
    text += fmt::format("  {:<26}ANSWERS DIFFER, expected {}\n", "", row.expected.value_or("?"));
  }
  return text;
}

std::string to_json(const std::vector<Row>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& row : rows) {
    nlohmann::ordered_json json = {{"section", row.section}, {"row", row.name}};
    json["sides"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < row.sides.size(); ++i) {
      json["sides"].push_back(document(row.sides[i]));
      if (const auto ratio = row.ratio(i)) json["sides"].back()["ratio"] = *ratio;
    }
    if (row.expected) json["expected"] = *row.expected;
    if (!row.note.empty()) json["note"] = row.note;
    json["agrees"] = row.agrees();
    list.push_back(std::move(json));
  }
  return base::json_text(nlohmann::ordered_json{{"rows", std::move(list)}}, 2) + '\n';
}

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
