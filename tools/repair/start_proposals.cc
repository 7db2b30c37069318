// Repairs of the start.
//
// Edits are tried one by one, likeliest first: the edited text is compiled for one timepoint and
// its starts are compared with the world's. An edit is right if the model then has a start of the
// world and none that the world excludes. If no single edit is right, the best of them, by what is
// left of the conflict, are each tried together with every other one, and so on, three at most.
// If the model has no start of the world, a single edit has to be of an axiom without which it
// has one; others are not tried. Each proposal is then checked against the recorded runs and random
// sequences like any other. Cost: one compilation for each edit, at most 500 of one size.

#include "tools/repair/start_proposals.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "compiler/base/words.h"
#include "compiler/repair/edit_text.h"
#include "tools/repair/world_files.h"

namespace parallax::tools {
namespace {

using compiler::Edit;

constexpr std::size_t kMostStartTried = 500;    // sets of edits of one size
constexpr std::size_t kMostStartBases = 3;      // of them are continued
constexpr std::size_t kMostStartEdits = 3;      // at once
constexpr std::size_t kMostStartVerified = 40;  // are checked against runs and sequences

class StartSearch {
 public:
  StartSearch(const RepairInput& input, Context& context)
      : input_(input),
        conflict_(*input.start),
        domain_(*input.domain),
        comparison_(StartComparison::make(input.loaded, context)),
        context_(context),
        edits_(edits()),
        texts_(domain_.ast, domain_.files, domain_.forms, edits_, files_of_world()) {}

  FoundProposals run() {
    result_.edits = edits_.size();
    find_blamed();
    std::vector<Tried> bases(1);
    for (std::size_t size = 1; size <= kMostStartEdits && !context_.stopped(); ++size) {
      auto tried = extend(bases);
      std::stable_sort(tried.begin(), tried.end(),
                       [](const Tried& a, const Tried& b) { return a.rank() < b.rank(); });
      take(tried);
      if (!result_.proposals.empty()) break;
      std::erase_if(tried, [&](const Tried& each) { return each.left() >= left_; });
      if (tried.empty()) break;
      left_ = tried.front().left();
      if (tried.size() > kMostStartBases) tried.resize(kMostStartBases);
      bases = std::move(tried);
    }
    return std::move(result_);
  }

 private:
  struct Tried {
    std::vector<std::size_t> set = {};
    StartComparison::Answer answer = {};
    int oddity = 0;

    bool is_right() const { return answer.has_wanted && answer.refused == 0; }
    /// The rest of the conflict: first that no start of the world is one of the model's.
    std::pair<std::size_t, std::size_t> left() const { return {answer.missing, answer.refused}; }
    std::tuple<bool, std::size_t, std::size_t, int> rank() const {
      return {!is_right(), answer.missing, answer.refused, oddity};
    }
  };

  std::vector<Edit> edits() const {
    compiler::EditScope scope;
    auto& step = scope.steps.emplace_back();
    step.differing = conflict_.differs;
    step.after = conflict_.wanted.front();
    for (const auto* all : {&input_.evidence, &input_.sequences.choosing}) {
      for (const auto& seen : *all) {
        scope.states.insert(scope.states.end(), seen.states.begin(), seen.states.end());
      }
    }
    auto out = compiler::start_edits(domain_.ast, *domain_.typed, domain_.forms, scope);
    std::stable_sort(out.begin(), out.end(),
                     [](const Edit& a, const Edit& b) { return a.oddity < b.oddity; });
    return out;
  }

  /// Whatever an edit makes of an axiom, the others still exclude what they exclude together.
  void find_blamed() {
    if (conflict_.is_shared) return;
    for (std::size_t i = 0; i < edits_.size() && !context_.stopped(); ++i) {
      if (edits_[i].kind != Edit::Kind::kDropAxiom) continue;
      std::string wrong;
      const auto text = compiler::flat_text(domain_.ast, domain_.files, texts_.changes({i}));
      const auto model = compile_text(text, 1, context_, wrong);
      if (model && comparison_->ask(*model, conflict_).has_wanted) {
        blamed_.insert(edits_[i].axioms.front());
      }
    }
  }

