// k-induction (Sheeran, Singh and Stalmarck 2000) with invariants.
//
// Four claims, each a formula without a model, make the property hold at every timepoint:
//   beginning   no trace of a horizon up to n breaks it at its end
//   start       the invariants hold at the first timepoint that windows may begin at
//   kept        where they hold, they hold one timepoint later
//   step        no window in which they hold at every timepoint, and the property at k timepoints
//               one after the other, breaks the property at the next one
// A shortest trace that breaks the property would be longer than n by the first claim, so its last
// k + 1 timepoints are such a window. No state comes twice in such a trace before its last
// timepoints: what lies between could be cut out. So the step may ask for different states, if the
// state decides what can follow; it does so for those pairs that a solution makes equal.
//
// Invariants are the candidates (state_clause.h) that survive both claims: a solution of a claim's
// negation drops all candidates that it contradicts (Houdini, Flanagan and Leino 2001).
//
// Cost: a SAT question for each k and each pair of equal states met, and at most one for each
// candidate; k states in a window.

#include "runtime/induction/induction.h"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "runtime/induction/model_question.h"
#include "runtime/induction/state_clause.h"

namespace parallax::runtime {
namespace {

class Induction {
 public:
  Induction(const InductionTask& task, const ClaimProver& prove) : task_(task), prove_(prove) {}

  InductionAnswer run() {
    begin();
    if (!decided_) find_invariants();
    answer_.steps = std::max(most(), 0);
    for (Timepoint k = 1; !decided_ && k <= most();
         k = k < most() ? std::min(2 * k, most()) : k + 1) {
      step(k);
    }
    if (!decided_) decide(InductionVerdict::kUndecided);
    return answer_;
  }

 private:
  void decide(InductionVerdict verdict) {
    answer_.verdict = verdict;
    decided_ = true;
  }
  /// The longest step for which the beginning covers the timepoints before its window.
  Timepoint most() const {
    return task_.whole->horizon - task_.ahead - task_.back - task_.last_fixed;
  }
  std::unique_ptr<ModelQuestion> question(const CompiledModel& model, std::string claim) const {
    return std::make_unique<ModelQuestion>(model, std::move(claim), task_.stop);
  }

  /// Does a trace of some horizon up to the model's break the property?
  void begin() {
    const auto& model = *task_.whole;
    beginning_ = question(model, "no trace of a horizon up to this one breaks the property");
    const compiler::AtomIndex index(model);
    std::vector<std::pair<Literal, Timepoint>> breaks;
    std::vector<Literal> some;
    for (auto t = task_.back; t + task_.ahead <= model.horizon; ++t) {
      const auto hit = index.hit(t);
      if (!hit) continue;
      const auto broken = beginning_->new_variable();
      beginning_->imply(broken, *hit);
      if (t + task_.ahead > 0) beginning_->imply(broken, beginning_->reaches(t + task_.ahead));
      breaks.emplace_back(broken, t);
      some.push_back(broken);
    }
    beginning_->add(some);
    switch (beginning_->solve({})) {
      case SolveStatus::kUnsatisfiable:
        return;
      case SolveStatus::kUnknown:
        return decide(InductionVerdict::kStopped);
      case SolveStatus::kSatisfiable:
        break;
    }
    for (const auto& [broken, t] : breaks) {
      const auto status = beginning_->solve({broken});
      if (status == SolveStatus::kUnknown) return decide(InductionVerdict::kStopped);
      if (status == SolveStatus::kUnsatisfiable) continue;
      answer_.broken_at = t;
      break;
    }
    decide(InductionVerdict::kBroken);
  }

  // --- invariants ---

  /// A literal that implies that the clause is false at t.
  static Literal violation(ModelQuestion& question, const StateClause& clause, Timepoint t) {
    const auto violated = question.new_variable();
    const auto literals = clause_at(question.model(), clause, t);
    if (!literals) question.add(std::vector{~violated});
    for (const auto literal : literals.value_or(std::vector<Literal>())) {
      question.imply(violated, ~literal);
    }
    return violated;
  }

