// Repair in rounds: propose, apply the best change, run again, until nothing is wrong.
//
// Each round repairs the last run's folder and takes its first proposal, if it is the only one
// of its rank; a tie ends the loop, as a choice is the user's. A proposal has to explain the
// runs of all earlier rounds as well, so rounds cannot undo each other. Changes are made in
// copies of the files that the scenario reads; the user's files are only read. The next campaign
// draws with another seed, since the starts of the repair are clean by construction. It ends
// clean only if no initial state has lost its way to the constraints (a model that admits
// nothing would be clean as well) and no random sequence of events refutes what was applied. Cost:
// one repair and one campaign for each round.

#include "tools/repair/repair_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/words.h"
#include "harness/campaign/campaign.h"
#include "harness/config/validate_list.h"
#include "harness/report/report.h"
#include "tools/app/run_coverage.h"
#include "tools/repair/apply.h"
#include "tools/repair/lost_starts.h"
#include "tools/repair/plan_runs.h"
#include "tools/repair/ranking.h"
#include "tools/repair/scenario_copy.h"
#include "tools/repair/trace_numbers.h"
#include "tools/repair/world_files.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using harness::CampaignResult;
using harness::CampaignVerdict;

class Rounds {
 public:
  Rounds(const RepairLoopOptions& options, Context& context)
      : options_(options), context_(context) {}

