// Unit propagation once over a whole model.
//
// Each clause counts its literals that are not false yet. When a literal becomes false the
// clauses that have it, found in one array sorted by literal, are counted down; a clause that
// comes to one and has no true literal sets its last one. No values are ever taken back, so no
// watched literals are needed. Linear: each occurrence of a literal is visited once for
// counting, and the literals of a clause twice more when it becomes unit.

#include "runtime/graph/unit_values.h"

namespace parallax::runtime {
namespace {

using compiler::Literal;

class Propagator {
 public:
  explicit Propagator(const compiler::CompiledModel& model)
      : model_(model),
        values_(static_cast<std::size_t>(model.variable_count()), 0),
        open_(model.clauses.size()),
        first_(2 * values_.size() + 1, 0) {
    for (std::size_t c = 0; c < model.clauses.size(); ++c) {
      for (const auto literal : model.clauses[c]) ++first_[falsifier(literal) + 1];
    }
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    clauses_.resize(first_.back());
    auto next = first_;
    for (std::size_t c = 0; c < model.clauses.size(); ++c) {
      open_[c] = static_cast<std::uint32_t>(model.clauses[c].size());
      for (const auto literal : model.clauses[c]) {
        clauses_[next[falsifier(literal)]++] = static_cast<std::uint32_t>(c);
      }
    }
  }

  std::vector<std::int8_t> run() && {
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (open_[c] == 1) set(model_.clauses[c][0]);
    }
    while (!queue_.empty()) {
      const auto literal = queue_.back();
      queue_.pop_back();
      const auto index = falsifier(~literal);
      for (auto i = first_[index]; i < first_[index + 1]; ++i) {
        if (--open_[clauses_[i]] == 1) set_last(model_.clauses[clauses_[i]]);
      }
    }
    return std::move(values_);
  }

 private:
  /// The place of the literal that makes this one false.
  static std::size_t falsifier(Literal literal) {
    return 2 * (static_cast<std::size_t>(literal.var()) - 1) + (literal.is_positive() ? 1 : 0);
  }
  std::int8_t value(Literal literal) const {
    const auto value = values_[static_cast<std::size_t>(literal.var()) - 1];
    return literal.is_positive() ? value : static_cast<std::int8_t>(-value);
  }
  void set(Literal literal) {
    if (value(literal) != 0) return;
    values_[static_cast<std::size_t>(literal.var()) - 1] = literal.is_positive() ? 1 : -1;
    queue_.push_back(literal);
  }
  void set_last(std::span<const Literal> clause) {
    for (const auto literal : clause) {
      if (value(literal) > 0) return;
    }
    for (const auto literal : clause) {
      if (value(literal) == 0) return set(literal);
    }
  }

  const compiler::CompiledModel& model_;
  std::vector<std::int8_t> values_;
  std::vector<std::uint32_t> open_;  // literals of the clause that are not false yet
  std::vector<std::size_t> first_;   // by falsifier: into clauses_
  std::vector<std::uint32_t> clauses_;
  std::vector<Literal> queue_;
};

}  // namespace

std::vector<std::int8_t> unit_values(const compiler::CompiledModel& model) {
  return Propagator(model).run();
}

}  // namespace parallax::runtime
