// parallax_rare_table: coverage and width of the intervals for rare events.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "harness/confidence/quantiles.h"
#include "harness/search/rare_event.h"
#include "tools/bench/search/rare_worlds.h"

namespace parallax::bench {
namespace {

using harness::RareEventEnd;
using harness::RareEventMethod;
using harness::RareEventOptions;

constexpr double kNone = 1e9;  // in place of a ratio where there is no interval from both sides

struct TableOptions {
  std::int64_t repetitions = 1000;
  double share = 0.1;  // of Clopper's and Pearson's runs
  std::vector<double> probabilities = {1e-3, 1e-4, 1e-5};
  std::vector<std::size_t> dimensions = {4, 8};
  std::vector<std::string> worlds = rare_world_names();
  std::vector<RareEventMethod> methods = {RareEventMethod::kImportance,
                                          RareEventMethod::kSplitting};
};

/// Number of uniform runs after which the ends of the Clopper-Pearson interval have the ratio 2, if
/// as many fail as are expected.
double plain_runs(double probability) {
  for (double failures = 1.0;; failures += 1.0) {
    const double all = failures / probability;
    const double lower = harness::beta_quantile(0.025, failures, all - failures + 1.0);
    const double upper = harness::beta_quantile(0.975, failures + 1.0, all - failures);
    if (upper / lower <= 2.0) return all;
  }
}

std::string ratio_at(std::vector<double>& ratios, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(ratios.size() - 1));
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(at), ratios.end());
  return ratios[at] < kNone ? fmt::format("{:.2f}", ratios[at]) : std::string("-");
}

void print_row(RareEventMethod method, const RareWorld& world, const TableOptions& table) {
  std::int64_t covered = 0, two_sided = 0, refused = 0;
  double runs = 0.0, mean = 0.0;
  std::vector<double> ratios;
  for (std::int64_t i = 1; i <= table.repetitions; ++i) {
    RareEventOptions options;
    options.method = method;
    options.dimensions = world.dimensions();
    options.budget = static_cast<std::int64_t>(table.share * plain_runs(world.probability()));
    options.seed = static_cast<std::uint64_t>(i);
    const auto result = estimate_rare_event(options, [&](auto points) {
      std::vector<harness::Evaluation> out;
      out.reserve(points.size());
      for (const auto& point : points) out.push_back(world.evaluate(point));
      return std::optional(std::move(out));
    });
    runs += static_cast<double>(result.runs);
    const bool one_sided = method == RareEventMethod::kImportance &&
                           result.end == RareEventEnd::kUnreached;  // an upper end is a claim, too
    const bool estimated = result.end == RareEventEnd::kEstimated;
    const bool is_two_sided = estimated && result.lower > 0.0;
    if (!estimated && !one_sided) ++refused;
    if (is_two_sided) ++two_sided;
    if (estimated) mean += result.probability;
    ratios.push_back(is_two_sided ? result.upper / result.lower : kNone);
    if ((estimated || one_sided) && result.lower <= world.probability() &&
        world.probability() <= result.upper) {
      ++covered;
    }
  }
  const auto n = static_cast<double>(table.repetitions);
  const auto claims = static_cast<double>(table.repetitions - refused);
  const double coverage = claims > 0.0 ? static_cast<double>(covered) / claims : 0.0;
  const auto median = ratio_at(ratios, 0.5);
  const bool good = coverage >= 0.92 && median != "-" && std::stod(median) <= 2.0;
  fmt::print("| {} | {} | {} | {:g} | {} | {} | {} | {:.1f} % | {:.2f} | {:.0f} | {} |\n",
             to_string(method), world.name(), world.dimensions(), world.probability(),
             claims > 0.0 ? fmt::format("{:.1f} %", 100.0 * coverage) : std::string("-"), median,
             ratio_at(ratios, 0.9), 100.0 * static_cast<double>(refused) / n,
             two_sided == 0 ? 0.0 : mean / (n - static_cast<double>(refused)) / world.probability(),
             runs / n, good ? "yes" : "no");
  std::fflush(stdout);
}

int usage() {
  std::fputs(
      "usage: parallax_rare_table [--repetitions N] [--share S] [--probability P] [--world NAME]\n"
      "                           [--dimensions D] [--method importance|splitting]\n",
      stderr);
  return 2;
}

int run(int count, char** arguments) {
  TableOptions table;
  for (int i = 1; i < count; i += 2) {
    const std::string name = arguments[i];
    if (i + 1 >= count) return usage();
    const char* value = arguments[i + 1];
    const double number = std::strtod(value, nullptr);
    if (name == "--repetitions") {
      table.repetitions = std::max(2L, std::strtol(value, nullptr, 10));
    } else if (name == "--share") {
      table.share = std::clamp(number, 0.1, 10.0);
    } else if (name == "--probability") {
      table.probabilities = {std::clamp(number, 1e-7, 1e-3)};
    } else if (name == "--dimensions") {
      table.dimensions = {static_cast<std::size_t>(std::clamp(number, 4.0, 12.0))};
    } else if (name == "--method") {
      std::erase_if(table.methods, [&](auto method) { return to_string(method) != value; });
    } else if (name == "--world") {
      std::erase_if(table.worlds, [&](const auto& world) { return world != value; });
    } else {
      return usage();
    }
  }
  if (table.methods.empty() || table.worlds.empty()) return usage();
  fmt::print(
      "| method | world | d | p | 95 % interval covers | ratio of its ends, median | 90 % below | "
      "not resolved | mean of estimates / p | runs | good |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double probability : table.probabilities) {
    for (const auto method : table.methods) {
      for (const auto dimensions : table.dimensions) {
        for (const auto& name : table.worlds) {
          print_row(method, RareWorld(name, dimensions, probability), table);
        }
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace parallax::bench

int main(int count, char** arguments) { return parallax::bench::run(count, arguments); }
