#include "tools/repair/plan_proposals.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "compiler/base/file_io.h"
#include "compiler/repair/edit_grammar.h"
#include "tools/repair/plan_candidates.h"
#include "tools/repair/plan_search.h"

namespace parallax::tools {

using compiler::PlanEdit;

namespace {

constexpr std::size_t kMostSteps = 3;      // that went wrong
constexpr std::size_t kMostSites = 16;     // that actions are inserted at
constexpr std::size_t kMostChoices = 100;  // that the solver is asked for, in each model
constexpr std::size_t kMostTogether = 48;  // edits that are written into one plan
constexpr std::size_t kMostTried = 5;      // of them are compiled from their text
constexpr std::size_t kMostKept = 3;       // proposals for each model
constexpr std::int64_t kMoreSteps = 3;     // than the scenario has, for what an edit adds

/// How the world is taken to be.
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
    if (!read()) return std::move(found_);
    std::set<std::string> known;
    for (const auto& parting : input_.partings) {
      if (context_.stopped() || known.size() == kMostSteps) break;
      if (known.insert(parting.step.event).second) repair(parting);
    }
    // The best for each way that the world may be, then the second ones.
    std::stable_sort(kept_.begin(), kept_.end(), [](const Kept& a, const Kept& b) {
      // What only hides a failure comes last, however small it is.
      return std::tuple(a.proposal.hides_failure, a.proposal.size, a.kind, a.round) <
             std::tuple(b.proposal.hides_failure, b.proposal.size, b.kind, b.round);
    });
    for (auto& each : kept_) found_.proposals.push_back(std::move(each.proposal));
    return std::move(found_);
  }

 private:
  /// The plan's text and the binding table; false: there is none that could be edited.
  bool read() {
    const auto& scenario = input_.loaded.scenario;
    if (scenario.plan.empty() || !scenario.bind || !input_.loaded.compilation.plan) return false;
    const auto before = context_.sink();
    const auto files = load_scenario_plan(scenario, context_);
    const auto bind = base::load_text(scenario.bind->text, context_.files(), context_.sink());
    if (files) plan_ = compiler::PlanText::read(context_.files(), *files);
    if (bind) {
      auto binding = compiler::parse_plan_binding(context_.files(), *bind, context_.sink());
      if (binding) binding_ = *std::move(binding);
    }
    context_.sink() = before;
    return plan_ && binding_;
  }

  void repair(const RunParting& parting) {
    const auto seen =
        std::find_if(input_.evidence.begin(), input_.evidence.end(),
                     [&](const Evidence& each) { return each.ids.front() == parting.ids.front(); });
    if (seen == input_.evidence.end()) return;
    task_ = {};
    can_be_run_.clear();
    task_.scenario = &input_.loaded.scenario;
    task_.plan = &*plan_;
    task_.evidence = &*seen;
    task_.step = parting.after - 1;
    task_.bad = {parting.step, parting.seen};
    task_.horizon = input_.loaded.compilation.model.horizon + kMoreSteps;
    find_difference();
    if (!find_place()) return;
    for (const auto& world : worlds()) {
      if (!context_.stopped()) look(world);
    }
  }

  /// What held in front of the step where it went wrong, and never where it went well.
  void find_difference() {
    differing_.clear();
    went_well_ = false;
    const auto& failing = task_.evidence->states[task_.step];
    auto out = failing;
    bool any = false;
    for (const auto& seen : input_.evidence) {
      for (std::size_t t = 0; t < seen.steps.size() && t < seen.seen_to(); ++t) {
        const bool parted = seen.divergence == t + 1;
        if (seen.steps[t].event != task_.bad.step.event || seen.steps[t].failed || parted) continue;
        went_well_ = true;
        if (seen.states[t] == failing) continue;
        any = true;
        std::erase_if(out, [&](const auto& entry) {
          const auto other = seen.states[t].find(entry.first);
          return other == seen.states[t].end() || other->second == entry.second;
        });
      }
    }
    if (any) differing_ = std::move(out);
  }

