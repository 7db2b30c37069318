#include "tests/fuzz/old_encoder.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "tests/fuzz/old_models.h"
#include "tests/fuzz/old_terms.h"
#include "tests/fuzz/old_tree.h"

namespace parallax::test {
namespace {

using compiler::EffectAxiom;
using compiler::EffectKind;
using compiler::FormulaKind;
using compiler::SymbolKind;
using compiler::TermKind;
using compiler::TrajectoryKind;
using compiler::TypedFormula;
using Kind = OldTree::Kind;

class OldEncoder : OldTerms {
 public:
  OldEncoder(const compiler::TypedModel& model, const std::vector<StatedExclusion>& exclusions)
      : OldTerms(model), exclusions_(exclusions) {
    for (const auto& time : domain(*model.core.time)) horizon_ = std::max(horizon_, time.number);
    for (std::size_t i = 0; i < model.symbols.size(); ++i) {
      const auto symbol = model.symbols.id_at(i);
      if (model.symbols[symbol].kind != SymbolKind::kFluent) continue;
      for (auto& made : instances(symbol)) fluents_.push_back({made.text, symbol});
    }
  }

  OldAnswer run(std::size_t limit) {
    encode();
    if (!beyond_.empty()) return {{}, beyond_};
    return old_models(formulas_, static_cast<std::size_t>(horizon_), limit);
  }

 private:
  struct Fluent {
    std::string text;
    compiler::SymbolId symbol;
  };
  bool encoding3() const { return model_.options.encoding == 3; }

  // --- atoms ---

  OldTree state(char kind, const std::string& fluent, bool fits, std::int64_t t) const {
    return OldTree::atom_of(timed_atom(kind, t, fluent), !fits || t < 0 || t > horizon_);
  }
  OldTree happens(const OldValue& event, std::int64_t t) const {
    return OldTree::atom_of(timed_atom('e', t, event.text), !event.fits || t < 0 || t >= horizon_);
  }

  /// The formula that replaces an effect atom.
  OldTree transformed(EffectKind kind, const OldValue& event, const OldValue& fluent,
                      std::int64_t t) const {
    const auto released = state('r', fluent.text, fluent.fits, t + 1);
    if (kind == EffectKind::kReleases) {
      return OldTree::of(Kind::kImplies, {happens(event, t), released});
    }
    auto after = state('h', fluent.text, fluent.fits, t + 1);
    if (kind == EffectKind::kTerminates) after = OldTree::of(Kind::kNot, {std::move(after)});
    return OldTree::of(Kind::kImplies,
                       {happens(event, t),
                        old_conjunction({std::move(after), OldTree::of(Kind::kNot, {released})})});
  }

  OldTree atom(const TypedFormula& formula) {
    std::vector<OldValue> arguments;
    for (const auto id : formula.terms) arguments.push_back(term(id));
    const auto& core = model_.core;
    const auto& symbol = formula.predicate;
    if (symbol == core.happens) return happens(arguments[0], arguments[1].number);
    if (symbol == core.holds_at || symbol == core.released_at) {
      return state(symbol == core.holds_at ? 'h' : 'r', arguments[0].text, arguments[0].fits,
                   arguments[1].number);
    }
    for (const auto& [effect, kind] : {std::pair(core.initiates, EffectKind::kInitiates),
                                       std::pair(core.terminates, EffectKind::kTerminates),
                                       std::pair(core.releases, EffectKind::kReleases)}) {
      if (symbol != effect) continue;
      if (encoding3()) beyond_ = "effects inside formulas with encoding 3";
      return transformed(kind, arguments[0], arguments[1], arguments[2].number);
    }
    const auto made = applied(symbol, arguments);
    return OldTree::atom_of(predicate_atom(made.text), !made.fits);
  }

  // --- formulas ---

  /// Combines a quantifier's instances, without those that have an atom that does not exist.
  static OldTree quantified(bool all, std::vector<OldTree> instances) {
    std::erase_if(instances, [](const OldTree& instance) { return instance.has_beyond(); });
    if (instances.empty()) return OldTree::constant(all);
    if (instances.size() == 1) return std::move(instances.front());
    return OldTree::of(all ? Kind::kAnd : Kind::kOr, std::move(instances));
  }

