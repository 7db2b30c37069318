// Learns a model of a scenario's actions from simulations, in rounds.
//
// A round runs the scenario's plan, random sequences of its events (explorer.cc) or the traces
// of the learned model, adds what was observed and learns all rules about events anew from all
// runs (taught_model.cc). Rounds go on while they teach something. The model is good when a
// campaign with it ends without a discrepancy, gives a claim and leaves all axioms as they were;
// for a scenario in open loop the traces of the model have to pass such a campaign as well,
// unless the model leaves outcomes open. A clean run may still make another model the simplest
// one, so the first clean rounds are learned from; later ones only confirm.
//
// It ends early when a discrepancy changes no axiom, because then axioms about events cannot say
// what was observed, or when the budget of simulations or rounds is used up. Cost: one campaign
// and one run of the learner for each round.

#include "tools/learn/learn.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <system_error>

#include "compiler/base/file_io.h"
#include "harness/campaign/journal.h"
#include "harness/report/report.h"
#include "tools/app/observed_path.h"
#include "tools/learn/bounded_traces.h"
#include "tools/learn/outcome_facts.h"
#include "tools/learn/round_folder.h"
#include "tools/learn/taught_model.h"
#include "tools/repair/explorer.h"

namespace parallax::tools {

using harness::CampaignVerdict;
using harness::Execution;

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kBatch = 10;  // sequences between two models
constexpr std::int64_t kMostLearningRounds = 400;
/// Clean rounds after which the model is learned anew. Later ones contradict nothing and would only
/// sharpen it.
constexpr std::int64_t kSharpened = 1;

class ScenarioLearner {
 public:
  ScenarioLearner(
      const LearnOptions& options,
      const std::function<base::Result<harness::SimulatorFactory>(const ScenarioModel&)>& simulator,
      Context& context)
      : options_(options), ask_simulator_(simulator), context_(context) {}

  base::Result<LearnResult> run() {
    auto& sink = context_.sink();
    // Loads it as it asks for, then for closed loop: both must be possible.
    auto own = load_scenario_model(options_.scenario, context_, {.as_run = true});
    if (!own) return sink.already_reported();
    own_execution_ = own->scenario.execution;
    loaded_ = load_scenario_model(options_.scenario, context_,
                                  {.as_run = true, .execution = Execution::kClosedLoop});
    if (!*loaded_) return sink.already_reported();
    if (!prepare()) return sink.already_reported();
    go();
    finish();
    if (!write()) return sink.already_reported();
    return std::move(result_);
  }

 private:
  const ScenarioModel& loaded() const { return **loaded_; }
  bool over() const {
    return context_.stopped() || result_.simulations >= options_.max_runs ||
           std::ssize(result_.rounds) >= kMostLearningRounds;
  }

  base::Status prepare() {
    auto& sink = context_.sink();
    if (!options_.model_file.empty() &&
        !base::check_output(options_.model_file, context_.files(), sink)) {
      return sink.already_reported();
    }
    harness::SimulatorFactory simulator;
    if (!loaded().world) {
      auto factory = ask_simulator_(loaded());
      if (!factory) return sink.already_reported();
      simulator = *std::move(factory);
    }
    auto made = TaughtModel::make(loaded(), options_.scenario, context_);
    if (!made) return sink.already_reported();
    taught_ = *std::move(made);
    result_.dropped = taught_->dropped();
    auto folder = RoundFolder::make(options_, loaded(), std::move(simulator), context_);
    if (!folder) return sink.already_reported();
    folder_ = *std::move(folder);
    return base::Unit{};
  }

  void go() {
    if (options_.explore > 0) {
      // One execution shows what the plan does; random sequences follow.
      if (!plan_round(1) || over()) return;
      while (result_.sequences < options_.explore && !over()) {
        if (!explore_round()) return;
      }
    }
    while (!over()) {
      const auto planned = plan_round(std::nullopt);
      if (!planned) return;
      if (!*planned) continue;
      if (own_execution_ == Execution::kClosedLoop) {
        result_.clean = true;
        return;
      }
      if (taught_->leaves_open()) {
        result_.clean = true;
        result_.judged_in_closed_loop = true;
        return;
      }
      if (over()) return;
      const auto traced = trace_round();
      if (!traced) return;
      if (!*traced) continue;
      result_.clean = true;
      return;
    }
  }

  // --- rounds

  std::optional<OpenRound> begin(LearnRound::Kind kind, Execution execution) {
    LearnRound told;
    told.number = std::ssize(result_.rounds) + 1;
    told.kind = kind;
    told.axioms = known_axioms_.size();
    return folder_->begin(told, taught_->text(), execution, result_.why);
  }

  void limit_runs(harness::Scenario& scenario, std::optional<std::int64_t> most) const {
    auto left = options_.max_runs - result_.simulations;
    if (most) left = std::min(left, *most);
    auto& limit = scenario.limits.max_runs;
    if (limit == 0 || limit > left) limit = std::max<std::int64_t>(left, 1);
  }

