#include "tools/app/coverage_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/loop_judge.h"
#include "harness/campaign/loop_samples.h"
#include "tools/app/cover_items.h"

namespace parallax::tools {

using base::Known;
using harness::PathStep;
using harness::SampleRecord;

namespace {

compiler::TypedModel up_to(const compiler::TypedModel& model, std::int64_t last) {
  auto out = model;
  auto& upper = out.sorts[*out.core.time].ranges[0].upper;
  upper = std::min(upper, std::max<std::int64_t>(last, 1));
  return out;
}

/// A key of the execution: those with equal texts are the same for the model.
std::string text_of(const SampleRecord& record, const std::vector<harness::LoopState>& states) {
  std::string out;
  for (std::size_t i = 0; i < record.path->steps.size(); ++i) {
    const auto& step = record.path->steps[i];
    out += fmt::format("{}|{}|{}|{}|{};", step.step, step.event, step.object, step.condition,
                       step.succeeded ? "" : harness::reason_word(record.outcomes[i]));
  }
  for (const auto& seen : states) {
    out += seen.state.in_no_state ? "\n!" : "\n";
    for (const auto& [id, holds] : seen.state.holds) {
      out += fmt::format("{}{} ", holds ? "" : "-", id.index());
    }
    for (const auto id : seen.neither) out += fmt::format("?{} ", id.index());
    for (const auto& text : seen.outside) out += text + " ";
  }
  return out;
}

}  // namespace

base::Result<std::unique_ptr<LoopCoverage>> LoopCoverage::make(const ScenarioModel& loaded,
                                                               std::int64_t longest,
                                                               Context& context) {
  auto loop = ClosedLoop::make(loaded, context);
  if (!loop) return context.sink().already_reported();
  std::unique_ptr<LoopCoverage> out(new LoopCoverage(loaded, *std::move(loop), longest, context));
  if (const auto reason = out->evaluator_.refusal()) {
    return context.sink().error_about(codes::kCheckGivenUp, "", 1, *reason);
  }
  out->model_ = std::make_unique<ModelCoverage>(out->typed_, out->evaluator_, context.files());
  return out;
}

LoopCoverage::LoopCoverage(const ScenarioModel& loaded, std::unique_ptr<ClosedLoop> loop,
                           std::int64_t longest, Context& context)
    : loaded_(loaded),
      context_(context),
      loop_(std::move(loop)),
      fluents_(*loop_->symbols()),
      typed_(up_to(*loaded.compilation.typed, longest)),
      evaluator_(typed_, {.stop = &context.stop()}),
      plan_(*loaded.compilation.plan, *loaded.compilation.typed, context.files()) {}

base::Status LoopCoverage::add(const SampleRecord& record, std::uint64_t seed,
                               const RunTerms& terms, const base::SourceRange& place) {
  const auto foreign = [&](const std::string& why) {
    return context_.sink().error(codes::kForeignJournalLine, place, why);
  };
  const auto key = harness::LoopSamples::choices_key(seed, record.sample);
  const auto path = loop_->scenario_plan().retrace(key, record);
  if (!path) return foreign("the plan does not do this in what was observed");
  std::set<std::string> missing;
  const auto states =
      harness::path_states(*loaded_.scenario.mapping, fluents_, record, terms.comparison, missing);
  if (!missing.empty()) return foreign(fmt::format("it lacks `{}`", *missing.begin()));
  const auto text = text_of(record, states);
  const auto found = judged_.find(text);
  const auto& judged = found != judged_.end()
                           ? found->second
                           : judged_.emplace(text, judge(record, terms.comparison)).first->second;
  for (const auto& item : plan_.covered_by(*path)) ++hits_[item];
  for (const auto& item : judged.covered) ++hits_[item];
  // The bound is about drawn starts only; behaviours shown from chosen ones still count as shown.
  const bool drawn = harness::is_drawn(record);
  if (drawn) {
    for (const auto& one : judged.possible) ++possible_[one];
  }
  shown_.insert(judged.shown.begin(), judged.shown.end());
  if (judged.lacking) {
    const auto& lacking = *judged.lacking;
    auto name = fmt::format("{} {} {}", lacking.place, lacking.event, lacking.outcome);
    for (const auto& fluent : lacking.fluents) name += " " + fluent;
    ++lacking_.try_emplace(std::move(name), lacking).first->second.runs;
  }
  confidence_ = std::min(confidence_, terms.confidence);
  if (drawn) ++drawn_;
  return base::Unit{};
}

ModelBehaviour LoopCoverage::behaviour(const PathStep& step, std::string outcome) const {
  const auto& location =
      loaded_.compilation.plan->locations[loaded_.compilation.plan->locations.id_at(
          static_cast<std::size_t>(step.step))];
  const auto key =
      coverage_key(CoverageGroup::kPerforms, location.source, step.event, context_.files());
  return {key.file, key.line, key.column, step.event, std::move(outcome)};
}

LoopCoverage::Judged LoopCoverage::judge(const SampleRecord& record,
                                         harness::Comparison comparison) {
  Judged out;
  const auto& mapping = *loaded_.scenario.mapping;
  const std::span<const PathStep> performs = record.path->steps;
  std::set<std::string> missing;
  std::vector<Fluents> states;
  for (auto& seen : harness::path_states(mapping, fluents_, record, comparison, missing)) {
    states.push_back(std::move(seen.state.holds));
  }
  const auto judgement = harness::judge_path(mapping, fluents_, *loop_, record, comparison);
  const bool clean = judgement.admitted == Known::kYes;
  const auto& divergence = judgement.divergence;
  if (judgement.admitted == Known::kUndecided) return out;
  // The number of events that the model can follow; it follows none if it does not admit the start.
  const auto admitted = clean
                            ? performs.size()
                            : static_cast<std::size_t>(std::max<std::int64_t>(divergence.event, 0));
  const bool begins = clean || divergence.event >= 0;
  const std::span<const Fluents> followed(states.data(), admitted + 1);
  if (begins) {
    if (const auto trace = loop_->trace_of(performs.first(admitted), admitted, followed)) {
      out.covered = model_->covered_by(*trace);
    }
    note_outcomes(record, states, admitted, out);
  }
  for (const auto& step : performs) {
    if (auto event = model_->event(step.event)) out.covered.insert(*std::move(event));
  }
  if (clean) return out;
  auto& lacking = out.lacking.emplace();
  lacking.example = record.sample;
  for (const auto& fluent : judgement.fluents) {
    lacking.fluents.push_back((fluent.observed ? "" : "not ") + fluent.fluent);
  }
  if (!begins) {
    lacking.event = "start";
    return out;
  }
  const auto& step = performs[admitted];
  lacking.event = step.object.empty() ? step.event : step.event + "=" + step.object;
  lacking.place = step.source;
  lacking.outcome = step.succeeded ? "succeeds" : "fails with " + step.condition;
  lacking.what = divergence.impossible ? "event" : divergence.outcome ? "outcome" : "state";
  return out;
}

/// How the performs ended, and how else they could have.
void LoopCoverage::note_outcomes(const SampleRecord& record, const std::vector<Fluents>& states,
                                 std::size_t admitted, Judged& out) {
  const auto& graph = *loaded_.compilation.plan;
  const auto& steps = record.path->steps;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const auto& step = steps[k];
    const auto& location =
        graph.locations[graph.locations.id_at(static_cast<std::size_t>(step.step))];
    out.shown.insert(behaviour(step, outcome_of(step, location)));
    if (k > admitted) continue;
    for (const bool success : {true, false}) {
      auto path = std::vector<PathStep>(steps.begin(), steps.begin() + static_cast<long>(k) + 1);
      path.back().succeeded = success;
      path.back().object.clear();
      const auto answer = loop_->admits(path, k + 1, std::span(states.data(), k + 1));
      if (answer != Known::kYes) continue;
      if (success || location.failures.empty()) {
        out.possible.insert(behaviour(step, success ? "succeeds" : "fails"));
        continue;
      }
      for (const auto& way : location.failures) {
        out.possible.insert(behaviour(step, "fails with " + way.failure_class));
      }
    }
  }
}

void LoopCoverage::write(Coverage& coverage) const {
  for (const auto& [key, text] : model_->all()) coverage.items[key].text = text;
  for (const auto& key : plan_.all()) coverage.items[key];
  for (const auto& [key, hits] : hits_) coverage.items[key].hits += hits;
  for (const auto& [one, runs] : possible_) {
    if (shown_.contains(one)) continue;
    const auto bound = 1.0 - std::pow(1.0 - confidence_, 1.0 / static_cast<double>(runs));
    coverage.never_shown.push_back({loaded_.scenario.name, one, runs, drawn_, confidence_, bound});
  }
  for (const auto& [name, one] : lacking_) {
    coverage.lacking.push_back(one);
    coverage.lacking.back().scenario = loaded_.scenario.name;
  }
}

}  // namespace parallax::tools