  std::unique_ptr<PlanModel> compile(const std::string& model,
                                     const std::vector<compiler::TextChange>& changes,
                                     bool constraints, PlanModel::Wrong& wrong) {
    EditedTexts texts;
    texts.model = model;
    for (const auto& file : changed_files(plan_->files(), changes)) {
      texts.plan.emplace(file.name, file.after);
    }
    texts.horizon = task_.horizon;
    texts.constraints = constraints;
    return PlanModel::compile(input_.loaded.scenario, texts, context_, wrong);
  }

  bool has_constraints() const {
    return !input_.loaded.scenario.constraints.empty() &&
           input_.loaded.scenario.execution != harness::Execution::kClosedLoop;
  }

  /// Where the plan was in the run, and what it comes to from there in the model as it is.
  bool find_place() {
    PlanModel::Wrong wrong;
    const auto model = compile(input_.text, {}, has_constraints(), wrong);
    if (!model) {
      found_.remarks.push_back("the plan by itself cannot be compiled: " + wrong.why);
      return false;
    }
    const auto start = model->start(*task_.evidence);
    const auto path = model->locations(*task_.evidence, task_.step);
    if (!start || path.empty()) return false;
    PlanGoal constraints, done;
    constraints.constraints = done.done = true;
    if (has_constraints()) task_.goal.constraints = model->reaches(constraints, *start) == true;
    task_.goal.done = model->reaches(done, *start) == true;
    if (!task_.goal.any()) return false;
    scope_ = {};
    scope_.plan = &*plan_;
    scope_.binding = &*binding_;
    scope_.typed = &*input_.domain->typed;
    const auto& graph = model->graph();
    for (auto k = path.size(); k-- > 0;) {
      const auto& location = graph.locations[path[k]];
      auto forms = location.calls;
      forms.push_back(location.source);
      for (const auto& source : forms) {
        const auto form = plan_->form_at(same_text(source));
        if (!form) continue;
        if (k + 1 == path.size()) add_once(scope_.failing, *form);
        const auto statement = plan_->statement_around(*form);
        if (statement && scope_.sites.size() < kMostSites) add_once(scope_.sites, *statement);
      }
    }
    // The perform itself first, then the calls that lead to it.
    std::reverse(scope_.failing.begin(), scope_.failing.end());
    const auto& last = graph.locations[path.back()];
    scope_.failure = last.failure_class;
    for (const auto& way : last.failures) {
      const bool fits = std::find(way.reasons.begin(), way.reasons.end(), task_.bad.step.reason) !=
                        way.reasons.end();
      if (fits) scope_.failure = way.failure_class;
    }
    for (const auto& [fluent, holds] : differing_) {
      constexpr std::size_t kMostConditions = 6;
      if (is_defined(fluent) || scope_.conditions.size() == kMostConditions) continue;
      scope_.conditions.push_back(compiler::plan_condition(fluent, !holds));
    }
    return true;
  }

  /// Texts are read anew for every compilation; names and places stay.
  base::SourceRange same_text(const base::SourceRange& source) const {
    const auto& name = context_.files()[source.file].name();
    for (std::uint32_t i = 0; i < plan_->data().end_id().index(); ++i) {
      const auto& own = plan_->source(compiler::DatumId(i));
      if (context_.files()[own.file].name() == name) return {own.file, source.begin, source.end};
    }
    return source;
  }

  static void add_once(std::vector<compiler::DatumId>& list, compiler::DatumId form) {
    if (std::find(list.begin(), list.end(), form) == list.end()) list.push_back(form);
  }

  bool is_defined(const std::string& fluent) const {
    const auto& typed = *input_.domain->typed;
    const auto symbol = typed.find_symbol(compiler::symbol_of(fluent));
    return symbol && typed.symbols[*symbol].noninertial;
  }

  std::vector<World> worlds() const {
    std::vector<World> out;
    for (std::size_t i = 0; i < models_.size() && i < kMostModels; ++i) {
      if (!models_[i].text) continue;
      out.push_back({*models_[i].text, i + 1, &models_[i]});
    }
    // The runs themselves: the step is bad where it went wrong.
    if (out.empty() && !differing_.empty()) out.push_back({input_.text});
    return out;
  }

