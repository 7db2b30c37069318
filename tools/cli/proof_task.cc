#include "tools/cli/proof_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "harness/geometry_proof/affine_form.h"
#include "harness/geometry_proof/certificate.h"
#include "harness/robot/ode_simulator.h"

namespace parallax::tools {
namespace {

std::optional<double> whole_number_text(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// One `--assume NAME=VALUE` or `NAME=LOW:HIGH`; a text that says what is wrong with it.
std::string assume_one(const std::string& given, const harness::WorldLayout& layout,
                       harness::ProofAssumptions& out) {
  const auto equals = given.find('=');
  const std::string name = given.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : given.substr(equals + 1);
  for (const auto& field : harness::assumption_fields()) {
    if (name != field.name) continue;
    const auto number = whole_number_text(value);
    const auto why = harness::wrong_assumption(number.value_or(-1.0));
    if (!why.empty()) return fmt::format("`{}` {}", value, why);
    out.*field.value = *number;
    return "";
  }
  for (std::size_t i = 0; i < layout.sliders.size(); ++i) {
    if (name != layout.sliders[layout.sliders.id_at(i)].name + ".q") continue;
    const auto colon = value.find(':');
    const auto low = whole_number_text(value.substr(0, colon));
    const auto high = colon == std::string::npos ? low : whole_number_text(value.substr(colon + 1));
    if (!low || !high || *low > *high) return fmt::format("`{}` is no range LOW:HIGH", value);
    out.sliders.emplace_back(name, harness::Bounds1{*low, *high});
    return "";
  }
  return fmt::format(
      "nothing is called `{}`; there are drift, drift-rad, sliding, sliding-rad, goal, goal-rad, "
      "parked, held, "
      "held-rad, held-height, lean, and JOINT.q of a slider",
      name);
}

}  // namespace

ProofTrace::ProofTrace(const ScenarioModel& loaded, Invocation& invocation)
    : loaded_(loaded),
      invocation_(invocation),
      traces_(loaded, invocation),
      fluents_(*traces_.symbols()),
      simulator_(harness::OdeSimulator(loaded.scenario.world).info()) {}

std::unique_ptr<ProofTrace> ProofTrace::find(const ScenarioModel& loaded, std::int64_t number,
                                             Invocation& invocation) {
  const auto& scenario = loaded.scenario;
  auto& sink = invocation.sink();
  if (!scenario.simulator.is_built_in() || !scenario.world.mobile) {
    sink.error(codes::kNothingToProve, base::SourceRange{scenario.source, 0, 0},
               scenario.simulator.is_built_in()
                   ? "its world has no mobile robot"
                   : "what a simulator of its own does is not known as geometry");
    return nullptr;
  }
  if (!loaded.compilation.model.has_constraints) {
    sink.error(codes::kNothingToSimulate, base::SourceRange{scenario.source, 0, 0});
    return nullptr;
  }
  std::unique_ptr<ProofTrace> out(new ProofTrace(loaded, invocation));
  auto trace = out->trace_of(number);
  if (!trace) return nullptr;
  auto starts = harness::StartStates::make(
      {scenario, out->fluents_, out->simulator_, out->traces_, sink}, *std::move(trace));
  if (!starts) return nullptr;
  out->starts_.emplace(*std::move(starts));
  return out;
}

/// The trace of the number, or nothing, which was reported.
std::optional<harness::CampaignTrace> ProofTrace::trace_of(std::int64_t number) {
  std::int64_t last = 0;
  while (true) {
    auto trace = traces_.next();
    if (!trace) return std::nullopt;
    if (!*trace) break;
    last = (*trace)->number;
    if (last == number) return std::move(**trace);
  }
  if (!invocation_.stopped()) {
    invocation_.sink().error_about(codes::kNoSuchTrace, loaded_.scenario.file.string(), number,
                                   last == 0   ? "the scenario has none"
                                   : last == 1 ? "the scenario has only one"
                                               : fmt::format("the scenario has {}", last));
  }
  return std::nullopt;
}

std::optional<std::vector<std::int64_t>> ProofTrace::states() {
  if (is_single()) return std::vector<std::int64_t>{0};
  std::vector<std::int64_t> out;
  if (const auto count = starts_->count()) {
    const auto most = std::min(*count, static_cast<std::int64_t>(kMostStates));
    for (std::int64_t state = 1; state <= most; ++state) out.push_back(state);
    return out;
  }
  for (std::size_t sample = 1; sample <= kMostStates; ++sample) {
    const auto state = starts_->state_of(static_cast<std::int64_t>(sample), true);
    if (!state) return std::nullopt;
    if (!*state) {
      // Stopped; or hardly a candidate leads to these events: then those that were found are
      // proved.
      if (!starts_->ran_out(static_cast<std::int64_t>(sample))) return std::nullopt;
      break;
    }
    if (std::find(out.begin(), out.end(), **state) == out.end()) out.push_back(**state);
  }
  return out;
}

harness::StartResult ProofTrace::about() const {
  harness::StartResult out;
  starts_->describe(out, static_cast<std::int64_t>(kMostStates));
  return out;
}

std::optional<ProofTask> ProofTrace::task(std::int64_t state,
                                          const std::vector<std::string>& assume) {
  const auto& scenario = loaded_.scenario;
  auto& sink = invocation_.sink();
  const auto prepared = starts_->prepared(state);
  if (!prepared || !*prepared) return std::nullopt;
  const auto& plan = (*prepared)->plan;
  if (plan->sampler.law() != nullptr) {
    sink.error(codes::kNothingToProve, scenario.sampling_source,
               "starts are drawn by a law, and proofs are about uniform ones");
    return std::nullopt;
  }
  ProofTask task{plan, is_single() ? "" : text(state), harness::lay_out(scenario.world), {}, {},
                 {}};
  for (const auto& one : assume) {
    const auto fault = assume_one(one, task.layout, task.assumptions);
    if (fault.empty()) continue;
    sink.error_about(codes::kUsage, "--assume " + one, fault);
    return std::nullopt;
  }
  if (const auto fault = harness::wrong_assumptions(task.assumptions, task.layout);
      !fault.empty()) {
    sink.error_about(codes::kUsage, "--assume", fault);
    return std::nullopt;
  }
  for (std::size_t i = 0; i < plan->calls.size(); ++i) {
    const auto& call = plan->calls[i];
    task.calls.push_back({plan->trace->event(i), call.controller, call.arguments});
  }
  harness::StartBox whole;
  const auto variables = harness::drawn_variables(task.start(), whole);
  if (variables.size() >= harness::AffineForm::kMostVariables) {
    sink.error(codes::kNothingToProve, scenario.sampling_source,
               fmt::format("{} variables are drawn, and a proof takes at most {}", variables.size(),
                           harness::AffineForm::kMostVariables - 1));
    return std::nullopt;
  }
  return task;
}

}  // namespace parallax::tools
