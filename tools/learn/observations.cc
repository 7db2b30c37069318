#include "tools/learn/observations.h"

#include <algorithm>

#include "compiler/base/integer_range.h"
#include "compiler/repair/condition_literal.h"
#include "compiler/repair/number_term.h"
#include "harness/region/fluent_binding.h"
#include "runtime/enumerate/path_admission.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::Literal;
using compiler::SymbolKind;
using runtime::SolveStatus;

namespace {

std::string ground_name(const std::string& symbol, const std::vector<std::string>& arguments) {
  std::string out = symbol + "(";
  for (std::size_t i = 0; i < arguments.size(); ++i) out += (i == 0 ? "" : ",") + arguments[i];
  return out + ")";
}

/// A fluent, an event, or a user's predicate about constants alone.
bool is_word(const compiler::TypedModel& typed, const compiler::Symbol& symbol) {
  if (symbol.kind == SymbolKind::kFluent || symbol.kind == SymbolKind::kEvent) return true;
  if (symbol.kind != SymbolKind::kPredicate) return false;
  const auto& core = typed.core;
  return std::none_of(symbol.arguments.begin(), symbol.arguments.end(), [&](auto sort) {
    return sort == core.time || sort == core.fluent || sort == core.event;
  });
}

/// The constants of a sort, and the numbers of its ranges, each once.
std::vector<std::string> elements_of(const compiler::TypedModel& typed, compiler::SortId sort) {
  auto out = compiler::constants_of(typed, sort);
  if (!compiler::numerals_of(typed, sort).empty()) return out;
  for (std::uint32_t i = 0; i < typed.sorts.size(); ++i) {
    const compiler::SortId below(i);
    if (!typed.is_subsort(below, sort)) continue;
    for (const auto& range : typed.sorts[below].ranges) {
      for (const auto n : base::IntegerRange(range.lower, range.upper)) {
        if (out.size() > LearnVocabulary::kMostAtoms) break;
        out.push_back(std::to_string(n));
      }
    }
  }
  return out;
}

}  // namespace

LearnVocabulary::LearnVocabulary(const compiler::TypedModel& typed) : typed_(typed) {
  for (const auto& declared : typed.symbols) {
    if (!is_word(typed, declared)) continue;
    std::size_t count = 1;
    for (const auto sort : declared.arguments) {
      auto& domain = domains_[sort.index()];
      if (domain.empty()) {
        for (const auto& name : elements_of(typed, sort)) domain.push_back(number_of(name));
      }
      count = std::min<std::size_t>(count * domain.size(), kMostAtoms + 1);
    }
    if (count > kMostAtoms) {
      left_out_.push_back(declared.name);
      continue;
    }
    const auto symbol = symbols_.size();
    symbols_.push_back({declared.name, declared.kind, declared.arguments, !declared.noninertial});
    first_atoms_.push_back(atoms_.size());
    if (declared.kind == SymbolKind::kEvent || count == 0) continue;
    std::vector<std::size_t> at(declared.arguments.size(), 0);
    while (true) {
      Atom atom{symbol, {}, {}};
      std::vector<std::string> names;
      for (std::size_t i = 0; i < at.size(); ++i) {
        atom.arguments.push_back(domains_[declared.arguments[i].index()][at[i]]);
        names.push_back(constants_[atom.arguments.back()]);
      }
      atom.name = ground_name(declared.name, names);
      by_name_.emplace(atom.name, atoms_.size());
      atoms_.push_back(std::move(atom));
      std::size_t i = at.size();
      while (i > 0 && ++at[i - 1] == domains_[declared.arguments[i - 1].index()].size()) {
        at[--i] = 0;
      }
      if (i == 0) break;
    }
  }
  places_.resize(typed.sorts.size());
  for (const auto& [sort, domain] : domains_) {
    places_[sort].assign(constants_.size(), -1);
    for (std::size_t i = 0; i < domain.size(); ++i) {
      places_[sort][domain[i]] = static_cast<std::int64_t>(i);
    }
  }
}

std::size_t LearnVocabulary::number_of(const std::string& constant) {
  const auto [place, is_new] = numbers_.emplace(constant, constants_.size());
  if (is_new) {
    constants_.push_back(constant);
    values_.push_back(compiler::number_of(constant, {}));
  }
  return place->second;
}

std::optional<std::size_t> LearnVocabulary::symbol_named(const std::string& name) const {
  const auto found = std::find_if(symbols_.begin(), symbols_.end(),
                                  [&](const auto& symbol) { return symbol.name == name; });
  if (found == symbols_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - symbols_.begin());
}

