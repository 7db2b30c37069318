#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "harness/campaign/judge.h"
#include "tools/page/gather.h"

namespace parallax::tools {
namespace {

using harness::SampleRecord;
using harness::State;

constexpr std::size_t kMostTimelines = 40;
constexpr auto kNoNumber = std::numeric_limits<double>::quiet_NaN();

double number_in(const State& state, const std::string& name) {
  const auto found = state.find(name);
  if (found == state.end()) return kNoNumber;
  if (const auto* flag = std::get_if<bool>(&found->second)) return *flag ? 1.0 : 0.0;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*whole);
  }
  if (const auto* value = std::get_if<double>(&found->second)) return *value;
  return kNoNumber;
}

/// The variables of starts whose values differ, and the bodies that starts put somewhere.
void add_variables(const std::vector<const harness::JournalText*>& journals, PageData& page) {
  std::map<std::string, std::set<double>> seen;
  std::set<std::string> bodies;
  const auto look_at = [&](const State& start) {
    for (const auto& [name, value] : start) {
      if (std::holds_alternative<std::string>(value)) continue;
      auto& values = seen[name];
      if (values.size() < 2) values.insert(number_in(start, name));
      const bool is_place = name.ends_with(".x") || name.ends_with(".y");
      if (is_place) bodies.insert(name.substr(0, name.size() - 2));
    }
  };
  for (const auto* journal : journals) {
    for (const auto& [key, record] : journal->samples) look_at(record.initial);
  }
  for (const auto& [name, values] : seen) {
    if (values.size() > 1) page.variables.push_back(name);
  }
  page.bodies.assign(bodies.begin(), bodies.end());
}

/// The position of a body; an unobserved coordinate is that of the start, else 0.
BodyWay way_of(const SampleRecord& record, const std::string& body) {
  BodyWay way;
  const auto x = body + ".x", y = body + ".y";
  double at_x = number_in(record.initial, x), at_y = number_in(record.initial, y);
  if (std::isnan(at_x)) at_x = 0.0;
  if (std::isnan(at_y)) at_y = 0.0;
  for (const auto& observation : record.observations) {
    const double seen_x = number_in(observation, x), seen_y = number_in(observation, y);
    if (std::isfinite(seen_x)) at_x = seen_x;
    if (std::isfinite(seen_y)) at_y = seen_y;
    way.push_back({static_cast<float>(at_x), static_cast<float>(at_y)});
  }
  return way;
}

const harness::Discrepancy* discrepancy_in(const PageData& page, std::int64_t trace,
                                           std::int64_t sample) {
  for (const auto& one : page.discrepancies) {
    if (one.found.trace == trace && one.found.sample == sample) return &one.found;
  }
  return nullptr;
}

/// Does the report say that each simulation of the trace without a discrepancy was clean?
bool others_are_clean(const PageData& page, std::int64_t trace) {
  std::int64_t found = 0;
  for (const auto& one : page.discrepancies) found += one.found.trace == trace ? 1 : 0;
  return std::any_of(page.traces.begin(), page.traces.end(), [&](const PageTrace& one) {
    return one.number == trace && one.simulations > 0 &&
           one.clean + one.lost + found >= one.simulations;
  });
}

}  // namespace

PageSample page_sample(const SampleRecord& record, const PageData& page) {
  PageSample out;
  out.trace = record.trace;
  out.sample = record.sample;
  out.start_state = record.start_state;
  out.seed = record.seed;
  out.events = static_cast<std::int64_t>(record.outcomes.size());
  out.retries = record.retries;
  for (const auto& outcome : record.outcomes) out.sim_time_s += outcome.sim_time_s;
  for (const auto& variable : page.variables) {
    out.start.push_back(number_in(record.initial, variable));
  }
  for (const auto& body : page.bodies) out.ways.push_back(way_of(record, body));
  if (record.searched) out.origin = SampleOrigin::kSearch;
  if (record.visit) out.origin = SampleOrigin::kChosen;
  if (record.path) {
    if (!record.path->target.empty()) out.origin = SampleOrigin::kChosen;
    using harness::PathEnd;
    out.unfinished = record.path->end == PathEnd::kPerformLimit ||
                     record.path->end == PathEnd::kTimeLimit || record.path->end == PathEnd::kCut;
  }
  if (record.status == harness::SampleStatus::kLost) {
    out.verdict = PageVerdict::kLost;
    out.cause = "lost: " + record.reason;
  }
  return out;
}

