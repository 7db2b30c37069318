#pragma once

// Traces by names, for tests that write them by hand.

#include <memory>
#include <string>
#include <vector>

#include "harness/campaign/trace_input.h"

namespace parallax::harness::test {

using Table = std::shared_ptr<compiler::SymbolTable>;

inline Table table_of(const std::vector<std::string>& fluents) {
  auto table = std::make_shared<compiler::SymbolTable>();
  for (const auto& fluent : fluents) table->add_fluent(fluent);
  return table;
}

struct NamedEvent {
  std::string text;
  PlannedEvent planned = {};
};

/// `holds` has one entry more than there are events.
inline CampaignTrace named_trace(std::int64_t number, std::string key,
                                 const std::vector<std::vector<std::string>>& holds,
                                 const std::vector<NamedEvent>& events,
                                 const Table& table = table_of({})) {
  CampaignTrace out;
  out.number = number;
  out.key = std::move(key);
  out.symbols = table;
  for (std::size_t t = 0; t < holds.size(); ++t) {
    std::vector<std::string> happens;
    if (t < events.size()) {
      happens.push_back(events[t].text);
      out.plan.push_back(events[t].planned);
    }
    out.points.push_back(runtime::point_of_names(holds[t], happens, *table));
  }
  return out;
}

}  // namespace parallax::harness::test
