#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/name_advice.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// `time` of `time27`: the sort that a variable of this name has.
std::string_view sort_of_variable(std::string_view name);

/// Extensions that a formula may use beyond its own quantifiers.
struct ElaborationOptions {
  bool allow_free_time = false;
  /// Names that no quantifier binds are variables of their sort, the same ones in all formulas that
  /// are elaborated.
  bool allow_free_variables = false;
  bool fluents_as_atoms = false;
  std::optional<TermId> fluent_time = std::nullopt;
  bool allow_effects = true;   // Initiates, Trajectory, ...
  bool complete_model = true;  // missing ranges are errors
};

/// Turns syntax trees into typed formulas: resolves names, gives variables their sorts, checks
/// arities, sorts and well-formedness. Several errors a formula; no recursion. The declarations of
/// the model must be complete.
class Elaborator {
 public:
  /// Formulas and terms of one model (E2114): some 150 bytes each, tree and axiom included.
  static constexpr std::size_t kMaxTypedNodes = 500'000;

  Elaborator(TypedModel& model, const ElaborationOptions& options, base::DiagnosticSink& sink);

  /// The typed formula; none if there was any error.
  std::optional<TypedFormulaId> elaborate(const Ast& ast, NodeId root);

  /// Results for the formula elaborated last.
  bool mentions_effects() const { return mentions_effects_; }  // also trajectories
  std::optional<VariableId> free_time() const { return free_time_; }
  /// Free variables of all formulas so far, in order of occurrence.
  const std::vector<VariableId>& free_variables() const { return free_variables_; }

  /// By symbol: was it used in any formula so far?
  bool mentioned(SymbolId symbol) const { return mentioned_[symbol.index()]; }
  void mention(SymbolId symbol) { mentioned_[symbol.index()] = true; }

  /// Reports once that an integer sort used at `use` has no range.
  void require_range(SortId sort, const base::SourceRange& use);
  bool has_room(const base::SourceRange& at);
  SortDomains& domains() { return domains_; }

 private:
  enum class Position : std::uint8_t { kFormula, kTerm };
  /// A node whose children are being visited.
  struct Frame {
    NodeId node;
    Position position = Position::kFormula;
    Position child_position = Position::kFormula;
    std::uint32_t next_child = 0;
    std::uint32_t end_child = 0;
    std::size_t values = 0;  // size of values_ when the frame was opened
    std::optional<SymbolId> symbol;
    std::optional<SortId> expected;  // sort that the parent expects, for messages
    std::vector<VariableId> variables;
    bool failed = false;
  };
  /// The result of a node: id of a formula or a term, by position.
  struct Value {
    std::uint32_t id = 0;
    bool failed = false;
  };

  void visit(NodeId node, Position position, std::optional<SortId> expected);
  void enter(Frame& frame, const Node& node);
  void enter_unary(Frame& frame, const Node& node);
  void enter_binary(Frame& frame, const Node& node);
  void check_time_is_free(Frame& frame, const Node& node);
  void enter_apply(Frame& frame, const Node& node);
  void enter_quantifier(Frame& frame, const Node& node);
  void enter_aggregate(Frame& frame, const Node& node);
  void bind_variables(Frame& frame, const Node& node);
  bool is_inside_aggregate() const;
  void advance();
  Value leave(const Frame& frame, const Node& node);

  // elaborate_terms.cc
  /// `expected`: the sort of the place, if it is known, for messages.
  Value name(const Node& node, Position position, std::optional<SortId> expected);
  Value variable(const Node& node, std::optional<SortId> expected);
  Value constant(const Node& node, std::optional<SortId> expected);
  /// A number, below a sign: the least one has no positive counterpart.
  Value number(const Node& node, const Node* minus = nullptr);
  Value apply(const Frame& frame, const Node& node);
  Value arithmetic(const Node& node, TermId left, TermId right);
  Value negation_of_term(const Node& node, TermId operand);
  Value comparison(const Node& node, TermId left, TermId right);
  Value aggregate(const Frame& frame, const Node& node);
  Value aggregate_comparison(const Node& node, bool turned, const Value& counted, TermId number);
  Value fluent_atom(const Frame& frame, const Node& node, std::vector<TermId> arguments);
  bool check_argument(const Symbol& symbol, std::size_t position, TermId term);
  bool check_integer(Operator op, TermId term);
  bool check_integers(Operator op, TermId left, TermId right);
  bool is_integer(TermId term) const;
  std::vector<SortId> sorts_of(TermId term) const;
  void report_unknown_symbol(const Node& node, Position position, std::optional<SortId> expected);
  void report_constant(const Node& node, std::optional<SortId> expected);
  std::optional<VariableId> free_variable(const Node& node);
  void report_free(const Node& node, std::optional<SortId> expected);
  std::optional<SortId> sort_beside(const Node& comparison, std::uint32_t index) const;
  std::optional<SortId> sort_of_use(const Node& formula, std::string_view name) const;
  TermId time_term(const base::SourceRange& source);

  Value connective(const Frame& frame, const Node& node);
  Value add(TypedFormula formula);
  Value add(Term term);
  static Value failure() { return {0, true}; }
  base::SourceRange source(const Node& node) const { return ast_->source(node); }
  std::string quoted(const Node& node) const;
  std::string quoted(TermId term) const;

  void bind(VariableId variable);
  void unbind(const Frame& frame);

  TypedModel& model_;
  const ElaborationOptions options_;
  base::DiagnosticSink& sink_;
  NameAdvice advice_;
  SortDomains domains_;
  const Ast* ast_ = nullptr;
  std::vector<Frame> frames_;
  std::vector<Value> values_;
  /// Innermost binding last. Names are views into the source text.
  std::unordered_map<std::string_view, std::vector<VariableId>> scope_;
  std::vector<std::string_view> bound_names_;  // of the open quantifiers, in order
  std::unordered_set<std::string_view> reported_free_;
  std::unordered_set<std::uint32_t> reported_ranges_;  // sorts
  std::vector<bool> mentioned_;                        // by symbol
  std::optional<VariableId> free_time_;
  std::vector<VariableId> free_variables_;
  std::vector<std::string_view> free_names_;  // of these, views into the source text
  bool mentions_effects_ = false;
  bool full_ = false;
};

}  // namespace parallax::compiler
