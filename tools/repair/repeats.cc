#include "tools/repair/repeats.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_grammar.h"
#include "harness/discrete/stepped_model.h"
#include "tools/repair/experiment.h"

namespace parallax::tools {
namespace {

constexpr std::int64_t kSeen = 5;         // times, after which it is taken to be always so
constexpr std::size_t kMostRepeated = 3;  // steps

harness::CampaignTrace trace_of(const Evidence& seen, std::size_t steps,
                                const compiler::SymbolTable& known) {
  auto symbols = std::make_shared<compiler::SymbolTable>(known);
  harness::CampaignTrace out;
  for (std::size_t t = 0; t <= steps; ++t) {
    std::vector<std::string> holds, happens;
    for (const auto& [fluent, value] : seen.states[t]) {
      if (value) holds.push_back(fluent);
    }
    if (t < steps) happens.push_back(seen.steps[t].event);
    out.points.push_back(runtime::point_of_names(holds, happens, *symbols));
  }
  out.plan.resize(steps);
  out.symbols = std::move(symbols);
  out.key = experiment_key(out);
  return out;
}

}  // namespace

bool chance_decides(const RepairInput& input) {
  if (input.loaded.world == nullptr) return false;
  const auto& world = input.loaded.world->model;
  const auto& typed = *input.domain->typed;
  for (std::size_t i = 0; i < world.release_slots.size(); ++i) {
    if (!world.release_slots[i]) continue;
    const auto symbol = typed.find_symbol(base::symbol_of(world.fluents[i].name));
    if (!symbol || !typed.symbols[*symbol].noninertial) return true;
  }
  return false;
}

std::vector<Repeat> repeats_wanted(const RepairInput& input) {
  std::vector<Repeat> out;
  std::size_t looked_at = 0;
  const compiler::SymbolTable symbols(input.loaded.compilation.model);
  for (const auto& seen : input.evidence) {
    if (looked_at == kMostRepeated) break;
    if (!seen.divergence || seen.ids.front().starts_with('e')) continue;
    ++looked_at;
    const auto t = *seen.divergence;
    std::int64_t times = 0;
    bool always = true;
    for (const auto& other : input.evidence) {
      if (!goes_like(seen, other, t)) continue;
      times += static_cast<std::int64_t>(other.runs());
      always = always && other.states[t] == seen.states[t];
    }
    if (always && times < kSeen) out.push_back({trace_of(seen, t, symbols), kSeen - times});
  }
  return out;
}

}  // namespace parallax::tools
