#include "tools/repair/plan_proposals.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_grammar.h"
#include "tools/repair/plan_candidates.h"
#include "tools/repair/plan_search.h"
#include "tools/repair/plan_step.h"

namespace parallax::tools {

using compiler::PlanEdit;

namespace {

constexpr std::size_t kMostSteps = 3;      // that went wrong
constexpr std::size_t kMostChoices = 100;  // that the solver is asked for, in each model
constexpr std::size_t kMostTogether = 48;  // edits that are written into one plan
constexpr std::size_t kMostTried = 5;      // of them are compiled from their text
constexpr std::size_t kMostKept = 3;       // proposals for each model

/// An assumption about the world.
struct World {
  std::string text;      // of the model
  std::size_t rank = 0;  // of the proposal that says so; 0: the model as it is
  const Proposal* from = nullptr;
};

class PlanRepair {
 public:
  PlanRepair(const RepairInput& input, const std::vector<Proposal>& models, Context& context)
      : input_(input), models_(models), context_(context) {}

  FoundProposals run() {
    source_ = read_plan(input_, context_);
    if (!source_) return std::move(found_);
    std::set<std::string> known;
    for (const auto& parting : input_.partings) {
      if (context_.stopped() || known.size() == kMostSteps) break;
      if (known.insert(parting.step.event).second) repair(parting);
    }
    // The best for each assumption about the world, then the second ones.
    std::stable_sort(kept_.begin(), kept_.end(), [](const Kept& a, const Kept& b) {
      // Changes that only hide a failure come last, however small they are.
      return std::tuple(a.proposal.hides_failure, a.proposal.size, a.kind, a.round) <
             std::tuple(b.proposal.hides_failure, b.proposal.size, b.kind, b.round);
    });
    for (auto& each : kept_) found_.proposals.push_back(std::move(each.proposal));
    return std::move(found_);
  }

 private:
  void repair(const RunParting& parting) {
    auto step = find_plan_step(input_, *source_, parting, context_, found_.remarks);
    if (!step) return;
    step_ = *std::move(step);
    can_be_run_.clear();
    for (const auto& world : worlds()) {
      if (!context_.stopped()) look(world);
    }
  }

  bool constrained() const { return has_constraints(input_.loaded.scenario); }

  std::vector<World> worlds() const {
    std::vector<World> out;
    for (std::size_t i = 0; i < models_.size() && i < kMostModels; ++i) {
      if (!models_[i].text) continue;
      out.push_back({*models_[i].text, i + 1, &models_[i]});
    }
    // The runs themselves: the step is bad where it went wrong.
    if (out.empty() && !step_.differing.empty()) out.push_back({input_.text});
    return out;
  }

  struct Tried {
    Proposal proposal;
    int kind = 0;
    std::vector<compiler::TextChange> changes;  // of the plan
    /// The change is around the step: the order does not consider its traces.
    bool around() const { return kind >= static_cast<int>(PlanEdit::Kind::kRetry); }
  };
  struct Kept {
    Proposal proposal;
    int kind = 0;
    std::size_t round = 0;  // number of better ones for the same world
  };

