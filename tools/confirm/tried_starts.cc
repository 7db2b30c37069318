#include "tools/confirm/tried_starts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/sample_maker.h"
#include "harness/campaign/start_states.h"
#include "tools/app/trace_feed.h"

namespace parallax::tools {
namespace {

using harness::SampleRecord;
using harness::SampleStatus;
using harness::StartPoint;
using harness::StartVerdict;
using harness::State;

/// One recorded simulation from other starts.
class OtherStarts final : public harness::SampleMaker {
 public:
  OtherStarts(SampleRecord like, std::vector<harness::ActionCall> calls, bool repeats_losses,
              std::shared_ptr<const harness::LoopSamples> executions, std::int64_t first,
              std::vector<State> starts)
      : like_(std::move(like)),
        calls_(std::move(calls)),
        repeats_losses_(repeats_losses),
        executions_(std::move(executions)),
        first_(first),
        starts_(std::move(starts)) {}

  std::optional<SampleRecord> make(std::int64_t sample, harness::Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override {
    const auto& start = starts_[static_cast<std::size_t>(sample - first_)];
    if (executions_) return executions_->make_at(like_, sample, start, simulator, abandoned);
    auto record = like_;
    record.sample = sample;
    record.attempt = record.rejected = 0;
    record.searched = true;
    record.initial = start;
    auto made = harness::repeat_sample(calls_, repeats_losses_, record, simulator, abandoned);
    if (made) made->phase = harness::DrawPhase::kCertify;
    return made;
  }
  std::optional<SampleRecord> repeat(const SampleRecord& record, harness::Simulator& simulator,
                                     const std::function<bool()>& abandoned) const override {
    return harness::repeat_sample(calls_, repeats_losses_, record, simulator, abandoned);
  }

 private:
  SampleRecord like_;
  std::vector<harness::ActionCall> calls_;
  bool repeats_losses_;
  std::shared_ptr<const harness::LoopSamples> executions_;
  std::int64_t first_;
  std::vector<State> starts_;
};

std::string unit_of(const harness::SimulatorInfo& simulator, const std::string& name) {
  const auto& known = simulator.parameters;
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const auto& parameter) { return parameter.name == name; });
  return found == known.end() || found->unit == "1" ? std::string() : found->unit;
}

}  // namespace

TriedStarts::TriedStarts(const RecordedDiscrepancy& found, const ScenarioModel& as_run,
                         const TriedStartsOptions& options, Context& context)
    : found_(found),
      as_run_(as_run),
      options_(options),
      extra_{options.jobs, options.runs, options.progress},
      context_(context),
      like_(found.journal.samples.at(
          {found.path.id.trace, found.path.id.sample, harness::DrawPhase::kCertify})),
      reader_(found, context) {}

base::Result<std::unique_ptr<TriedStarts>> TriedStarts::open(
    const std::string& run_dir, const RecordedDiscrepancy& found, const ScenarioModel& as_run,
    const harness::SimulatorFactory& make_simulator, const TriedStartsOptions& options,
    Context& context) {
  auto& sink = context.sink();
  std::unique_ptr<TriedStarts> out(new TriedStarts(found, as_run, options, context));
  auto runs = ExtraRuns::open({run_dir, kFolder, *found.journal.header}, as_run, make_simulator,
                              out->extra_, context);
  if (!runs) return sink.already_reported();
  if (*runs == nullptr) return std::unique_ptr<TriedStarts>();
  out->runs_ = *std::move(runs);
  if (found.path.executed) {
    const auto prepared = out->prepare_executions();
    if (!prepared) return sink.already_reported();
    if (!*prepared) return std::unique_ptr<TriedStarts>();
  } else if (!out->prepare_trace()) {
    return sink.already_reported();
  }
  if (!out->take_record()) return sink.already_reported();
  return out;
}

