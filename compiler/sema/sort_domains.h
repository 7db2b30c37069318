#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Answers questions about the sorts of a model whose declarations are complete, with memory of
/// the answers. The model must outlive it.
class SortDomains {
 public:
  explicit SortDomains(const TypedModel& model);

  /// As TypedModel::sorts_overlap.
  bool overlap(SortId a, SortId b);
  /// The ranges of an integer sort and of all sorts below it.
  const std::vector<Sort::Range>& ranges(SortId sort);
  bool contains(SortId sort, std::int64_t value);
  /// False if the sort is known to have no element. (A reified sort with a constructor counts as
  /// having one.)
  bool has_elements(SortId sort);

 private:
  std::vector<SortId> below(SortId sort) const;  // `sort` first

  const TypedModel& model_;
  std::vector<std::vector<SortId>> children_;  // by sort
  std::vector<bool> has_constructor_;          // by sort
  std::unordered_map<std::uint64_t, bool> overlaps_;
  std::unordered_map<std::uint32_t, std::vector<Sort::Range>> ranges_;
  std::unordered_map<std::uint32_t, bool> has_elements_;
};

}  // namespace parallax::compiler