  /// A part that is constant counts as a constant at once. The program of 2005 does so in
  /// conjunctions and disjunctions alone; parts below a negation or a quantifier it may discard
  /// (docs/reference/model_language.md).
  OldTree tree(compiler::TypedFormulaId id) {
    auto made = written_out(id);
    if (made.has_beyond()) return made;
    const auto simple = simplified(made, false);
    return simple.is(Kind::kTrue) || simple.is(Kind::kFalse) ? simple : made;
  }

  OldTree written_out(compiler::TypedFormulaId id) {
    const auto& formula = model_.formulas[id];
    const auto parts = [&] {
      std::vector<OldTree> made;
      for (const auto child : formula.children) made.push_back(tree(child));
      return made;
    };
    switch (formula.kind) {
      case FormulaKind::kAggregate:  // refused
      case FormulaKind::kTemporal:
        break;
      case FormulaKind::kTrue:
      case FormulaKind::kFalse:
        return OldTree::constant(formula.kind == FormulaKind::kTrue);
      case FormulaKind::kAtom:
        return atom(formula);
      case FormulaKind::kCompare:
        return OldTree::constant(compare(formula));
      case FormulaKind::kNot:
        return OldTree::of(Kind::kNot, parts());
      case FormulaKind::kAnd:
        return old_conjunction(parts());
      case FormulaKind::kOr:
        return old_disjunction(parts());
      case FormulaKind::kImplies:
        return OldTree::of(Kind::kImplies, parts());
      case FormulaKind::kIff:
        return OldTree::of(Kind::kEquiv, parts());
      case FormulaKind::kForall:
      case FormulaKind::kExists: {
        std::vector<OldTree> instances;
        each_assignment(formula.variables, 0,
                        [&] { instances.push_back(tree(formula.children[0])); });
        return quantified(formula.kind == FormulaKind::kForall, std::move(instances));
      }
    }
    return OldTree::constant(true);
  }

  // --- what is asserted ---

  /// Asserts the simplified formula; one that grounds to a constant is left out.
  std::optional<OldTree> assert_tree(const OldTree& made) {
    auto simple = simplified(made, false);
    if (simple.is(Kind::kTrue) || simple.is(Kind::kFalse)) return std::nullopt;
    formulas_.push_back(simple);
    return simple;
  }

  void encode() {
    for (const auto& exclusion : exclusions_) write_out(exclusion);
    for (const auto& axiom : model_.axioms) {
      const auto stated = [&](const StatedExclusion& one) { return one.source == axiom.source; };
      if (std::any_of(exclusions_.begin(), exclusions_.end(), stated)) continue;
      const auto made = assert_tree(tree(axiom.formula));
      if (made && !axiom.mentions_effects) labelled_.emplace_back(axiom.label, *made);
    }
    for (const auto& effect : model_.effects) assert_effect(effect);
    for (const auto& fluent : fluents_) assert_start(fluent);
    const auto completions = completed_clauses();
    for (const auto& axiom : model_.trajectories) assert_trajectory(axiom);
    for (const auto& fluent : fluents_) assert_frame(fluent);
    assert_completions(completions);
  }

  void state_exclusion(const OldTree& made) {
    if (auto kept = assert_tree(made)) labelled_.emplace_back("", *std::move(kept));
  }

  void write_out(const StatedExclusion& exclusion) {
    for (const auto first : exclusion.names) {
      for (const auto second : exclusion.names) {
        if (first == second) continue;
        state_exclusion(over_arguments({first, second}, true, [](std::vector<OldTree> atoms) {
          for (auto& atom : atoms) atom = OldTree::of(Kind::kNot, {std::move(atom)});
          return old_disjunction(std::move(atoms));
        }));
      }
    }
    if (!exclusion.is_xor || exclusion.names.empty()) return;
    state_exclusion(over_arguments(exclusion.names, false, [](std::vector<OldTree> atoms) {
      return atoms.size() == 1 ? atoms.front() : old_disjunction(std::move(atoms));
    }));
  }