  /// Drops candidates until no valuation contradicts one that is left; `held`: by candidate, that
  /// it holds before. False: stopped.
  bool drop_violated(ModelQuestion& question, const std::vector<Literal>& violations,
                     std::optional<Literal> reach, const std::vector<Literal>& held = {}) {
    question.add(violations);
    for (;;) {
      std::vector<Literal> assumptions;
      if (reach) assumptions.push_back(*reach);
      for (std::size_t c = 0; c < candidates_.size(); ++c) {
        if (!alive_[c]) assumptions.push_back(~violations[c]);
        if (alive_[c] && !held.empty()) assumptions.push_back(held[c]);
      }
      const auto status = question.solve(std::move(assumptions));
      if (status == SolveStatus::kUnsatisfiable) return true;
      if (status == SolveStatus::kUnknown) return false;
      drop_false(question);
    }
  }
  /// Candidates that are false in the valuation at hand.
  void drop_false(ModelQuestion& question) {
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const auto& literals = checked_[c];
      const bool is_true =
          !literals || std::any_of(literals->begin(), literals->end(),
                                   [&](Literal literal) { return question.value(literal); });
      if (!is_true) alive_[c] = false;
    }
  }
  /// Notes where `drop_false` finds the candidates.
  void look_at(const CompiledModel& model, Timepoint t) {
    checked_.clear();
    for (const auto& clause : candidates_) checked_.push_back(clause_at(model, clause, t));
  }
  void find_invariants() {
    const auto first = task_.last_fixed + 1;
    if (first > task_.whole->horizon) return;
    candidates_ = candidate_invariants(*task_.whole, first);
    alive_.assign(candidates_.size(), true);
    if (!start_holds(first) || !is_kept()) return decide(InductionVerdict::kStopped);
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      if (alive_[c]) invariants_.push_back(candidates_[c]);
    }
    answer_.invariants = invariants_.size();
  }

  bool start_holds(Timepoint first) {
    start_ = question(*task_.whole, "the invariants hold at the first timepoint of the induction");
    std::vector<Literal> violations;
    for (const auto& clause : candidates_) violations.push_back(violation(*start_, clause, first));
    look_at(*task_.whole, first);
    start_violations_ = violations;
    first_ = first;
    return drop_violated(*start_, violations, reach(*start_, first));
  }
  static std::optional<Literal> reach(const ModelQuestion& question, Timepoint t) {
    return t > 0 ? std::optional(question.reaches(t)) : std::nullopt;
  }

  bool is_kept() {
    auto window = task_.window(std::max(task_.width, 1));
    if (!window) {
      decide(InductionVerdict::kNotProved);
      return true;
    }
    pair_ = std::make_unique<CompiledModel>(*std::move(window));
    kept_ = question(*pair_, "where the invariants hold, they hold one timepoint later");
    std::vector<Literal> violations, held;
    for (const auto& clause : candidates_) {
      held.push_back(kept_->new_variable());
      if (auto before = clause_at(*pair_, clause, 0)) {
        before->push_back(~held.back());
        kept_->add(*before);
      }
      violations.push_back(violation(*kept_, clause, 1));
    }
    look_at(*pair_, 1);
    return drop_violated(*kept_, violations, kept_->reaches(1), held);
  }

  // --- the step ---

