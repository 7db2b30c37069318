// The user's formulas about states, as far as runs confirm them.
//
// Each formula, and each half of a definition, stands in one compiled model behind a predicate,
// so that an incremental solver can tell which states a selection of formulas admits. As long as
// some state that was seen is excluded: each single formula without which a state becomes
// possible gets its vote, and the one with most votes is dropped; if a state needs several
// dropped at once, a minimal set of them is. For a wrong half of a definition, exceptions are
// learned from the states in which the definition decides the fluent by itself
// (opening_search.cc), and the half is weakened by them. Exceptions that exclude a seen state
// together with the rest lose their certainty.
//
// Cost: a solver call for each state and formula, for each formula that is dropped.

#include "tools/learn/state_axioms.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "runtime/session/solver_session.h"
#include "tools/learn/learned_model.h"
#include "tools/learn/opening_search.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::Literal;
using runtime::SolveStatus;

namespace {

/// A predicate that the model has not.
std::string assumption_name(const compiler::TypedModel& typed) {
  std::string out = "Assumed";
  const auto clashes = [&] {
    return std::any_of(typed.symbols.begin(), typed.symbols.end(),
                       [&](const auto& symbol) { return symbol.name.starts_with(out); });
  };
  while (clashes()) out += "X";
  return out;
}

void add_runs(const std::vector<std::string>& from, std::vector<std::string>& to) {
  for (const auto& run : from) {
    if (std::find(to.begin(), to.end(), run) == to.end()) to.push_back(run);
  }
}

}  // namespace

std::unique_ptr<StateAxioms> StateAxioms::make(const Declarations& declarations,
                                               const LearnVocabulary& vocabulary,
                                               const Context& context, std::string& why) {
  auto out = std::unique_ptr<StateAxioms>(new StateAxioms(declarations, vocabulary, context));
  for (std::size_t i = 0; i < declarations.formulas.size(); ++i) {
    if (declarations.formulas[i].definition) {
      out->parts_.push_back({i, Part::Half::kNeeds, {}, false, true, {}, {}});
      out->parts_.push_back({i, Part::Half::kSuffices, {}, false, true, {}, {}});
    } else {
      out->parts_.push_back({i, Part::Half::kWhole, {}, false, true, {}, {}});
    }
  }
  out->model_ = compile_text(out->guarded(), 1, context, why);
  if (!out->model_) return nullptr;
  out->index_ = std::make_unique<compiler::AtomIndex>(*out->model_);
  out->session_ = std::make_unique<runtime::SolverSession>(
      *out->model_, runtime::make_cadical_solver(&context.stop()));
  const auto name = assumption_name(vocabulary.typed());
  for (std::size_t i = 0; i < out->parts_.size(); ++i) {
    out->parts_[i].assumption =
        out->index_->find(AtomKind::kPredicate, fmt::format("{}{}()", name, i), std::nullopt);
  }
  return out;
}

std::string StateAxioms::guarded() const {
  const auto name = assumption_name(vocabulary_.typed());
  std::string out;
  std::size_t part = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) out += fmt::format("predicate {}{}()\n", name, i);
  for (const auto& piece : declarations_.states) {
    out += piece.text;
    if (!piece.formula) continue;
    for (; part < parts_.size() && parts_[part].formula == *piece.formula; ++part) {
      out += fmt::format("{}{}{}() -> ({}).\n", declarations_.formulas[*piece.formula].quantifier(),
                         name, part, body(parts_[part]));
    }
  }
  return out;
}

std::string StateAxioms::body(const Part& part) const {
  const auto& formula = declarations_.formulas[part.formula];
  switch (part.half) {
    case Part::Half::kNeeds:
      return fmt::format("{} -> ({})", formula.definition->left, formula.definition->right);
    case Part::Half::kSuffices:
      return fmt::format("({}) -> {}", formula.definition->right, formula.definition->left);
    case Part::Half::kWhole:
      break;
  }
  return formula.body;
}

