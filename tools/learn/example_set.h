#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace parallax::tools {

/// A set of examples by number.
class ExampleSet {
 public:
  explicit ExampleSet(std::size_t count, bool all = false) : words_((count + 63) / 64, 0) {
    for (std::size_t i = 0; all && i < count; ++i) insert(i);
  }
  void insert(std::size_t i) { words_[i / 64] |= std::uint64_t{1} << (i % 64); }
  bool contains(std::size_t i) const { return (words_[i / 64] >> (i % 64) & 1U) != 0; }
  std::optional<std::size_t> first() const {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (words_[i] != 0) return i * 64 + static_cast<std::size_t>(std::countr_zero(words_[i]));
    }
    return std::nullopt;
  }
  std::size_t size() const {
    std::size_t out = 0;
    for (const auto word : words_) out += static_cast<std::size_t>(std::popcount(word));
    return out;
  }
  ExampleSet both(const ExampleSet& other) const {
    auto out = *this;
    for (std::size_t i = 0; i < words_.size(); ++i) out.words_[i] &= other.words_[i];
    return out;
  }
  ExampleSet without(const ExampleSet& other) const {
    auto out = *this;
    for (std::size_t i = 0; i < words_.size(); ++i) out.words_[i] &= ~other.words_[i];
    return out;
  }
  friend bool operator==(const ExampleSet&, const ExampleSet&) = default;

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace parallax::tools
