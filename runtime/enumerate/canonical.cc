// The lexicographically first valuation, by asking a solver.
//
// Literals are settled in order. One that already has its preferred value keeps it. Of those
// that have not, a whole block is asked about with one clause: can any of them have it? If not,
// the block is settled as it is and the next block is twice as long. If so, the block shrinks to
// a quarter, down to one literal, which then has its preferred value. The valuation at hand is
// always one under everything settled so far, so each answer is used. Literals that the solver
// knows to be fixed are not asked about.
//
// Cost: a few calls where nothing can be improved; about log2 of the number of literals for each
// one that can.

#include "runtime/enumerate/canonical.h"

#include <algorithm>
#include <utility>

namespace parallax::runtime {

using compiler::AtomKind;

namespace {

/// Goes through the literals in order. Most are settled in one valuation and cannot change, so
/// whole blocks are asked about at once: can any literal of the block that is not as preferred
/// become so? If none can, the block stays as it is; else a smaller block is asked about, down to
/// one literal.
class CanonicalSearch {
 public:
  CanonicalSearch(SolverSession& session, Timepoint n, std::span<const Literal> assumptions,
                  std::span<const Literal> order)
      : session_(session), n_(n), order_(order), fixed_(assumptions.begin(), assumptions.end()) {}

  /// False if the solver was stopped.
  bool run() {
    while (at_ < order_.size()) {
      const auto end = std::min(at_ + block_, order_.size());
      const auto open = unpreferred(end);
      const auto status = open.empty() ? SolveStatus::kUnsatisfiable : solve_any(open);
      if (status == SolveStatus::kUnknown) return false;
      has_moved_ = has_moved_ || status == SolveStatus::kSatisfiable;
      if (status == SolveStatus::kUnsatisfiable) {
        keep(end);
        block_ *= 2;
      } else if (block_ == 1) {
        keep(end);  // it is as preferred now
      } else {
        block_ = std::max<std::size_t>(1, std::min(block_, order_.size() - at_) / 4);
      }
    }
    return true;
  }
  std::vector<Literal> take() { return std::move(fixed_); }
  bool has_moved() const { return has_moved_; }

 private:
  std::vector<Literal> unpreferred(std::size_t end) const {
    std::vector<Literal> out;
    for (std::size_t i = at_; i < end; ++i) {
      const auto literal = order_[i];
      if (!session_.value(literal) && !session_.is_fixed(~literal)) out.push_back(literal);
    }
    return out;
  }
  /// The block keeps the values of the last valuation.
  void keep(std::size_t end) {
    for (; at_ < end; ++at_) {
      fixed_.push_back(session_.value(order_[at_]) ? order_[at_] : ~order_[at_]);
    }
  }
  SolveStatus solve_any(std::vector<Literal> some) {
    if (some.size() == 1) {
      fixed_.push_back(some.front());
      const auto status = session_.solve(n_, fixed_);
      fixed_.pop_back();
      return status;
    }
    const auto wanted = session_.new_variable();
    some.push_back(~wanted);
    session_.add_clause(some);
    fixed_.push_back(wanted);
    const auto status = session_.solve(n_, fixed_);
    fixed_.pop_back();
    const auto retired = ~wanted;
    session_.add_clause(std::span(&retired, 1));
    return status;
  }

  SolverSession& session_;
  Timepoint n_;
  std::span<const Literal> order_;
  std::vector<Literal> fixed_;
  std::size_t at_ = 0;
  std::size_t block_ = 1024;
  bool has_moved_ = false;
};

}  // namespace

std::vector<std::vector<Literal>> projection_blocks(const CompiledModel& model, Distinct distinct) {
  std::vector<std::vector<Literal>> blocks(static_cast<std::size_t>(model.horizon) + 1);
  std::vector<Literal> predicates;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const auto block = static_cast<std::size_t>(atom.time.value_or(0));
    if (atom.kind == AtomKind::kHoldsAt ||
        (atom.kind == AtomKind::kReleasedAt && distinct == Distinct::kAll)) {
      blocks[block].push_back(atom.literal());
    } else if (atom.kind == AtomKind::kHappens) {
      blocks[static_cast<std::size_t>(atom.needed_horizon(model.horizon))].push_back(
          atom.literal());
    } else if (atom.kind == AtomKind::kPredicate && distinct == Distinct::kAll) {
      predicates.push_back(atom.literal());
    }
  });
  if (!predicates.empty()) blocks.push_back(std::move(predicates));
  return blocks;
}

std::vector<Literal> projected_atoms(const CompiledModel& model, Distinct distinct) {
  std::vector<Literal> out;
  for (const auto& block : projection_blocks(model, distinct)) {
    out.insert(out.end(), block.begin(), block.end());
  }
  return out;
}

std::optional<OrderedValuation> make_canonical(SolverSession& session, Timepoint n,
                                               std::span<const Literal> assumptions,
                                               std::span<const Literal> order) {
  CanonicalSearch search(session, n, assumptions, order);
  if (!search.run()) return std::nullopt;
  auto fixed = search.take();
  fixed.erase(fixed.begin(), fixed.begin() + static_cast<std::ptrdiff_t>(assumptions.size()));
  return OrderedValuation{std::move(fixed), search.has_moved()};
}

std::optional<OrderedValuation> in_order(SolverSession& session, Timepoint n,
                                         std::span<const Literal> assumptions,
                                         std::span<const Literal> order, TraceOrder wanted) {
  if (wanted == TraceOrder::kCanonical) return make_canonical(session, n, assumptions, order);
  OrderedValuation found;
  for (const auto literal : order)
    found.literals.push_back(session.value(literal) ? literal : ~literal);
  return found;
}

}  // namespace parallax::runtime
