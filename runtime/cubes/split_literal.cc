// A variable by which a question falls into two easier ones (lookahead: Heule and van Maaren
// 2009).
//
// Each candidate is set to either value and propagated; the best one has the largest product of
// the numbers of literals that its two values fix. A value that leads to a conflict is
// impossible: the other one is set at once and helps all later candidates. Of many variables
// some thousand are tried, evenly over their numbers and so over the timepoints.
//
// Cost: two propagations for each candidate; it ends early after some million literals were set.

#include "runtime/cubes/split_literal.h"

#include <algorithm>

namespace parallax::runtime {
namespace {

/// So many variables are tried for one choice.
constexpr std::size_t kTried = 4096;
/// No further variables are tried once this many literals were set.
constexpr std::size_t kMostSet = 4'000'000;

}  // namespace

SplitLiteral::SplitLiteral(std::int32_t variables, std::span<const std::int32_t> clauses)
    : variables_(variables), propagation_(variables) {
  std::vector<Code> clause;
  for (const auto literal : clauses) {
    if (literal != 0) {
      const auto variable = Literal::positive(literal < 0 ? -literal : literal);
      clause.push_back(ClausePropagation::code(literal < 0 ? ~variable : variable));
      continue;
    }
    if (clause.empty()) is_consistent_ = false;
    if (clause.size() == 1) units_.push_back(clause.front());
    if (clause.size() > 1) propagation_.add(clause);
    clause.clear();
  }
}

bool SplitLiteral::hold(Code code) { return propagation_.assume(code) && propagation_.propagate(); }

std::size_t SplitLiteral::reach(Code code) {
  const auto before = propagation_.trail().size();
  const bool holds = hold(code);
  const auto fixed = propagation_.trail().size() - before;
  propagation_.undo(before);
  return holds ? fixed : 0;
}

std::optional<SplitLiteral::Code> SplitLiteral::best_open() {
  std::vector<Code> open;
  for (std::int32_t v = 0; v < variables_; ++v) {
    const auto code = 2 * static_cast<Code>(v);
    if (propagation_.is_open(code)) open.push_back(code);
  }
  const auto tried = std::min(open.size(), kTried);
  std::optional<Code> best;
  std::size_t most = 0, set = 0;
  for (std::size_t i = 0; i < tried && set < kMostSet; ++i) {
    const auto code = open[i * open.size() / tried];
    if (!propagation_.is_open(code)) continue;
    const auto with = reach(code), without = reach(code + 1);
    set += with + without;
    if (with == 0 || without == 0) {
      // Only one value is possible.
      if (!hold(with == 0 ? code + 1 : code)) return std::nullopt;
      continue;
    }
    if (with * without > most) {
      most = with * without;
      best = code;
    }
  }
  // It may have become known on the way.
  return best && propagation_.is_open(*best) ? best : std::nullopt;
}

std::optional<Literal> SplitLiteral::best(std::span<const Literal> assumed,
                                          const std::function<bool(Literal)>& is_fixed) {
  bool holds = is_consistent_;
  for (const auto unit : units_) holds = holds && hold(unit);
  for (std::int32_t v = 1; v <= variables_ && holds; ++v) {
    const auto literal = Literal::positive(v);
    if (is_fixed(literal)) holds = hold(ClausePropagation::code(literal));
    if (is_fixed(~literal)) holds = holds && hold(ClausePropagation::code(~literal));
  }
  for (const auto literal : assumed) holds = holds && hold(ClausePropagation::code(literal));
  std::optional<Literal> result;
  if (const auto code = holds ? best_open() : std::nullopt) {
    result = Literal::positive(static_cast<std::int32_t>(*code / 2) + 1);
  }
  propagation_.undo(0);
  return result;
}

}  // namespace parallax::runtime
