// Which variables of a model are functions of the observed ones, and by which functions.
//
// Auxiliaries with a complete definition are conjunctions (Plaisted and Greenbaum 1986) and
// become known with their last child; unit propagation finds constants. For any other variable
// and each of its two values there is a candidate: it has the value exactly where one of its
// clauses, with all other variables known, leaves no choice. A candidate is refuted by a
// valuation in which the variable has the value although no such clause forces it. One call asks
// for a valuation that refutes any open candidate, until there is none; those left are forced.
// If nothing is forced, the variables of the earliest timepoint are declared free, which is
// never wrong, and the search goes on.
//
// Cost: linear for gates and constants; solver calls, some for each timepoint, only if other
// variables are neither observed nor constant.

#include "runtime/compare/definitions.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "runtime/graph/unit_values.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {
namespace {

/// Finds the auxiliaries that the model's definitions make conjunctions, and sets their role. The
/// first literal of a definition is the auxiliary's own. An auxiliary that is defined in one
/// polarity only is used in that one only; anything else is left alone. Linear in the clauses.
void find_gates(const compiler::CompiledModel& model, const std::vector<bool>& observed,
                Definitions& out);

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Literal;

/// Clauses that mention one auxiliary.
struct Candidate {
  std::vector<Literal> implied;     // it implies each of them
  std::vector<Literal> implies_it;  // all of them together imply it
  std::size_t long_clauses = 0;
  bool used_positive = false, used_negative = false;  // outside of its own definition
};

class GateFinder {
 public:
  GateFinder(const CompiledModel& model, const std::vector<bool>& observed, Definitions& out)
      : model_(model),
        observed_(observed),
        out_(out),
        candidates_(static_cast<std::size_t>(model.variable_count())) {}