std::optional<std::size_t> LearnVocabulary::constant_named(const std::string& name) const {
  const auto found = numbers_.find(name);
  return found == numbers_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::size_t> LearnVocabulary::stepped(std::size_t number, int by) const {
  if (!values_[number]) return std::nullopt;
  std::int64_t value = 0;
  if (__builtin_add_overflow(*values_[number], by, &value)) return std::nullopt;
  return constant_named(std::to_string(value));
}

bool LearnVocabulary::is_less(std::size_t left, std::size_t right) const {
  const auto known = [&](std::size_t number) { return number < values_.size() && values_[number]; };
  return known(left) && known(right) && *values_[left] < *values_[right];
}

const std::vector<std::size_t>& LearnVocabulary::domain(compiler::SortId sort) const {
  static const std::vector<std::size_t> kNone;
  const auto found = domains_.find(sort.index());
  return found == domains_.end() ? kNone : found->second;
}

std::optional<std::size_t> LearnVocabulary::atom(std::size_t symbol,
                                                 const std::vector<std::size_t>& arguments) const {
  // In the order in which they are numbered: the last argument changes first.
  const auto& sorts = symbols_[symbol].sorts;
  std::size_t place = 0;
  for (std::size_t i = 0; i < sorts.size(); ++i) {
    const auto here = places_[sorts[i].index()][arguments[i]];
    if (here < 0) return std::nullopt;
    place = place * domain(sorts[i]).size() + static_cast<std::size_t>(here);
  }
  return first_atoms_[symbol] + place;
}

std::optional<std::size_t> LearnVocabulary::atom_named(const std::string& name) const {
  const auto found = by_name_.find(name);
  if (found == by_name_.end()) return std::nullopt;
  return found->second;
}

std::optional<LearnVocabulary::Atom> LearnVocabulary::event(const std::string& name) const {
  const auto ground = harness::ground_fluent(name);
  for (std::size_t i = 0; i < symbols_.size(); ++i) {
    if (symbols_[i].kind != SymbolKind::kEvent || symbols_[i].name != ground.symbol) continue;
    Atom out{i, {}, name};
    for (const auto& argument : ground.arguments) {
      const auto number = numbers_.find(argument);
      if (number == numbers_.end()) return std::nullopt;
      out.arguments.push_back(number->second);
    }
    return out;
  }
  return std::nullopt;
}

StateCompletion::StateCompletion(const compiler::CompiledModel& model,
                                 const LearnVocabulary& vocabulary, const std::atomic<bool>& stop)
    : session_(model, runtime::make_cadical_solver(&stop)), index_(model), vocabulary_(vocabulary) {
  for (const auto& atom : vocabulary.atoms()) {
    auto truth = Truth::kUnknown;
    if (vocabulary.symbols()[atom.symbol].kind == SymbolKind::kPredicate) {
      const auto value = runtime::predicate_value(session_, atom.name);
      if (value == base::Known::kYes) truth = Truth::kTrue;
      if (value == base::Known::kNo) truth = Truth::kFalse;
    }
    fixed_.push_back(truth);
  }
}

std::optional<std::vector<Truth>> StateCompletion::complete(const Evidence::State& seen) {
  const auto known = known_.find(seen);
  if (known != known_.end()) return known->second;
  std::vector<Literal> facts;
  auto out = fixed_;
  bool possible = true;
  for (const auto& [fluent, holds] : seen) {
    if (const auto atom = vocabulary_.atom_named(fluent)) {
      out[*atom] = holds ? Truth::kTrue : Truth::kFalse;
    }
    const auto literal = index_.find(AtomKind::kHoldsAt, fluent, 0);
    if (!literal && holds) possible = false;
    if (literal) facts.push_back(holds ? *literal : ~*literal);
  }
  possible = possible && session_.solve(0, facts) != SolveStatus::kUnsatisfiable;
  for (std::size_t i = 0; possible && i < out.size(); ++i) {
    const auto& atom = vocabulary_.atoms()[i];
    const bool fluent = vocabulary_.symbols()[atom.symbol].kind == SymbolKind::kFluent;
    if (!fluent || out[i] != Truth::kUnknown) continue;
    const auto literal = index_.find(AtomKind::kHoldsAt, atom.name, 0);
    if (!literal) {
      out[i] = Truth::kFalse;
      continue;
    }
    for (const bool value : {true, false}) {
      facts.push_back(value ? ~*literal : *literal);
      const auto status = session_.solve(0, facts);
      facts.pop_back();
      if (status != SolveStatus::kUnsatisfiable) continue;
      out[i] = value ? Truth::kTrue : Truth::kFalse;
      break;
    }
  }
  std::optional<std::vector<Truth>> answer;
  if (possible) answer = std::move(out);
  return known_.emplace(seen, std::move(answer)).first->second;
}

std::size_t Observations::number_of(const std::vector<Truth>& state) {
  const auto [place, is_new] = numbers_.emplace(state, states_.size());
  if (is_new) states_.push_back(state);
  return place->second;
}

std::optional<std::size_t> Observations::add(const Evidence& run) {
  std::optional<std::size_t> before;
  // The start is skipped: a trace gives all fluents there, also unobserved ones.
  for (std::size_t t = 1; t < run.states.size(); ++t) {
    for (const auto& [fluent, holds] : run.states[t]) {
      const auto atom = vocabulary_.atom_named(fluent);
      if (atom) observed_.insert(vocabulary_.atoms()[*atom].symbol);
    }
  }
  for (std::size_t t = 0; t < run.states.size(); ++t) {
    const auto state = completion_.complete(run.states[t]);
    if (!state) return t;
    const auto after = number_of(*state);
    if (before) {
      const auto& step = run.steps[t - 1];
      const auto event = vocabulary_.event(step.event);
      if (event) {
        const bool refused = step.failed && says_not_possible(step.reason);
        const auto [place, is_new] =
            places_.emplace(std::tuple(*before, after, step.event, refused), transitions_.size());
        if (is_new) {
          transitions_.push_back({*before, after, event->symbol, event->arguments, refused, {}});
        }
        auto& runs = transitions_[place->second].runs;
        for (const auto& id : run.ids) {
          if (std::find(runs.begin(), runs.end(), id) == runs.end()) runs.push_back(id);
        }
      }
    }
    before = after;
  }
  return std::nullopt;
}

}  // namespace parallax::tools