  base::Result<RepairLoop> run() {
    auto& sink = context_.sink();
    if (!prepare()) return sink.already_reported();
    auto folder = options_.repair.folder;
    for (std::int64_t number = 1;; ++number) {
      if (number > options_.rounds) {
        end(LoopEnd::kRounds, fmt::format("{} rounds were allowed", options_.rounds));
        break;
      }
      const auto next = (fs::path(options_.out) / fmt::format("run-{}", number)).string();
      const auto goes_on = round(folder, next);
      if (!goes_on) {
        // Earlier rounds are kept.
        end(LoopEnd::kFailed, fmt::format("an error ended round {}", number));
        break;
      }
      if (!*goes_on) break;
      folder = {next, copy_->scenario().string()};
    }
    auto changes = copy_->changes(context_);
    if (!changes) return sink.already_reported();
    loop_.files = *std::move(changes);
    loop_.read_by_world = read_by_world(original_->scenario, loop_.files, context_);
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
      return sink.error_about(codes::kFileNotWritable, options_.out,
                              "--loop needs a folder that is new or empty");
    }
    auto folder = options_.repair.folder;
    folder.may_use_kept = false;  // it edits the files
    const auto journal = harness::read_journal(folder.folder, context_.files(), sink);
    if (!journal) return sink.already_reported();
    if (!journal->header) {
      return sink.error_about(codes::kNoJournal, folder.folder);
    }
    header_ = *journal->header;
    const auto first_file = context_.files().size();
    const auto first_input = context_.files().inputs().size();
    auto loaded = load_recorded_scenario(folder, header_, ScenarioUse::kRun, context_);
    if (!loaded) return sink.already_reported();
    const auto others = harness::scenarios_to_validate(loaded->scenario.file, context_.files(),
                                                       sink, context_.form().allow_outside);
    if (!others) return sink.already_reported();
    for (const auto& other : *others) {  // what they read is copied, too
      if (!load_scenario_model(other.text, context_, {.as_run = true})) {
        return sink.already_reported();
      }
    }
    auto copy =
        ScenarioCopy::make(loaded->scenario, out / "files", first_file, first_input, context_);
    if (!copy) return sink.already_reported();
    original_.emplace(*std::move(loaded));
    copy_.emplace(*std::move(copy));
    return base::Unit{};
  }

  /// One round; false: it was the last. The first one reads the user's files, so that its
  /// experiments are made in the world that was run; what it changes are the copies.
  base::Result<bool> round(const RunFolderOptions& folder, const std::string& next) {
    auto& sink = context_.sink();
    auto repair = options_.repair;
    repair.folder = folder;
    auto found = repair_with_experiments(repair, options_.experiments, context_);
    if (!found) return sink.already_reported();
    auto& round = loop_.rounds.emplace_back();
    round.folder = folder.folder;
    round.runs = found->runs;
    round.failed = found->failed;
    round.experiments = found->experiments;
    if (context_.stopped()) {
      end(LoopEnd::kStopped, "it was stopped");
      return false;
    }
    if (found->partings.empty()) {
      found->finished
          ? end(LoopEnd::kNothing, "the model admits all runs of " + folder.folder)
          : end(LoopEnd::kInconclusive,
                "the model admits all runs of " + folder.folder + ", which came to no verdict");
      return false;
    }
    const auto input = load_repair_input(repair, context_);
    if (!input) return sink.already_reported();
    auto* first = choose(*found, input->evidence);
    if (first == nullptr) return false;
    auto files = copy_->in_copies(std::move(first->files), context_);
    if (!files) return sink.already_reported();
    first->files = *std::move(files);
    if (!apply_proposal(*first, base::WriteGate(true), context_)) return sink.already_reported();
    refuted_by_ = refutation(*first, *found);
    round.words = first->words;
    round.effects = first->effects;
    round.patch = patch_from_here(first->files);
    evidence_.insert(evidence_.end(), input->evidence.begin(), input->evidence.end());
    // Runs that a precaution takes to fail are set aside in later rounds, too.
    if (first->precaution) set_aside(input->evidence, evidence_);
    round.next_folder = next;
    return run_again(next, round);
  }

  /// The first proposal, if it is the only one of its rank; otherwise the loop ends with the
  /// reason.
  Proposal* choose(RepairResult& found, const std::vector<Evidence>& seen) {
    auto& all = found.proposals;
    const auto before = all.size();
    auto cautious = evidence_;
    set_aside(seen, cautious);
    // Proposals must also explain the runs of earlier rounds.
    std::erase_if(all, [&](const Proposal& proposal) {
      const auto& earlier = proposal.precaution ? cautious : evidence_;
      return proposal.text && !verify(*proposal.text, earlier, {}, context_).admits;
    });
    if (all.empty()) {
      end(LoopEnd::kNone, before == 0 ? "no change was found that explains all runs"
                                      : "what explains these runs contradicts those of earlier "
                                        "rounds");
      return nullptr;
    }
    auto& first = all.front();
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

  base::Result<CampaignResult> campaign(ScenarioModel& loaded, const std::string& folder) {
    harness::CampaignOptions options;
    header_.asked.apply(loaded.scenario, options);
    if (header_.max_runs > 0) loaded.scenario.limits.max_runs = header_.max_runs;
    // Draws other starts than those of the repair, which are clean by construction.
    options.seed = header_.seed + loop_.rounds.size();
    options.run_dir = folder;
    return run_plan(loaded, std::move(options), options_.experiments, context_);
  }

  /// Runs the copies as the recorded run was run; false: there is nothing more to repair.
  base::Result<bool> run_again(const std::string& folder, RepairRound& round) {
    auto& sink = context_.sink();
    auto loaded = load_scenario_model(copy_->scenario(), context_,
                                      {.as_run = true, .execution = recorded_execution(header_)});
    if (!loaded) return sink.already_reported();
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
    if (result->failed) return sink.already_reported();
    switch (result->verdict) {
      case CampaignVerdict::kDiscrepancy:
        return true;
      case CampaignVerdict::kNoDiscrepancy:
        end_clean(loaded->compilation.model);
        return false;
      case CampaignVerdict::kInconclusive:
        break;
    }
    end(LoopEnd::kInconclusive, "the run after it decides nothing");
    return false;
  }

  /// The model that was applied last, which other events may refute.
  void end_without_loss() {
    if (!refuted_by_) return end(LoopEnd::kClean, "the run after it is clean");
    end(LoopEnd::kRefuted,
        "the run after it is clean, but the model is refuted by " + *refuted_by_);
  }

  /// A run is also clean if the trace that went wrong no longer exists.
  void end_clean(const compiler::CompiledModel& model) {
    const auto& before = original_->compilation.model;
    if (!before.has_constraints || !model.has_constraints) {
      return end_without_loss();
    }
    const auto starts = lost_starts(before, model, context_.stop());
    if (starts.lost == 0) return end_without_loss();
    end(LoopEnd::kPlanAtFault,
        fmt::format(
            "the run after it is clean, but from {} of {}{} initial states the constraints "
            "can no longer be reached, and nothing was run (the first: where {}): from there "
            "it is the plan that has to change",
            starts.lost, starts.more ? "the first " : "", starts.of, starts.first));
  }

  base::Status write_log() {
    auto& sink = context_.sink();
    const fs::path out = options_.out;
    const auto patch = patch_from_here(loop_.files);
    if (!base::write_file_atomically(out / "rounds.txt", loop_text(loop_), sink,
                                     base::TextForm::kLines) ||
        !base::write_file_atomically(out / "rounds.json", loop_json(loop_), sink) ||
        !base::write_file_atomically(out / "repair.patch", patch, sink)) {
      return sink.already_reported();
    }
    return base::Unit{};
  }

  const RepairLoopOptions& options_;
  Context& context_;
  harness::JournalHeader header_;
  std::optional<ScenarioModel> original_;  // what was run at first
  std::optional<ScenarioCopy> copy_;
  std::vector<Evidence> evidence_;         // of the rounds that were
  std::optional<std::string> refuted_by_;  // what was applied last
  RepairLoop loop_;
};

}  // namespace

