#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/known.h"
#include "compiler/sema/typed_model.h"
#include "runtime/session/solver_session.h"
#include "tools/app/context.h"
#include "tools/repair/evidence.h"

namespace parallax::tools {

using base::Truth;

/// The vocabulary of rules: fluents, predicates without time and events of a model, with the
/// constants of their sorts, all by number.
class LearnVocabulary {
 public:
  struct Symbol {
    std::string name;
    compiler::SymbolKind kind = compiler::SymbolKind::kFluent;
    std::vector<compiler::SortId> sorts;
    bool inertial = true;  // of a fluent: events change it
  };
  struct Atom {
    std::size_t symbol = 0;
    std::vector<std::size_t> arguments;
    std::string name;  // "At(box,r1)"
  };

  /// `typed` outlives the object. Symbols with more than `kMostAtoms` ground atoms are left out.
  explicit LearnVocabulary(const compiler::TypedModel& typed);
  static constexpr std::size_t kMostAtoms = 20'000;

  const compiler::TypedModel& typed() const { return typed_; }
  const std::vector<Symbol>& symbols() const { return symbols_; }
  const std::vector<Atom>& atoms() const { return atoms_; }  // of fluents and predicates
  const std::string& constant(std::size_t number) const { return constants_[number]; }
  std::size_t constant_count() const { return constants_.size(); }
  const std::vector<std::size_t>& domain(compiler::SortId sort) const;
  std::optional<std::size_t> symbol_named(const std::string& name) const;
  std::optional<std::size_t> constant_named(const std::string& name) const;
  /// The constant for this number plus `by`. None: the constant is no number, or the sum is no
  /// number of the model.
  std::optional<std::size_t> stepped(std::size_t number, int by) const;
  /// Are both numbers, and the first one less?
  bool is_less(std::size_t left, std::size_t right) const;
  /// None: there is no such atom; the arguments are outside of its sorts.
  std::optional<std::size_t> atom(std::size_t symbol,
                                  const std::vector<std::size_t>& arguments) const;
  std::optional<std::size_t> atom_named(const std::string& name) const;
  /// Symbol and arguments of a printed event. None: it has nested terms or is not the model's.
  std::optional<Atom> event(const std::string& name) const;
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  std::size_t number_of(const std::string& constant);

  const compiler::TypedModel& typed_;
  std::vector<Symbol> symbols_;
  std::vector<Atom> atoms_;
  std::vector<std::string> constants_, left_out_;
  std::vector<std::optional<std::int64_t>> values_;  // of constants that are numbers
  std::map<std::string, std::size_t> numbers_, by_name_;
  std::vector<std::size_t> first_atoms_;                       // by symbol
  std::map<std::uint32_t, std::vector<std::size_t>> domains_;  // by sort
  std::vector<std::vector<std::int64_t>> places_;  // by sort, then constant: in the domain, or -1
};

/// Completes states by their axioms: whether a state with these values is possible, and the fluents
/// that are not observed but follow.
class StateCompletion {
 public:
  /// `model`: the declarations without a start; it outlives the object.
  StateCompletion(const compiler::CompiledModel& model, const LearnVocabulary& vocabulary,
                  const std::atomic<bool>& stop);
  /// By atom. None: no state of the model has these values.
  std::optional<std::vector<Truth>> complete(const Evidence::State& seen);

 private:
  runtime::SolverSession session_;
  compiler::AtomIndex index_;
  const LearnVocabulary& vocabulary_;
  std::vector<Truth> fixed_;  // of predicates, by atom
  std::map<Evidence::State, std::optional<std::vector<Truth>>> known_;
};

/// One step of runs, perhaps seen many times.
struct Transition {
  std::size_t before = 0, after = 0;  // states
  std::size_t event = 0;              // symbol
  std::vector<std::size_t> arguments;
  bool refused = false;           // the world said that it is not possible
  std::vector<std::string> runs;  // in the order in which they came
};

/// All observed steps, each once.
class Observations {
 public:
  Observations(const LearnVocabulary& vocabulary, StateCompletion& completion)
      : vocabulary_(vocabulary), completion_(completion) {}

  /// Adds the steps of a run, up to the first state that no state of the model corresponds to.
  /// Returns the timepoint of that state, if there is one.
  std::optional<std::size_t> add(const Evidence& run);

  const LearnVocabulary& vocabulary() const { return vocabulary_; }
  const std::vector<Transition>& transitions() const { return transitions_; }
  const std::vector<Truth>& state(std::size_t number) const { return states_[number]; }
  const std::vector<std::vector<Truth>>& states() const { return states_; }
  /// Fluent symbols that were observed at least once.
  const std::set<std::size_t>& observed() const { return observed_; }

 private:
  std::size_t number_of(const std::vector<Truth>& state);

  const LearnVocabulary& vocabulary_;
  StateCompletion& completion_;
  std::vector<std::vector<Truth>> states_;
  std::map<std::vector<Truth>, std::size_t> numbers_;
  std::vector<Transition> transitions_;
  std::map<std::tuple<std::size_t, std::size_t, std::string, bool>, std::size_t> places_;
  std::set<std::size_t> observed_;
};

}  // namespace parallax::tools