  struct Tried {
    Proposal proposal;
    int kind = 0;
    std::vector<compiler::TextChange> changes;  // of the plan
    /// What is around the step: the order does not ask for its traces.
    bool around() const { return kind >= static_cast<int>(PlanEdit::Kind::kRetry); }
  };
  struct Kept {
    Proposal proposal;
    int kind = 0;
    std::size_t round = 0;  // so many better ones there are for the same world
  };

  /// Looks for what helps in that world, if the plan is any the worse for its being like that.
  void look(const World& world) {
    task_.model = world.text;
    task_.bad.where = world.rank == 0 ? differing_ : Evidence::State{};
    PlanModel::Wrong wrong;
    const auto before = compile(world.text, {}, false, wrong);
    if (!before) return;
    before->set_bad(task_.bad);
    if (before->can_be_bad() != true) return;
    std::set<std::string> defined, fluents;
    for (const auto& symbol : input_.domain->typed->symbols) {
      if (symbol.kind == compiler::SymbolKind::kFluent && symbol.noninertial) {
        defined.insert(symbol.name);
      }
    }
    for (const auto& [fluent, holds] : task_.bad.where) fluents.insert(compiler::symbol_of(fluent));
    std::vector<Tried> tried;
    const auto event = compiler::symbol_of(task_.bad.step.event);
    // Of an event that never went well nothing tells what it needs.
    for (const bool wide : {false, true}) {
      if (!went_well_) break;
      auto events = events_that_matter(world.text, input_.text, event, fluents, defined, wide);
      auto edits = plan_moves(scope_, events);
      // What is inserted is to make the step possible, not to take its place.
      events.erase(event);
      for (auto& edit : plan_insertions(scope_, events)) edits.push_back(std::move(edit));
      // Two together are looked for where the step is alone.
      if (wide && edits.size() > kMostTogether) edits.resize(kMostTogether);
      task_.goal.event = task_.bad.step.event;
      try_edits(world, edits, false, wide ? 2 : 1, *before, tried);
      task_.goal.event.clear();
      if (!wide && tried.empty()) {
        try_edits(world, plan_guards(scope_), false, 1, *before, tried);
      }
      if (!tried.empty() || context_.stopped()) break;
    }
    try_edits(world, plan_handlers(scope_), true, 1, *before, tried);
    keep(world, *before, std::move(tried));
  }

