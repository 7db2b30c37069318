#include "tools/app/evidence.h"

#include <algorithm>
#include <set>
#include <utility>

#include "tools/app/bearing.h"
#include "tools/app/kept_borders.h"

namespace parallax::tools {
namespace {

/// A number, also of a flag; none of a text.
std::optional<double> number_of(const harness::Value& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1.0 : 0.0;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

/// The start parameters that are numbers in every run, and not always the same.
std::vector<std::string> varying_parameters(const std::vector<const harness::State*>& starts) {
  std::vector<std::string> out;
  if (starts.empty()) return out;
  for (const auto& parameter : *starts.front()) {
    const std::string& name = parameter.first;  // clang 14 does not capture a structured binding
    std::set<double> seen;
    const bool is_number = std::all_of(starts.begin(), starts.end(), [&](const auto* start) {
      const auto found = start->find(name);
      const auto number = found == start->end() ? std::nullopt : number_of(found->second);
      if (number) seen.insert(*number);
      return number.has_value();
    });
    if (is_number && seen.size() > 1) out.push_back(name);
  }
  return out;
}

}  // namespace

CauseEvidence cause_of(const std::vector<const harness::State*>& starts,
                       const std::vector<bool>& failed, bool world_is_model,
                       const std::vector<harness::CauseBorder>& borders) {
  CauseEvidence out;
  out.parameters = varying_parameters(starts);
  std::vector<harness::CauseRun> runs;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    auto& run = runs.emplace_back();
    run.failed = failed[i];
    for (const auto& name : out.parameters) {
      run.start.push_back(*number_of(starts[i]->find(name)->second));
    }
  }
  out.finding = harness::tell_cause(runs, world_is_model);
  harness::weigh_borders(borders, runs, out.parameters, out.finding);
  return out;
}

base::Result<harness::Persistence> count_failures(const RecordedDiscrepancy& found,
                                                  const std::vector<harness::SampleRecord>& records,
                                                  Context& context) {
  BearingReader reader(found, context);
  harness::Persistence out;
  for (const auto& record : records) {
    const auto how = reader.bearing(record);
    if (!how) return context.sink().already_reported();
    if (*how == Bearing::kOther) continue;
    ++out.runs;
    out.failures += *how == Bearing::kSame ? 1 : 0;
  }
  return out;
}

base::Result<CauseEvidence> gather_evidence(const std::string& run_dir,
                                            const RecordedDiscrepancy& found,
                                            const FurtherRecords& further, Context& context) {
  const harness::SampleId id = found.path.id;
  const harness::SampleKey known(id.trace, id.sample, harness::DrawPhase::kCertify);
  auto journal = without_samples(found.journal);
  const auto add = [&](const harness::SampleKey& key, const harness::SampleRecord& record) {
    if (record.trace != id.trace) return false;
    journal.places[key] = found.journal.places.at(known);
    return journal.samples.emplace(key, record).second;
  };
  for (const auto& [key, record] : found.journal.samples) {
    if (add(key, record)) journal.places[key] = found.journal.places.at(key);
  }
  CauseEvidence out;
  for (const auto& [start, line] : further.starts) {
    if (journal.starts.emplace(start, line).second) {
      journal.start_places[start] = found.journal.trace_places.at(start.first);
    }
  }
  for (const auto& record : further.samples) {
    if (add({record.trace, record.sample, record.phase}, record)) ++out.further;
  }
  const auto paths = observed_paths(found.loaded, journal, context);
  if (!paths) return context.sink().already_reported();
  BearingReader reader(found, context);
  const auto& fluents = found.loaded.compilation.model.fluents;
  std::vector<const harness::State*> bearing;
  std::vector<bool> failed;
  std::vector<harness::StateRun> states;
  for (const auto& path : *paths) {
    const auto how = reader.bearing(path);
    if (how == Bearing::kOther) {
      ++out.otherwise;
      continue;
    }
    bearing.push_back(&path.start);
    failed.push_back(how == Bearing::kSame);
    auto& state = states.emplace_back();
    state.failed = failed.back();
    for (const auto& [fluent, holds] : path.states.front()) {
      if (holds) state.holds.insert(fluents[fluent.index()].name);
    }
  }
  if (context.stopped()) {
    out.not_made = "stopped before those on record were looked at";
    return out;
  }
  auto told = cause_of(bearing, failed, found.loaded.world != nullptr,
                       kept_borders(run_dir, id, found.path.start));
  out.parameters = std::move(told.parameters);
  out.finding = std::move(told.finding);
  harness::weigh_states(states, out.finding);
  return out;
}

}  // namespace parallax::tools
