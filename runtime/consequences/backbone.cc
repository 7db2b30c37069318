// Which atoms are true in all traces, in some, or in none (Janota, Lynce and Marques-Silva
// 2015).
//
// Each valuation found is evidence: an atom seen true and seen false is settled. One call then
// asks for a valuation in which any unsettled atom differs from what was seen; such an atom is
// preferred in the solver, so that many differ at once. When no such valuation exists, all atoms
// that are left are the same in every trace. With state constraints this is done for each length
// of traces, and an atom is asked about only in traces that have its timepoint.
//
// Cost: at most one call for each atom that is true in some traces only, and two for each
// length.

#include "runtime/consequences/backbone.h"

namespace parallax::runtime {
namespace {

class BackboneSearch {
 public:
  BackboneSearch(SolverSession& session, std::span<const Literal> atoms, Asked asked)
      : session_(session), atoms_(atoms), asked_(asked), index_(session.model()) {
    for (const auto atom : atoms) {
      const auto described = session.model().atom(atom.var());
      const bool event = described.kind == compiler::AtomKind::kHappens;
      needed_.push_back(described.time.value_or(0) + (event ? 1 : 0));
    }
    seen_true_.resize(atoms.size());
    seen_false_.resize(atoms.size());
  }

  Consequences run() {
    const auto horizon = session_.model().horizon;
    if (!session_.model().has_constraints) {
      stopped_ = !explore(horizon, {});
    } else {
      std::vector<Literal> unmet;  // no hit so far
      for (Timepoint n = 0; n <= horizon && !stopped_; ++n) {
        const auto hit = index_.hit(n);
        if (!hit) continue;
        auto assumptions = unmet;
        assumptions.push_back(*hit);
        stopped_ = !explore(n, assumptions);
        unmet.push_back(~*hit);
      }
    }
    return result();
  }

 private:
  /// The traces of one length; false if the solver was stopped.
  bool explore(Timepoint n, const std::vector<Literal>& assumptions) {
    const auto first = session_.solve_whole(n, assumptions);
    if (first == SolveStatus::kUnknown) return false;
    if (first == SolveStatus::kUnsatisfiable) return true;
    note(n);
    while (true) {
      const auto wanted = session_.new_variable();
      std::vector<Literal> some = {~wanted};
      for (std::size_t i = 0; i < atoms_.size(); ++i) {
        if (needed_[i] > n || is_settled(i)) continue;
        const auto other = seen_true_[i] ? ~atoms_[i] : atoms_[i];
        if (session_.is_fixed(~other)) continue;
        some.push_back(other);
        session_.prefer(other);
      }
      auto status = SolveStatus::kUnsatisfiable;
      if (some.size() > 1) {
        session_.add_clause(some);
        auto assumed = assumptions;
        assumed.push_back(wanted);
        status = session_.solve_whole(n, assumed);
        const auto retired = ~wanted;
        session_.add_clause(std::span(&retired, 1));
      }
      if (status == SolveStatus::kUnknown) return false;
      if (status == SolveStatus::kUnsatisfiable) return true;
      note(n);
    }
  }

  bool is_settled(std::size_t i) const {
    return seen_false_[i] && (seen_true_[i] || asked_ == Asked::kAll);
  }

  void note(Timepoint n) {
    session_.require_model(n);
    any_ = true;
    for (std::size_t i = 0; i < atoms_.size(); ++i) {
      if (needed_[i] > n) continue;
      (session_.value(atoms_[i]) ? seen_true_ : seen_false_)[i] = true;
    }
  }

  Consequences result() const {
    Consequences out;
    if (any_ || !stopped_) out.any = any_;
    for (std::size_t i = 0; i < atoms_.size(); ++i) {
      const bool yes = seen_true_[i], no = seen_false_[i];
      auto extent = yes ? Extent::kAll : no ? Extent::kNone : Extent::kAbsent;
      if (no && asked_ == Asked::kAll) {
        extent = Extent::kNotAll;
      } else if (yes && no) {
        extent = Extent::kSome;
      } else if (stopped_) {
        extent = Extent::kUndecided;
        out.complete = false;
      }
      out.extents.push_back(extent);
    }
    out.complete = out.complete && out.any.has_value();
    return out;
  }

  SolverSession& session_;
  std::span<const Literal> atoms_;
  Asked asked_;
  compiler::AtomIndex index_;
  std::vector<Timepoint> needed_;  // by atom: the shortest length that has it
  std::vector<bool> seen_true_, seen_false_;
  bool any_ = false, stopped_ = false;
};

}  // namespace

Consequences find_consequences(SolverSession& session, std::span<const Literal> atoms,
                               Asked asked) {
  return BackboneSearch(session, atoms, asked).run();
}

}  // namespace parallax::runtime
