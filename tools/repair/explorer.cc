// Random sequences of a plan's events, simulated from random initial states of the model.
//
// Every second sequence repeats the beginning of a run that is known, of random length, so that
// states far from the start are reached too; a few random events follow. Events are those that
// the plan performs, with its arguments, and all other instances of their symbols (or of all
// symbols) that can be called without arguments of a plan. Draws come from a counter-based
// generator keyed by the seed and the number of the sequence, so a sequence does not depend on
// those before it. A sequence that cannot be simulated is skipped with a remark.
//
// Cost: one simulation for each sequence; events are limited.

#include "tools/repair/explorer.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/base/hash.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/trial.h"
#include "tools/app/closed_loop.h"
#include "tools/app/own_identity.h"
#include "tools/app/version.h"

namespace parallax::tools {

using harness::CampaignTrace;

namespace {

constexpr std::uint64_t kRandomEvents = 6;  // limit on random events in a row
constexpr std::size_t kMostEvents = 2000;   // to choose from

/// Traces are made here, so nobody asks for the next one.
class NoTraces final : public harness::TraceFeed {
 public:
  explicit NoTraces(runtime::Symbols symbols) : symbols_(std::move(symbols)) {}
  base::Result<std::optional<CampaignTrace>> next() override {
    return std::optional<CampaignTrace>();
  }
  std::string exploration() const override { return "stopped"; }
  runtime::Symbols symbols() const override { return symbols_; }

 private:
  runtime::Symbols symbols_;
};

class SequenceExplorer {
 public:
  SequenceExplorer(const ScenarioModel& loaded, const std::vector<Evidence>& known,
                   const harness::SimulatorFactory& make_simulator, const ExploreOptions& options,
                   Context& context)
      : loaded_(loaded),
        known_(known),
        make_simulator_(make_simulator),
        options_(options),
        context_(context) {}

  /// Finds what sequences are made of; false: nothing begins anywhere, as it was stopped.
  base::Result<bool> prepare() {
    auto& sink = context_.sink();
    auto loop = ClosedLoop::make(loaded_, context_);
    if (!loop) return sink.already_reported();
    symbols_ = (*loop)->symbols();
    if (!find_starts(**loop)) return sink.already_reported();
    if (starts_.empty()) return false;
    find_events((*loop)->plan());
    return true;
  }

  std::vector<std::string> event_names() const {
    std::vector<std::string> out;
    for (const auto& event : events_) out.push_back(event.event);
    return out;
  }

  base::Result<Explored> run() {
    auto& sink = context_.sink();
    const auto prepared = prepare();
    if (!prepared) return sink.already_reported();
    if (!*prepared) return std::move(out_);
    if (events_.empty()) {
      out_.skipped.emplace_back("no event of the plan can be asked for by itself");
      return std::move(out_);
    }
    NoTraces feed(symbols_);
    std::unique_ptr<harness::Journal> journal;
    harness::TrialBench bench(
        loaded_.scenario, feed, make_simulator_, {options_.seed, options_.jobs, &context_.stop()},
        [&](const harness::SampleRecord& record) { journal->append(record); }, sink);
    const auto started = bench.start();
    if (!started) return sink.already_reported();
    if (!*started) return std::move(out_);
    if (!open(bench, journal)) return sink.already_reported();
    for (std::int64_t i = 0; i < options_.count && !context_.stopped(); ++i) {
      simulate(options_.first + i, bench, *journal);
      if (options_.progress) options_.progress({options_.first + i, i + 1, options_.count, 0.0});
    }
    bench.close();
    out_.made = bench.runs_made();
    if (!journal->rewrite(lines_, std::move(records_), sink)) return sink.already_reported();
    return std::move(out_);
  }

 private:
  base::Status open(const harness::TrialBench& bench, std::unique_ptr<harness::Journal>& journal) {
    auto& sink = context_.sink();
    harness::CampaignOptions header;
    header.seed = options_.seed;
    header.scenario_hash = loaded_.sources_hash;
    header.tool_version = options_.tool_version;
    record_identity(loaded_.scenario, header);
    header.keep_going = true;
    header.random_sequences = true;
    std::error_code error;
    header.start_folder = std::filesystem::current_path(error).string();
    auto folder = harness::RunFolder::claim(options_.run_dir, false, sink);
    if (!folder) return sink.already_reported();
    auto opened = harness::Journal::open(
        *std::move(folder), journal_header(loaded_.scenario, header, bench.simulator()), {},
        loaded_.scenario.limits.max_lost_in_a_row, context_.files(), sink);
    if (!opened) return sink.already_reported();
    journal = *std::move(opened);
    return base::Unit{};
  }

