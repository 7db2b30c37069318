#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/loop_input.h"
#include "harness/campaign/sample_row.h"
#include "harness/campaign/trial.h"

namespace parallax::harness {

/// The verdict of another simulator on the start of one simulation: the same verdict, the other
/// one, or none, because it was lost or does not take the start.
enum class OpinionAnswer : std::uint8_t { kClean, kDiscrepancy, kNone };
inline constexpr auto kOpinionAnswerWords =
    base::word_table<OpinionAnswer>("clean", "discrepancy", "none");
constexpr std::string_view to_string(OpinionAnswer answer) {
  return kOpinionAnswerWords.of(answer);
}

/// One simulation of a run, made again by the other simulator.
struct Opinion {
  std::int64_t trace = 0, sample = 0;
  bool found = false;  // a discrepancy in the run; else it was clean
  std::string cause;   // of the run's discrepancy
  OpinionAnswer answer = OpinionAnswer::kNone;
  std::string other;  // the cause of a discrepancy there, or why there is no answer
};

/// A run as another simulator sees it: every discrepancy, and some clean simulations.
struct SecondOpinion {
  std::string first, other;  // "ode 0.16.2", "mujoco 2.2.2"; the engines' names in front
  std::int64_t clean_asked = 0;
  std::vector<Opinion> opinions;  // discrepancies, then clean ones; each by trace and sample
  double level = 0.95;

  std::int64_t count(bool found, OpinionAnswer answer) const;
  /// No more than this share of the simulations that are clean in the run are anything else there,
  /// with confidence `level`: by Clopper and Pearson, no answer taken for the worst. 1 without any.
  double disagreement_upper() const;
};

/// So many clean simulations bring the bound below 5 % if all are clean in the other, too.
inline constexpr std::int64_t kUsualOpinions = 59;

/// A simulation that the other simulator is asked about.
struct OpinionQuestion {
  SampleRecord record;
  bool found = false;
  std::string cause;
};

/// All discrepancies among `rows`, which are those of a run in their order, and its first clean
/// simulations with a drawn start, trace by trace in turn, at most `clean` of them: which these are
/// does not depend on what the other simulator says. `samples` has their records.
std::vector<OpinionQuestion> opinion_questions(const std::vector<SampleRow>& rows,
                                               const std::map<SampleKey, SampleRecord>& samples,
                                               std::int64_t clean);

/// The traces of a run by number and, behind it, by the number of the initial state that a sample
/// begins in; 0: as it was enumerated.
using TracesOfRun =
    std::map<std::pair<std::int64_t, std::int64_t>, std::shared_ptr<const CampaignTrace>>;

/// Simulates the starts and seeds again with the bench's simulator, which was started, and judges
/// what comes of them as the run does. Nothing depends on the number of workers. None when stopped.
/// Reports an action that the simulator refuses, and a variable that it does not show
/// (kSimulatorRefused).
base::Result<std::optional<std::vector<Opinion>>> opinions_on_traces(
    const Scenario& scenario, SimulatorBench& bench, TraceFeed& feed, const TracesOfRun& traces,
    std::vector<OpinionQuestion> questions, base::DiagnosticSink& sink);

/// The same of executions of a plan, which goes on by what the other simulator reports. `seed`: of
/// the run.
base::Result<std::optional<std::vector<Opinion>>> opinions_on_executions(
    const Scenario& scenario, SimulatorBench& bench, LoopFeed& feed, std::uint64_t seed,
    std::vector<OpinionQuestion> questions, base::DiagnosticSink& sink);

}  // namespace parallax::harness