  /// The names of the variables of a symbol's arguments. Pairs number every one; in the disjunction
  /// of `xor` a sort that the symbol has once is not numbered.
  std::vector<std::string> variable_names(compiler::SymbolId symbol, bool numbers) const {
    const auto& sorts = model_.symbols[symbol].arguments;
    std::map<std::uint32_t, int> seen;
    std::vector<std::string> names;
    for (const auto sort : sorts) {
      const int number = ++seen[sort.index()];
      const bool once = std::count(sorts.begin(), sorts.end(), sort) == 1;
      names.push_back(model_.sorts[sort].name + (once && !numbers ? "" : std::to_string(number)));
    }
    return names;
  }

  /// For all values of the variables, and timepoints unless the names are predicates.
  template <typename Combine>
  OldTree over_arguments(const std::vector<compiler::SymbolId>& symbols, bool numbers,
                         const Combine& combine) {
    std::map<std::string, compiler::SortId> variables;
    bool timed = false;
    for (const auto symbol : symbols) {
      const auto names = variable_names(symbol, numbers);
      for (std::size_t i = 0; i < names.size(); ++i) {
        variables.emplace(names[i], model_.symbols[symbol].arguments[i]);
      }
      timed = timed || model_.symbols[symbol].kind != SymbolKind::kPredicate;
    }
    std::vector<std::map<std::string, OldValue>> choices = {{}};
    for (const auto& [name, sort] : variables) {
      std::vector<std::map<std::string, OldValue>> longer;
      for (const auto& choice : choices) {
        for (const auto& value : domain(sort)) {
          longer.push_back(choice);
          longer.back().emplace(name, value);
        }
      }
      choices = std::move(longer);
    }
    std::vector<OldTree> all;
    for (std::int64_t t = 0; t <= (timed ? horizon_ : 0); ++t) {
      for (const auto& choice : choices) {
        std::vector<OldTree> atoms;
        for (const auto symbol : symbols) {
          std::vector<OldValue> arguments;
          for (const auto& name : variable_names(symbol, numbers)) {
            arguments.push_back(choice.at(name));
          }
          const auto made = applied(symbol, arguments);
          const auto kind = model_.symbols[symbol].kind;
          atoms.push_back(kind == SymbolKind::kEvent ? happens(made, t)
                          : kind == SymbolKind::kFluent
                              ? state('h', made.text, made.fits, t)
                              : OldTree::atom_of(predicate_atom(made.text)));
        }
        all.push_back(combine(std::move(atoms)));
      }
    }
    if (variables.empty() && !timed) return all.front();
    return quantified(true, std::move(all));
  }

  bool is_noninertial(const std::string& fluent) const {
    for (const auto& one : fluents_) {
      if (one.text == fluent) return model_.symbols[one.symbol].noninertial;
    }
    return false;
  }

  void assert_effect(const EffectAxiom& effect) {
    std::vector<OldTree> all;
    each_assignment(effect.variables, 0, [&] {
      const auto fluent = term(effect.fluent);
      if (encoding3() && is_noninertial(fluent.text)) return;
      all.push_back(OldTree::of(
          Kind::kImplies, {tree(effect.condition), transformed(effect.kind, term(effect.event),
                                                               fluent, term(effect.time).number)}));
    });
    assert_tree(quantified(true, std::move(all)));
  }

  void assert_start(const Fluent& fluent) {
    const auto& symbol = model_.symbols[fluent.symbol];
    for (std::int64_t t = 0; symbol.noninertial && t <= horizon_; ++t) {
      assert_tree(state('r', fluent.text, true, t));
    }
    if (symbol.noninertial || symbol.manual_release) return;
    assert_tree(OldTree::of(Kind::kNot, {state('r', fluent.text, true, 0)}));
  }

  /// The events that change the fluent at t by this axiom. Variables beside those of the fluent and
  /// the time get a quantifier of their own.
  std::vector<OldTree> causes(const EffectAxiom& effect, const std::string& fluent,
                              std::int64_t t) {
    std::vector<OldTree> found;
    std::vector<OldTree> filtered;
    const bool bare = is_bare(effect);
    each_assignment(effect.variables, 0, [&] {
      if (term(effect.fluent).text != fluent || term(effect.time).number != t) return;
      auto made = old_conjunction({tree(effect.condition), happens(term(effect.event), t)});
      (bare ? found : filtered).push_back(std::move(made));
    });
    if (!bare) found.push_back(quantified(false, std::move(filtered)));
    return found;
  }