std::optional<std::size_t> StateAxioms::symbol_of(const Part& part) const {
  const auto& formula = declarations_.formulas[part.formula];
  for (std::size_t i = 0; formula.definition && i < vocabulary_.symbols().size(); ++i) {
    if (vocabulary_.symbols()[i].name == formula.definition->fluent) return i;
  }
  return std::nullopt;
}

std::vector<bool> StateAxioms::kept() const {
  std::vector<bool> out;
  for (const auto& part : parts_) out.push_back(!part.refuted);
  return out;
}

bool StateAxioms::possible(const Evidence::State& seen, const std::vector<bool>& kept,
                           std::optional<std::size_t> without_fluent, std::optional<Literal> also) {
  std::vector<Literal> facts;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const auto& assumption = parts_[i].assumption;
    if (assumption) facts.push_back(kept[i] ? *assumption : ~*assumption);
  }
  for (const auto& [fluent, holds] : seen) {
    if (without_fluent) {
      const auto atom = vocabulary_.atom_named(fluent);
      if (atom && vocabulary_.atoms()[*atom].symbol == *without_fluent) continue;
    }
    const auto literal = index_->find(AtomKind::kHoldsAt, fluent, 0);
    if (!literal && holds) return false;
    if (literal) facts.push_back(holds ? *literal : ~*literal);
  }
  if (also) facts.push_back(*also);
  return session_->solve(0, facts) != SolveStatus::kUnsatisfiable;
}

/// Drops the formula without which most states become possible; among equals a definition of an
/// observed fluent, then the first. True: one was dropped.
bool StateAxioms::refute_one(const std::vector<ReachedState>& states) {
  const auto now = kept();
  std::vector<std::size_t> votes(parts_.size(), 0);
  std::vector<bool> defines_seen(parts_.size(), false);
  std::vector<std::size_t> together;  // of a state that more than one formula excludes
  for (const auto& state : states) {
    if (context_.stopped()) return false;
    if (possible(state.seen, now)) continue;
    if (!possible(state.seen, std::vector<bool>(parts_.size(), false))) continue;
    bool single = false;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!now[i] || !parts_[i].assumption) continue;
      auto without = now;
      without[i] = false;
      if (!possible(state.seen, without)) continue;
      ++votes[i];
      single = true;
      const auto symbol = symbol_of(parts_[i]);
      defines_seen[i] = symbol && std::any_of(state.seen.begin(), state.seen.end(), [&](auto& one) {
                          const auto atom = vocabulary_.atom_named(one.first);
                          return atom && vocabulary_.atoms()[*atom].symbol == *symbol;
                        });
    }
    if (single || !together.empty()) continue;
    std::vector<bool> with(parts_.size(), false);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!now[i]) continue;
      with[i] = true;
      if (possible(state.seen, with)) continue;
      with[i] = false;
      together.push_back(i);
    }
  }
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (votes[i] == 0) continue;
    if (!best ||
        std::pair(votes[i], defines_seen[i]) > std::pair(votes[*best], defines_seen[*best]))
      best = i;
  }
  if (best) together = {*best};
  for (const auto i : together) parts_[i].refuted = true;
  return !together.empty();
}

void StateAxioms::refute(const std::vector<ReachedState>& states, const std::atomic<bool>& stop) {
  const auto before = text(true);
  while (refute_one(states)) {
  }
  const auto now = kept();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    auto& part = parts_[i];
    if (!part.refuted) continue;
    part.runs.clear();
    auto with = now;
    with[i] = true;
    for (const auto& state : states) {
      if (possible(state.seen, with)) continue;
      add_runs(state.runs, part.runs);
      if (state.start) part.at_start = false;
    }
  }
  learn_exceptions(states, stop);
  if (text(true) != before) ++version_;
}

