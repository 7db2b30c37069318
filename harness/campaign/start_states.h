#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/sample_runner.h"
#include "harness/campaign/start_draw.h"
#include "harness/campaign/start_result.h"
#include "harness/campaign/trace_input.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

/// The sources of a trace's initial states. All of them outlive the StartStates.
struct StartSources {
  const Scenario& scenario;
  const ModelFluents& fluents;
  const SimulatorInfo& simulator;
  TraceFeed& feed;
  base::DiagnosticSink& sink;
  std::uint64_t campaign_seed = 1;
};

/// A trace from one of its initial states, ready to be simulated.
struct PreparedStart {
  std::int64_t state = 0;
  std::shared_ptr<const TracePlan> plan;
  std::shared_ptr<const SampleMaker> samples;
};

/// The initial states that lead to the events of one trace, and which of them each sample begins
/// in. States are numbered from 1; the first is that of the trace itself. Where there is one only
/// its number is 0, and nothing of what follows costs anything.
class StartStates {
 public:
  /// Lists the states; the trace's own only where that is stopped. Reports what prepare_trace
  /// reports of the first one.
  static base::Result<StartStates> make(const StartSources& sources, CampaignTrace trace);

  bool is_single() const { return states_.size() == 1 && !more_; }
  /// Number of states that can be drawn. None: there are too many to list.
  std::optional<std::int64_t> count() const;
  /// Drawn samples come after this one.
  void begin_after(std::int64_t sample) { offset_ = sample; }

  /// The state of a drawn sample. As long as nothing was lost, in random orders of all states, one
  /// order after the other; `independent`: drawn by itself, each equally likely or by its weight.
  /// Weighted and unlisted states are always drawn so. None: stopped, or drawing ended (`ran_out`).
  base::Result<std::optional<std::int64_t>> state_of(std::int64_t sample, bool independent);

  /// Was no state found for a drawn sample, because hardly any candidate is one?
  bool ran_out(std::int64_t sample) const;

  /// The trace from that state; made at the first call. None: stopped.
  base::Result<std::optional<PreparedStart>> prepared(std::int64_t state);
  /// The same of a state that was asked for before.
  const PreparedStart& known(std::int64_t state) const;
  /// The trace as it was handed in.
  const TracePlan& first() const { return *known(is_single() ? 0 : 1).plan; }

  /// Whether a sample may begin in the state of this number.
  bool has(std::int64_t state) const;
  /// How states are drawn, for a journal: "uniform of 6"; empty where there is one only.
  std::string law_text() const;
  /// Names which initial states samples begin in, with their weights: equal for equal ones.
  std::string digest() const;
  /// Fills in all but the counts. Candidates are those of samples up to `last`.
  void describe(StartResult& result, std::int64_t last) const;
  /// The true ones, by name, of the fluents that tell listed states apart.
  std::set<std::string> holds(std::int64_t state) const;
  /// The listed state whose share of the unit interval, in equal parts or by weights, has `u`.
  std::int64_t state_at(double u) const;
  /// The true fluents of the state that do not hold in every listed one: "TrolleyAt(onWay)".
  std::string text(std::int64_t state) const;

 private:
  using State = FluentSet;

  explicit StartStates(const StartSources& sources) : sources_(sources) {}
  base::Status list();
  State own() const;
  base::Result<PreparedStart> prepare(CampaignTrace trace, std::int64_t state);
  bool can_begin(const State& state) const;
  void leave_out_unrealisable();
  std::int64_t permuted(std::int64_t position);
  base::Result<std::optional<std::int64_t>> accepted(std::int64_t sample);

  StartSources sources_;
  std::shared_ptr<const CampaignTrace> trace_;
  std::uint64_t trace_key_ = 0;
  std::vector<compiler::FluentId> fluents_;  // that tell states apart, ascending
  std::vector<State> states_;                // by number - 1
  FluentSet common_;                         // true in each of them
  std::vector<double> weights_;              // none: each equally likely
  bool more_ = false;
  std::vector<std::vector<State>> parts_;  // if so
  std::map<State, std::int64_t> numbers_;  // likewise, of the drawn ones
  struct Drawn {
    std::int64_t state = 0, refused = 0;  // 0: none was found; refused: candidates before it
  };
  std::map<std::int64_t, Drawn> drawn_;  // likewise, by sample
  std::int64_t refused_ = 0;             // before the states that were found
  std::vector<std::string> unrealisable_;
  std::int64_t others_ = 0;  // initial states that are not drawn, by `initial: first`
  std::map<std::int64_t, PreparedStart> prepared_;
  std::int64_t offset_ = 0;
  std::int64_t block_ = -1;  // whose order is in `order_`
  std::vector<std::int64_t> order_;
};

}  // namespace parallax::harness
