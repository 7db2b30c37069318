// Smallest sets of edits of a plan that help.
//
// The plan is compiled once with all candidate edits in it, each guarded by a fluent of its own;
// edits that make the text wrong are found by the places of the messages, left out, and the rest
// is compiled again. The facts are those of the run that went wrong, up to its failure if the
// plan is to handle it, else of its start. By rising number of edits, bounded by a sequential
// counter (Sinz 2005), and by rising length of the execution, the solver looks for one that
// reaches the goal; sets that were found, and supersets, are excluded. If it goes well without
// any edit there is nothing to look for.
//
// Cost: one call for each size and length, and one for each set found.

#include "tools/repair/plan_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace parallax::tools {

using compiler::AtomKind;
using compiler::GuardedPlan;
using compiler::PlanEdit;
using compiler::Timepoint;
using runtime::Literal;
using runtime::SolveStatus;

namespace {

constexpr int kMostRounds = 12;  // of leaving out edits that make no plan

/// At most `bound` of the literals are true, by Sinz's sequential counter.
Literal at_most(runtime::SolverSession& session, const std::vector<Literal>& literals,
                std::size_t bound) {
  // Sinz 2005: reached[j] is implied by "of those so far more than j are true".
  const auto guard = session.new_variable();
  std::vector<Literal> reached(bound, ~guard);
  bool any = false;
  for (const auto literal : literals) {
    if (any) {
      std::vector<Literal> over = {~guard, ~literal};
      if (bound > 0) over.push_back(~reached[bound - 1]);
      session.add_clause(over);
    } else if (bound == 0) {
      session.add_clause(std::vector<Literal>{~guard, ~literal});
    }
    if (bound == 0) continue;
    std::vector<Literal> next;
    for (std::size_t j = 0; j < bound; ++j) {
      next.push_back(session.new_variable());
      if (any) session.add_clause(std::vector<Literal>{~reached[j], next[j]});
      if (j == 0) session.add_clause(std::vector<Literal>{~literal, next[j]});
      if (j > 0 && any) {
        session.add_clause(std::vector<Literal>{~literal, ~reached[j - 1], next[j]});
      }
    }
    reached = std::move(next);
    any = true;
  }
  return guard;
}

class PlanEditSearch {
 public:
  PlanEditSearch(const PlanTask& task, const std::vector<PlanEdit>& edits, Context& context,
                 std::vector<std::string>& remarks)
      : task_(task), edits_(edits), context_(context), remarks_(remarks) {
    used_.resize(edits.size());
    std::iota(used_.begin(), used_.end(), std::size_t{0});
  }

  /// False if the edits make no plan together, or the search was stopped.
  bool compile() {
    for (int round = 0; round < kMostRounds && !used_.empty() && !context_.stopped(); ++round) {
      std::vector<PlanEdit> edits;
      for (const auto i : used_) edits.push_back(edits_[i]);
      guarded_ = compiler::guarded_plan(*task_.plan, edits);
      EditedTexts texts;
      texts.model = task_.model;
      for (std::size_t i = 0; i < edits.size(); ++i) {
        *texts.model += fmt::format("fluent {}()\n", compiler::plan_edit_fluent(i));
      }
      texts.plan = guarded_.files;
      texts.horizon = task_.horizon;
      texts.constraints = task_.goal.constraints;
      PlanModel::Wrong wrong;
      model_ = PlanModel::compile(*task_.scenario, texts, context_, wrong);
      if (model_) return true;
      if (!leave_out(wrong)) {
        remarks_.push_back("the edits of the plan could not be compiled together: " + wrong.why);
        return false;
      }
    }
    return false;
  }

  std::vector<PlanChoice> find(bool handles, std::size_t most, std::size_t limit) {
    std::vector<PlanChoice> out;
    auto& session = model_->session();
    if (!prepare()) return out;
    auto facts = handles ? model_->like(*task_.evidence, task_.step + 1, task_.step + 2)
                         : model_->start(*task_.evidence);
    if (!facts) return out;
    if (!handles) {
      model_->set_bad(task_.bad);
      facts->push_back(model_->clean());
    }
    const auto after = handles ? task_.step + 1 : 0;
    const auto all = session.new_variable();  // of the sets that were found none again
    facts->push_back(all);
    for (std::size_t size = 0; size <= most && !context_.stopped(); ++size) {
      auto wanted = *facts;
      wanted.push_back(at_most(session, selectors_, size));
      for (auto n = static_cast<Timepoint>(after + 1); n <= model_->horizon();) {
        const auto status = model_->solve(task_.goal, n, wanted, after);
        if (status == SolveStatus::kUnknown) return out;
        if (status != SolveStatus::kSatisfiable) {
          ++n;
          continue;
        }
        // It goes well without any edit: there is nothing to look for.
        if (size == 0) return {};
        out.push_back(read(n));
        if (out.size() == limit) return out;
        std::vector<Literal> other = {~all};
        for (std::size_t i = 0; i < selectors_.size(); ++i) {
          if (session.value(selectors_[i])) other.push_back(~selectors_[i]);
        }
        session.add_clause(other);
      }
      if (!out.empty()) break;
    }
    return out;
  }