  /// Looks for changes that help in that world, if the plan is the worse for the world being like
  /// that.
  void look(const World& world) {
    step_.task.model = world.text;
    step_.task.bad.where = world.rank == 0 ? step_.differing : Evidence::State{};
    PlanModel::Wrong wrong;
    const auto before = compile_plan(step_.task, world.text, {}, false, context_, wrong);
    if (!before) return;
    before->set_bad(step_.task.bad);
    if (before->can_be_bad() != true) return;
    std::set<std::string> defined, fluents;
    for (const auto& symbol : input_.domain->typed->symbols) {
      if (symbol.kind == compiler::SymbolKind::kFluent && symbol.noninertial) {
        defined.insert(symbol.name);
      }
    }
    for (const auto& [fluent, holds] : step_.task.bad.where)
      fluents.insert(base::symbol_of(fluent));
    std::vector<Tried> tried;
    const auto event = base::symbol_of(step_.task.bad.step.event);
    // Nothing tells what an event needs that never went well.
    for (const bool wide : {false, true}) {
      if (!step_.went_well) break;
      auto events = events_that_matter(world.text, input_.text, event, fluents, defined, wide);
      auto edits = plan_moves(step_.scope, events);
      // An insertion makes the step possible; it must not take its place.
      events.erase(event);
      for (auto& edit : plan_insertions(step_.scope, events)) edits.push_back(std::move(edit));
      // Two together are looked for where the step is alone.
      if (wide && edits.size() > kMostTogether) edits.resize(kMostTogether);
      step_.task.goal.event = step_.task.bad.step.event;
      try_edits(world, edits, false, wide ? 2 : 1, *before, tried);
      step_.task.goal.event.clear();
      if (!wide && tried.empty()) {
        try_edits(world, plan_guards(step_.scope), false, 1, *before, tried);
      }
      if (!tried.empty() || context_.stopped()) break;
    }
    try_edits(world, plan_handlers(step_.scope), true, 1, *before, tried);
    keep(world, *before, std::move(tried));
  }

  /// Tries kMostTogether edits at once: a plan with too many in it becomes too large. Those nearest
  /// to the step come first; the others are skipped if one of them helps.
  void try_edits(const World& world, const std::vector<PlanEdit>& edits, bool handles,
                 std::size_t most, PlanModel& before, std::vector<Tried>& out) {
    found_.edits += edits.size();
    const auto known = out.size();
    for (std::size_t i = 0; i < edits.size() && out.size() == known; i += kMostTogether) {
      if (context_.stopped()) return;
      const auto end = std::min(edits.size(), i + kMostTogether);
      try_together(world,
                   {edits.begin() + static_cast<std::ptrdiff_t>(i),
                    edits.begin() + static_cast<std::ptrdiff_t>(end)},
                   handles, most, before, out);
    }
  }

  void try_together(const World& world, const std::vector<PlanEdit>& edits, bool handles,
                    std::size_t most, PlanModel& before, std::vector<Tried>& out) {
    auto choices =
        find_plan_edits(step_.task, edits, handles, most, kMostChoices, context_, found_.remarks);
    const auto oddity = [&](const PlanChoice& choice) {
      int sum = 0;
      for (const auto edit : choice.edits) sum += edits[edit].oddity;
      return sum;
    };
    std::stable_sort(choices.begin(), choices.end(), [&](const auto& a, const auto& b) {
      return std::tuple(a.edits.size(), oddity(a)) < std::tuple(b.edits.size(), oddity(b));
    });
    found_.more = found_.more || choices.size() > kMostTried;
    if (choices.size() > kMostTried) choices.resize(kMostTried);
    for (const auto& choice : choices) {
      std::vector<PlanEdit> chosen;
      for (const auto edit : choice.edits) chosen.push_back(edits[edit]);
      if (context_.stopped()) return;
      try_text(world, chosen, handles, before, out);
      const auto careful = with_condition(chosen, choice);
      if (!careful) continue;
      const auto plain = out.size();
      try_text(world, *careful, handles, before, out);
      // Keeps the condition only if fewer traces change with it.
      if (out.size() < 2 || out.size() == plain) continue;
      const auto last = out.end() - 1;
      if (words_of(chosen) != (last - 1)->proposal.words) continue;
      out.erase(changed(*last) < changed(*(last - 1)) ? last - 1 : last);
    }
  }

  /// The insertion with a condition: only where a fluent that it undoes has the value that it had
  /// when the step went wrong.
  std::optional<std::vector<PlanEdit>> with_condition(std::vector<PlanEdit> edits,
                                                      const PlanChoice& choice) const {
    if (edits.size() != 1 || edits.front().kind != PlanEdit::Kind::kInsert) return std::nullopt;
    const auto& failing = step_.task.evidence->states[step_.task.step];
    for (const bool known : {true, false}) {
      for (const auto& [fluent, value] : choice.undone) {
        const auto then = failing.find(fluent);
        if (then == failing.end() || then->second != value || is_defined(input_, fluent)) continue;
        if (known && !step_.differing.contains(fluent)) continue;
        edits.front().condition = compiler::plan_condition(fluent, value);
        return edits;
      }
    }
    return std::nullopt;
  }