  /// Executes the plan. True: clean, with a claim; none: nothing more can be learned.
  std::optional<bool> plan_round(std::optional<std::int64_t> most) {
    auto round = begin(LearnRound::Kind::kPlan, Execution::kClosedLoop);
    if (!round) return std::nullopt;
    auto& scenario = round->loaded->scenario;
    limit_runs(scenario, most);
    auto loop = ClosedLoop::make(*round->loaded, *round->context);
    if (!loop) return failed(*round);
    round->loop = *std::move(loop);
    const auto options = folder_->campaign(*round);
    auto ran = harness::run_loop_campaign(scenario, *round->loop, round->simulator, options,
                                          round->context->files(), round->context->sink());
    return judge(*round, ran, most.has_value());
  }

  /// Simulates the traces of the scenario as it asks for.
  std::optional<bool> trace_round() {
    auto round = begin(LearnRound::Kind::kTraces, Execution::kOpenLoop);
    if (!round) return std::nullopt;
    if (!round->loaded->compilation.model.has_constraints) return true;
    limit_runs(round->loaded->scenario, std::nullopt);
    // The number of traces depends on the runs that they take.
    round->loaded->scenario.criterion.family = harness::Family::kPerTrace;
    EnumeratedTraces all(*round->loaded, *round->context);
    std::int64_t made = 0, done = 0, trace = 0;
    BoundedTraces traces(all, made, options_.max_runs - result_.simulations);
    auto options = folder_->campaign(*round);
    options.progress = [&](const harness::CampaignProgress& progress) {
      made += progress.trace == trace ? progress.done - done : progress.done;
      done = progress.done;
      trace = progress.trace;
      if (options_.progress) options_.progress(progress);
    };
    auto ran = harness::run_campaign(round->loaded->scenario, traces, round->simulator, options,
                                     round->context->files(), round->context->sink());
    if (ran && ran->traces.empty() && !context_.stopped()) {
      result_.why = "no trace of the learned model reaches the scenario's constraints";
      close(*round, "no trace");
      return std::nullopt;
    }
    if (ran && traces.ended() && ran->verdict == CampaignVerdict::kNoDiscrepancy) {
      ran->verdict = CampaignVerdict::kInconclusive;
    }
    return judge(*round, ran, false);
  }

  std::optional<bool> judge(OpenRound& round, base::Result<harness::CampaignResult>& ran,
                            bool first) {
    if (!ran) return failed(round);
    if (ran->journal_open) {
      (void)harness::write_report(*ran, round.folder / "run", round.context->sink());
    }
    round.told.simulations = ran->simulations;
    result_.simulations += ran->simulations;
    const auto outcome = std::string(harness::to_string(ran->verdict));
    const bool clean = ran->verdict == CampaignVerdict::kNoDiscrepancy;
    if (clean) ++clean_rounds_;
    const bool taught = take(round, !clean || clean_rounds_ <= kSharpened);
    close(round, outcome);
    if (clean) {
      result_.claims.clear();
      for (const auto& trace : ran->traces) {
        auto& claims = result_.claims;
        const bool told = std::find(claims.begin(), claims.end(), trace.claim) != claims.end();
        if (!trace.claim.empty() && !told) claims.push_back(trace.claim);
      }
      return !taught;  // with more runs another model may be the simplest one
    }
    if (context_.stopped()) return std::nullopt;
    if (ran->failed) {
      result_.why =
          fmt::format("round {}: {}", round.told.number, first_error(round.context->sink()));
      return std::nullopt;
    }
    if (taught || first) return false;
    if (ran->verdict == CampaignVerdict::kInconclusive) {
      if (!over()) {
        result_.why = fmt::format("the run of round {} is inconclusive", round.told.number);
        const auto& loop = ran->traces.empty() ? std::nullopt : ran->traces.front().loop;
        if (loop && !loop->why_unfinished.empty()) result_.why += ": " + loop->why_unfinished;
      }
      return std::nullopt;
    }
    result_.why = fmt::format(
        "what round {} found teaches nothing that axioms about events can say", round.told.number);
    if (!ran->discrepancies.empty()) {
      result_.why += ": " + ran->discrepancies.front().cause.text;
    }
    return std::nullopt;
  }

  /// The run ended with an error; its records count all the same.
  std::optional<bool> failed(OpenRound& round) {
    const auto why = first_error(round.context->sink());
    std::error_code error;
    if (fs::exists(round.folder / "run" / harness::kJournalName, error)) {
      if (take(round)) {
        close(round, "error: " + why);
        return false;
      }
    }
    result_.why = fmt::format("round {}: {}", round.told.number, why);
    close(round, "error: " + why);
    return std::nullopt;
  }

