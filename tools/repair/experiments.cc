// Simulations that tell proposals apart, chosen one after the other.
//
// While several proposals are supported by the runs as much as the first one, the trace that
// separates most pairs of their models is simulated, recorded, and the repair proposes again
// with it. It ends when no two can be told apart, no run tells them apart, or the budget is used
// up; the reason is told. Where chance may decide, steps that failed once are repeated first: if
// the event can also go well, a proposal that it always fails is wrong. Proposals that vanish
// are verified once more, to tell refuted ones from those that others crowded out. Cost: one
// repair for each experiment.

#include "tools/repair/experiments.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "harness/config/validate_list.h"
#include "tools/repair/experiment.h"
#include "tools/repair/experiment_runs.h"
#include "tools/repair/plan_runs.h"
#include "tools/repair/ranking.h"
#include "tools/repair/repeats.h"
#include "tools/repair/validation.h"
#include "tools/repair/world_files.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostContenders = 8;  // are told apart at a time

class Experiments {
 public:
  Experiments(const RepairOptions& options, const ExperimentOptions& experiments, RepairInput input,
              Context& context)
      : options_(options),
        experiments_(experiments),
        first_(std::move(input)),
        context_(context),
        chooser_(first_.loaded, context) {}

  base::Result<RepairResult> run() {
    if (!repeat()) return context_.sink().already_reported();
    if (!first_.partings.empty() && !context_.stopped()) {
      auto sequences = random_sequences(first_, experiments_, context_);
      if (!sequences) return context_.sink().already_reported();
      first_.sequences = *std::move(sequences);
      if (last_) {
        last_->sequences = first_.sequences;
        last_->memo = first_.memo;
      }
    }
    auto proposed = propose_repairs(last_ ? *last_ : first_, context_);
    if (!proposed) return proposed;
    auto& result = *proposed;
    if (first_.start && !run_from_start(result)) return context_.sink().already_reported();
    if (!tell_apart(result)) return context_.sink().already_reported();
    if (runs_ != nullptr && !context_.stopped() && !runs_->close()) {
      return context_.sink().already_reported();
    }
    return with_plan(finished(std::move(result)));
  }

 private:
  /// The world excluded the start, so that no run was made: the plan is run from the start of the
  /// first proposal, and what is seen orders the proposals as random sequences do.
  base::Status run_from_start(RepairResult& result) {
    if (result.proposals.empty() || context_.stopped() || !forbidden().empty()) return base::Unit{};
    auto loaded = load_to_execute(first_, context_);
    if (!loaded) return base::Unit{};
    auto seen =
        runs_of_plan(*std::move(loaded), *result.proposals.front().text, experiments_, context_);
    if (seen.empty()) return base::Unit{};
    auto& choosing = first_.sequences.choosing;
    choosing.insert(choosing.begin(), std::make_move_iterator(seen.begin()),
                    std::make_move_iterator(seen.end()));
    first_.memo = std::make_shared<SequenceMemo>();
    auto proposed = propose_repairs(first_, context_);
    if (!proposed) return context_.sink().already_reported();
    result = *std::move(proposed);
    return base::Unit{};
  }

  /// Makes experiments that tell the likeliest proposals apart, until no two can be told apart.
  base::Status tell_apart(RepairResult& result) {
    if (!may_be_made(result)) return base::Unit{};
    const bool on_record = first_.experiments > 0;
    if (runs_ == nullptr && on_record && !open()) return context_.sink().already_reported();
    if (runs_ != nullptr && !complete(result)) return context_.sink().already_reported();
    while (!context_.stopped()) {
      const auto models = contenders(result);
      if (models.size() < 2) break;
      if (budget() <= 0) {
        result.why_tied = "the budget of runs is used up, --runs gives more";
        break;
      }
      const auto experiment = chooser_.choose(
          models, [this](const auto& trace) { return runs_ == nullptr || runs_->usable(trace); });
      if (!experiment) {
        if (!context_.stopped()) result.why_tied = why_none(models);
        break;
      }
      if (runs_ == nullptr && !open()) return context_.sink().already_reported();
      if (runs_ == nullptr) break;
      const auto made = make(*experiment, result);
      if (!made) return context_.sink().already_reported();
      if (!*made) break;
    }
    return base::Unit{};
  }

