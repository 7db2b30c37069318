#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace parallax::compiler {

/// Positions in a store by name: open addressing, four bytes a slot. It keeps no names, so that it
/// can be copied with the store that has them; `name_of(position)` gives them.
class NameIndex {
 public:
  std::size_t size() const { return size_; }

  template <typename NameOf>
  std::optional<std::uint32_t> find(std::string_view name, const NameOf& name_of) const {
    if (slots_.empty()) return std::nullopt;
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = hash(name) & mask; slots_[i] != 0; i = (i + 1) & mask) {
      if (name_of(slots_[i] - 1) == name) return slots_[i] - 1;
    }
    return std::nullopt;
  }

  /// `position` must not be in the index.
  template <typename NameOf>
  void insert(std::uint32_t position, const NameOf& name_of) {
    if ((size_ + 1) * 2 > slots_.size()) grow(name_of);
    place(position, name_of(position));
    ++size_;
  }

 private:
  static std::size_t hash(std::string_view name) { return std::hash<std::string_view>{}(name); }

  void place(std::uint32_t position, std::string_view name) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = hash(name) & mask;
    while (slots_[i] != 0) i = (i + 1) & mask;
    slots_[i] = position + 1;
  }

  template <typename NameOf>
  void grow(const NameOf& name_of) {
    const auto old = std::move(slots_);
    slots_.assign(old.empty() ? 16 : old.size() * 2, 0);
    for (const auto slot : old) {
      if (slot != 0) place(slot - 1, name_of(slot - 1));
    }
  }

  std::vector<std::uint32_t> slots_;  // position + 1; 0 is free
  std::size_t size_ = 0;
};

}  // namespace parallax::compiler