  /// So many at once: a plan that has too many in it becomes too large. Those that are nearest to
  /// the step come first, and what lies further away is not looked at where one of them helps.
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
        find_plan_edits(task_, edits, handles, most, kMostChoices, context_, found_.remarks);
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
      // The condition stands there only if it keeps something from changing.
      if (out.size() < 2 || out.size() == plain) continue;
      const auto last = out.end() - 1;
      if (words_of(chosen) != (last - 1)->proposal.words) continue;
      out.erase(changed(*last) < changed(*(last - 1)) ? last - 1 : last);
    }
  }

  /// The insertion only where there is something to do: where what it undoes is as it was when the
  /// step went wrong.
  std::optional<std::vector<PlanEdit>> with_condition(std::vector<PlanEdit> edits,
                                                      const PlanChoice& choice) const {
    if (edits.size() != 1 || edits.front().kind != PlanEdit::Kind::kInsert) return std::nullopt;
    const auto& failing = task_.evidence->states[task_.step];
    for (const bool known : {true, false}) {
      for (const auto& [fluent, value] : choice.undone) {
        const auto then = failing.find(fluent);
        if (then == failing.end() || then->second != value || is_defined(fluent)) continue;
        if (known && !differing_.contains(fluent)) continue;
        edits.front().condition = compiler::plan_condition(fluent, value);
        return edits;
      }
    }
    return std::nullopt;
  }

  std::string words_of(const std::vector<PlanEdit>& edits) const {
    std::string words;
    for (const auto& edit : edits) {
      words += (words.empty() ? "" : "; and ") + compiler::plan_edit_words(*plan_, edit);
    }
    return words;
  }

  /// Traces that are others.
  static mpz_class changed(const Tried& each) {
    const auto& effects = each.proposal.effects;
    mpz_class sum = 0;
    if (effects && effects->lost) sum += effects->lost->value;
    if (effects && effects->gained) sum += effects->gained->value;
    return sum;
  }

  /// With the model as it is the plan must have that execution, too, or nobody can run it. That is
  /// the same for each way that the world may be.
  bool can_be_run(const std::vector<compiler::TextChange>& changes) {
    std::string key = task_.goal.event;
    for (const auto& file : changed_files(plan_->files(), changes)) {
      key += "\n" + file.name + "\n" + file.after;
    }
    const auto known = can_be_run_.find(key);
    if (known != can_be_run_.end()) return known->second;
    PlanModel::Wrong wrong;
    const auto as_is = compile(input_.text, changes, has_constraints(), wrong);
    const auto start = as_is ? as_is->start(*task_.evidence) : std::nullopt;
    const bool reaches = start && as_is->reaches(task_.goal, *start) == true;
    if (!context_.stopped()) can_be_run_.emplace(std::move(key), reaches);
    return reaches;
  }

  void try_text(const World& world, const std::vector<PlanEdit>& edits, bool handles,
                PlanModel& before, std::vector<Tried>& out) {
    const auto changes = compiler::plan_changes(*plan_, edits);
    auto words = words_of(edits);
    const auto refuse = [&](const std::string& why) {
      found_.remarks.push_back(fmt::format("not proposed: {} ({})", words, why));
    };
    PlanModel::Wrong wrong;
    const auto edited = compile(world.text, changes, has_constraints(), wrong);
    if (!edited) return refuse(wrong.why);
    const auto facts = handles ? edited->like(*task_.evidence, task_.step + 1, task_.step + 2)
                               : edited->start(*task_.evidence);
    const auto after = handles ? task_.step + 1 : 0;
    if (!facts || edited->reaches(task_.goal, *facts, after) != true) {
      return refuse("the edited plan does not get there");
    }
    const auto length = edited->length();
    if (!handles) {
      edited->set_bad(task_.bad);
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
    proposal.files = changed_files(plan_->files(), changes);
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
    if (!tried.around()) add_effects(before, world, tried, has_constraints() ? nullptr : &*edited);
    out.push_back(std::move(tried));
  }

  std::string evidence(const World& world, bool handles, compiler::Timepoint length) const {
    const auto& run = task_.evidence->ids.front();
    const auto& event = task_.bad.step.event;
    const auto target = task_.goal.constraints && task_.goal.done
                            ? "reaches the constraints and its end"
                            : (task_.goal.done ? "reaches its end" : "reaches the constraints");
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
    if (task_.goal.constraints) out.reaches = true;
    PlanModel::Wrong wrong;
    const auto compiled =
        behind == nullptr ? compile(world.text, tried.changes, false, wrong) : nullptr;
    if (behind == nullptr) behind = compiled.get();
    if (behind == nullptr) return;
    runtime::DifferenceOptions options;
    options.stop = &context_.stop();
    options.counts_only = true;
    const auto difference = runtime::compare_traces(before.compared(), behind->compared(), options);
    const auto number = [](const runtime::OneSided& side) -> std::optional<runtime::TraceNumber> {
      if (side.answer == runtime::Answer::kUnknown) return std::nullopt;
      return side.count;
    };
    out.lost = number(difference.lost);
    out.gained = number(difference.gained);
  }

  /// The best of one world: what does the step before what goes on without it, then what changes
  /// the fewest traces.
  void keep(const World& world, PlanModel& before, std::vector<Tried> tried) {
    std::stable_sort(tried.begin(), tried.end(), [](const Tried& a, const Tried& b) {
      if (a.proposal.hides_failure != b.proposal.hides_failure) return b.proposal.hides_failure;
      if (a.proposal.size != b.proposal.size) return a.proposal.size < b.proposal.size;
      if (a.kind != b.kind) return a.kind < b.kind;
      // Of retries and handlers the innermost takes the least.
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
  std::optional<compiler::PlanText> plan_;
  std::optional<compiler::PlanBinding> binding_;
  PlanTask task_;
  std::map<std::string, bool> can_be_run_;  // by the goal's event and the edited texts
  PlanScope scope_;
  Evidence::State differing_;
  bool went_well_ = false;  // the event did, in some run
};

}  // namespace

FoundProposals plan_proposals(const RepairInput& input, const std::vector<Proposal>& models,
                              Context& context) {
  return PlanRepair(input, models, context).run();
}

}  // namespace parallax::tools