  /// Repeats steps where chance may decide: if an event that went wrong once can also go well, a
  /// proposal that it always fails is wrong.
  base::Status repeat() {
    if (!chance_decides(first_) || !forbidden().empty()) return base::Unit{};
    std::int64_t made = 0;
    for (bool any = true; any && !context_.stopped();) {
      any = false;
      for (const auto& wanted : repeats_wanted(last_ ? *last_ : first_)) {
        if (runs_ == nullptr && !open()) return context_.sink().already_reported();
        if (runs_ == nullptr) return base::Unit{};  // stopped
        const auto before = runs_->made();
        for (auto i = wanted.times; i > 0 && budget() > 0 && runs_->usable(wanted.trace); --i) {
          const auto done = runs_->make({wanted.trace, 0}, budget());
          if (!done) return context_.sink().already_reported();
          if (!*done) break;
        }
        any = any || runs_->made() > before;
        made += runs_->made() - before;
      }
      if (!any) break;
      auto input = load_repair_input(first_.options, context_);
      if (!input) return context_.sink().already_reported();
      last_.emplace(*std::move(input));
    }
    if (made > 0) {
      remarks_.push_back(fmt::format("{} made to see whether what went wrong is chance", made));
    }
    return base::Unit{};
  }

  std::int64_t most() const {
    const bool model = first_.loaded.world != nullptr;
    return experiments_.runs.value_or(model ? kRunsInModel : kRunsInPhysics);
  }
  std::int64_t budget() const { return most() - (runs_ == nullptr ? 0 : runs_->made()); }

  std::string nothing_tells() const {
    return first_.loaded.scenario.plan.empty() ? "no run of the scenario tells them apart"
                                               : "no run of this plan tells them apart";
  }

  /// Why there is no further experiment: no run can tell them apart, if that was proved, or the
  /// search stopped at its limits.
  std::string why_none(const std::vector<std::string>& models) const {
    for (const auto& text : models) {
      if (!chooser_.are_same(models.front(), text)) {
        return "no further run that tells them apart was found, and the search for one stopped at "
               "its limits";
      }
    }
    return nothing_tells();
  }

  /// Sets the reason only where experiments would have been needed.
  bool may_be_made(RepairResult& result) {
    if (contenders(result).size() < 2 || context_.stopped()) return false;
    result.why_tied = first_.start ? "no run begins before the start is repaired" : forbidden();
    return result.why_tied.empty();
  }

  /// Why no simulation may be made; empty if it may.
  std::string forbidden() const {
    std::error_code ignored;
    const auto& folder = options_.folder.folder;
    const auto place = fs::path(folder) / kExperiments;
    if (experiments_.runs == 0) return "no runs may be made to tell them apart (--runs 0)";
    if (options_.other_model) return "none are made of a scenario that may be another one";
    if (!first_.loaded.scenario.simulator.command.empty() && !experiments_.allow_commands) {
      return "the simulator is a command, which --allow-commands permits";
    }
    if (::access(folder.c_str(), W_OK) != 0 || fs::is_symlink(place, ignored)) {
      return "nothing can be written into the folder";
    }
    return "";
  }

  /// The models of the proposals that the runs support as much as the first one.
  std::vector<std::string> contenders(const RepairResult& result) {
    std::vector<std::string> out;
    if (result.proposals.empty()) return out;
    for (const auto i : as_well_founded(result.proposals)) {
      const auto& proposal = result.proposals[i];
      if (!proposal.text || proposal.changes != Proposal::Changes::kModel) continue;
      if (out.size() == kMostContenders) break;
      out.push_back(*proposal.text);
      contenders_.emplace(*proposal.text, Contender{proposal.words, proposal.precaution});
    }
    return out;
  }

