#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "compiler/ground/ground_term.h"

namespace parallax::compiler {

/// The atoms of one symbol that may be true, as rows of values: the arguments and, in tables of
/// event occurrences, the timepoint last. Grows at the end; rows keep their numbers.
class GroundTable {
 public:
  explicit GroundTable(std::size_t columns) : columns_(columns) {}
  void add(std::span<const GroundTermId> row);
  std::size_t size() const { return rows_; }
  std::size_t columns() const { return columns_; }
  std::span<const GroundTermId> row(std::uint32_t number) const {
    return std::span(values_).subspan(number * columns_, columns_);
  }
  /// The rows whose columns in `mask` (bit i: column i) hold `key`, in order. An index on the mask
  /// is built when first asked for. Valid until the next `add`.
  std::span<const std::uint32_t> find(std::uint64_t mask, std::span<const GroundTermId> key);

 private:
  using Index = std::unordered_map<std::uint64_t, std::vector<std::uint32_t>>;  // by hash of key
  static std::uint64_t hash(std::span<const GroundTermId> key);
  void note(Index& index, std::uint64_t mask, std::uint32_t number) const;

  std::size_t columns_;
  std::size_t rows_ = 0;
  std::vector<GroundTermId> values_;
  std::map<std::uint64_t, Index> indexes_;  // by mask
};

}  // namespace parallax::compiler
