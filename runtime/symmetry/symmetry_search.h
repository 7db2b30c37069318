#pragma once

#include <optional>

#include "runtime/symmetry/constant_colours.h"
#include "runtime/symmetry/constant_group.h"

namespace parallax::runtime {

/// The symmetries of a model that exchange several constants at once, beyond those that exchange
/// two. For every constant of a base that exchanges leave open, and every constant of its colour,
/// it looks for one that takes the first to the second and fixes the bases before
/// (individualization and refinement, as in McKay 1981; from the last base to the first, so that
/// products of known symmetries are not sought). Each is one that the exact check accepts.
class SymmetrySearch {
 public:
  /// `set_of`: by constant, the number of the set in which any two are exchangeable. All outlive
  /// the search. `most`: number of literals that refinements may look at, beyond 16 times those of
  /// the model.
  SymmetrySearch(PermutationCheck& check, ConstantColours& colours,
                 const std::vector<std::uint32_t>& set_of, std::int64_t most);

  /// Together with the exchanges within the sets they generate all symmetries, if the search is
  /// complete.
  const std::vector<ConstantMap>& generators() const { return generators_; }
  /// False: the search was given up, as it would have taken too long.
  bool is_complete() const { return complete_; }
  /// All symmetries of the model; those within sets, if the search is not complete.
  ConstantGroup group(const std::vector<std::string>& constants) const;
  /// Lower bound on the number of symmetries.
  mpz_class known_order() const;

 private:
  using Colours = ConstantColours::Colours;
  struct Refined {
    Colours colours;
    std::size_t rounds = 0;
  };
  std::vector<std::vector<std::uint32_t>> cells_of(const Colours& colours) const;
  bool is_within_set(const std::vector<std::uint32_t>& cell) const;
  void choose_bases();
  void find_generators();
  void close_level(std::size_t level);
  std::vector<std::uint32_t> orbits_at(std::size_t level) const;
  std::optional<ConstantMap> find(std::vector<std::uint32_t> from, std::vector<std::uint32_t> to);
  std::optional<ConstantMap> finish(const Colours& source, const Colours& target);
  std::vector<std::uint32_t> images_to_try(const std::vector<std::uint32_t>& from,
                                           const std::vector<std::uint32_t>& to,
                                           std::uint32_t constant,
                                           const std::vector<std::uint32_t>& cell) const;
  bool may_go_on();

  PermutationCheck& check_;
  ConstantColours& colours_;
  const std::vector<std::uint32_t>& set_of_;
  std::int64_t most_check_ = 0, most_colours_ = 0;
  std::vector<std::uint32_t> bases_;
  std::vector<std::vector<std::uint32_t>> candidates_;  // by base: the cell it was chosen from
  std::vector<Refined> refined_;                        // by how many bases are told apart
  std::vector<ConstantMap> generators_;
  std::vector<std::size_t> level_of_;  // by generator
  std::vector<ConstantGroup::Level> levels_;
  std::int64_t words_ = 0;
  bool complete_ = true;
};

}  // namespace parallax::runtime
