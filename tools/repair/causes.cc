#include "tools/repair/causes.h"

#include <algorithm>
#include <map>
#include <set>

#include "tools/app/evidence.h"

namespace parallax::tools {
namespace {

using PathsById = std::map<std::string, const ObservedPath*>;

/// Does it happen again in the runs that get to the step of `failed` in the same way?
RepairCause cause_at(const RepairInput& input, const Evidence& failed, const PathsById& by_id,
                     std::set<std::string>& told) {
  const auto t = *failed.divergence;
  std::vector<const harness::State*> starts;
  std::vector<bool> fails;
  for (const auto& other : input.evidence) {
    if (!goes_like(failed, other, t)) continue;
    // Runs that left the model there in another way are no evidence for this one.
    const bool same = other.divergence == t && other.states[t] == failed.states[t];
    if (!same && other.divergence && *other.divergence <= t) continue;
    for (const auto& id : other.ids) {
      const auto found = by_id.find(id);
      if (found == by_id.end()) continue;
      starts.push_back(&found->second->start);
      fails.push_back(same);
    }
    if (same) told.insert(other.ids.front());
  }
  const auto cause = cause_of(starts, fails, input.loaded.world != nullptr);
  if (cause.finding.kind == harness::CauseKind::kUnknown) return {};
  return {std::string(harness::to_string(cause.finding.kind)), cause.words()};
}

}  // namespace

std::vector<RepairCause> causes_of(const RepairInput& input) {
  std::vector<RepairCause> out;
  if (input.contradictions.empty()) return out;
  PathsById by_id;
  for (const auto& path : input.paths) {
    by_id.emplace(std::to_string(path.id.trace) + "." + std::to_string(path.id.sample), &path);
  }
  std::set<std::string> told;
  for (const auto& seen : input.evidence) {
    if (!seen.divergence || told.contains(seen.ids.front())) continue;
    auto cause = cause_at(input, seen, by_id, told);
    if (!cause.words.empty()) out.push_back(std::move(cause));
  }
  return out;
}

}  // namespace parallax::tools
