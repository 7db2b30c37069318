// Traces by their numbers, from counts of components (component_counter.cc).
//
// Counting first sets variables in the order of time: events determine later states, so states
// that cannot be reached are never met. If that exceeds its limits, the order of an elimination
// is tried, in which clauses that look far cost less but unreachable states are counted as well.
// A trace is then found by setting one observed atom after the other, each by the count of what
// is left, and a search fills in what tells no traces apart. A trial has limits of some tenths
// of a second. Cost: for each trace at most two counts for each atom, most of which are
// remembered.

#include "runtime/graph/component_traces.h"

#include "compiler/base/contract.h"
#include "runtime/enumerate/canonical.h"

namespace parallax::runtime {
namespace {

/// Events determine later states, so that states that cannot be reached are not met; but a clause
/// that looks far may make too many of them differ.
constexpr ComponentCounter::Limits kInOrderOfTime = {200'000'000, 300'000, 50'000'000};
/// Some tenths of a second. The limits are of all calls together.
constexpr ComponentCounter::Limits kTrialInOrderOfTime = {10'000'000, 20'000, 5'000'000};
constexpr ComponentCounter::Limits kTrial = {30'000'000, 60'000, 10'000'000};

}  // namespace

ComponentTraces::ComponentTraces(const CompiledModel& model, Distinct distinct,
                                 const std::atomic<bool>* stop, ComponentEffort effort)
    : model_(model),
      symbols_(symbols_of(model)),
      stop_(stop),
      counter_(model.variable_count(), projected_atoms(model, distinct)),
      search_(model.variable_count(), projected_atoms(model, distinct)) {
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    counter_.add_clause(model.clauses[c]);
    search_.add_clause(model.clauses[c]);
  }
  const bool is_trial = effort == ComponentEffort::kTrial;
  total_ = counter_.count({}, is_trial ? kTrialInOrderOfTime : kInOrderOfTime, stop);
  if (!total_ && counter_.reorder()) {
    total_ = counter_.count({}, is_trial ? kTrial : ComponentCounter::Limits{}, stop);
  }
}

std::optional<Trace> ComponentTraces::next() {
  if (!total_ || next_ >= *total_) return std::nullopt;
  const auto values = counter_.nth(next_, {}, stop_);
  if (!values) return std::nullopt;
  search_.begin(*values);
  // Only what tells no traces apart is left to find.
  auto status = ClauseSearch::Status::kGaveUp;
  while (status == ClauseSearch::Status::kGaveUp) {
    if (stop_ != nullptr && stop_->load()) return std::nullopt;
    status = search_.next(1000);
  }
  PARALLAX_REQUIRE(status == ClauseSearch::Status::kFound, "what was counted is there");
  ++next_;
  const auto value = [&](Literal literal) { return search_.value(literal); };
  auto trace = decode_trace(model_, symbols_, model_.horizon, value);
  trace.number = next_.fits_slong_p() ? next_.get_si() : 0;
  return trace;
}

bool ComponentTraces::print_next(const TraceFormat& format, std::string& out) {
  const auto trace = next();
  if (trace) out += format_trace(format, *trace, next_.get_str());
  return trace.has_value();
}

SourceStats ComponentTraces::stats() const {
  SourceStats stats;
  stats.strategy = "components";
  stats.states = counter_.components();
  return stats;
}

}  // namespace parallax::runtime
