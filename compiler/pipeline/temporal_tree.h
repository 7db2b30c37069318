#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/ground/formula_grounder.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A temporal formula without the quantifiers around its operators, negations pushed down to the
/// state formulas that are its leaves. Children come before their parents.
class TemporalTree {
 public:
  enum class Kind : std::uint8_t {
    kLeaf,
    kAnd,  // says nothing where some part does
    kOr,
    kAll,  // a quantifier's instances: those that say nothing leave it
    kAny,
    kAlways,
    kEventually,
    kNext,
    kWeakNext,
    kUntil,
    kRelease,  // !(!a until !b)
    kHistorically,
    kOnce,
    kPreviously,
    kWeakPreviously,  // !previously !a
    kSince,
    kTriggered,  // !(!a since !b)
    kAtStart     // what the child is at timepoint 0
  };
  using Number = std::uint32_t;
  struct Node {
    Kind kind = Kind::kLeaf;
    bool negated = false;    // kLeaf
    bool looks_on = false;   // an operator about later timepoints is in it
    TypedFormulaId formula;  // the formula it was made from
    Number binding = 0;      // kLeaf
    std::vector<Number> children;
  };

  /// Deeper formulas are refused (E1009).
  static constexpr std::size_t kMostLevels = 1'000;

  /// All outlive the tree. Messages go to `place` where a formula does not stand in its file.
  TemporalTree(GroundModel& model, FormulaGrounder& grounder, base::SourceRange place,
               base::DiagnosticSink& sink);
  /// None: it is too deep or has too many instances, which was reported.
  std::optional<Number> add(TypedFormulaId formula, bool negated);
  /// A node of the kind around others, made of the formula of the last of them.
  Number wrap(Kind kind, std::vector<Number> children);
  /// The same formula as one about the last timepoint that looks back: true at n if the trace from
  /// 0 to n fulfils the node at 0. None where operators about later timepoints are nested.
  std::optional<Number> looking_back(Number node);

  const Node& operator[](Number node) const { return nodes_[node]; }
  std::size_t size() const { return nodes_.size(); }
  /// Where the formula stands for the user.
  base::SourceRange source(TypedFormulaId formula) const;
  /// Gives the variables around a leaf their values.
  void bind(Number binding);
  void unbind(Number binding);

 private:
  struct Binding {
    Number outer = 0;
    VariableId variable;
    GroundTermId value;
  };
  std::optional<Number> made(TypedFormulaId id, bool negated, Number binding, std::size_t level);
  std::optional<Number> make(TypedFormulaId id, bool negated, Number binding, std::size_t level);
  std::optional<Number> quantified(TypedFormulaId id, bool negated, Number binding,
                                   std::size_t level);
  Number push(Node node);

  GroundModel& model_;
  FormulaGrounder& grounder_;
  base::SourceRange place_;
  base::DiagnosticSink& sink_;
  std::vector<bool> temporal_;  // by formula: an operator is in it
  std::vector<Node> nodes_;
  std::vector<Binding> bindings_ = {{}};  // the first one is none
  std::map<std::tuple<std::uint32_t, bool, Number>, Number> known_;
};

}  // namespace parallax::compiler
