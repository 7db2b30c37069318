#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/journal.h"
#include "harness/campaign/loop_input.h"
#include "harness/campaign/loop_samples.h"
#include "harness/campaign/start_draw.h"
#include "harness/campaign/trial.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

/// The fluents that the mapping reads: states of the model that agree on them are one.
std::vector<compiler::FluentId> compared_fluents(const Scenario& scenario,
                                                 const ModelFluents& fluents);

/// Every perform of the plan needs a controller that takes what it says. Reports what action_calls
/// reports.
base::Status check_performs(const Scenario& scenario, const ExecutablePlan& plan,
                            base::DiagnosticSink& sink);

/// The counterpart of Trial for plans: executions of a plan in the order of their numbers,
/// simulated by workers that may run ahead, or taken from the journal.
class LoopStream {
 public:
  /// Everything outlives the object; `bench` has been started.
  LoopStream(const Scenario& scenario, LoopFeed& feed, SimulatorBench& bench, std::uint64_t seed,
             base::DiagnosticSink& sink)
      : scenario_(scenario), feed_(feed), bench_(bench), seed_(seed), sink_(sink) {}

  /// The state with these fluents as a trace without events.
  static std::shared_ptr<const CampaignTrace> start_state(const LoopFeed& feed,
                                                          std::vector<compiler::FluentId> holds);

  /// Call it before anything is simulated. Checks that every perform of the plan has a controller
  /// that takes its arguments, and that an initial state has a start. False when stopped.
  /// Reports what these checks report.
  base::Result<bool> prepare();
  /// Reports kForeignJournalLine for a start that is not that of its number.
  base::Status continue_from(const Journal& journal);

  /// The maker of executions; valid after `prepare`.
  const std::shared_ptr<const LoopSamples>& samples() const { return samples_; }
  std::int64_t initial_states() const { return std::ssize(samples_->starts()); }
  /// The initial states that no start can be in, each with the reason.
  const std::vector<std::string>& unrealisable() const { return unrealisable_; }
  bool has_weights() const { return has_weights_; }
  const LoopStart& start_of(const SampleRecord& record) const { return samples_->start_of(record); }
  /// The fluents that distinguish an initial state from the others, as text.
  std::string text(std::int64_t state) const;
  std::int64_t next_sample() const { return next_; }  // from 1
  /// Lets the workers simulate all samples up to this one.
  void submit_to(std::int64_t last);
  /// Waits for the next sample. None when stopped. Reports kForeignJournalLine for one on record
  /// whose start is not the one that is chosen now.
  base::Result<std::optional<SampleRecord>> next();
  /// The next sample from an initial state that is chosen because no drawn one had tried it; what
  /// ran ahead is forgotten. None when stopped.
  std::optional<SampleRecord> visit(std::int64_t state);
  /// Simulates the record's actions once more. None when stopped. Unless the stream `goes_on`, what
  /// ran ahead is forgotten.
  std::optional<SampleRecord> repeat(const SampleRecord& record, bool goes_on);
  /// The execution on record, and how it is made and judged again; it was clean.
  CleanSample clean_sample(const SampleRecord& record) const;
  base::DiagnosticBuilder report_refused(const SampleRecord& record) const;
  bool on_record(const SampleRecord& record) const {
    const auto* known = recorded(record.sample, DrawPhase::kCertify);
    return known != nullptr && known->visit == record.visit;
  }

 private:
  void describe_unrealisable(const LoopStates& states);
  void choose();
  const SampleRecord* recorded(std::int64_t sample, DrawPhase phase) const {
    return journal_->find(1, sample, phase);
  }
  std::optional<SampleRecord> result_of(std::int64_t sample, DrawPhase phase);

  const Scenario& scenario_;
  LoopFeed& feed_;
  SimulatorBench& bench_;
  std::uint64_t seed_;
  base::DiagnosticSink& sink_;
  const Journal* journal_ = nullptr;
  bool has_weights_ = false;
  std::vector<std::string> unrealisable_;
  FluentSet common_;  // true in each of the initial states
  std::shared_ptr<const LoopSamples> samples_;
  StartGuide* guide_ = nullptr;
  std::map<std::int64_t, GuidedStart> chosen_;  // by sample; of the others the start is drawn
  std::int64_t decided_ = 0;                    // the last sample of which it is known
  std::int64_t next_ = 1;                       // the sample that is waited for
  std::int64_t submitted_ = 0;  // the last one that the workers were given or the journal has
};

}  // namespace parallax::harness