std::string_view to_string(LoopEnd end) {
  static constexpr std::string_view kWords[] = {
      "clean",   "nothing-to-repair", "tie",    "no-proposal", "plan-at-fault",
      "refuted", "inconclusive",      "rounds", "stopped",     "failed"};
  return kWords[static_cast<std::size_t>(end)];
}

base::Result<RepairLoop> repair_in_rounds(const RepairLoopOptions& options, Context& context) {
  return Rounds(options, context).run();
}

std::string loop_text(const RepairLoop& loop) {
  std::string out;
  for (std::size_t i = 0; i < loop.rounds.size(); ++i) {
    const auto& round = loop.rounds[i];
    out += fmt::format("round {}: {}: {}, {} of them not as the model says", i + 1, round.folder,
                       base::counted(round.runs, "run"), round.failed);
    if (round.experiments > 0) {
      out += fmt::format("; {} made to tell proposals apart", round.experiments);
    }
    out += '\n';
    if (round.words.empty()) continue;
    out += fmt::format("  applied: {}\n", round.words);
    if (round.effects) {
      out += fmt::format("    traces lost: {}, gained: {}\n", number_text(round.effects->lost),
                         number_text(round.effects->gained));
    }
    if (round.verdict.empty()) continue;
    out += fmt::format("  run again: {}, in {}\n", round.verdict, round.next_folder);
    if (round.verdict == "discrepancy") continue;
    for (const auto& claim : round.claims) out += fmt::format("    {}\n", claim);
  }
  out += fmt::format("{}: {}.\n", to_string(loop.end), loop.why);
  if (loop.files.empty()) return out;
  for (const auto& name : loop.read_by_world) {
    out += fmt::format(
        "The world reads {}, too. The rounds ran in the world as it was; applied, the "
        "change is one of the world as well.\n",
        name);
  }
  const auto place = patch_place_words(loop.files);
  if (!place.empty()) out += place + "\n";
  return out + "\n" + patch_from_here(loop.files);
}

std::string loop_json(const RepairLoop& loop) {
  const auto* status = loop.end == LoopEnd::kFailed ? "error" : "ok";
  nlohmann::ordered_json out = {
      {"status", status}, {"end", to_string(loop.end)}, {"why", loop.why}};
  auto& rounds = out["rounds"] = nlohmann::ordered_json::array();
  for (const auto& round : loop.rounds) {
    nlohmann::ordered_json one = {{"folder", round.folder},
                                  {"runs", round.runs},
                                  {"failed", round.failed},
                                  {"experiments", round.experiments}};
    if (!round.words.empty()) {
      one["words"] = round.words;
      one["patch"] = round.patch;
      const auto effects = round.effects.value_or(TraceEffects{});
      one["traces_lost"] = number_json(effects.lost);
      one["traces_gained"] = number_json(effects.gained);
      one["next_folder"] = round.next_folder;
      one["verdict"] = round.verdict;
      one["claims"] = round.claims;
    }
    rounds.push_back(std::move(one));
  }
  out["read_by_world"] = loop.read_by_world;
  out["patch"] = patch_from_here(loop.files);
  out["patch_folder"] = patch_folder(loop.files);
  return base::json_text(out);
}

}  // namespace parallax::tools