namespace {

/// Makes timelines of predicted and observed fluents from the journal.
class TimelineMaker {
 public:
  TimelineMaker(const harness::JournalText& journal, const ScenarioModel* loaded,
                const PageData& page)
      : journal_(journal), loaded_(loaded), page_(page) {
    if (loaded_ == nullptr) return;
    symbols_.emplace(loaded_->compilation.model);
    fluents_.emplace(*symbols_);
  }

  PageTimeline make(const SampleRecord& record, PageVerdict verdict) const {
    PageTimeline out;
    out.trace = record.trace;
    out.sample = record.sample;
    out.verdict = verdict;
    add_steps(record, out);
    std::map<std::string, TimelineRow> rows;
    const auto count = out.steps.size() + 1;
    const auto row_of = [&](const std::string& fluent) -> TimelineRow& {
      auto& row = rows[fluent];
      if (row.fluent.empty()) row = {fluent, std::string(count, '-'), std::string(count, '-')};
      return row;
    };
    observe(record, count, row_of);
    predict(record, count, row_of);
    const auto* found = discrepancy_in(page_, record.trace, record.sample);
    if (found != nullptr) report(*found, count, row_of);
    finish(found, rows, out);
    return out;
  }

 private:
  void add_steps(const SampleRecord& record, PageTimeline& out) const {
    const auto outcome_of = [&](std::size_t i, PageStep& step) {
      if (i >= record.outcomes.size()) return;
      const auto& outcome = record.outcomes[i];
      step.outcome = to_string(outcome.status);
      step.reason = outcome.reason;
      step.sim_time_s = outcome.sim_time_s;
    };
    if (record.path) {
      for (std::size_t i = 0; i < record.path->steps.size(); ++i) {
        const auto& step = record.path->steps[i];
        const auto name = step.object.empty() ? step.event : step.event + " = " + step.object;
        out.steps.push_back({name, step.source, {}, {}, {}});
        outcome_of(i, out.steps.back());
        if (!step.succeeded) out.steps.back().outcome = "failed";
        if (out.steps.back().reason.empty()) out.steps.back().reason = step.condition;
      }
      return;
    }
    const auto* line = journal_.find_line_of(record);
    if (line == nullptr) return;
    const auto& trace = *line->trace;
    for (std::size_t i = 0; i < trace.event_count(); ++i) {
      out.steps.push_back({trace.event(i), trace.plan[i].source, {}, {}, {}});
      outcome_of(i, out.steps.back());
    }
  }

  template <typename RowOf>
  void observe(const SampleRecord& record, std::size_t count, const RowOf& row_of) const {
    if (loaded_ == nullptr) return;
    const auto last = std::min(count, record.observations.size());
    for (std::size_t t = 0; t < last; ++t) {
      std::set<std::string> missing;
      const auto moment = harness::moment_at(t, count - 1);
      const auto seen = harness::loop_state(*loaded_->scenario.mapping, *fluents_,
                                            record.observations[t], moment, &missing);
      for (const auto& [fluent, holds] : seen.state.holds) {
        row_of(symbols_->name(fluent)).observed[t] = holds ? '1' : '0';
      }
      for (const auto fluent : seen.neither) row_of(symbols_->name(fluent)).observed[t] = 'n';
      for (const auto& outside : seen.outside) row_of(outside).observed[t] = '1';
    }
  }