  bool is_bare(const EffectAxiom& effect) const {
    const auto& fluent = model_.terms[effect.fluent];
    const auto& event = model_.terms[effect.event];
    const auto& time = model_.terms[effect.time];
    if (effect.shares_instances || fluent.kind != TermKind::kApply ||
        event.kind != TermKind::kApply || time.kind != TermKind::kVariable) {
      return false;
    }
    std::vector<std::uint32_t> known = {time.variable.index()};
    for (const auto argument : fluent.arguments) {
      if (model_.terms[argument].kind != TermKind::kVariable) return false;
      known.push_back(model_.terms[argument].variable.index());
    }
    std::vector<std::uint32_t> used;
    collect(effect.event, used);
    collect(effect.condition, used);
    return std::all_of(used.begin(), used.end(), [&](std::uint32_t variable) {
      const bool own = std::any_of(effect.variables.begin(), effect.variables.end(),
                                   [&](auto bound) { return bound.index() == variable; });
      return !own || std::find(known.begin(), known.end(), variable) != known.end();
    });
  }

  void collect(compiler::TermId id, std::vector<std::uint32_t>& found) const {
    const auto& node = model_.terms[id];
    if (node.kind == TermKind::kVariable) found.push_back(node.variable.index());
    for (const auto argument : node.arguments) collect(argument, found);
  }
  void collect(compiler::TypedFormulaId id, std::vector<std::uint32_t>& found) const {
    const auto& formula = model_.formulas[id];
    for (const auto part : formula.terms) collect(part, found);
    for (const auto child : formula.children) collect(child, found);
  }

  void add_causes(EffectKind kind, const std::string& fluent, std::int64_t t,
                  std::vector<OldTree>& into) {
    for (const auto& effect : model_.effects) {
      if (effect.kind != kind) continue;
      for (auto& cause : causes(effect, fluent, t)) into.push_back(std::move(cause));
    }
  }

  void assert_frame(const Fluent& fluent) {
    const bool noninertial = model_.symbols[fluent.symbol].noninertial;
    const bool any_inertial = std::any_of(fluents_.begin(), fluents_.end(), [&](const Fluent& one) {
      return !model_.symbols[one.symbol].noninertial;
    });
    const bool any_inertial_symbol =
        any_inertial ||
        std::any_of(model_.symbols.begin(), model_.symbols.end(),
                    [](const auto& s) { return s.kind == SymbolKind::kFluent && !s.noninertial; });
    if (noninertial && (!encoding3() || any_inertial_symbol)) return;
    for (std::int64_t t = 0; t < horizon_; ++t) {
      const auto frame = [&](char kind, bool rises, std::vector<EffectKind> kinds) {
        auto before = state(kind, fluent.text, true, t);
        auto after = state(kind, fluent.text, true, t + 1);
        std::vector<OldTree> parts;
        if (rises) {
          parts = {before, OldTree::of(Kind::kNot, {after})};
        } else {
          parts = {OldTree::of(Kind::kNot, {before}), after};
        }
        if (kind == 'h') parts.push_back(state('r', fluent.text, true, t + 1));
        if (!noninertial) {
          for (const auto one : kinds) add_causes(one, fluent.text, t, parts);
        }
        auto made = old_disjunction(std::move(parts));
        if (!made.has_beyond()) assert_tree(made);
      };
      frame('h', true, {EffectKind::kInitiates});
      frame('h', false, {EffectKind::kTerminates});
      frame('r', true, {EffectKind::kReleases});
      frame('r', false, {EffectKind::kInitiates, EffectKind::kTerminates});
    }
  }