void StateAxioms::learn_exceptions(const std::vector<ReachedState>& states,
                                   const std::atomic<bool>& stop) {
  std::vector<Part*> wrong;
  for (auto& part : parts_) {
    if (part.refuted && part.half != Part::Half::kWhole) wrong.push_back(&part);
  }
  if (wrong.empty()) return;
  for (auto* part : wrong) part->exceptions.clear();
  // Completes the states by the other formulas, without any exceptions yet.
  if (const auto text = this->text(true); text != bare_text_) {
    std::string why;
    auto model = compile_text(text, 1, context_, why);
    if (!model) return;
    bare_completion_.reset();
    bare_model_ = *std::move(model);
    bare_completion_ = std::make_unique<StateCompletion>(*bare_model_, vocabulary_, stop);
    bare_text_ = text;
  }
  std::vector<std::vector<Truth>> truths;
  for (const auto& state : states) {
    auto truth = bare_completion_->complete(state.seen);
    truths.push_back(truth ? *std::move(truth) : std::vector<Truth>());
  }
  for (auto* part : wrong) learn_exceptions(*part, states, truths, stop);
  doubt_exceptions(states, truths, stop);
}

/// Exceptions that are certain by themselves may, together with other formulas, exclude a state
/// that runs came to. Then none counts as certain.
void StateAxioms::doubt_exceptions(const std::vector<ReachedState>& states,
                                   const std::vector<std::vector<Truth>>& truths,
                                   const std::atomic<bool>& stop) {
  std::string why;
  const auto model = compile_text(text(true), 1, context_, why);
  bool all = model.has_value();
  if (all) {
    StateCompletion completion(*model, vocabulary_, stop);
    for (std::size_t i = 0; i < states.size() && all; ++i) {
      all = truths[i].empty() || completion.complete(states[i].seen).has_value();
    }
  }
  if (all) return;
  for (auto& part : parts_) {
    for (auto& rule : part.exceptions) rule.certain = false;
  }
}

void StateAxioms::learn_exceptions(Part& part, const std::vector<ReachedState>& states,
                                   const std::vector<std::vector<Truth>>& truths,
                                   const std::atomic<bool>& stop) {
  const auto symbol = symbol_of(part);
  if (!symbol) return;
  // The definition as it was written, for what it says of a state.
  auto whole = kept();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    whole[i] = whole[i] || parts_[i].formula == part.formula;
  }
  OpeningProblem problem{RuleKind::kAdmits, 0, *symbol, {}, 0.0};
  const bool expected = part.half == Part::Half::kSuffices;
  std::map<std::pair<std::vector<Truth>, std::vector<std::size_t>>, std::size_t> places;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (truths[i].empty() || stop.load()) continue;
    for (const auto& [fluent, holds] : states[i].seen) {
      const auto atom = vocabulary_.atom_named(fluent);
      if (!atom || vocabulary_.atoms()[*atom].symbol != *symbol) continue;
      const auto literal = index_->find(AtomKind::kHoldsAt, fluent, 0);
      if (!literal) continue;
      // This half concerns states in which the definition gives `expected`.
      if (possible(states[i].seen, whole, symbol, expected ? ~*literal : *literal)) continue;
      OpeningExample example{i, {}, vocabulary_.atoms()[*atom].arguments, 0, 0, false, {}};
      (holds ? example.held : example.failed) = states[i].runs.size();
      example.open = holds != expected;
      example.runs = states[i].runs;
      problem.examples.push_back(std::move(example));
    }
  }
  part.exceptions = shortest_exceptions(std::move(problem), vocabulary_, truths, stop);
}

std::string StateAxioms::condition(const LearnedRule& exception,
                                   const StateFormula& formula) const {
  return print_condition(exception, vocabulary_, formula.definition->arguments, formula.time);
}