  template <typename RowOf>
  void predict(const SampleRecord& record, std::size_t count, const RowOf& row_of) const {
    const auto* line = journal_.find_line_of(record);
    if (record.path || line == nullptr) return;
    const auto& trace = *line->trace;
    std::set<std::string> names;
    if (fluents_) {
      for (const auto& fluent : fluents_->ground()) names.insert(fluent.text);
    }
    const auto known = std::min(count, trace.points.size());
    for (std::size_t t = 0; t < known; ++t) {
      for (const auto name : trace.holds(t)) names.insert(std::string(name));
    }
    for (const auto& name : names) row_of(name).predicted = std::string(count, '0');
    for (std::size_t t = 0; t < known; ++t) {
      for (const auto name : trace.holds(t)) row_of(std::string(name)).predicted[t] = '1';
    }
  }

  /// Adds the differences in report.json, also without the scenario. For an executed plan the model
  /// agrees with all observations up to the difference.
  template <typename RowOf>
  void report(const harness::Discrepancy& found, std::size_t count, const RowOf& row_of) const {
    for (const auto* differing : {&found.first, &found.fluents}) {
      for (const auto& entry : *differing) {
        if (entry.timepoint < 0 || static_cast<std::size_t>(entry.timepoint) >= count) continue;
        const auto t = static_cast<std::size_t>(entry.timepoint);
        auto& row = row_of(entry.fluent);
        row.predicted[t] = entry.predicted ? '1' : '0';
        if (row.observed[t] == '-') row.observed[t] = entry.observed ? '1' : '0';
      }
    }
  }

