#include "tools/app/bearing.h"

namespace parallax::tools {

harness::JournalText without_samples(const harness::JournalText& journal) {
  harness::JournalText out;
  out.header = journal.header;
  out.traces = journal.traces;
  out.starts = journal.starts;
  out.start_places = journal.start_places;
  out.trace_places = journal.trace_places;
  return out;
}

BearingReader::BearingReader(const RecordedDiscrepancy& found, Context& context)
    : found_(found),
      context_(context),
      journal_(without_samples(found.journal)),
      facts_(found.loaded.compilation.model),
      session_(found.loaded.compilation.model, runtime::make_cadical_solver(&context.stop())) {}

Bearing BearingReader::bearing(const ObservedPath& path) {
  const auto after = found_.parting->after;
  if (path.steps.size() < after || !goes_the_same_way(path, after)) return Bearing::kOther;
  const auto here = parting_of(path, facts_, session_);
  if (here.undecided) return Bearing::kOther;
  if (!here.after || *here.after > after) return Bearing::kClean;
  if (*here.after < after) return Bearing::kOther;
  const auto& differences = found_.parting->differences;
  if (differences.empty() || differences.front().neither) return Bearing::kSame;
  const auto& first = differences.front();
  const auto seen = path.states[after].find(first.fluent);
  const bool same = seen != path.states[after].end() && seen->second == first.observed;
  return same ? Bearing::kSame : Bearing::kOther;
}

base::Result<Bearing> BearingReader::bearing(const harness::SampleRecord& record) {
  const auto& id = found_.path.id;
  const harness::SampleKey key(record.trace, record.sample, record.phase);
  journal_.places[key] =
      found_.journal.places.at({id.trace, id.sample, harness::DrawPhase::kCertify});
  journal_.samples[key] = record;
  const auto path = observed_path(
      found_.loaded, harness::recorded_run(journal_, {record.trace, record.sample}), context_);
  journal_.samples.erase(key);
  if (!path) return context_.sink().already_reported();
  return bearing(*path);
}

bool BearingReader::goes_the_same_way(const ObservedPath& path, std::size_t after) const {
  for (std::size_t t = 0; t < after; ++t) {
    if (path.steps[t].event != found_.path.steps[t].event) return false;
  }
  return true;
}

}  // namespace parallax::tools
