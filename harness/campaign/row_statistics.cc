#include "harness/campaign/row_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "compiler/base/hash.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

constexpr double kQuantiles[] = {0.05, 0.5, 0.95};

bool is_lost_row(const SampleRow& row) { return std::string_view(row.outcome) == "lost"; }

/// The margin of one event, where it has that one and it is a finite number.
std::optional<double> margin_at(const State& margins, std::string_view name) {
  const auto found = margins.find(name);
  if (found == margins.end()) return std::nullopt;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*whole);
  }
  const auto* number = std::get_if<double>(&found->second);
  return number != nullptr && std::isfinite(*number) ? std::optional(*number) : std::nullopt;
}

/// The value that a run reports under this name.
std::optional<double> reported(const SampleRow& row, std::string_view name) {
  if (name == "duration") return row.sim_time_s;
  std::optional<double> out;
  for (std::size_t event = 0; event < row.margins.size(); ++event) {
    const auto prefix = std::to_string(event) + ".";
    if (name.starts_with(prefix)) return margin_at(row.margins[event], name.substr(prefix.size()));
    const auto margin = margin_at(row.margins[event], name);
    if (margin) out = std::min(out.value_or(*margin), *margin);
  }
  return out;
}

std::string start_hash(const State& start) {
  return fmt::format("{:016x}", base::fnv1a64(encode_state(start)));
}

}  // namespace

void add_values(const std::vector<SampleRow>& rows, const std::vector<std::string>& names,
                RatesResult& result) {
  const std::vector<double> quantiles(std::begin(kQuantiles), std::end(kQuantiles));
  // An interval for a fixed number of runs says nothing where they were stopped.
  const auto level = result.fixed_runs ? std::optional(result.confidence) : std::nullopt;
  for (auto& trace : result.traces) {
    for (const auto& name : names) {
      ReportedValue one{name, 0, {}};
      std::vector<double> values;
      for (const auto& row : rows) {
        if (row.trace != trace.number || is_lost_row(row)) continue;
        const auto value = reported(row, name);
        if (value) values.push_back(*value);
        one.without += value ? 0 : 1;
      }
      if (!values.empty()) {
        one.summary = summarize_values(std::move(values), trace.unseen, quantiles, level);
      }
      trace.values.push_back(std::move(one));
    }
  }
}

std::vector<std::string> margin_names(const std::vector<SampleRow>& rows) {
  std::set<std::string> names;
  for (const auto& row : rows) {
    for (const auto& margins : row.margins) {
      for (const auto& [name, value] : margins) names.insert(name);
    }
  }
  return {names.begin(), names.end()};
}

void add_outcomes(const std::vector<SampleRow>& rows, RatesResult& result) {
  for (auto& trace : result.traces) {
    for (const auto& row : rows) {
      if (row.trace == trace.number) {
        trace.outcomes.push_back({row.outcome, start_hash(row.start)});
      }
    }
  }
}

}  // namespace parallax::harness
