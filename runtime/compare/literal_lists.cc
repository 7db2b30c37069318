#include "runtime/compare/literal_lists.h"

#include <algorithm>

#include "compiler/base/hash.h"

namespace parallax::runtime {

std::size_t LiteralLists::hash_of(std::span<const Literal> list) {
  auto hash = base::kFnvStart;
  for (const auto literal : list) {
    hash = base::fnv1a64_word(hash, static_cast<std::uint32_t>(literal.dimacs()));
  }
  return static_cast<std::size_t>(hash);
}

std::size_t LiteralLists::place_of(std::span<const Literal> list) const {
  const auto hash = hash_of(list);
  const auto mask = table_.size() - 1;
  auto place = hash & mask;
  for (; table_[place] != 0; place = (place + 1) & mask) {
    const auto& entry = entries_[table_[place] - 1];
    if (entry.hash != hash || entry.size != list.size()) continue;
    if (std::equal(list.begin(), list.end(), literals_.begin() + static_cast<long>(entry.begin))) {
      break;
    }
  }
  return place;
}

std::optional<LiteralLists::Literal> LiteralLists::find(std::span<const Literal> list) const {
  const auto entry = table_[place_of(list)];
  if (entry == 0) return std::nullopt;
  return entries_[entry - 1].value;
}

void LiteralLists::emplace(std::span<const Literal> list, Literal value) {
  const auto place = place_of(list);
  if (table_[place] != 0) return;
  entries_.push_back({hash_of(list), literals_.size(), list.size(), value});
  literals_.insert(literals_.end(), list.begin(), list.end());
  table_[place] = static_cast<std::uint32_t>(entries_.size());
  if (2 * entries_.size() > table_.size()) grow();
}

void LiteralLists::grow() {
  table_.assign(2 * table_.size(), 0);
  const auto mask = table_.size() - 1;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    auto place = entries_[i].hash & mask;
    while (table_[place] != 0) place = (place + 1) & mask;
    table_[place] = static_cast<std::uint32_t>(i + 1);
  }
}

}  // namespace parallax::runtime