  void step(Timepoint k) {
    const auto steps = std::max({task_.back + k + task_.ahead, task_.width, 1});
    const auto window = task_.window(steps);
    if (!window) return decide(InductionVerdict::kNotProved);
    const auto last = steps - task_.ahead;  // where the property is to be broken
    if (last - task_.back > most()) return;
    const auto asked = question(*window, "no window breaks the property at its end alone");
    const compiler::AtomIndex index(*window);
    for (auto t = task_.back; t <= last; ++t) {
      const auto hit = index.hit(t);
      if (!hit && t == last) return conclude(last - task_.back, nullptr);
      if (hit) asked->add(std::vector{t == last ? *hit : ~*hit});
    }
    for (const auto& clause : invariants_) {
      for (Timepoint t = 0; t <= steps; ++t) {
        if (const auto literals = clause_at(*window, clause, t)) asked->add(*literals);
      }
    }
    for (;;) {
      const auto status = asked->solve({asked->reaches(steps)});
      if (status == SolveStatus::kUnknown) return decide(InductionVerdict::kStopped);
      if (status == SolveStatus::kUnsatisfiable) return conclude(last - task_.back, asked.get());
      if (task_.width > 1 || !ask_for_other_states(*asked, last - task_.back)) return;
    }
  }
  /// Asks for two states to differ that are equal in the valuation at hand; false: none are.
  static bool ask_for_other_states(ModelQuestion& question, Timepoint last) {
    const auto& model = question.model();
    const auto slots = state_slots(model);
    std::set<std::vector<bool>> seen;
    std::vector<std::vector<bool>> states;
    for (Timepoint t = 0; t <= last; ++t) {
      auto& state = states.emplace_back();
      for (const auto slot : slots) {
        state.push_back(question.value(Literal::positive(model.variable(slot, t))));
      }
    }
    bool asked = false;
    for (Timepoint i = 0; i <= last; ++i) {
      for (auto k = i + 1; k <= last; ++k) {
        if (states[static_cast<std::size_t>(i)] != states[static_cast<std::size_t>(k)]) continue;
        ask_to_differ(question, slots, i, k);
        asked = true;
      }
    }
    return asked;
  }
  static std::vector<std::uint32_t> state_slots(const CompiledModel& model) {
    std::vector<std::uint32_t> slots;
    for (std::uint32_t slot = 0; slot < model.state_slots; ++slot) {
      const auto kind = model.slots[slot].kind;
      if (kind == compiler::AtomKind::kHoldsAt || kind == compiler::AtomKind::kReleasedAt) {
        slots.push_back(slot);
      }
    }
    return slots;
  }
  static void ask_to_differ(ModelQuestion& question, const std::vector<std::uint32_t>& slots,
                            Timepoint i, Timepoint k) {
    std::vector<Literal> some;
    for (const auto slot : slots) {
      const auto a = Literal::positive(question.model().variable(slot, i));
      const auto b = Literal::positive(question.model().variable(slot, k));
      const auto differ = question.new_variable();
      const Literal either[] = {~differ, a, b}, not_both[] = {~differ, ~a, ~b};
      question.add(either);
      question.add(not_both);
      some.push_back(differ);
    }
    question.add(some);
  }

  /// Has all claims proved.
  void conclude(Timepoint k, const ModelQuestion* step) {
    answer_.steps = k;
    if (!invariants_.empty() && !ask_again_about_start()) {
      return decide(InductionVerdict::kStopped);
    }
    const bool proved =
        accepted(*beginning_, "beginning") &&
        (invariants_.empty() || (accepted(*start_, "start") && accepted(*kept_, "kept"))) &&
        (step == nullptr || accepted(*step, "step"));
    decide(proved ? InductionVerdict::kHolds : InductionVerdict::kNotProved);
  }
  bool accepted(const ProofClaim& claim, std::string_view name) const {
    return prove_(claim, name) == ProofVerdict::kAccepted;
  }
  /// The claim was about all that `kept` has dropped since; fewer follow all the more.
  bool ask_again_about_start() {
    std::vector<Literal> assumptions;
    if (const auto reached = reach(*start_, first_)) assumptions.push_back(*reached);
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      if (!alive_[c]) assumptions.push_back(~start_violations_[c]);
    }
    return start_->solve(std::move(assumptions)) == SolveStatus::kUnsatisfiable;
  }

  const InductionTask& task_;
  const ClaimProver& prove_;
  InductionAnswer answer_;
  bool decided_ = false;
  std::unique_ptr<CompiledModel> pair_;  // a window of one step, or as many as a clause spans
  std::unique_ptr<ModelQuestion> beginning_, start_, kept_;
  Timepoint first_ = 0;
  std::vector<StateClause> candidates_, invariants_;
  std::vector<bool> alive_;  // by candidate
  std::vector<Literal> start_violations_;
  std::vector<std::optional<std::vector<Literal>>> checked_;  // by candidate
};

}  // namespace

InductionAnswer decide_by_induction(const InductionTask& task, const ClaimProver& prove) {
  return Induction(task, prove).run();
}

}  // namespace parallax::runtime