  bool is_blamed(const Edit& edit) const {
    return blamed_.empty() ||
           std::any_of(edit.axioms.begin(), edit.axioms.end(),
                       [&](std::size_t axiom) { return blamed_.contains(axiom); });
  }

  std::vector<Tried> extend(const std::vector<Tried>& bases) {
    std::vector<Tried> out;
    std::set<std::string> known;
    for (const auto& base : bases) {
      for (std::size_t i = 0; i < edits_.size() && out.size() < kMostStartTried; ++i) {
        if (context_.stopped()) return out;
        auto set = base.set;
        if (set.empty() && !is_blamed(edits_[i])) continue;
        if (std::any_of(set.begin(), set.end(), [&](std::size_t j) { return meet(i, j); }))
          continue;
        set.push_back(i);
        std::sort(set.begin(), set.end());
        const auto text = compiler::flat_text(domain_.ast, domain_.files, texts_.changes(set));
        if (!known.insert(text).second) continue;
        std::string wrong;
        const auto model = compile_text(text, 1, context_, wrong);
        if (!model) continue;
        out.push_back(
            {std::move(set), comparison_->ask(*model, conflict_), base.oddity + edits_[i].oddity});
      }
    }
    result_.more = result_.more || out.size() == kMostStartTried;
    return out;
  }

  /// Do both edits change the same formula?
  bool meet(std::size_t a, std::size_t b) const {
    if (a == b) return true;
    return !edits_[a].axioms.empty() && edits_[a].axioms == edits_[b].axioms;
  }

  void take(const std::vector<Tried>& tried) {
    std::size_t verified = 0;
    for (const auto& each : tried) {
      if (!each.is_right() || context_.stopped()) return;
      if (verified++ == kMostStartVerified) {
        result_.more = true;
        return;
      }
      Proposal proposal;
      const auto changes = texts_.changes(each.set);
      proposal.text = compiler::flat_text(domain_.ast, domain_.files, changes);
      proposal.verdict = verify(*proposal.text, input_.evidence, input_.sequences.choosing,
                                context_, input_.memo.get());
      proposal.words = texts_.words(each.set);
      if (!proposal.verdict.admits) {
        result_.remarks.push_back(
            fmt::format("not proposed, as the check of its text says no: {} ({})", proposal.words,
                        proposal.verdict.why));
        continue;
      }
      proposal.of_start = true;
      proposal.size = each.set.size();
      proposal.oddity = each.oddity;
      for (const auto edit : each.set) proposal.open = proposal.open || edits_[edit].frees;
      proposal.files = changed_files(domain_.files, changes);
      result_.proposals.push_back(std::move(proposal));
    }
  }

  /// The numbers of the model's files that the world reads as well.
  std::set<std::uint32_t> files_of_world() const {
    std::vector<ChangedFile> all;
    for (std::uint32_t i = 0; i < domain_.files.size(); ++i) {
      all.push_back({domain_.files[base::FileId(i)].name(), "", ""});
    }
    const auto shared = read_by_world(input_.loaded.scenario, all, context_);
    std::set<std::uint32_t> out;
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      if (std::find(shared.begin(), shared.end(), all[i].name) != shared.end()) out.insert(i);
    }
    return out;
  }

  const RepairInput& input_;
  const StartConflict& conflict_;
  const DomainModel& domain_;
  const std::unique_ptr<StartComparison> comparison_;
  Context& context_;
  const std::vector<Edit> edits_;
  const compiler::EditText texts_;
  FoundProposals result_;
  std::set<std::size_t> blamed_;  // axioms; none: any edit may help
  std::pair<std::size_t, std::size_t> left_ = {~std::size_t(0), ~std::size_t(0)};
};

}  // namespace

FoundProposals start_proposals(const RepairInput& input, Context& context) {
  if (!input.start) return {};
  return StartSearch(input, context).run();
}

}  // namespace parallax::tools