  base::Status find_starts(ClosedLoop& loop) {
    const harness::ModelFluents fluents(*symbols_);
    std::vector<compiler::FluentId> compared;
    for (std::size_t i = 0; i < fluents.ground().size(); ++i) {
      const auto* binding = loaded_.scenario.mapping->find(fluents.ground()[i].symbol);
      if (binding != nullptr && !binding->is_ignored()) compared.push_back(fluents.id(i));
    }
    for (const auto& start : options_.starts) {
      auto& holds = starts_.emplace_back();
      for (const auto fluent : compared) {
        const auto found = start.find(symbols_->name(fluent));
        if (found != start.end() && found->second) holds.push_back(fluent);
      }
    }
    if (!starts_.empty()) return base::Unit{};
    auto states = loop.initial_states(compared);
    if (!states) return context_.sink().already_reported();
    if (*states) starts_ = std::move((*states)->holds);
    return base::Unit{};
  }

  CampaignTrace empty_trace(std::int64_t number, std::size_t events) const {
    CampaignTrace trace;
    trace.number = number;
    trace.symbols = symbols_;
    trace.points.resize(events + 1);
    return trace;
  }

  /// Can the event be performed with the plan's arguments, or without any?
  bool can_be_called(const harness::PlannedPerform& perform) const {
    const auto event = symbols_->event(perform.event);
    if (!event) return false;
    auto one = empty_trace(1, 1);
    one.points.front().happens = {*event};
    one.plan = {{perform.source, perform.arguments}};
    base::DiagnosticSink unread;
    return action_calls(loaded_.scenario, one, unread).has_value();
  }

  void find_events(const harness::ExecutablePlan& plan) {
    std::set<std::string> names, symbols;
    for (auto& perform : plan.performs()) {
      symbols.insert(base::symbol_of(perform.event));
      if (names.insert(perform.event).second && can_be_called(perform)) {
        events_.push_back(std::move(perform));
      }
    }
    bool others = false, drawn = false;
    for (std::uint32_t i = 0; i < symbols_->event_count(); ++i) {
      if (events_.size() > kMostEvents) break;
      harness::PlannedPerform other;
      other.event = symbols_->name(compiler::EventId(i));
      const bool of_plan = symbols.contains(base::symbol_of(other.event));
      others = others || !of_plan;
      if (!of_plan && !options_.all_events) continue;
      if (names.insert(other.event).second && can_be_called(other)) {
        drawn = drawn || !of_plan;
        events_.push_back(std::move(other));
      }
    }
    out_.of_plan = others && !drawn;
  }

  std::uint64_t draw(const harness::CounterRng& random, std::uint64_t place,
                     std::uint64_t count) const {
    const auto drawn =
        static_cast<std::uint64_t>(random.uniform(place) * static_cast<double>(count));
    return std::min(drawn, count - 1);
  }

  /// A sequence of events: perhaps the beginning of an earlier run, then at random.
  std::vector<const harness::PlannedPerform*> sequence(const harness::CounterRng& random,
                                                       std::int64_t number) const {
    std::vector<const harness::PlannedPerform*> out;
    std::uint64_t place = 1;
    if (number % 2 == 0 && !known_.empty()) {
      const auto& run = known_[draw(random, place++, known_.size())];
      const auto length = draw(random, place++, run.steps.size() + 1);
      std::vector<std::string> names;
      for (std::size_t i = 0; i < length; ++i) names.push_back(run.steps[i].event);
      out = performs_of(names);
    }
    const auto more = 1 + draw(random, place++, kRandomEvents);
    for (std::uint64_t i = 0; i < more; ++i) {
      out.push_back(&events_[draw(random, place++, events_.size())]);
    }
    return out;
  }

  /// The start that looks like this, or the first one.
  const std::vector<compiler::FluentId>& start_like(const Evidence::State& state) const {
    const auto looks_like = [&](const std::vector<compiler::FluentId>& start) {
      std::set<std::string> holds;
      for (const auto fluent : start) holds.insert(symbols_->name(fluent));
      return std::all_of(state.begin(), state.end(), [&](const auto& each) {
        return holds.contains(each.first) == each.second;
      });
    };
    const auto found = std::find_if(starts_.begin(), starts_.end(), looks_like);
    return found == starts_.end() ? starts_.front() : *found;
  }