  base::Status open() {
    auto& sink = context_.sink();
    const RunFolderOptions folder{options_.folder.folder, first_.loaded.scenario.file.string()};
    auto loaded = load_recorded_scenario(folder, first_.header, ScenarioUse::kRun, context_);
    if (!loaded) return sink.already_reported();
    as_run_ = std::make_unique<ScenarioModel>(*std::move(loaded));
    auto& scenario = as_run_->scenario;
    scenario.starts = harness::Starts::kUniform;  // it is the experiments that choose
    scenario.compare = recorded_comparison(first_.header).value_or(scenario.comparison());
    const auto simulator = experiments_.simulator(*as_run_);
    if (!simulator) return sink.already_reported();
    std::int64_t last = 0;
    for (const auto& path : first_.paths) {
      if (!path.experiment) last = std::max(last, path.id.sample);
    }
    extra_ = {experiments_.jobs, most(), experiments_.progress};
    auto runs = ExperimentRuns::open({folder.folder, kExperiments, first_.header}, *as_run_, last,
                                     *simulator, extra_, context_);
    if (!runs) return sink.already_reported();
    runs_ = *std::move(runs);
    return base::Unit{};
  }

  /// Completes the runs that an earlier repair was making when it ended.
  base::Status complete(RepairResult& result) {
    const auto before = runs_->made();
    const auto made = runs_->complete(budget());
    if (!made) return context_.sink().already_reported();
    if (runs_->made() == before || context_.stopped()) return base::Unit{};
    return propose_again(result);
  }

  base::Result<bool> make(const Experiment& experiment, RepairResult& result) {
    const auto before = runs_->made();
    const auto errors = context_.sink().error_count();
    const auto made = runs_->make(experiment, budget());
    if (!made) return context_.sink().already_reported();
    if (!*made) return !context_.stopped() && context_.sink().error_count() == errors;
    remarks_.push_back(fmt::format("{} made to tell {} pairs of proposals apart: {}",
                                   runs_->made() - before, experiment.separated,
                                   experiment.trace.key));
    if (!propose_again(result)) return context_.sink().already_reported();
    return true;
  }

  base::Status propose_again(RepairResult& result) {
    auto wide = first_.options;
    auto input = load_repair_input(wide, context_);
    if (!input) return context_.sink().already_reported();
    input->sequences = first_.sequences;
    input->memo = first_.memo;
    auto proposed = propose_repairs(*input, context_);
    if (!proposed) return context_.sink().already_reported();
    result = *std::move(proposed);
    last_.emplace(*std::move(input));
    return base::Unit{};
  }

  /// Changes of the plan start from the remaining repairs of the model.
  base::Result<RepairResult> with_plan(RepairResult result) {
    if (!options_.plan) return result;
    auto& input = last_ ? *last_ : first_;
    input.options.limit = options_.limit;
    if (!add_plan_proposals(input, result, context_)) return context_.sink().already_reported();
    return result;
  }

  struct Contender {
    std::string words;
    bool precaution = false;
  };

  /// Is it refuted: does it not explain the new runs, or not as far as the first one does? If not,
  /// it was crowded out by others, as the number of proposals is limited.
  bool is_refuted(const std::string& text, const Contender& contender,
                  const std::vector<Proposal>& left) const {
    auto seen = (last_ ? *last_ : first_).evidence;
    if (contender.precaution) set_aside((last_ ? *last_ : first_).evidence, seen);
    const auto verdict = verify(text, seen, {}, context_);
    return !verdict.admits ||
           (!left.empty() && verdict.runs_whole < left.front().verdict.runs_whole);
  }

