#include "runtime/compare/gates.h"

#include <algorithm>

namespace parallax::runtime {
namespace {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Literal;

/// What the clauses say of one auxiliary.
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

  /// A gate that needs itself is none. (Depth first; a file may hold anything.)
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

}  // namespace

void find_gates(const CompiledModel& model, const std::vector<bool>& observed, Definitions& out) {
  out.of.resize(static_cast<std::size_t>(model.variable_count()));
  GateFinder(model, observed, out).run();
}

}  // namespace parallax::runtime
