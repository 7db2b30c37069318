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

/// A state that runs came to, as it was seen, and what the model says of it.
struct SeenState {
  Evidence::State seen;
  std::vector<std::string> runs;
  bool start = false;  // of a run
};

/// A formula about states that runs contradict, and what became of it.
struct RefutedFormula {
  std::string text, place;
  std::vector<std::string> runs;
  std::string instead;  // formulas; empty: nothing
};

/// The formulas about states, as far as runs bear them out. They come from the user and are taken
/// as they are until a run comes to a state that they exclude. Then the fewest formulas go that
/// explain all such states. Of a definition, `F <-> G`, each half is a formula by itself: what
/// contradicts one leaves the other. In the half that is wrong exceptions are learned
/// (find_openings): certain ones, where it was otherwise whenever anyone saw it, and others; any
/// other formula goes. At the start, where states are drawn from them, all
/// hold as they were, but for those that a start contradicts.
class StateAxioms {
 public:
  /// `declarations` and `vocabulary` outlive the object. Null: they are no model by themselves;
  /// `why` is what is wrong.
  static std::unique_ptr<StateAxioms> make(const Declarations& declarations,
                                           const LearnVocabulary& vocabulary,
                                           const Context& context, std::string& why);

  /// Takes back what these states, all that were seen so far, contradict.
  void refute(const std::vector<SeenState>& states, const std::atomic<bool>& stop);
  /// The declarations with what is left of the formulas: `everywhere` without those that hold at
  /// the start alone.
  std::string text(bool everywhere) const;
  std::vector<RefutedFormula> refuted() const;
  /// Has a fluent that a formula defined no one value any more?
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
  bool refute_one(const std::vector<SeenState>& states);
  void learn_exceptions(const std::vector<SeenState>& states, const std::atomic<bool>& stop);
  void learn_exceptions(Part& part, const std::vector<SeenState>& states,
                        const std::vector<std::vector<Truth>>& truths,
                        const std::atomic<bool>& stop);
  void doubt_exceptions(const std::vector<SeenState>& states,
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