std::string StateAxioms::weakened(const Part& part, bool everywhere) const {
  const auto& formula = declarations_.formulas[part.formula];
  if (part.half == Part::Half::kWhole) return "";
  const auto& left = formula.definition->left;
  const auto& right = formula.definition->right;
  const bool needs = part.half == Part::Half::kNeeds;
  std::string exceptions, certain;
  bool anything = false;
  for (const auto& rule : part.exceptions) {
    const auto text = condition(rule, formula);
    anything = anything || text.empty();
    exceptions += fmt::format("{}({})", exceptions.empty() ? "" : " | ", text);
    if (!rule.certain) continue;
    // The other half states the remaining conditions, unless it is wrong, too.
    std::vector<std::string> where;
    if (!everywhere && part.at_start && !formula.time.empty())
      where.push_back(formula.time + "!=0");
    if (!text.empty()) where.push_back("(" + text + ")");
    if (other_half_is_wrong(part)) where.push_back((needs ? "!(" : "(") + right + ")");
    certain += formula.quantifier();
    for (std::size_t i = 0; i < where.size(); ++i) certain += (i == 0 ? "" : " & ") + where[i];
    certain += fmt::format("{}{}{}.\n", where.empty() ? "" : " -> ", needs ? "" : "!", left);
  }
  if (exceptions.empty() || anything) return certain;
  return (needs ? fmt::format("{}{} -> ({}) | {}.\n", formula.quantifier(), left, right, exceptions)
                : fmt::format("{}({}) -> {} | {}.\n", formula.quantifier(), right, left,
                              exceptions)) +
         certain;
}

bool StateAxioms::other_half_is_wrong(const Part& part) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const auto& other) {
    return other.formula == part.formula && other.half != part.half && other.refuted;
  });
}

std::string StateAxioms::at_start(const Part& part) const {
  const auto& formula = declarations_.formulas[part.formula];
  if (!part.at_start || formula.time.empty()) return "";
  return fmt::format("{}{}=0 -> ({}).\n", formula.quantifier(), formula.time, body(part));
}

std::string StateAxioms::text(bool everywhere) const {
  std::string out;
  std::size_t first = 0;
  for (const auto& piece : declarations_.states) {
    out += piece.text;
    if (!piece.formula) continue;
    const auto& formula = declarations_.formulas[*piece.formula];
    auto end = first;
    bool touched = false;
    for (; end < parts_.size() && parts_[end].formula == *piece.formula; ++end) {
      touched = touched || parts_[end].refuted;
    }
    for (auto i = first; touched && i < end; ++i) {
      const auto& part = parts_[i];
      if (part.refuted && !everywhere) {
        out += fmt::format("; {} was otherwise: contradicted by {}.\n", formula.place,
                           named_runs(part.runs));
      }
      if (!part.refuted) {
        out += fmt::format("{}{}.\n", formula.quantifier(), body(part));
      } else {
        out += weakened(part, everywhere);
        if (!everywhere) out += at_start(part);
      }
    }
    if (!touched) out += formula.text;
    first = end;
  }
  return out;
}

bool StateAxioms::opens() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const auto& part) {
    if (!part.refuted || part.half == Part::Half::kWhole) return false;
    return part.exceptions.empty() || !std::all_of(part.exceptions.begin(), part.exceptions.end(),
                                                   [](const auto& rule) { return rule.certain; });
  });
}

std::vector<RefutedFormula> StateAxioms::refuted() const {
  std::vector<RefutedFormula> out;
  for (const auto& part : parts_) {
    if (!part.refuted) continue;
    const auto& formula = declarations_.formulas[part.formula];
    RefutedFormula told{formula.quantifier() + body(part) + ".", formula.place, part.runs,
                        weakened(part, false) + at_start(part)};
    if (!told.instead.empty()) told.instead.pop_back();
    std::replace(told.instead.begin(), told.instead.end(), '\n', ' ');
    out.push_back(std::move(told));
  }
  return out;
}

}  // namespace parallax::tools
