#include "harness/campaign/start_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/hash.h"
#include "harness/region/state_mapping.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

namespace {

std::vector<std::string> quoted_names(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t at = text.find('`'); at != std::string::npos;) {
    const auto end = text.find('`', at + 1);
    if (end == std::string::npos) break;
    names.push_back(text.substr(at + 1, end - at - 1));
    at = text.find('`', end + 1);
  }
  return names;
}

/// The name of a body in regions: all parts of the robot are `robot`.
std::string name_in_mapping(const WorldSpec& world, const std::string& body) {
  const auto base = base_body(world);
  if (base.empty() || body == base) return body == base ? "robot" : body;
  const auto layout = lay_out(world);
  const auto id = layout.find_body(body), base_id = layout.find_body(base);
  const bool part = id && base_id && layout.link_of[id->index()] &&
                    layout.assembly_of[id->index()] == layout.assembly_of[base_id->index()];
  return part ? "robot" : body;
}

/// The region that the start of the trace puts the body into.
const Region* region_of(const Scenario& scenario, const CampaignTrace& trace,
                        const std::string& body) {
  for (const auto text : trace.holds(0)) {
    const auto fluent = ground_fluent(text);
    const auto* binding = scenario.mapping->find(fluent.symbol);
    if (binding == nullptr) continue;
    const auto* inside = binding->inside();
    if (inside == nullptr || !inside->drawn) continue;
    if (with_arguments(inside->body, fluent) != body) continue;
    const auto* region = inside->region_of(fluent, scenario.mapping->regions());
    if (region != nullptr) return region;
  }
  return nullptr;
}

struct Place {
  base::SourceRange source;
  std::string note;
  bool is_region = false;
};

std::optional<Place> place_of(const Scenario& scenario, const CampaignTrace& trace,
                              const std::string& body) {
  if (const auto* region = region_of(scenario, trace, name_in_mapping(scenario.world, body))) {
    return Place{region->source, fmt::format("`{}` is put into `{}`", body, region->name), true};
  }
  const auto at = scenario.body_sources.find(body);
  if (at == scenario.body_sources.end()) return std::nullopt;
  return Place{at->second, fmt::format("`{}` stands here", body)};
}

}  // namespace

base::DiagnosticBuilder report_rejected(const Scenario& scenario, const CampaignTrace& trace,
                                        std::int64_t rejected, std::int64_t sample,
                                        const std::string& reason, base::DiagnosticSink& sink) {
  std::vector<Place> places;
  for (const auto& name : quoted_names(reason)) {
    if (auto place = place_of(scenario, trace, name)) places.push_back(*std::move(place));
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.is_region && !b.is_region; });
  auto error = sink.error(codes::kStartsRejected,
                          places.empty() ? scenario.sampling_source : places.front().source,
                          rejected, sample, trace.number, reason);
  for (const auto& place : places) error.note(place.source, place.note);
  if (!scenario.simulator.models.empty()) {
    error.note(
        "the world is a model: what it says of timepoint 0 has to admit the starts of the "
        "scenario's "
        "model");
  }
  return error;
}

base::DiagnosticBuilder report_other_start(const Scenario& scenario, const SampleRecord& record,
                                           const DivergingFluent& fluent,
                                           base::DiagnosticSink& sink) {
  if (!scenario.simulator.is_built_in()) {
    return sink.error(
        codes::kStartNotTaken, scenario.simulator.source, record.sample, record.trace,
        fmt::format("`{}` {}", fluent.fluent, fluent.observed ? "holds" : "does not hold"));
  }
  return sink.error(codes::kMappingNotInverse, scenario.mapping_source, record.sample, record.trace,
                    fluent.observed ? "a state with" : "a state without", fluent.fluent);
}

void check_first_start(const Scenario& scenario, const CampaignTrace& trace,
                       const PreparedTrace& prepared, const ModelFluents& fluents,
                       std::uint64_t seed, Simulator& simulator,
                       const std::function<bool()>& abandoned, base::DiagnosticSink& sink) {
  auto start = std::make_shared<CampaignTrace>(trace);
  start->points.resize(1);
  start->plan.clear();
  const TracePlan plan{start,
                       {},
                       prepared.sampler,
                       seed,
                       base::fnv1a64(trace.key),
                       scenario.limits.max_rejected_starts,
                       false};
  const auto record = run_sample(plan, 1, simulator, abandoned);
  if (!record) return;
  if (record->status == SampleStatus::kRejected) {
    report_rejected(scenario, trace, record->rejected, record->sample, record->reason, sink);
  }
  if (record->status == SampleStatus::kRefused && record->observations.empty()) {
    sink.error(codes::kSimulatorRefused, scenario.sampling_source,
               fmt::format("refused the start in simulation {}.{}", trace.number, record->sample),
               record->reason);
  }
  if (record->status != SampleStatus::kOk) return;
  const auto judgement = judge(*scenario.mapping, fluents, *start, record->observations);
  if (!judgement.missing.empty() || judgement.first_divergence != 0) return;
  report_other_start(scenario, *record, judgement.first.front(), sink);
}

}  // namespace parallax::harness