  void assert_trajectory(const compiler::TrajectoryAxiom& axiom) {
    if (encoding3()) {
      if (model_.options.trajectory) beyond_ = "trajectories with encoding 3";
      return;
    }
    if (axiom.kind == TrajectoryKind::kAntiTrajectory) return;
    std::vector<OldTree> all;
    each_assignment(axiom.variables, 0, [&] {
      const auto fluent = term(axiom.fluent), target = term(axiom.target);
      const auto t = term(axiom.time).number, d = term(axiom.offset).number;
      const auto known = [&](const Fluent& one) { return one.text == fluent.text; };
      if (std::none_of(fluents_.begin(), fluents_.end(), known) || t < 0 || t >= horizon_) return;
      std::vector<OldTree> started, stopped;
      add_causes(EffectKind::kInitiates, fluent.text, t, started);
      for (auto s = t + 1; s < t + d && s <= horizon_; ++s) {
        std::vector<OldTree> here;
        add_causes(EffectKind::kTerminates, fluent.text, s, here);
        auto made = old_disjunction(std::move(here));
        stopped.push_back(std::move(made));
      }
      auto premise =
          old_conjunction({OldTree::of(Kind::kNot, {quantified(false, std::move(stopped))}),
                           old_disjunction(std::move(started))});
      auto head = OldTree::of(Kind::kImplies,
                              {std::move(premise), state('h', target.text, target.fits, t + d)});
      all.push_back(OldTree::of(Kind::kImplies, {tree(axiom.condition), std::move(head)}));
    });
    assert_tree(quantified(true, std::move(all)));
  }

  // --- completion ---

  bool is_of(const std::string& literal, compiler::SymbolId predicate) const {
    const auto& core = model_.core;
    if (predicate == core.happens) return literal.starts_with("e|");
    if (predicate == core.holds_at) return literal.starts_with("h|");
    if (predicate == core.released_at) return literal.starts_with("r|");
    return literal.starts_with(predicate_atom(model_.symbols[predicate].name + "("));
  }

  /// By completion: the clauses of all formulas that it covers.
  std::vector<std::vector<OldClause>> completed_clauses() {
    std::vector<std::vector<OldClause>> all;
    for (const auto& completion : model_.completions) {
      auto& mine = all.emplace_back();
      for (const auto& [label, formula] : labelled_) {
        if (completion.label && *completion.label != label) continue;
        std::vector<OldClause> clauses;
        if (distributed(formula, clauses)) {
          for (auto& clause : clauses) mine.push_back(std::move(clause));
          continue;
        }
        for (const auto& atom : atoms_in(formula)) {
          if (is_of(atom, completion.predicate)) beyond_ = "completion over named parts";
        }
      }
    }
    return all;
  }

  void assert_completions(const std::vector<std::vector<OldClause>>& clauses) {
    std::set<std::string> atoms;
    for (const auto& formula : formulas_) {
      for (auto& atom : atoms_in(formula)) atoms.insert(std::move(atom));
    }
    for (std::size_t i = 0; i < model_.completions.size(); ++i) {
      for (const auto& atom : atoms) {
        if (is_of(atom, model_.completions[i].predicate)) assert_completion(atom, clauses[i]);
      }
    }
  }

  void assert_completion(const std::string& atom, const std::vector<OldClause>& clauses) {
    bool found = false;
    std::vector<OldTree> reasons;
    for (const auto& clause : clauses) {
      if (std::find(clause.begin(), clause.end(), atom) == clause.end()) continue;
      found = true;
      std::vector<OldTree> others;
      for (const auto& literal : clause) {
        if (literal == atom) continue;
        const bool negative = literal.starts_with("!");
        auto other = OldTree::atom_of(negative ? literal.substr(1) : literal);
        others.push_back(negative ? std::move(other) : OldTree::of(Kind::kNot, {std::move(other)}));
      }
      if (!others.empty()) reasons.push_back(OldTree::of(Kind::kAnd, std::move(others)));
    }
    auto denied = OldTree::of(Kind::kNot, {OldTree::atom_of(atom)});
    if (!found) {
      formulas_.push_back(std::move(denied));
    } else if (!reasons.empty()) {
      formulas_.push_back(
          OldTree::of(Kind::kOr, {std::move(denied), OldTree::of(Kind::kOr, std::move(reasons))}));
    }
  }

  const std::vector<StatedExclusion>& exclusions_;
  std::int64_t horizon_ = 0;
  std::vector<Fluent> fluents_;
  std::vector<OldTree> formulas_;  // simplified
  std::vector<std::pair<std::string, OldTree>> labelled_;
};

}  // namespace

OldAnswer old_encoder_traces(const compiler::TypedModel& model,
                             const std::vector<StatedExclusion>& exclusions, std::size_t limit) {
  return OldEncoder(model, exclusions).run(limit);
}

}  // namespace parallax::test