  RepairResult finished(RepairResult result) {
    auto& all = result.proposals;
    for (const auto& [text, contender] : contenders_) {
      const bool left = std::any_of(all.begin(), all.end(),
                                    [&](const Proposal& each) { return each.text == text; });
      // A proposal that a stopped search has not found again is not refuted.
      if (left || context_.stopped()) continue;
      (is_refuted(text, contender, all) ? result.refuted : result.crowded_out)
          .push_back(contender.words);
    }
    for (auto a = contenders_.begin(); a != contenders_.end(); ++a) {
      for (auto b = std::next(a); b != contenders_.end(); ++b) {
        if (!chooser_.are_same(a->first, b->first)) continue;
        remarks_.push_back(
            fmt::format("{}: {} and {}", nothing_tells(), a->second.words, b->second.words));
      }
    }
    std::sort(result.refuted.begin(), result.refuted.end());
    std::sort(result.crowded_out.begin(), result.crowded_out.end());
    if (!all.empty()) {
      result.tied = of_first_rank(all);
      result.founded = as_well_founded(all);
    }
    if (options_.limit > 0 && all.size() > static_cast<std::size_t>(options_.limit)) {
      all.resize(static_cast<std::size_t>(options_.limit));
      result.more = true;
    }
    result.tied_hidden = result.tied - std::min(result.tied, all.size());
    compare_traces(first_, all, context_);
    hold_against_sequences(first_, result, context_);
    hold_against_plans(result);
    result.remarks.insert(result.remarks.begin(), remarks_.begin(), remarks_.end());
    return result;
  }

  /// Runs other plans with the model of the first proposal, and asks each proposal about them.
  void hold_against_plans(RepairResult& result) {
    const auto first = std::find_if(result.proposals.begin(), result.proposals.end(),
                                    [](const Proposal& each) { return each.text.has_value(); });
    if (first == result.proposals.end() || context_.stopped()) return;
    const auto before = context_.sink();
    const auto others =
        harness::scenarios_to_validate(first_.loaded.scenario.file, context_.files(),
                                       context_.sink(), context_.form().allow_outside);
    context_.sink() = before;
    if (!others || others->empty()) return;
    if (const auto why = forbidden(); !why.empty()) {
      remarks_.push_back("no other plan was run: " + why);
      return;
    }
    const auto plans = runs_of_other_plans(*others, *first->text, experiments_, context_);
    for (auto& proposal : result.proposals) {
      if (!proposal.text || proposal.changes == Proposal::Changes::kPlan) continue;
      for (const auto& plan : plans) {
        const auto held = verify(*proposal.text, {}, plan.runs, context_);
        proposal.verdict.plans.push_back(
            {plan.scenario, plan.runs.size(), held.validated, held.refuted_by});
      }
    }
  }

  const RepairOptions& options_;
  const ExperimentOptions& experiments_;
  RepairInput first_;
  std::optional<RepairInput> last_;  // with the runs that were made
  Context& context_;
  ExperimentChooser chooser_;
  std::map<std::string, Contender> contenders_;  // all that were, by their models
  std::vector<std::string> remarks_;
  std::unique_ptr<ScenarioModel> as_run_;
  ExtraRunsOptions extra_;
  std::unique_ptr<ExperimentRuns> runs_;  // last: it refers to the others
};

}  // namespace

base::Result<RepairResult> repair_with_experiments(const RepairOptions& options,
                                                   const ExperimentOptions& experiments,
                                                   Context& context) {
  auto wide = options;
  if (wide.limit > 0) {
    wide.limit = std::max(wide.limit, static_cast<std::int64_t>(kMostContenders) + 1);
  }
  auto input = load_repair_input(wide, context);
  if (!input) return context.sink().already_reported();
  const auto scenario = input->loaded.scenario;
  auto result = Experiments(options, experiments, *std::move(input), context).run();
  if (!result) return result;
  for (auto& proposal : result->proposals) {
    proposal.read_by_world = read_by_world(scenario, proposal.files, context);
  }
  return result;
}

}  // namespace parallax::tools
