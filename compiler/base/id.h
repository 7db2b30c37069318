#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace parallax::base {

template <typename Tag>
concept OrderedTag = requires {
  requires Tag::kOrdered;
};

/// A 32-bit index with a tag. It compares equal and hashes; it is not ordered unless its order
/// means something, which a tag says with `static constexpr bool kOrdered = true`.
/// "No id" is std::optional<Id>, never a reserved value.
template <typename Tag>
class Id {
 public:
  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t index) : index_(index) {}
  constexpr std::uint32_t index() const { return index_; }
  friend constexpr bool operator==(Id, Id) = default;
  friend constexpr auto operator<=>(Id a, Id b) requires OrderedTag<Tag> {
    return a.index_ <=> b.index_;
  }

 private:
  std::uint32_t index_ = 0;
};

/// Owns the values behind ids, in the order in which they were added.
/// A reference from `[]` is valid until the next `add`.
template <typename IdType, typename T>
class Store {
 public:
  IdType add(T value) {
    values_.push_back(std::move(value));
    return IdType(static_cast<std::uint32_t>(values_.size() - 1));
  }
  T& operator[](IdType id) { return values_[id.index()]; }
  const T& operator[](IdType id) const { return values_[id.index()]; }
  void reserve(std::size_t count) { values_.reserve(count); }
  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  IdType id_at(std::size_t position) const { return IdType(static_cast<std::uint32_t>(position)); }

 private:
  std::vector<T> values_;
};

}  // namespace parallax::base

template <typename Tag>
struct std::hash<parallax::base::Id<Tag>> {
  std::size_t operator()(parallax::base::Id<Tag> id) const noexcept { return id.index(); }
};