  std::string words_of(const std::vector<PlanEdit>& edits) const {
    std::string words;
    for (const auto& edit : edits) {
      words += (words.empty() ? "" : "; and ") + compiler::plan_edit_words(source_->text, edit);
    }
    return words;
  }

  /// Number of traces that change.
  static mpz_class changed(const Tried& each) {
    const auto& effects = each.proposal.effects;
    mpz_class sum = 0;
    if (effects && effects->lost) sum += effects->lost->value;
    if (effects && effects->gained) sum += effects->gained->value;
    return sum;
  }

  /// The plan must have that execution with the original model, too, or nobody can run it. That is
  /// the same for each assumption about the world.
  bool can_be_run(const std::vector<compiler::TextChange>& changes) {
    std::string key = step_.task.goal.event;
    for (const auto& file : changed_files(source_->text.files(), changes)) {
      key += "\n" + file.name + "\n" + file.after;
    }
    const auto known = can_be_run_.find(key);
    if (known != can_be_run_.end()) return known->second;
    PlanModel::Wrong wrong;
    const auto as_is =
        compile_plan(step_.task, input_.text, changes, constrained(), context_, wrong);
    const auto start = as_is ? as_is->start(*step_.task.evidence) : std::nullopt;
    const bool reaches = start && as_is->reaches(step_.task.goal, *start) == true;
    if (!context_.stopped()) can_be_run_.emplace(std::move(key), reaches);
    return reaches;
  }

  void try_text(const World& world, const std::vector<PlanEdit>& edits, bool handles,
                PlanModel& before, std::vector<Tried>& out) {
    const auto changes = compiler::plan_changes(source_->text, edits);
    auto words = words_of(edits);
    const auto refuse = [&](const std::string& why) {
      found_.remarks.push_back(fmt::format("not proposed: {} ({})", words, why));
    };
    PlanModel::Wrong wrong;
    const auto edited =
        compile_plan(step_.task, world.text, changes, constrained(), context_, wrong);
    if (!edited) return refuse(wrong.why);
    const auto facts =
        handles ? edited->like(*step_.task.evidence, step_.task.step + 1, step_.task.step + 2)
                : edited->start(*step_.task.evidence);
    const auto after = handles ? step_.task.step + 1 : 0;
    if (!facts || edited->reaches(step_.task.goal, *facts, after) != true) {
      return refuse("the edited plan does not get there");
    }
    const auto length = edited->length();
    if (!handles) {
      edited->set_bad(step_.task.bad);
      if (edited->can_be_bad() != false) return refuse("another execution comes to such a step");
    }
    if (world.rank != 0 && !handles && !can_be_run(changes)) {
      return refuse("the model as it is does not get there");
    }
    Tried tried;
    auto& proposal = tried.proposal;
    proposal.changes = Proposal::Changes::kPlan;
    proposal.under = world.rank;
    proposal.size = edits.size();
    for (const auto& edit : edits) proposal.oddity += edit.oddity;
    tried.kind = static_cast<int>(edits.front().kind);
    if (tried.kind == static_cast<int>(PlanEdit::Kind::kMove)) tried.kind = 0;
    proposal.words = std::move(words);
    proposal.files = changed_files(source_->text.files(), changes);
    if (world.from != nullptr) proposal.verdict = world.from->verdict;
    proposal.evidence.push_back(evidence(world, handles, length));
    proposal.hides_failure = std::any_of(edits.begin(), edits.end(), [](const PlanEdit& edit) {
      return edit.kind == PlanEdit::Kind::kHandle;
    });
    if (proposal.hides_failure) {
      proposal.evidence.emplace_back(
          "It hides the failure: nothing is done about it, and what follows goes on as if the step "
          "had been done.");
    }
    tried.changes = changes;
    // Without constraints it is compiled already.
    if (!tried.around()) add_effects(before, world, tried, constrained() ? nullptr : &*edited);
    out.push_back(std::move(tried));
  }

