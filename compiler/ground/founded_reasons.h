#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/ground/ground_model.h"
#include "compiler/ground/least_fixpoint.h"

namespace parallax::compiler {

/// The reasons of one event, fluent or user predicate.
struct AtomReasons {
  std::vector<FormulaId> always;                       // at timepoint 0, valid for all
  std::map<Timepoint, std::vector<FormulaId>> single;  // by the atom's timepoint
};

/// `option founded on`: completed atoms that can be reasons of each other need a derivation that
/// does not lead through themselves. Adds to what completion asserts; see the source file.
class FoundedReasons {
 public:
  /// Axioms by kind and index of the atom and the bits of the reason that they give it.
  using Sources = std::map<std::tuple<AtomKind, std::uint32_t, std::uint32_t>, base::SourceRange>;

  /// `sources` are for messages; reasons that are moved in time are added. At most `max_nodes` new
  /// formulas are made for one circle. All outlive the object.
  FoundedReasons(GroundModel& model, Sources& sources, std::size_t max_nodes,
                 base::DiagnosticSink& sink)
      : model_(model), sources_(sources), max_nodes_(max_nodes), sink_(sink) {}

  /// A completed event, fluent or predicate that may be true; once for each of its completions.
  void add(AtomKind kind, std::uint32_t index, const AtomReasons& reasons, std::uint32_t origin);
  /// Asserts the derivations, or reports a circle that has none (kNotFounded). Once, at the end.
  void write();

 private:
  struct Definition {
    AtomKind kind = AtomKind::kPredicate;
    std::uint32_t index = 0;
    std::vector<const AtomReasons*> reasons;  // by completion
    std::uint32_t origin = 0;                 // of the last one
  };
  /// A definition at one timepoint.
  struct Member {
    FormulaId atom;
    std::size_t definition = 0;
    std::vector<FormulaId> reasons;
  };
  using Graph = std::vector<std::vector<std::size_t>>;

  std::optional<std::size_t> definition_of(const GroundAtom& atom) const;
  Graph needs_of_definitions() const;
  bool is_uniform(const std::vector<std::size_t>& component) const;
  std::vector<FormulaId> reasons_at(const Definition& definition, Timepoint t);
  FormulaId atom_at(const Definition& definition, Timepoint t);
  void write_uniform(const std::vector<std::size_t>& component);
  void write_unfolded(const std::vector<std::size_t>& component);
  void write_circle(const std::vector<Member>& members, Timepoint width);
  bool is_refused(const Member& member, const FixpointSystem& circle);
  base::SourceRange origin_of(const Member& member) const;
  void refuse(const Member& member, base::SourceRange source, const std::string& why);

  GroundModel& model_;
  Sources& sources_;
  std::size_t max_nodes_;
  base::DiagnosticSink& sink_;
  std::vector<Definition> definitions_;
  std::map<std::pair<AtomKind, std::uint32_t>, std::size_t> numbers_;
};

/// Conjuncts of a formula, with disjunctions over conjunctions distributed where that makes few:
/// each speaks of fewer atoms, so that its reasons do not mix with those of others.
std::vector<FormulaId> separate_conjuncts(FormulaStore& formulas, FormulaId formula);

}  // namespace parallax::compiler
