#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "harness/campaign/trace_input.h"
#include "runtime/enumerate/closed_world.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "tools/app/context.h"
#include "tools/app/plan_reservations.h"
#include "tools/app/scenario_model.h"
#include "tools/app/start_weights.h"
#include "tools/app/unreached_starts.h"

namespace parallax::tools {

/// Hands the traces of a compiled model to a campaign, one at a time: the solver waits while the
/// campaign simulates.
class EnumeratedTraces final : public harness::TraceFeed {
 public:
  /// `model` and `context` outlive the feed.
  EnumeratedTraces(const compiler::CompiledModel& model, Context& context,
                   const runtime::PlanEnumeratorOptions& options = {});
  /// The same with what the scenario says of initial states; `loaded` outlives the feed, too.
  EnumeratedTraces(const ScenarioModel& loaded, Context& context,
                   const runtime::PlanEnumeratorOptions& options = {});
  base::Result<std::optional<harness::CampaignTrace>> next() override;
  std::string exploration() const override;
  std::vector<std::string> bounds() const override;
  std::string reservation() const override;
  runtime::Symbols symbols() const override { return enumerator_->symbols(); }
  base::Result<std::optional<harness::TraceStarts>> starts(
      const harness::CampaignTrace& trace, std::span<const compiler::FluentId> fluents) override;
  base::Result<std::pair<base::Known, std::optional<harness::CampaignTrace>>> from(
      const harness::CampaignTrace& trace, std::span<const compiler::FluentId> fluents,
      const std::vector<compiler::FluentId>& state) override;
  base::Known admits(const harness::CampaignTrace& trace,
                     const std::vector<std::map<compiler::FluentId, bool>>& observed) override;
  /// Sets the source of notes for the message that no execution meets the constraints.
  void explain_absence_by(std::function<std::vector<std::string>()> reasons) {
    reasons_ = std::move(reasons);
  }
  std::int64_t solve_calls() const { return session_->solve_calls(); }

 private:
  base::Status explain_absence() const;
  base::Result<std::optional<harness::CampaignTrace>> next_trace();
  base::Known is_closed(const harness::CampaignTrace& trace);
  base::Result<bool> has_weight(const harness::CampaignTrace& trace);
  base::Status end_of_weights();
  base::Result<StateWeights> weights_of(const std::vector<std::vector<compiler::FluentId>>& states,
                                        const std::vector<compiler::FluentId>& told_by);
  base::Status weigh(harness::TraceStarts& starts, const std::vector<compiler::FluentId>& told_by);

  const compiler::CompiledModel* model_;
  Context* context_;
  bool split_initial_;
  std::function<std::vector<std::string>()> reasons_;
  const ScenarioModel* loaded_ = nullptr;  // with `start_weights`; null: there are none
  std::set<std::size_t> weighed_;          // entries that hold in some initial state
  std::int64_t with_weight_ = 0;           // traces with a state of a weight above 0
  std::int64_t without_weight_ = 0;        // others, which are left out
  std::size_t states_without_weight_ = 0;  // of these
  std::int64_t weightless_ = 0;  // initial states of traces that are simulated, left out of them
  bool weights_told_ = false;
  /// The fluents that distinguish initial states, by the number of the trace.
  std::map<std::int64_t, std::vector<compiler::FluentId>> told_by_;
  std::unique_ptr<runtime::SolverSession> session_;
  std::unique_ptr<runtime::PlanEnumerator> enumerator_;
  std::int64_t given_ = 0;         // the number of the last trace
  PlanReservations reservations_;  // without cuts: those that traces come to are known at the end
  std::vector<std::string> gaps_;  // one sentence each
  std::optional<UnreachedStarts> unreached_;
  std::optional<runtime::ClosedWorld> closed_world_;  // made where axioms demand events
};

/// The trace as campaigns have it, with what the plan says of its events. Reports
/// kSeveralEventsAtOnce unless between each timepoint and the next exactly one event happens that
/// no axiom demands.
base::Result<harness::CampaignTrace> campaign_trace(const compiler::CompiledModel& model,
                                                    runtime::Trace trace, Context& context);

/// Has the model an execution of `steps` steps? If it has none, reports why: the axioms of a
/// minimal core, each with its place. `unexplored`: of the plan, one sentence each
/// (reservation_texts); where there are any nothing is proved.
base::Known report_if_unsatisfiable(const compiler::CompiledModel& model, compiler::Timepoint steps,
                                    Context& context,
                                    const std::vector<std::string>& unexplored = {});

}  // namespace parallax::tools
