#include "tools/repair/repair_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "harness/campaign/campaign.h"
#include "harness/report/report.h"
#include "tools/app/closed_loop.h"
#include "tools/app/run_coverage.h"
#include "tools/app/trace_feed.h"
#include "tools/app/version.h"
#include "tools/repair/apply.h"
#include "tools/repair/ranking.h"
#include "tools/repair/scenario_copy.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using harness::CampaignResult;
using harness::CampaignVerdict;

/// What the recorded run was asked for on its command line, beside the scenario.
void ask_as_recorded(const harness::JournalHeader& header, harness::Scenario& scenario) {
  const auto options = nlohmann::json::parse(header.options, nullptr, false);
  if (!options.is_object()) return;
  const auto criterion = options.value("criterion", nlohmann::json::object());
  auto& spec = scenario.criterion;
  const bool paper = criterion.value("kind", "clean-runs") == "paper";
  spec.kind = paper ? harness::CriterionKind::kPaper : harness::CriterionKind::kCleanRuns;
  spec.confidence_level = criterion.value("confidence", spec.confidence_level);
  spec.epsilon = criterion.value("epsilon", spec.epsilon);
  scenario.match_model = options.value("match", "model") == "model";
  scenario.compare = recorded_comparison(header).value_or(scenario.comparison());
  const bool guided = options.value("starts", "uniform") == "guided";
  scenario.starts = guided ? harness::Starts::kGuided : harness::Starts::kUniform;
}

class Rounds {
 public:
  Rounds(const RepairLoopOptions& options, Context& context)
      : options_(options), context_(context) {}

  base::Result<RepairLoop> run() {
    auto& sink = context_.sink();
    if (!prepare()) return sink.already_reported();
    auto folder = options_.repair.folder.folder;
    for (std::int64_t number = 1;; ++number) {
      if (number > options_.rounds) {
        end(LoopEnd::kRounds, fmt::format("{} rounds were allowed", options_.rounds));
        break;
      }
      const auto next = (fs::path(options_.out) / fmt::format("run-{}", number)).string();
      const auto goes_on = round(folder, next);
      if (!goes_on) return sink.already_reported();
      if (!*goes_on) break;
      folder = next;
    }
    auto changes = copy_->changes(context_);
    if (!changes) return sink.already_reported();
    loop_.files = *std::move(changes);
    if (!write_log()) return sink.already_reported();
    return std::move(loop_);
  }

 private:
  void end(LoopEnd how, std::string why) {
    loop_.end = how;
    loop_.why = std::move(why);
  }

  /// Copies what the scenario of the run reads.
  base::Status prepare() {
    auto& sink = context_.sink();
    std::error_code error;
    const fs::path out = options_.out;
    if (fs::exists(out, error) && !fs::is_empty(out, error)) {
      return sink.error_about(base::DiagnosticCode::kFileNotWritable, options_.out,
                              "--loop needs a folder that is new or empty");
    }
    const auto& folder = options_.repair.folder;
    const auto journal = harness::read_journal(folder.folder, context_.files(), sink);
    if (!journal) return sink.already_reported();
    if (!journal->header) {
      return sink.error_about(base::DiagnosticCode::kNoJournal, folder.folder);
    }
    header_ = *journal->header;
    const auto first_file = context_.files().size();
    const auto first_input = context_.files().inputs().size();
    const auto loaded = load_recorded_scenario(folder, header_, ScenarioUse::kRun, context_);
    if (!loaded) return sink.already_reported();
    auto copy =
        ScenarioCopy::make(loaded->scenario.file, out / "files", first_file, first_input, context_);
    if (!copy) return sink.already_reported();
    copy_.emplace(*std::move(copy));
    return base::Unit{};
  }

