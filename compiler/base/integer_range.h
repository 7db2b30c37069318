#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

namespace parallax::base {

/// The integers from `first` to `last`, both included, for a range-based for. It also ends where
/// `last` is the largest integer, at which `i <= last; ++i` overflows. Empty if last < first.
class IntegerRange {
 public:
  IntegerRange(std::int64_t first, std::int64_t last) : first_(first), last_(last) {}

  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = std::int64_t;
    using difference_type = std::ptrdiff_t;
    using pointer = const std::int64_t*;
    using reference = std::int64_t;

    Iterator(std::int64_t value, std::int64_t last, bool is_over)
        : value_(value), last_(last), is_over_(is_over) {}
    std::int64_t operator*() const { return value_; }
    Iterator& operator++() {
      is_over_ = value_ == last_;
      if (!is_over_) ++value_;
      return *this;
    }
    friend bool operator==(const Iterator& a, const Iterator& b) {
      return a.is_over_ == b.is_over_ && (a.is_over_ || a.value_ == b.value_);
    }

   private:
    std::int64_t value_, last_;
    bool is_over_;
  };

  Iterator begin() const { return {first_, last_, last_ < first_}; }
  Iterator end() const { return {last_, last_, true}; }

 private:
  std::int64_t first_, last_;
};

}  // namespace parallax::base