  std::string evidence(const World& world, bool handles, compiler::Timepoint length) const {
    const auto& run = step_.task.evidence->ids.front();
    const auto& event = step_.task.bad.step.event;
    const auto target =
        step_.task.goal.constraints && step_.task.goal.done
            ? "reaches the constraints and its end"
            : (step_.task.goal.done ? "reaches its end" : "reaches the constraints");
    const auto world_words = world.rank == 0
                                 ? "By what the runs have shown"
                                 : fmt::format("If the world is as proposal {} says", world.rank);
    if (handles) {
      return fmt::format("{}: after {} went as in run {} the plan still {}, in {} steps.",
                         world_words, event, run, target, length);
    }
    return fmt::format(
        "{}: no execution comes any more to {} as in run {}, and the plan {} from that start, in "
        "{} steps.",
        world_words, event, run, target, length);
  }

  void add_effects(PlanModel& before, const World& world, Tried& tried,
                   PlanModel* behind = nullptr) {
    auto& out = tried.proposal.effects.emplace();
    if (step_.task.goal.constraints) out.reaches = true;
    PlanModel::Wrong wrong;
    const auto compiled = behind == nullptr ? compile_plan(step_.task, world.text, tried.changes,
                                                           false, context_, wrong)
                                            : nullptr;
    if (behind == nullptr) behind = compiled.get();
    if (behind == nullptr) return;
    runtime::DifferenceOptions options;
    options.stop = &context_.stop();
    options.counts_only = true;
    const auto difference = runtime::compare_traces(before.compared(), behind->compared(), options);
    const auto number = [](const runtime::OneSided& side) -> std::optional<runtime::TraceNumber> {
      if (side.answer == runtime::DifferenceAnswer::kUnknown) return std::nullopt;
      return side.count;
    };
    out.lost = number(difference.lost);
    out.gained = number(difference.gained);
  }

  /// Keeps the best for one assumption about the world: changes that perform the step before those
  /// that go on without it, then those that change the fewest traces.
  void keep(const World& world, PlanModel& before, std::vector<Tried> tried) {
    std::stable_sort(tried.begin(), tried.end(), [](const Tried& a, const Tried& b) {
      if (a.proposal.hides_failure != b.proposal.hides_failure) return b.proposal.hides_failure;
      if (a.proposal.size != b.proposal.size) return a.proposal.size < b.proposal.size;
      if (a.kind != b.kind) return a.kind < b.kind;
      // The innermost of several retries or handlers takes the least.
      if (a.around()) return a.proposal.oddity < b.proposal.oddity;
      const auto left = changed(a), right = changed(b);
      return left != right ? left < right : a.proposal.oddity < b.proposal.oddity;
    });
    std::size_t kept = 0;
    std::set<int> kinds;
    for (auto& each : tried) {
      // One retry and one handler are enough: the innermost.
      if (each.around() && !kinds.insert(each.kind).second) continue;
      const auto same = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& other) {
        return other.proposal.words == each.proposal.words;
      });
      if (same != kept_.end()) {
        same->proposal.evidence.push_back(each.proposal.evidence.front());
        continue;
      }
      if (kept == kMostKept) {
        found_.more = true;
        break;
      }
      if (each.around()) add_effects(before, world, each);
      each.proposal.precaution = world.from != nullptr && world.from->precaution;
      kept_.push_back({std::move(each.proposal), each.kind, kept++});
    }
  }

  const RepairInput& input_;
  const std::vector<Proposal>& models_;
  Context& context_;
  FoundProposals found_;
  std::vector<Kept> kept_;
  std::optional<PlanSource> source_;
  PlanStep step_;                           // at hand
  std::map<std::string, bool> can_be_run_;  // by the goal's event and the edited texts
};

}  // namespace

FoundProposals plan_proposals(const RepairInput& input, const std::vector<Proposal>& models,
                              Context& context) {
  return PlanRepair(input, models, context).run();
}

}  // namespace parallax::tools