  std::vector<const harness::PlannedPerform*> performs_of(
      const std::vector<std::string>& names) const {
    std::vector<const harness::PlannedPerform*> out;
    for (const auto& name : names) {
      const auto found = std::find_if(events_.begin(), events_.end(),
                                      [&](const auto& event) { return event.event == name; });
      if (found != events_.end()) out.push_back(&*found);
    }
    return out;
  }

  CampaignTrace trace(std::int64_t number) const {
    if (options_.given) {
      const auto given = options_.given(number);
      return trace_of(number, performs_of(given.events), start_like(given.start));
    }
    const harness::CounterRng random({options_.seed, base::fnv1a64("learn: sequence"),
                                      harness::DrawPhase::kCertify,
                                      static_cast<std::uint64_t>(number), 0});
    return trace_of(number, sequence(random, number), starts_[draw(random, 0, starts_.size())]);
  }

  CampaignTrace trace_of(std::int64_t number,
                         const std::vector<const harness::PlannedPerform*>& events,
                         const std::vector<compiler::FluentId>& start) const {
    auto out = empty_trace(number, events.size());
    out.key = fmt::format("sequence {};", number);
    for (std::size_t t = 0; t < out.points.size(); ++t) {
      out.points[t].holds = start;
      if (t == events.size()) break;
      out.points[t].happens = {*symbols_->event(events[t]->event)};
      out.plan.push_back({events[t]->source, events[t]->arguments});
    }
    return out;
  }

  void skip(std::int64_t number) {
    std::string why = "it was lost";
    for (const auto& diagnostic : context_.sink().sorted()) {
      if (base::info(diagnostic.code).severity == base::Severity::kError) why = diagnostic.message;
    }
    out_.skipped.push_back(fmt::format("sequence {}: {}", number, why));
  }

  void simulate(std::int64_t number, harness::TrialBench& bench, harness::Journal& journal) {
    // A sequence that cannot be simulated does not end the exploration.
    const auto before = context_.sink();
    auto trial = harness::Trial::prepare(bench, trace(number));
    if (trial) {
      const auto& plan = trial->plan();
      lines_.push_back({plan.trace, plan.calls});
      journal.append(lines_.back());
      auto sample = trial->next();
      trial->end();
      if (sample && *sample && (*sample)->verdict != harness::SampleVerdict::kLost &&
          (*sample)->verdict != harness::SampleVerdict::kLostTooOften) {
        take(*plan.trace, **sample);
        records_.push_back(std::move((*sample)->record));
        return;
      }
    }
    if (!context_.stopped()) skip(number);
    context_.sink() = before;
  }

  void take(const CampaignTrace& trace, const harness::TrialSample& sample) {
    Evidence seen;
    seen.ids = {fmt::format("{}.{}", trace.number, sample.record.sample)};
    const auto& states = sample.judgement.states;
    for (std::size_t t = 0; t < states.size() && !states[t].in_no_state; ++t) {
      auto& state = seen.states.emplace_back();
      for (const auto& [fluent, holds] : states[t].holds) {
        state.emplace(symbols_->name(fluent), holds);
      }
      if (t == 0) continue;
      const auto& outcome = sample.record.outcomes[t - 1];
      const bool failed = outcome.status != harness::SimStatus::kOk;
      seen.steps.push_back(
          {trace.event(t - 1), failed, failed ? harness::reason_word(outcome) : ""});
    }
    if (!seen.states.empty()) out_.runs.push_back(std::move(seen));
  }

  const ScenarioModel& loaded_;
  const std::vector<Evidence>& known_;
  const harness::SimulatorFactory& make_simulator_;
  const ExploreOptions& options_;
  Context& context_;
  runtime::Symbols symbols_;
  std::vector<std::vector<compiler::FluentId>> starts_;
  std::vector<harness::PlannedPerform> events_;
  std::vector<harness::TraceLine> lines_;
  std::vector<harness::SampleRecord> records_;
  Explored out_;
};

}  // namespace

base::Result<std::vector<std::string>> sequence_events(const ScenarioModel& loaded,
                                                       const ExploreOptions& options,
                                                       Context& context) {
  const std::vector<Evidence> none;
  const harness::SimulatorFactory unused;
  SequenceExplorer explorer(loaded, none, unused, options, context);
  const auto prepared = explorer.prepare();
  if (!prepared) return context.sink().already_reported();
  return explorer.event_names();
}

base::Result<Explored> explore(const ScenarioModel& loaded, const std::vector<Evidence>& known,
                               const harness::SimulatorFactory& make_simulator,
                               const ExploreOptions& options, Context& context) {
  return SequenceExplorer(loaded, known, make_simulator, options, context).run();
}

}  // namespace parallax::tools
