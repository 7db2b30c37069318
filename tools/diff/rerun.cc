// Evidence for a gate: a scenario is run as it was and as it is.
//
// Each side is loaded from its own texts and every trace simulated a fixed number of times, as
// `parallax rates` does it. Both sides draw from one seed, so that run i of a trace begins alike on
// both, as far as the change leaves the starts alone. A clock ends what takes too long; then
// nothing is known, as counts that ended by chance of the machine are no evidence.

#include "tools/diff/rerun.h"

#include <fmt/format.h>

#include <chrono>

#include "compiler/base/clock_time.h"
#include "compiler/base/json.h"
#include "compiler/base/words.h"
#include "harness/campaign/rates.h"
#include "harness/campaign/row_statistics.h"
#include "harness/report/report.h"
#include "tools/app/rates_identity.h"
#include "tools/app/timed_stop.h"
#include "tools/app/trace_feed.h"
#include "tools/diff/rate_change.h"

namespace parallax::tools {
namespace {

using Clock = base::SteadyClock;
using OrderedJson = nlohmann::ordered_json;

/// The first error of a context, as the reason why a side cannot be run.
std::string first_error(const Context& context) {
  for (const auto& one : context.sink().sorted()) {
    if (base::info(one.code).severity == base::Severity::kError) return one.message;
  }
  return "it was stopped";
}

std::int64_t runs_made(const harness::RatesResult& result) {
  std::int64_t out = 0;
  for (const auto& trace : result.traces) out += trace.runs + trace.lost;
  return out;
}

OrderedJson counts_json(const harness::RateCounts& counts) {
  return {{"runs", counts.runs - counts.lost},
          {"lost", counts.lost},
          {"discrepancies", counts.failures}};
}

}  // namespace

void Rerunner::run(const RerunSide& before, const RerunSide& after, const Context& context,
                   RerunEvidence& out) {
  const auto old = side(before, "old", context, out);
  if (!old) return;
  const auto now = side(after, "new", context, out);
  if (!now) return;
  out.before = *old;
  out.after = *now;
  out.problem = not_comparable(out.before, out.after);
}

std::optional<RatesRevision> Rerunner::side(const RerunSide& side, const char* word,
                                            const Context& context, RerunEvidence& out) {
  const auto& rule = out.rule;
  const auto over = [&](std::int64_t made) -> std::optional<RatesRevision> {
    out.problem = fmt::format(
        "the budget of {} s was over with {} of the {} side made; give it more `seconds`",
        rule.seconds, base::counted(made, "run"), word);
    return std::nullopt;
  };
  if (spent_s_ >= rule.seconds) return over(0);
  const auto began = Clock::now();
  TimedStop stop(rule.seconds - spent_s_, context.stop());
  // Its messages are not those of the gate.
  Context own({.allow_outside = context.form().allow_outside}, stop.flag());
  const auto refuse = [&](const std::string& why) -> std::optional<RatesRevision> {
    if (stop.flag().load() && !context.stopped()) return over(0);
    out.problem = fmt::format("the {} side cannot be run: {}", word, why);
    return std::nullopt;
  };
  harness::ScenarioSettings settings;
  auto loaded = load_scenario_model(side.scenario, own, {.settings = &settings});
  if (!loaded) return refuse(first_error(own));
  auto& command = loaded->scenario.simulator.command;
  if (!command.empty() && side.is_kept) {
    return refuse("its texts name a command, which is started only as the scenario itself has it");
  }
  if (side.commands) command = command_of(command, *side.commands);
  if (!loaded->compilation.model.has_constraints) {
    return refuse("without `constraints` nothing is simulated");
  }
  const auto simulator = make_(*loaded, own, stop.flag());
  if (!simulator) return refuse(first_error(own));
  EnumeratedTraces traces(*loaded, own);
  std::vector<harness::SampleRow> rows;
  harness::RatesOptions options;
  options.seed = static_cast<std::uint64_t>(rule.seed);
  options.jobs = jobs_;
  options.runs = rule.runs;
  options.stop = &stop.flag();
  options.on_sample = [&rows](harness::SampleRow row) { rows.push_back(std::move(row)); };
  auto result = harness::estimate_rates(loaded->scenario, traces, *simulator, options, own.sink());
  spent_s_ += std::chrono::duration<double>(Clock::now() - began).count();
  if (context.stopped()) return refuse("it was stopped");
  if (!result) return refuse(first_error(own));
  if (!result->complete) {
    if (stop.flag().load()) return over(runs_made(*result));
    return refuse("its simulator was lost too often");
  }
  if (!result->is_answered()) {
    return refuse("its initial states cannot be drawn, so runs of the first say nothing of others");
  }
  harness::add_outcomes(rows, *result);
  add_identity(*loaded, settings, *result);
  auto rates = parse_rates(side.name, harness::rates_json(*result), own);
  if (!rates) return refuse(first_error(own));
  return *std::move(rates);
}

std::string rerun_json(const RerunEvidence& evidence) {
  OrderedJson out = {{"seed", evidence.rule.seed}, {"runs", evidence.rule.runs}};
  out["problem"] = evidence.problem.empty() ? OrderedJson(nullptr) : OrderedJson(evidence.problem);
  out["traces"] = OrderedJson::array();
  for (const auto& trace : evidence.before.traces) {
    const auto* now = rates_for(evidence.after, trace.events);
    if (now == nullptr) continue;
    const auto change = change_of(evidence.before, evidence.after, trace, *now);
    OrderedJson json = {{"trace", trace.events},
                        {"old", counts_json(change.before)},
                        {"new", counts_json(change.after)},
                        {"pairs", nullptr}};
    if (change.pairs) {
      using harness::RunResult;
      const auto parted = change.pairs->discordant(RunResult::kFailure, RunResult::kClean);
      json["pairs"] = {{"equal_starts", change.equal_starts},
                       {"gained", parted.gained},
                       {"mended", parted.mended}};
    }
    out["traces"].push_back(std::move(json));
  }
  return base::json_text(out);
}

}  // namespace parallax::tools
