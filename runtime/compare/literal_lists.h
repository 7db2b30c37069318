#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/artifact/literal.h"

namespace parallax::runtime {

/// Lists of literals with a literal for each, for look-up (open addressing). They lie in one block
/// of memory: there are as many as a model has clauses.
class LiteralLists {
 public:
  using Literal = compiler::Literal;

  bool contains(std::span<const Literal> list) const { return table_[place_of(list)] != 0; }
  std::optional<Literal> find(std::span<const Literal> list) const;
  /// A list that is there keeps its literal.
  void emplace(std::span<const Literal> list, Literal value);

 private:
  struct Entry {
    std::size_t hash, begin, size;
    Literal value;
  };
  static std::size_t hash_of(std::span<const Literal> list);
  std::size_t place_of(std::span<const Literal> list) const;
  void grow();

  std::vector<Literal> literals_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> table_ = std::vector<std::uint32_t>(64, 0);  // entry + 1; 0: none
};

}  // namespace parallax::runtime