  void run() {
    find_auxiliaries();
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) read(c);
    for (std::size_t v = 0; v < candidates_.size(); ++v) {
      if (is_auxiliary_[v] && is_gate(candidates_[v])) accept(v);
    }
    drop_cycles();
    out_.is_gate_clause.assign(model_.clauses.size(), false);
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (!model_.clause_is_definition[c] || model_.clauses[c].empty()) continue;
      const auto own = static_cast<std::size_t>(model_.clauses[c].front().var()) - 1;
      out_.is_gate_clause[c] = out_.of[own].role == Role::kGate;
    }
  }

 private:
  static std::size_t index(Literal literal) { return static_cast<std::size_t>(literal.var()) - 1; }

  void find_auxiliaries() {
    is_auxiliary_.assign(candidates_.size(), false);
    for (std::int32_t v = 1; v <= model_.variable_count(); ++v) {
      const auto i = static_cast<std::size_t>(v) - 1;
      const bool fixed = v <= model_.base();
      const auto kind =
          fixed ? model_.fixed[i].kind
                : model_.slots[static_cast<std::size_t>((v - model_.base() - 1) % model_.stride())]
                      .kind;
      is_auxiliary_[i] = kind == AtomKind::kAuxiliary && !observed_[i];
    }
  }

  void read(std::size_t c) {
    const auto clause = model_.clauses[c];
    std::size_t others = 0;
    if (model_.clause_is_definition[c] && clause.size() >= 2 && is_auxiliary_[index(clause[0])]) {
      others = 1;
      auto& own = candidates_[index(clause[0])];
      if (!clause[0].is_positive()) {
        // More than one alternative is no conjunction.
        if (clause.size() != 2) own.long_clauses = 2;
        own.implied.push_back(clause[1]);
      } else {
        ++own.long_clauses;
        for (const auto literal : clause.subspan(1)) own.implies_it.push_back(~literal);
      }
    }
    for (const auto literal : clause.subspan(others)) {
      auto& used = candidates_[index(literal)];
      (literal.is_positive() ? used.used_positive : used.used_negative) = true;
    }
  }

  static bool is_gate(Candidate& gate) {
    const auto sorted = [](std::vector<Literal>& literals) {
      std::sort(literals.begin(), literals.end(),
                [](Literal a, Literal b) { return a.dimacs() < b.dimacs(); });
    };
    sorted(gate.implied);
    sorted(gate.implies_it);
    if (gate.implied.empty()) return gate.long_clauses == 1 && !gate.used_positive;
    if (gate.long_clauses == 0) return !gate.used_negative;
    return gate.long_clauses == 1 && gate.implied == gate.implies_it;
  }

  void accept(std::size_t v) {
    auto& gate = candidates_[v];
    out_.of[v].role = Role::kGate;
    out_.of[v].children =
        gate.implied.empty() ? std::move(gate.implies_it) : std::move(gate.implied);
  }

  /// Drops gates that depend on themselves. (Depth first; a file may hold anything.)
  void drop_cycles() {
    enum : std::uint8_t { kNew, kOpen, kDone };
    std::vector<std::uint8_t> state(candidates_.size(), kNew);
    struct Frame {
      std::size_t variable;
      std::size_t next;
    };
    std::vector<Frame> stack;
    for (std::size_t root = 0; root < state.size(); ++root) {
      if (state[root] != kNew || out_.of[root].role != Role::kGate) continue;
      stack.push_back({root, 0});
      state[root] = kOpen;
      while (!stack.empty()) {
        auto& [v, next] = stack.back();
        auto& gate = out_.of[v];
        if (gate.role != Role::kGate || next == gate.children.size()) {
          state[v] = kDone;
          stack.pop_back();
          continue;
        }
        const auto child = index(gate.children[next++]);
        if (out_.of[child].role != Role::kGate) continue;
        if (state[child] == kOpen) {
          gate.role = Role::kFree;
          gate.children.clear();
        } else if (state[child] == kNew) {
          state[child] = kOpen;
          stack.push_back({child, 0});
        }
      }
    }
  }

  const CompiledModel& model_;
  const std::vector<bool>& observed_;
  Definitions& out_;
  std::vector<Candidate> candidates_;  // by variable - 1
  std::vector<bool> is_auxiliary_;     // by variable - 1
};

void find_gates(const CompiledModel& model, const std::vector<bool>& observed, Definitions& out) {
  out.of.resize(static_cast<std::size_t>(model.variable_count()));
  GateFinder(model, observed, out).run();
}

std::size_t index(Literal literal) { return static_cast<std::size_t>(literal.var()) - 1; }

/// Finds, one after the other, variables that the known ones force.
class ForcedSearch {
 public:
  ForcedSearch(const CompiledModel& model, const std::atomic<bool>* stop, Definitions& out)
      : model_(model), stop_(stop), out_(out), known_(out.of.size(), false) {}

  void run() {
    for (std::size_t v = 0; v < known_.size(); ++v) {
      const auto role = out_.of[v].role;
      known_[v] = role == Role::kObserved || role == Role::kConstant;
      if (role == Role::kFree) unknown_.push_back(static_cast<std::int32_t>(v) + 1);
    }
    index_gates();
    spread();
    if (unknown_.empty()) return;
    index_clauses();
    while (!unknown_.empty()) {
      const bool stopped = stop_ != nullptr && stop_->load();
      if (stopped || !force_some()) free_first(stopped);
      spread();
      std::erase_if(unknown_, [&](std::int32_t variable) {
        return bool{known_[static_cast<std::size_t>(variable) - 1]};
      });
    }
    std::sort(out_.free.begin(), out_.free.end());
  }

 private:
  struct Candidate {
    std::int32_t variable = 0;
    bool value = false;
    std::vector<std::size_t> clauses;
  };

  // --- gates become known with their last child -------------------------------------------------

