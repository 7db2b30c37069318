#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "runtime/symmetry/named_atoms.h"

namespace parallax::runtime {

/// Every constant's image, by constant.
using ConstantMap = std::vector<std::uint32_t>;

/// Does replacing constants by their images in all names map the clauses of a model onto
/// themselves? Clauses that hold at every timepoint are looked at once. Auxiliaries are mapped
/// along with their definitions; invariants, which follow from the rest, are left out. The origin
/// of a clause (an axiom, a plan, a state constraint) makes no difference.
class PermutationCheck {
 public:
  /// `model` and `atoms` outlive the check. Linear in the clauses of one timepoint and in those
  /// that hold once.
  PermutationCheck(const compiler::CompiledModel& model, const NamedAtoms& atoms);

  struct Entry {
    std::uint32_t clause = 0;  // number in the model
    std::int32_t section = 0;  // 0: holds once; else the section's number + 1
  };

  /// A hash that is equal for a constant and its image; constants with different hashes need no
  /// check.
  std::uint64_t signature(std::uint32_t constant) const;
  /// `map` is a permutation. Linear in the clauses that mention a constant that it moves; where
  /// facts differ, in those about such constants.
  bool is_symmetric(const ConstantMap& map);
  /// The clauses that the check looks at.
  const std::vector<Entry>& entries() const { return entries_; }
  /// Clauses looked at by all checks so far.
  std::int64_t work() const { return work_; }

 private:
  std::uint64_t literal_hash(compiler::Literal literal, ModelNode image, std::int32_t origin) const;
  std::uint64_t clause_hash(const Entry& entry) const;
  std::uint64_t definition_hash(ModelNode auxiliary) const;
  std::int32_t time_of(std::int32_t variable) const;
  ModelNode image(ModelNode node) const;
  void collect();
  void prepare();
  void order_auxiliaries();
  bool map_facts(const ConstantMap& map);
  bool map_names(const ConstantMap& map);
  bool is_bijective();
  bool map_auxiliaries();
  bool set_image(ModelNode node, ModelNode to);
  bool has_image(const Entry& entry);
  void clear();

  const compiler::CompiledModel& model_;
  const NamedAtoms& atoms_;
  std::vector<Entry> entries_;
  std::vector<std::vector<std::uint32_t>> mentions_;     // entries, by node
  std::vector<std::vector<std::uint32_t>> facts_;        // entries of one literal, by node
  std::vector<std::vector<std::uint32_t>> definitions_;  // entries, by auxiliary
  std::vector<std::vector<ModelNode>> users_;  // auxiliaries whose definitions mention the node
  std::vector<std::uint32_t> rank_;            // of auxiliaries: those they are defined by first
  std::unordered_multimap<std::uint64_t, std::uint32_t> by_hash_;  // entries
  std::unordered_map<std::uint64_t, ModelNode> by_definition_;
  std::vector<ModelNode> images_;  // of the permutation at hand, by node; kNoImage: itself
  std::vector<ModelNode> moved_;
  std::vector<std::uint32_t> seen_;  // by entry: number of the check
  std::uint32_t checks_ = 0;
  std::int64_t work_ = 0;
};

}  // namespace parallax::runtime
