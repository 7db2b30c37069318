#include "harness/report/sample_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "harness/simulator/state_json.h"

namespace parallax::harness {
namespace {

using MarginKey = std::pair<std::size_t, std::string>;  // number of the event, name

std::string cell(const State& state, const std::string& name) {
  const auto found = state.find(name);
  if (found == state.end()) return {};
  return base::csv_cell(std::visit(
      [](const auto& value) {
        using Plain = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Plain, std::string>) {
          return value;
        } else {
          return fmt::format("{}", value);  // of a double the shortest one that reads back
        }
      },
      found->second));
}

}  // namespace

bool is_sample_table(std::string_view head) {
  if (head.starts_with(kSamplesCsvMark)) return true;
  // The first two of these begin other lists of this program, too.
  return head.starts_with("{\"trace\":") && head.find(",\"sample\":") < 40 &&
         head.find(",\"start\":\"") < 100;
}

std::string samples_csv(const std::vector<SampleRow>& rows) {
  std::set<std::string> variables;
  std::set<MarginKey> margins;
  for (const auto& row : rows) {
    for (const auto& [name, value] : row.start) variables.insert(name);
    for (std::size_t i = 0; i < row.margins.size(); ++i) {
      for (const auto& [name, value] : row.margins[i]) margins.insert({i, name});
    }
  }
  std::string out(kSamplesCsvMark);
  out += "event,cause,reason,sim_time_s";
  const bool has_states =
      std::any_of(rows.begin(), rows.end(), [](const auto& row) { return row.start_state > 0; });
  if (has_states) out += ",start_state";
  for (const auto& name : variables) out += ',' + base::csv_cell("start." + name);
  for (const auto& [event, name] : margins) {
    out += ',' + base::csv_cell(fmt::format("margin.{}.{}", event, name));
  }
  out += '\n';
  for (const auto& row : rows) {
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}", row.trace, row.sample, row.seed,
                       row.drawn ? "drawn" : "chosen", row.rejected, row.retries, row.outcome,
                       row.event ? std::to_string(*row.event) : std::string(),
                       base::csv_cell(row.cause), base::csv_cell(row.reason), row.sim_time_s);
    if (has_states) out += fmt::format(",{}", row.start_state);
    for (const auto& name : variables) out += ',' + cell(row.start, name);
    for (const auto& [event, name] : margins) {
      out += ',';
      if (event < row.margins.size()) out += cell(row.margins[event], name);
    }
    out += '\n';
  }
  return out;
}

std::string samples_jsonl(const std::vector<SampleRow>& rows) {
  using OrderedJson = nlohmann::ordered_json;
  std::string out;
  for (const auto& row : rows) {
    OrderedJson object = {{"trace", row.trace},
                          {"sample", row.sample},
                          {"seed", row.seed},
                          {"start", row.drawn ? "drawn" : "chosen"},
                          {"rejected", row.rejected},
                          {"retries", row.retries},
                          {"outcome", row.outcome},
                          {"event", row.event ? OrderedJson(*row.event) : OrderedJson()},
                          {"cause", row.cause.empty() ? OrderedJson() : OrderedJson(row.cause)},
                          {"reason", row.reason.empty() ? OrderedJson() : OrderedJson(row.reason)},
                          {"sim_time_s", row.sim_time_s},
                          {"state", state_json<OrderedJson>(row.start)}};
    if (row.start_state > 0) object["start_state"] = row.start_state;
    auto margins = OrderedJson::array();
    for (std::size_t i = 0; i < row.margins.size(); ++i) {
      if (row.margins[i].empty()) continue;
      margins.push_back({{"event", i}, {"margins", state_json<OrderedJson>(row.margins[i])}});
    }
    object["margins"] = std::move(margins);
    if (!row.kind.empty()) object["kind"] = row.kind;
    out += base::json_text(object) + '\n';
  }
  return out;
}

}  // namespace parallax::harness