  void index_gates() {
    open_children_.assign(known_.size(), 0);
    parents_.resize(known_.size());
    for (std::size_t v = 0; v < known_.size(); ++v) {
      for (const auto child : out_.of[v].children) {
        if (known_[index(child)]) continue;
        ++open_children_[v];
        parents_[index(child)].push_back(static_cast<std::int32_t>(v) + 1);
      }
      if (out_.of[v].role == Role::kGate && open_children_[v] == 0) {
        settled_.push_back(static_cast<std::int32_t>(v) + 1);
      }
    }
  }

  void spread() {
    while (!settled_.empty()) {
      const auto variable = settled_.back();
      settled_.pop_back();
      const auto v = static_cast<std::size_t>(variable) - 1;
      known_[v] = true;
      out_.order.push_back(variable);
      for (const auto parent : parents_[v]) {
        if (--open_children_[static_cast<std::size_t>(parent) - 1] == 0) {
          settled_.push_back(parent);
        }
      }
    }
  }

  // --- variables that the model forces -----------------------------------------------------

  void index_clauses() {
    clauses_of_.resize(known_.size());
    tried_.assign(2 * known_.size(), 0);
    solver_ = make_cadical_solver(stop_);
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      solver_->add_clause(model_.clauses[c]);
      for (const auto literal : model_.clauses[c]) {
        if (out_.of[index(literal)].role == Role::kFree) clauses_of_[index(literal)].push_back(c);
      }
    }
    next_variable_ = model_.variable_count();
  }

  /// Clauses with the variable in this polarity whose other variables are all known.
  std::vector<std::size_t> usable(std::int32_t variable, bool value) const {
    std::vector<std::size_t> out;
    for (const auto c : clauses_of_[static_cast<std::size_t>(variable) - 1]) {
      const auto clause = model_.clauses[c];
      const bool fits = std::all_of(clause.begin(), clause.end(), [&](Literal literal) {
        return literal.var() == variable ? literal.is_positive() == value : known_[index(literal)];
      });
      if (fits) out.push_back(c);
    }
    return out;
  }

  /// Variables and values that have more usable clauses than when they were last tried.
  std::vector<Candidate> candidates() {
    std::vector<Candidate> out;
    for (const auto variable : unknown_) {
      for (const bool value : {true, false}) {
        auto clauses = usable(variable, value);
        auto& tried = tried_[2 * (static_cast<std::size_t>(variable) - 1) + (value ? 1 : 0)];
        if (clauses.size() <= tried) continue;
        tried = clauses.size();
        out.push_back({variable, value, std::move(clauses)});
      }
    }
    return out;
  }

  Literal new_literal() { return Literal::positive(++next_variable_); }
  static Literal literal_of(const Candidate& candidate) {
    const auto literal = Literal::positive(candidate.variable);
    return candidate.value ? literal : ~literal;
  }

  /// A literal that implies: the variable has the value although no clause forces it.
  Literal exception(const Candidate& candidate) {
    const auto selector = new_literal();
    const auto own = literal_of(candidate);
    solver_->add_clause(std::vector<Literal>{~selector, own});
    for (const auto c : candidate.clauses) {
      std::vector<Literal> rest = {~selector};
      for (const auto literal : model_.clauses[c]) {
        if (literal.var() != candidate.variable) rest.push_back(literal);
      }
      solver_->add_clause(rest);
    }
    return selector;
  }

  /// In the valuation at hand, is the candidate an exception?
  bool is_refuted(const Candidate& candidate) const {
    if (!solver_->value(literal_of(candidate))) return false;
    return std::all_of(candidate.clauses.begin(), candidate.clauses.end(), [&](std::size_t c) {
      const auto clause = model_.clauses[c];
      return std::any_of(clause.begin(), clause.end(), [&](Literal literal) {
        return literal.var() != candidate.variable && solver_->value(literal);
      });
    });
  }

  /// True if some variable was found to be forced.
  bool force_some() {
    auto open = candidates();
    std::vector<Literal> exceptions;
    for (const auto& candidate : open) exceptions.push_back(exception(candidate));
    while (!open.empty()) {
      const auto any = new_literal();
      auto clause = exceptions;
      clause.push_back(~any);
      solver_->add_clause(clause);
      solver_->assume(any);
      const auto status = solver_->solve();
      if (status == SolveStatus::kUnknown) return false;
      if (status == SolveStatus::kUnsatisfiable) break;
      std::size_t kept = 0;
      for (std::size_t i = 0; i < open.size(); ++i) {
        if (is_refuted(open[i])) continue;
        if (kept != i) open[kept] = std::move(open[i]);
        exceptions[kept++] = exceptions[i];
      }
      open.resize(kept);
      exceptions.resize(kept, any);
    }
    for (auto& candidate : open) settle(candidate);
    return !open.empty();
  }

  void settle(Candidate& candidate) {
    const auto v = static_cast<std::size_t>(candidate.variable) - 1;
    if (known_[v]) return;  // by its other polarity
    auto& definition = out_.of[v];
    definition.role = Role::kForced;
    definition.value = candidate.value;
    definition.clauses = std::move(candidate.clauses);
    make_known(candidate.variable);
  }

  void make_known(std::int32_t variable) {
    known_[static_cast<std::size_t>(variable) - 1] = true;
    settled_.push_back(variable);
  }

  // --- variables that it leaves open --------------------------------------------------------

  /// By timepoint, states before events.
  std::pair<std::int32_t, int> rank(std::int32_t variable) const {
    if (variable <= model_.base()) {
      const auto& atom = model_.fixed[static_cast<std::size_t>(variable) - 1];
      return {atom.time.value_or(-1), 1};
    }
    const auto place = variable - model_.base() - 1;
    const bool is_state = place % model_.stride() < static_cast<std::int32_t>(model_.state_slots);
    return {place / model_.stride(), is_state ? 0 : 1};
  }

  void free_first(bool all) {
    auto first = rank(unknown_.front());
    for (const auto variable : unknown_) first = std::min(first, rank(variable));
    for (const auto variable : unknown_) {
      if (!all && rank(variable) != first) continue;
      out_.free.push_back(variable);
      make_known(variable);
    }
  }

  const CompiledModel& model_;
  const std::atomic<bool>* stop_;
  Definitions& out_;
  std::vector<bool> known_;            // by variable - 1
  std::vector<std::int32_t> unknown_;  // other than gates
  std::vector<std::size_t> open_children_;
  std::vector<std::vector<std::int32_t>> parents_;
  std::vector<std::int32_t> settled_;  // known, but what follows is not looked at yet
  std::vector<std::vector<std::size_t>> clauses_of_;
  std::vector<std::size_t> tried_;  // by variable and polarity: clauses at the last attempt
  std::unique_ptr<SatSolver> solver_;
  std::int32_t next_variable_ = 0;
};

}  // namespace

Definitions find_definitions(const CompiledModel& model, const std::vector<bool>& observed,
                             const std::atomic<bool>* stop) {
  Definitions out;
  find_gates(model, observed, out);
  const auto values = unit_values(model);
  for (std::size_t v = 0; v < out.of.size(); ++v) {
    if (observed[v]) {
      out.of[v].role = Role::kObserved;
    } else if (out.of[v].role != Role::kGate && values[v] != 0) {
      out.of[v].role = Role::kConstant;
      out.of[v].value = values[v] > 0;
    }
  }
  // A variable that no clause mentions may as well be false.
  std::vector<bool> mentioned(out.of.size(), false);
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    for (const auto literal : model.clauses[c]) mentioned[index(literal)] = true;
  }
  for (std::size_t v = 0; v < out.of.size(); ++v) {
    if (!mentioned[v] && out.of[v].role == Role::kFree) out.of[v].role = Role::kConstant;
  }
  ForcedSearch(model, stop, out).run();
  return out;
}

}  // namespace parallax::runtime
