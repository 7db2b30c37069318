#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Finds completed atoms that can be reasons of each other. Completion asks a reason of each atom
/// that is true; under `A -> B` and `B -> A` each is the reason of the other, so both may be true
/// without any further reason. A model whose atoms do not depend on each other in such a circle is
/// tight (Fages 1994): there completion admits only atoms that the formulas bring about.
///
/// The reasons of ground atoms are split into conjunctions of literals. Atoms that follow from
/// facts and atoms that nothing can bring about are removed; the remaining atoms are searched for
/// circles whose literals do not contradict each other. At most quadratic in the reasons but for
/// that search, which has a budget.
class SupportLoops {
 public:
  /// `model` outlives the object.
  explicit SupportLoops(const GroundModel& model) : model_(model) {}

  /// A reason of an atom; with a width it is one at every timepoint, each time moved by as much.
  void add(const GroundAtom& atom, FormulaId reason, Timepoint width,
           const base::SourceRange& source);
  /// Warns (kSupportLoop) of a circle of each set of axioms that makes one. `completes`: is the
  /// atom completed, so that it needs a reason?
  void report(const std::function<bool(const GroundAtom&)>& completes, base::DiagnosticSink& sink);

 private:
  using Key = std::tuple<AtomKind, std::uint32_t, Timepoint>;
  struct Literal {
    Key atom;
    bool positive;
    friend auto operator<=>(const Literal&, const Literal&) = default;
  };
  struct Reason {
    Key head;
    std::vector<Literal> literals;  // literals that hold where it is one
    base::SourceRange source;
    bool dead = false;  // it asks for what nothing brings about
  };
  using Circle = std::vector<std::size_t>;  // reasons, each for what the one before asks for

  void add_conjunctions(const Key& head, FormulaId formula, Timepoint steps,
                        const base::SourceRange& source);
  void settle(const std::function<bool(const GroundAtom&)>& completes);
  void drop_impossible();
  void drop_certain();
  void drop_ends();
  std::optional<Circle> circle_from(const Key& start, std::size_t& budget) const;
  bool is_open(const Key& key) const { return open_.contains(key); }
  std::string text(const Key& key) const;

  const GroundModel& model_;
  std::vector<Reason> reasons_;
  std::map<Key, std::vector<std::size_t>> by_head_;
  std::set<Key> open_;  // completed, neither certain nor impossible, and maybe in a circle
  bool full_ = false;
};

}  // namespace parallax::compiler
