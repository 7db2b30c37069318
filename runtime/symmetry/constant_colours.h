#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/symmetry/permutation_check.h"

namespace parallax::runtime {

/// Distinguishes constants of a model by the clauses about them: colour refinement on the graph of
/// constants, atoms and clauses (one-dimensional Weisfeiler and Leman 1968). No symmetry takes a
/// constant to one of another colour; equal colours promise nothing.
class ConstantColours {
 public:
  using Colours = std::vector<std::uint64_t>;  // by constant

  /// All outlive the colours.
  ConstantColours(const compiler::CompiledModel& model, const NamedAtoms& atoms,
                  const PermutationCheck& check);

  /// Colours in which each of `marked` is distinguished by its place in the list. Refined until a
  /// round distinguishes nothing more; `rounds` gets the number of rounds.
  Colours refined(std::span<const std::uint32_t> marked, std::size_t& rounds);
  /// The colours after this many rounds, for comparison with colours that took as many.
  Colours after(std::span<const std::uint32_t> marked, std::size_t rounds);
  /// Literals looked at so far.
  std::int64_t work() const { return work_; }
  /// Literals that a round looks at.
  std::int64_t size() const { return static_cast<std::int64_t>(places_.size()); }

 private:
  struct Place {
    std::uint64_t tag;  // sign and time
    ModelNode node;
  };
  struct Clause {
    std::uint64_t tag;  // where it holds
    std::size_t end;    // of its places
  };
  void start(std::span<const std::uint32_t> marked);
  void refine_once();
  std::size_t count() const;

  const NamedAtoms& atoms_;
  std::vector<Clause> clauses_;
  std::vector<Place> places_;
  std::vector<std::uint64_t> kinds_;  // of nodes, before constants are told apart
  Colours constants_, nodes_, next_;
  std::int64_t work_ = 0;
};

}  // namespace parallax::runtime