base::Status TriedStarts::prepare_trace() {
  line_ = found_.journal.line_of(like_);
  if (!find_place()) return context_.sink().already_reported();
  const auto trace = runs_->in_symbols(*line_->trace);
  const auto prepared = runs_->prepare_start(trace);
  if (!prepared) return context_.sink().already_reported();
  auto start = trace;
  start.points.resize(1);
  start.points.front().happens.clear();
  start.plan.clear();
  start_ = std::make_shared<const harness::CampaignTrace>(std::move(start));
  add_parameters(prepared->sampler);
  return base::Unit{};
}

/// Tells the start's initial state, with the words that a run has for it.
base::Status TriedStarts::find_place() {
  if (like_.start_state == 0) return base::Unit{};
  place_ = {like_.start_state, std::nullopt,
            fmt::format("{}", fmt::join(line_->trace->holds(0), " "))};
  const auto& asked = found_.journal.header->asked;
  EnumeratedTraces feed(as_run_, context_,
                        {.all_hits = asked.all_hits, .split_initial = asked.split_initial});
  const auto& key = line_->trace->key;
  while (true) {
    auto trace = feed.next();
    if (!trace) return context_.sink().already_reported();
    if (!*trace) return base::Unit{};
    if ((*trace)->key != key) continue;
    auto states = harness::StartStates::make({as_run_.scenario, runs_->bench().fluents(),
                                              simulator(), feed, context_.sink(), runs_->seed()},
                                             **std::move(trace));
    if (!states) return context_.sink().already_reported();
    harness::StartResult about;
    states->describe(about, 0);
    place_.all = about.all;
    if (states->count() && states->has(place_.number)) place_.holds = states->text(place_.number);
    return base::Unit{};
  }
}

base::Result<bool> TriedStarts::prepare_executions() {
  auto& sink = context_.sink();
  auto loop = ClosedLoop::make(as_run_, context_);
  if (!loop) return sink.already_reported();
  loop_ = *std::move(loop);
  stream_ = std::make_unique<harness::LoopStream>(as_run_.scenario, *loop_, runs_->bench(),
                                                  runs_->seed(), sink);
  const auto prepared = stream_->prepare();
  if (!prepared || !*prepared) return prepared;
  const auto& start = stream_->start_of(like_);
  start_ = start.state;
  add_parameters(start.sampler);
  return true;
}

void TriedStarts::add_parameters(const harness::Sampler& sampler) {
  has_law_ = sampler.law() != nullptr;
  for (const auto& [name, interval] : sampler.cuboid().dimensions) {
    const auto value = like_.initial.find(name);
    const auto* number =
        value == like_.initial.end() ? nullptr : std::get_if<double>(&value->second);
    if (interval.lower == interval.upper || number == nullptr) {
      fixed_.push_back(name);
      continue;
    }
    // Starts are drawn from the interval without its upper end, which belongs to the neighbour.
    const double lower = interval.lower + sampler.inset(), upper = interval.upper - sampler.inset();
    parameters_.push_back(
        {{name, lower, std::nextafter(upper, lower)}, unit_of(simulator(), name), *number});
  }
}

/// Takes the recorded starts of the same trace with the seed of the simulation that failed.
base::Status TriedStarts::take_record() {
  const auto* recorded = line_ ? runs_->find_line(like_.trace, like_.start_state) : nullptr;
  if (recorded != nullptr && !same_but_for_places(*recorded, *line_)) {
    return context_.sink()
        .error_about(codes::kReplayImpossible, kFolder,
                     "the starts that were tried earlier are of another trace")
        .help("Remove that folder of the run, and they are simulated anew.");
  }
  for (const auto& [key, record] : runs_->samples()) {
    next_ = std::max(next_, record.sample + 1);
    const bool same = record.trace == like_.trace && record.start_state == like_.start_state &&
                      record.seed == like_.seed && record.searched;
    if (same && record.path.has_value() == like_.path.has_value()) {
      numbers_.emplace(record.initial, record.sample);
    }
  }
  return base::Unit{};
}