 private:
  bool prepare() {
    selectors_.clear();
    for (std::size_t i = 0; i < used_.size(); ++i) {
      const auto literal =
          model_->index().find(AtomKind::kHoldsAt, compiler::plan_edit_fluent(i) + "()", 0);
      // An edit that the model does not mention stays unused.
      if (literal) selectors_.push_back(*literal);
      if (literal) numbers_.push_back(i);
    }
    return !selectors_.empty();
  }

  bool leave_out(const PlanModel::Wrong& wrong) {
    std::vector<bool> bad(used_.size(), false);
    for (const auto& place : wrong.places) {
      const auto& name = context_.files()[place.file].name();
      for (std::size_t i = 0; i < used_.size(); ++i) {
        for (const auto& part : guarded_.parts[i]) {
          if (part.file == name && part.begin <= place.begin && place.end <= part.end) {
            bad[i] = true;
          }
        }
      }
    }
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (!bad[i]) left.push_back(used_[i]);
    }
    const bool any = left.size() < used_.size();
    used_ = std::move(left);
    return any;
  }

  PlanChoice read(Timepoint length) const {
    PlanChoice out;
    auto& session = model_->session();
    for (std::size_t i = 0; i < selectors_.size(); ++i) {
      if (!session.value(selectors_[i])) continue;
      out.edits.push_back(used_[numbers_[i]]);
      if (edits_[used_[numbers_[i]]].kind == PlanEdit::Kind::kInsert) {
        add_undone(numbers_[i], length, out);
      }
    }
    return out;
  }

  /// Collects the changes of fluents by performs of the inserted action.
  void add_undone(std::size_t edit, Timepoint length, PlanChoice& out) const {
    const auto& graph = model_->graph();
    auto& session = model_->session();
    for (Timepoint t = 0; t < length; ++t) {
      for (std::uint32_t i = 0; i < graph.locations.size(); ++i) {
        const auto at = model_->index().at(compiler::PlanStepId(i), t);
        if (!at || !session.value(*at)) continue;
        const auto& location = graph.locations[compiler::LocationId(i)];
        auto sources = location.calls;
        sources.push_back(location.source);
        const bool inserted = std::any_of(sources.begin(), sources.end(), [&](const auto& source) {
          const auto& name = context_.files()[source.file].name();
          return std::any_of(
              guarded_.parts[edit].begin(), guarded_.parts[edit].end(), [&](const auto& part) {
                return part.file == name && part.begin <= source.begin && source.end <= part.end;
              });
        });
        if (!inserted) continue;
        for (const auto& fluent : model_->model().fluents) {
          const auto before = model_->index().find(AtomKind::kHoldsAt, fluent.name, t);
          const auto behind = model_->index().find(AtomKind::kHoldsAt, fluent.name, t + 1);
          if (before && behind && session.value(*before) != session.value(*behind)) {
            out.undone.emplace_back(fluent.name, session.value(*before));
          }
        }
      }
    }
  }

  const PlanTask& task_;
  const std::vector<PlanEdit>& edits_;
  Context& context_;
  std::vector<std::string>& remarks_;
  std::vector<std::size_t> used_;  // edits that are in the guarded plan, by their number there
  GuardedPlan guarded_;
  std::unique_ptr<PlanModel> model_;
  std::vector<Literal> selectors_;
  std::vector<std::size_t> numbers_;  // by selector: the number in the guarded plan
};

}  // namespace

std::vector<PlanChoice> find_plan_edits(const PlanTask& task, const std::vector<PlanEdit>& edits,
                                        bool handles, std::size_t most, std::size_t limit,
                                        Context& context, std::vector<std::string>& remarks) {
  if (edits.empty()) return {};
  PlanEditSearch search(task, edits, context, remarks);
  if (!search.compile()) return {};
  return search.find(handles, most, limit);
}

}  // namespace parallax::tools