  void finish(const harness::Discrepancy* found, std::map<std::string, TimelineRow>& rows,
              PageTimeline& out) const {
    const auto differs = [](const TimelineRow& row, std::size_t t) {
      return row.predicted[t] != '-' && row.observed[t] != '-' &&
             row.predicted[t] != row.observed[t];
    };
    const auto count = out.steps.size() + 1;
    if (out.verdict == PageVerdict::kDiscrepancy) {
      for (std::size_t t = 0; t < count && !out.parting; ++t) {
        for (const auto& [name, row] : rows) {
          if (differs(row, t)) out.parting = t;
        }
      }
      if (found != nullptr && found->first_divergence >= 0 &&
          static_cast<std::size_t>(found->first_divergence) < count) {
        out.parting = static_cast<std::size_t>(found->first_divergence);
      }
    }
    for (auto& [name, row] : rows) {
      if (page_.closed_loop) {
        const auto known = out.parting ? std::min(*out.parting + 1, count) : count;
        for (std::size_t t = 0; t < known; ++t) {
          if (row.predicted[t] == '-') row.predicted[t] = row.observed[t];
        }
      }
      const auto moves = [](const std::string& values) {
        return values.find_first_not_of(values.front()) != std::string::npos;
      };
      bool parts = false;
      for (std::size_t t = 0; t < count; ++t) parts = parts || differs(row, t);
      const bool is_read = row.observed.find_first_not_of('-') != std::string::npos;
      row.changes = parts || (moves(row.predicted) && (is_read || loaded_ == nullptr)) ||
                    (is_read && moves(row.observed));
      const bool is_first = out.parting && (differs(row, *out.parting) || is_named(found, name));
      if (parts && out.verdict == PageVerdict::kDiscrepancy) {
        row.role = is_first ? TimelineRow::Role::kFirst : TimelineRow::Role::kFollows;
      }
      out.rows.push_back(std::move(row));
    }
    const auto rank = [](const TimelineRow& row) {
      if (row.role == TimelineRow::Role::kFirst) return 0;
      return row.role == TimelineRow::Role::kFollows ? 1 : row.changes ? 2 : 3;
    };
    std::stable_sort(out.rows.begin(), out.rows.end(),
                     [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  }

  static bool is_named(const harness::Discrepancy* found, const std::string& fluent) {
    return found != nullptr && std::any_of(found->first.begin(), found->first.end(),
                                           [&](const auto& one) { return one.fluent == fluent; });
  }

  const harness::JournalText& journal_;
  const ScenarioModel* loaded_;
  const PageData& page_;
  std::optional<compiler::SymbolTable> symbols_;
  std::optional<harness::ModelFluents> fluents_;
};

/// Traces of a run that has no report yet.
void add_traces(const harness::JournalText& journal, PageData& page) {
  if (!page.traces.empty()) return;
  for (const auto& [number, line] : journal.traces) {
    PageTrace trace;
    trace.number = number;
    for (std::size_t i = 0; i < line.trace->event_count(); ++i) {
      trace.steps.push_back({line.trace->event(i), line.trace->plan[i].source, {}, {}, {}});
    }
    page.traces.push_back(std::move(trace));
  }
  for (const auto& [key, record] : journal.samples) {
    if (std::get<2>(key) == harness::DrawPhase::kConfirm) continue;
    const auto of_it = std::find_if(page.traces.begin(), page.traces.end(),
                                    [&](const auto& one) { return one.number == record.trace; });
    if (of_it == page.traces.end()) {
      page.traces.emplace_back().number = record.trace;
      page.traces.back().simulations = 1;
    } else {
      ++of_it->simulations;
    }
    ++page.simulations;
  }
}

}  // namespace

void add_journal(const harness::JournalText& journal, const harness::JournalText* further,
                 PageData& page) {
  const bool has_report = !page.traces.empty();
  add_traces(journal, page);
  std::vector<const harness::JournalText*> journals = {&journal};
  if (further != nullptr) journals.push_back(further);
  add_variables(journals, page);
  std::map<std::int64_t, bool> clean_otherwise;
  for (const auto& trace : page.traces) {
    clean_otherwise[trace.number] = has_report && others_are_clean(page, trace.number);
  }
  for (const auto& [key, record] : journal.samples) {
    const auto [trace, sample, phase] = key;
    if (phase == harness::DrawPhase::kConfirm) continue;
    auto out = page_sample(record, page);
    const bool was_repeated =
        journal.samples.contains({trace, sample, harness::DrawPhase::kConfirm});
    const auto* found = discrepancy_in(page, trace, sample);
    if (found != nullptr || (!has_report && was_repeated)) {
      out.verdict = PageVerdict::kDiscrepancy;
      out.cause = found != nullptr ? found->cause.text : "";
    } else if (out.verdict != PageVerdict::kLost && clean_otherwise[trace]) {
      out.verdict = PageVerdict::kClean;
    }
    page.samples.push_back(std::move(out));
  }
}

void add_timelines(const harness::JournalText& journal, const ScenarioModel* loaded,
                   PageData& page) {
  const TimelineMaker timelines(journal, loaded, page);
  std::set<std::int64_t> with_clean;
  for (const auto& sample : page.samples) {
    const auto record =
        journal.samples.find({sample.trace, sample.sample, harness::DrawPhase::kCertify});
    if (record == journal.samples.end()) continue;
    const bool is_bad = sample.verdict == PageVerdict::kDiscrepancy;
    const bool is_told = is_bad && (page.discrepancies.empty() ||
                                    discrepancy_in(page, sample.trace, sample.sample) != nullptr);
    const bool is_fine = !is_bad && sample.verdict != PageVerdict::kLost;
    if (!is_told && (!is_fine || !with_clean.insert(sample.trace).second)) continue;
    if (page.timelines.size() < kMostTimelines) {
      page.timelines.push_back(timelines.make(record->second, sample.verdict));
    } else {
      ++page.timelines_left_out;
    }
  }
  std::stable_sort(page.timelines.begin(), page.timelines.end(), [](const auto& a, const auto& b) {
    return (a.verdict == PageVerdict::kDiscrepancy) > (b.verdict == PageVerdict::kDiscrepancy);
  });
}

}  // namespace parallax::tools