StartPoint TriedStarts::failing() const {
  StartPoint out;
  for (const auto& parameter : parameters_) out.push_back(parameter.failing);
  return out;
}

State TriedStarts::state_of(const StartPoint& point) const {
  auto state = like_.initial;
  for (std::size_t i = 0; i < parameters_.size(); ++i) state[parameters_[i].range.name] = point[i];
  return state;
}

const SampleRecord* TriedStarts::record(const StartPoint& start) const {
  const auto number = numbers_.find(state_of(start));
  if (number == numbers_.end()) return nullptr;
  const auto found =
      runs_->samples().find({like_.trace, number->second, harness::DrawPhase::kCertify});
  return found == runs_->samples().end() ? nullptr : &found->second;
}

std::vector<StartVerdict> TriedStarts::probe(const std::vector<StartPoint>& starts) {
  std::vector<StartVerdict> out;
  if (end_ != End::kNot) return out;
  std::vector<State> asked, fresh;
  auto left = options_.runs - this->asked();
  for (const auto& start : starts) {
    auto state = state_of(start);
    const bool known =
        verdicts_.contains(state) || std::find(asked.begin(), asked.end(), state) != asked.end();
    if (!known && left-- <= 0) {
      end_ = End::kBudget;
      break;
    }
    if (!numbers_.contains(state) && !known) fresh.push_back(state);
    asked.push_back(std::move(state));
  }
  if (!fresh.empty() && !simulate(fresh)) end_ = End::kFailed;
  for (const auto& state : asked) {
    if (const auto known = verdicts_.find(state); known != verdicts_.end()) {
      out.push_back(known->second);
      continue;
    }
    const auto number = numbers_.find(state);
    if (number == numbers_.end()) break;  // it ended before
    const auto verdict =
        verdict_of(runs_->samples().at({like_.trace, number->second, like_.phase}));
    if (!verdict) end_ = End::kFailed;
    if (!verdict || context_.stopped()) break;
    verdicts_.emplace(state, *verdict);
    out.push_back(*verdict);
  }
  if (context_.stopped() && end_ != End::kFailed) end_ = End::kStopped;
  return out;
}

base::Status TriedStarts::simulate(const std::vector<State>& starts) {
  const auto first = next_;
  const auto last = first + std::ssize(starts) - 1;
  const auto maker = std::make_shared<const OtherStarts>(
      like_, line_ ? line_->calls : std::vector<harness::ActionCall>(),
      harness::may_repeat_losses(simulator()), stream_ == nullptr ? nullptr : stream_->samples(),
      first, starts);
  const bool other_state = line_ && line_->start_state > 1;
  const auto made = runs_->make({line_ ? &*line_ : nullptr, maker, start_, true,
                                 other_state ? &found_.journal.traces.at(like_.trace) : nullptr},
                                first, last);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto number = first + static_cast<std::int64_t>(i);
    if (runs_->samples().contains({like_.trace, number, like_.phase})) {
      numbers_[starts[i]] = number;
    }
  }
  next_ = last + 1;
  if (!made) return context_.sink().already_reported();
  if (!*made) end_ = context_.stopped() ? End::kStopped : End::kLost;
  return base::Unit{};
}

base::Result<StartVerdict> TriedStarts::verdict_of(const SampleRecord& record) {
  if (record.status != SampleStatus::kOk) return StartVerdict::kNoStart;
  const auto& bench = runs_->bench();
  const auto first = harness::judge(*as_run_.scenario.mapping, bench.fluents(), *start_,
                                    {record.observations.front()});
  if (first.first_divergence) return StartVerdict::kNoStart;  // it begins in another cell
  const auto bearing = reader_.bearing(record);
  if (!bearing) return context_.sink().already_reported();
  if (*bearing == Bearing::kSame) return StartVerdict::kFails;
  return *bearing == Bearing::kClean ? StartVerdict::kClean : StartVerdict::kOtherwise;
}

base::Status TriedStarts::close() { return runs_->close(); }

}  // namespace parallax::tools