  /// One round; false: it was the last.
  base::Result<bool> round(const std::string& folder, const std::string& next) {
    auto& sink = context_.sink();
    auto repair = options_.repair;
    repair.folder = {folder, copy_->scenario().string()};
    auto found = repair_with_experiments(repair, options_.experiments, context_);
    if (!found) return sink.already_reported();
    auto& round = loop_.rounds.emplace_back();
    round.folder = folder;
    round.runs = found->runs;
    round.failed = found->failed;
    round.experiments = found->experiments;
    if (context_.stopped()) {
      end(LoopEnd::kStopped, "it was stopped");
      return false;
    }
    if (found->partings.empty()) {
      end(LoopEnd::kNothing, "the model admits all runs of " + folder);
      return false;
    }
    const auto input = load_repair_input(repair, context_);
    if (!input) return sink.already_reported();
    const auto* first = choose(*found);
    if (first == nullptr) return false;
    round.words = first->words;
    std::error_code error;
    round.patch = unified_diff(first->files, fs::current_path(error).string());
    for (const auto& file : first->files) {
      if (is_copy(file.name)) continue;
      return sink.error_about(base::DiagnosticCode::kFileNotWritable, file.name,
                              "--loop changes copies, and this file was not read from its copy: "
                              "name it relative to the scenario");
    }
    if (!apply_proposal(*first, context_)) return sink.already_reported();
    evidence_.insert(evidence_.end(), input->evidence.begin(), input->evidence.end());
    round.next_folder = next;
    return run_again(next, round);
  }

  /// Does the file lie in the folder of copies?
  bool is_copy(const std::string& name) const {
    std::error_code error;
    const auto file = fs::weakly_canonical(name, error);
    const auto folder = fs::weakly_canonical(fs::path(options_.out) / "files", error);
    const auto below = file.lexically_relative(folder);
    return !below.empty() && *below.begin() != "..";
  }

  /// The first proposal, if it is the only one of its rank; else why not is the end.
  const Proposal* choose(RepairResult& found) {
    auto& all = found.proposals;
    const auto before = all.size();
    // What was repaired in earlier rounds stays so.
    std::erase_if(all, [&](const Proposal& proposal) {
      return proposal.text && !verify(*proposal.text, evidence_, context_).admits;
    });
    if (all.empty()) {
      end(LoopEnd::kNone, before == 0 ? "no change was found that explains all runs"
                                      : "what explains these runs contradicts those of earlier "
                                        "rounds");
      return nullptr;
    }
    const auto& first = all.front();
    const auto tied = before == all.size() ? found.tied : of_first_rank(all);
    if (tied > 1) {
      end(LoopEnd::kTie, fmt::format("{} proposals are of one rank{}{}", tied,
                                     found.why_tied.empty() ? "" : ": ", found.why_tied));
      for (std::size_t i = 0; i < std::min(tied, all.size()); ++i) loop_.why += "; " + all[i].words;
      return nullptr;
    }
    if (first.effects && first.effects->reaches == false) {
      end(LoopEnd::kPlanAtFault,
          first.words +
              ": with that no trace reaches the constraints, so that it is the plan that "
              "has to change");
      return nullptr;
    }
    return &first;
  }

  base::Result<CampaignResult> campaign(const ScenarioModel& loaded, const std::string& folder) {
    auto& sink = context_.sink();
    const auto simulator = options_.experiments.simulator(loaded);
    if (!simulator) return sink.already_reported();
    std::error_code error;
    harness::CampaignOptions options;
    // Other starts than those that the repair was made for: they are clean by construction.
    options.seed = header_.seed + loop_.rounds.size();
    options.jobs = options_.experiments.jobs;
    options.run_dir = folder;
    options.start_folder = fs::current_path(error).string();
    options.scenario_hash = loaded.sources_hash;
    options.tool_version = kVersion;
    options.stop = &context_.stop();
    options.progress = options_.experiments.progress;
    auto& files = context_.files();
    if (loaded.scenario.execution == harness::Execution::kClosedLoop) {
      auto feed = ClosedLoop::make(loaded, context_);
      if (!feed) return sink.already_reported();
      return harness::run_loop_campaign(loaded.scenario, **feed, *simulator, options, files, sink);
    }
    EnumeratedTraces traces(loaded.compilation.model, context_);
    return harness::run_campaign(loaded.scenario, traces, *simulator, options, files, sink);
  }