  /// False: nothing more can be done.
  bool explore_round() {
    auto round = begin(LearnRound::Kind::kSequences, Execution::kClosedLoop);
    if (!round) return false;
    ExploreOptions options;
    options.seed = options_.seed;
    options.jobs = options_.jobs;
    options.first = result_.sequences + 1;
    options.count = std::min(
        {kBatch, options_.explore - result_.sequences, options_.max_runs - result_.simulations});
    options.run_dir = round->folder / "run";
    options.tool_version = options_.tool_version;
    options.progress = options_.progress;
    auto explored =
        explore(*round->loaded, taught_->runs(), round->simulator, options, *round->context);
    if (!explored) return failed(*round).has_value();
    result_.sequences += options.count;
    round->told.simulations = explored->made;
    result_.simulations += explored->made;
    for (auto& why : explored->skipped) result_.remarks.push_back(std::move(why));
    const auto predicted = taught_->check(explored->runs).admitted;
    for (const auto& run : explored->runs) taught_->add(run, round->told.number);
    const auto before = known_axioms_;
    taught_->relearn();
    close(*round, fmt::format("{} of {} as the model said", predicted, explored->runs.size()));
    const bool nothing = known_axioms_ == before;
    result_.sequences_clean = nothing ? result_.sequences_clean + options.count : 0;
    return true;
  }

  void close(OpenRound& round, std::string outcome) {
    round.told.outcome = std::move(outcome);
    const auto axioms = taught_->axioms();
    std::set<std::string> now(axioms.begin(), axioms.end());
    std::vector<std::string> changed;
    std::set_symmetric_difference(now.begin(), now.end(), known_axioms_.begin(),
                                  known_axioms_.end(), std::back_inserter(changed));
    round.told.changed = changed.size();
    known_axioms_ = std::move(now);
    context_.remark(fmt::format("round {}, {}: {} simulations, {}; {} axioms about events now",
                                round.told.number, to_string(round.told.kind),
                                round.told.simulations, round.told.outcome, known_axioms_.size()));
    result_.rounds.push_back(round.told);
  }

  // --- observations

  /// Learns from the simulations of a round; false if they have changed nothing.
  bool take(const OpenRound& round, bool learns = true) {
    const auto before = taught_->all_axioms();
    const auto journal =
        harness::read_journal(round.folder / "run", round.context->files(), round.context->sink());
    if (!journal) return false;
    auto paths = observed_paths(*round.loaded, *journal, *round.context);
    if (!paths) return false;
    const auto& compiled = round.loaded->compilation;
    std::set<std::string> told;  // fluents
    for (auto& path : *paths) {
      if (!round.loop) break;
      add_outcome_facts(*compiled.plan, round.loop->scenario_plan().questions(), compiled.model,
                        path, told);
    }
    taught_->add(*std::move(paths), compiled.model, round.told.number, told);
    learns ? taught_->relearn() : taught_->confirm();
    return taught_->all_axioms() != before;
  }

  // --- the end

  void finish() {
    result_.model = taught_->text();
    result_.axioms = taught_->axioms().size();
    result_.contradictions = taught_->contradictions();
    result_.refuted = taught_->refuted();
    result_.not_learnable = taught_->not_learned();
    // After a stop, the runs are not checked against the model any more.
    const auto check = context_.stopped() ? RunsCheck() : taught_->check(taught_->runs());
    result_.runs = check.runs;
    result_.admitted = check.admitted;
    if (!check.first.empty()) {
      result_.remarks.push_back("the first run that the model does not admit: " + check.first);
    }
    if (!check.wrong.empty()) {
      result_.remarks.push_back("the learned text is no right model: " + check.wrong);
    }
    if (result_.clean) {
      result_.why.clear();
      return;
    }
    result_.claims.clear();
    if (!result_.why.empty()) return;
    result_.why = context_.stopped()
                      ? "it was stopped"
                      : fmt::format("the budget of {} simulations is used up", options_.max_runs);
  }

  base::Status write() {
    auto& sink = context_.sink();
    if (!folder_->write_scenario(options_.out, taught_->text(), "learned.e", "learned.yaml",
                                 result_.judged_in_closed_loop) ||
        !base::write_file_atomically(options_.out / "log.txt", learn_log(result_), sink,
                                     base::TextForm::kLines)) {
      return sink.already_reported();
    }
    return base::Unit{};
  }

  const LearnOptions& options_;
  const std::function<base::Result<harness::SimulatorFactory>(const ScenarioModel&)>&
      ask_simulator_;
  Context& context_;
  std::optional<base::Result<ScenarioModel>> loaded_;
  Execution own_execution_ = Execution::kOpenLoop;
  std::int64_t clean_rounds_ = 0;
  std::optional<RoundFolder> folder_;
  std::unique_ptr<TaughtModel> taught_;
  std::set<std::string> known_axioms_;
  LearnResult result_;
};

}  // namespace

base::Result<LearnResult> learn(
    const LearnOptions& options,
    const std::function<base::Result<harness::SimulatorFactory>(const ScenarioModel&)>&
        make_simulator,
    Context& context) {
  return ScenarioLearner(options, make_simulator, context).run();
}

}  // namespace parallax::tools
