#include "runtime/graph/orbit_traces.h"

#include "runtime/enumerate/canonical.h"
#include "runtime/symmetry/lex_leader.h"

namespace parallax::runtime {

OrbitTraces::OrbitTraces(const CompiledModel& model, const TraceQuery& query) : symmetry_(model) {
  // The clauses leave more than one trace of some orbits, and symmetry is broken already.
  auto whole = query;
  whole.breaks_symmetry = false;
  if (constants().empty()) {
    traces_ = std::make_unique<ModelTraces>(model, whole);
  } else {
    const auto order = whole_order(model, projection_blocks(model, query.distinct));
    broken_ = broken_model(model, symmetry_.generators(), order);
    traces_ = std::make_unique<ModelTraces>(broken_, whole);
  }
  orbits_.emplace(model, symmetry_.group(),
                  query.distinct == Distinct::kAll ? Compared::kEverything : Compared::kObserved);
}

SourceStats OrbitTraces::stats() const {
  auto stats = traces_->stats();
  if (!constants().empty() && !stats.remark.empty()) {
    stats.remark = "comparing traces with exchanged ones ties all timepoints together";
  }
  return stats;
}

std::optional<Trace> OrbitTraces::next() {
  while (auto trace = traces_->next()) {
    if (constants().empty()) {
      size_ = 1;
      total_ = ++given_;
      return trace;
    }
    auto orbit = orbits_->of(*trace);
    if (!forms_.insert(std::move(orbit.form)).second) continue;
    size_ = std::move(orbit.size);
    total_ += size_;
    trace->number = ++given_;
    return trace;
  }
  return std::nullopt;
}

}  // namespace parallax::runtime