  /// Runs the copies as the recorded run was run; false: there is nothing more to repair.
  base::Result<bool> run_again(const std::string& folder, RepairRound& round) {
    auto& sink = context_.sink();
    auto loaded = load_scenario_run(copy_->scenario(), recorded_execution(header_), context_);
    if (!loaded) return sink.already_reported();
    ask_as_recorded(header_, loaded->scenario);
    auto result = campaign(*loaded, folder);
    if (!result) return sink.already_reported();
    if (result->journal_open) {
      result->coverage = coverage_of_run(*loaded, *result, context_);
      if (!harness::write_report(*result, folder, sink)) return sink.already_reported();
    }
    round.verdict = to_string(result->verdict);
    for (const auto& trace : result->traces) round.claims.push_back(trace.claim);
    if (context_.stopped()) {
      end(LoopEnd::kStopped, "it was stopped");
      return false;
    }
    switch (result->verdict) {
      case CampaignVerdict::kDiscrepancy:
        return true;
      case CampaignVerdict::kNoDiscrepancy:
        end(LoopEnd::kClean, "the run after it is clean");
        return false;
      case CampaignVerdict::kInconclusive:
        break;
    }
    end(LoopEnd::kInconclusive, "the run after it decides nothing");
    return false;
  }

  base::Status write_log() {
    auto& sink = context_.sink();
    const fs::path out = options_.out;
    std::error_code error;
    const auto patch = unified_diff(loop_.files, fs::current_path(error).string());
    if (!base::write_file_atomically(out / "rounds.txt", loop_text(loop_), sink) ||
        !base::write_file_atomically(out / "rounds.json", loop_json(loop_), sink) ||
        !base::write_file_atomically(out / "repair.patch", patch, sink)) {
      return sink.already_reported();
    }
    return base::Unit{};
  }

  const RepairLoopOptions& options_;
  Context& context_;
  harness::JournalHeader header_;
  std::optional<ScenarioCopy> copy_;
  std::vector<Evidence> evidence_;  // of the rounds that were
  RepairLoop loop_;
};

}  // namespace

std::string_view to_string(LoopEnd end) {
  static constexpr std::string_view kWords[] = {
      "clean",         "nothing-to-repair", "tie",    "no-proposal",
      "plan-at-fault", "inconclusive",      "rounds", "stopped"};
  return kWords[static_cast<std::size_t>(end)];
}

base::Result<RepairLoop> repair_in_rounds(const RepairLoopOptions& options, Context& context) {
  return Rounds(options, context).run();
}

std::string loop_text(const RepairLoop& loop) {
  std::string out;
  for (std::size_t i = 0; i < loop.rounds.size(); ++i) {
    const auto& round = loop.rounds[i];
    out += fmt::format("round {}: {}: {} run{}, {} of them not as the model says", i + 1,
                       round.folder, round.runs, round.runs == 1 ? "" : "s", round.failed);
    if (round.experiments > 0) {
      out += fmt::format("; {} made to tell proposals apart", round.experiments);
    }
    out += '\n';
    if (round.words.empty()) continue;
    out += fmt::format("  applied: {}\n", round.words);
    if (round.verdict.empty()) continue;
    out += fmt::format("  run again: {}, in {}\n", round.verdict, round.next_folder);
    if (round.verdict == "discrepancy") continue;
    for (const auto& claim : round.claims) out += fmt::format("    {}\n", claim);
  }
  out += fmt::format("{}: {}.\n", to_string(loop.end), loop.why);
  if (loop.files.empty()) return out;
  std::error_code error;
  return out + "\n" + unified_diff(loop.files, fs::current_path(error).string());
}

std::string loop_json(const RepairLoop& loop) {
  nlohmann::ordered_json out = {{"status", "ok"}, {"end", to_string(loop.end)}, {"why", loop.why}};
  auto& rounds = out["rounds"] = nlohmann::ordered_json::array();
  for (const auto& round : loop.rounds) {
    nlohmann::ordered_json one = {{"folder", round.folder},
                                  {"runs", round.runs},
                                  {"failed", round.failed},
                                  {"experiments", round.experiments}};
    if (!round.words.empty()) {
      one["words"] = round.words;
      one["patch"] = round.patch;
      one["next_folder"] = round.next_folder;
      one["verdict"] = round.verdict;
      one["claims"] = round.claims;
    }
    rounds.push_back(std::move(one));
  }
  std::error_code error;
  out["patch"] = unified_diff(loop.files, fs::current_path(error).string());
  return base::json_text(out);
}

}  // namespace parallax::tools
