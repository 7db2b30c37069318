#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/session/solver_session.h"
#include "tools/learn/declarations.h"
#include "tools/learn/observations.h"
#include "tools/learn/rule.h"

namespace parallax::tools {

/// An observed state, with the runs that came to it.
struct ReachedState {
  Evidence::State seen;
  std::vector<std::string> runs;
  bool start = false;  // of a run
};

/// A formula about states that runs contradict, and its replacement.
struct RefutedFormula {
  std::string text, place;
  std::vector<std::string> runs;
  std::string instead;  // formulas; empty: nothing
};

/// The formulas about states, as far as runs confirm them. They come from the user and are kept
/// until a run comes to a state that they exclude. Then the fewest formulas are dropped that
/// explain all such states. A definition, `F <-> G`, counts as two formulas, one for each half:
/// what contradicts one leaves the other. For the wrong half, exceptions are learned
/// (find_openings): certain ones, where it was wrong whenever it was observed, and others; any
/// other formula is dropped. At the start, where states are drawn from them, all formulas hold as
/// written, except those that a start contradicts.
class StateAxioms {
 public:
  /// `declarations` and `vocabulary` outlive the object. Null: they are no model by themselves;
  /// `why` is what is wrong.
  static std::unique_ptr<StateAxioms> make(const Declarations& declarations,
                                           const LearnVocabulary& vocabulary,
                                           const Context& context, std::string& why);

  /// Drops or weakens the formulas that these states, all observed so far, contradict.
  void refute(const std::vector<ReachedState>& states, const std::atomic<bool>& stop);
  /// The declarations with what is left of the formulas: `everywhere` without those that hold at
  /// the start alone.
  std::string text(bool everywhere) const;
  std::vector<RefutedFormula> refuted() const;
  /// Is there a fluent with a definition that no longer determines its value?
  bool opens() const;
  /// Changes when the text does.
  std::size_t version() const { return version_; }

 private:
  /// A formula, or a half of a definition.
  struct Part {
    enum class Half : std::uint8_t { kWhole, kNeeds, kSuffices };  // F -> G, G -> F
    std::size_t formula = 0;
    Half half = Half::kWhole;
    std::optional<compiler::Literal> assumption;  // none: the formula says nothing
    bool refuted = false;
    bool at_start = true;  // it holds there all the same
    std::vector<std::string> runs;
    std::vector<LearnedRule> exceptions;
  };
  StateAxioms(const Declarations& declarations, const LearnVocabulary& vocabulary,
              const Context& context)
      : declarations_(declarations), vocabulary_(vocabulary), context_(context) {}

  std::string guarded() const;
  std::string body(const Part& part) const;
  std::string condition(const LearnedRule& exception, const StateFormula& formula) const;
  std::string weakened(const Part& part, bool everywhere) const;
  bool other_half_is_wrong(const Part& part) const;
  std::string at_start(const Part& part) const;
  std::optional<std::size_t> symbol_of(const Part& part) const;
  bool possible(const Evidence::State& seen, const std::vector<bool>& kept,
                std::optional<std::size_t> without_fluent = std::nullopt,
                std::optional<compiler::Literal> also = std::nullopt);
  std::vector<bool> kept() const;
  bool refute_one(const std::vector<ReachedState>& states);
  void learn_exceptions(const std::vector<ReachedState>& states, const std::atomic<bool>& stop);
  void learn_exceptions(Part& part, const std::vector<ReachedState>& states,
                        const std::vector<std::vector<Truth>>& truths,
                        const std::atomic<bool>& stop);
  void doubt_exceptions(const std::vector<ReachedState>& states,
                        const std::vector<std::vector<Truth>>& truths,
                        const std::atomic<bool>& stop);

  const Declarations& declarations_;
  const LearnVocabulary& vocabulary_;
  const Context& context_;
  std::vector<Part> parts_;
  std::optional<compiler::CompiledModel> model_;  // each part behind a predicate
  std::unique_ptr<compiler::AtomIndex> index_;
  std::unique_ptr<runtime::SolverSession> session_;
  std::size_t version_ = 0;
  // The formulas without exceptions.
  std::string bare_text_;
  std::optional<compiler::CompiledModel> bare_model_;
  std::unique_ptr<StateCompletion> bare_completion_;
};

}  // namespace parallax::tools
