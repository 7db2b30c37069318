#include "compiler/ground/components.h"

#include <algorithm>
#include <cstdint>

namespace parallax::compiler {

std::vector<std::vector<std::size_t>> strong_components(
    const std::vector<std::vector<std::size_t>>& needs) {
  constexpr std::size_t kNew = SIZE_MAX;
  const auto count = needs.size();
  std::vector<std::vector<std::size_t>> components;
  std::vector<std::size_t> index(count, kNew), low(count, 0), path;
  std::vector<bool> settled(count, false);
  struct Visit {
    std::size_t node, next;
  };
  std::size_t met = 0;
  for (std::size_t root = 0; root < count; ++root) {
    if (index[root] != kNew) continue;
    std::vector<Visit> stack = {{root, 0}};
    while (!stack.empty()) {
      auto& [node, next] = stack.back();
      if (next == 0) {
        index[node] = low[node] = met++;
        path.push_back(node);
      }
      if (next < needs[node].size()) {
        const auto other = needs[node][next++];
        if (index[other] == kNew) {
          stack.push_back({other, 0});
        } else if (!settled[other]) {
          low[node] = std::min(low[node], index[other]);
        }
        continue;
      }
      const auto done = node;
      stack.pop_back();
      if (!stack.empty()) {
        auto& above = low[stack.back().node];
        above = std::min(above, low[done]);
      }
      if (low[done] != index[done]) continue;
      auto& component = components.emplace_back();
      std::size_t member = kNew;
      do {
        member = path.back();
        path.pop_back();
        settled[member] = true;
        component.push_back(member);
      } while (member != done);
      std::sort(component.begin(), component.end());
    }
  }
  return components;
}

}  // namespace parallax::compiler
