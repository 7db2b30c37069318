#include "tools/app/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/artifact/symbol_table.h"
#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/judge.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/model_traces.h"
#include "tools/app/recorded_run.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::Literal;
using compiler::Timepoint;

namespace {

/// What finding needed instances may cost, for all sets together: a fraction of the time there is.
runtime::Effort effort_of(double time_limit_s) {
  constexpr double kMost = 100'000, kEachSecond = 5'000;  // conflicts
  const auto most = time_limit_s > 0 ? std::min(kMost, kEachSecond * time_limit_s) : kMost;
  return runtime::Effort(static_cast<std::int64_t>(most));
}

using nlohmann::json;

/// A discrepancy as report.json has it.
struct ReportedDiscrepancy {
  struct Fluent {
    std::string name;
    std::int64_t timepoint = 0;
    bool observed = false;
  };
  std::int64_t trace = 0, sample = 0, first_divergence = 0;
  std::vector<Fluent> first;  // that differed there

  std::string id() const { return fmt::format("{}.{}", trace, sample); }
};

/// None if an entry is none that `parallax run` writes.
std::optional<ReportedDiscrepancy> decode(const json& entry) {
  const auto integer = [](const json& object, const char* name) {
    const auto* value = base::json_member(object, name);
    return value == nullptr ? std::nullopt : base::json_as<std::int64_t>(*value);
  };
  const auto trace = integer(entry, "trace"), sample = integer(entry, "sample"),
             divergence = integer(entry, "first_divergence");
  const auto* first = base::json_member(entry, "first");
  if (!trace || !sample || !divergence || *divergence < 0 || first == nullptr ||
      !first->is_array()) {
    return std::nullopt;
  }
  ReportedDiscrepancy out{*trace, *sample, *divergence, {}};
  for (const auto& fluent : *first) {
    const auto time = integer(fluent, "timepoint");
    const auto *name = base::json_member(fluent, "fluent"),
               *observed = base::json_member(fluent, "observed");
    if (!time || name == nullptr || !name->is_string() || observed == nullptr ||
        !observed->is_boolean()) {
      return std::nullopt;
    }
    out.first.push_back({name->get<std::string>(), *time, observed->get<bool>()});
  }
  return out;
}

/// One discrepancy of report.json; none if the run has none. Reports one that is not there.
base::Result<std::optional<ReportedDiscrepancy>> find_discrepancy(const std::string& run_dir,
                                                                  const std::string& sample,
                                                                  base::DiagnosticSink& sink) {
  const auto path = (std::filesystem::path(run_dir) / "report.json").string();
  const auto text = base::read_file_of(run_dir, "report.json", sink);
  if (!text) return sink.already_reported();
  const auto report = json::parse(*text, nullptr, false);
  const auto refuse = [&] {
    return sink.error_about(base::DiagnosticCode::kUsage, path, "this is no report of a run");
  };
  const auto* list = base::json_member(report, "discrepancies");
  if (list == nullptr || !list->is_array()) return refuse();
  std::string others;
  for (const auto& entry : *list) {
    auto found = decode(entry);
    if (!found) return refuse();
    if (sample.empty() || sample == found->id()) return std::optional(*std::move(found));
    others += (others.empty() ? "" : ", ") + found->id();
  }
  if (sample.empty()) return std::optional<ReportedDiscrepancy>();
  return sink
      .error_about(base::DiagnosticCode::kNoSuchSample, run_dir, sample + " with a discrepancy")
      .note(others.empty() ? "the run found no discrepancy"
                           : "it found discrepancies in " + others);
}

/// The start and the events of the trace, as far as the divergence, and what was seen there.
class Observation {
 public:
  Observation(const compiler::CompiledModel& model, const harness::TraceLine& trace)
      : model_(model), trace_(*trace.trace), index_(model) {}

  ObservedRun make(const ReportedDiscrepancy& discrepancy) {
    run_.observed.length = static_cast<Timepoint>(
        std::min(discrepancy.first_divergence, std::int64_t{model_.horizon}));
    read_trace();
    for (std::size_t t = 0; t < events_.size(); ++t) {
      run_.lines.push_back(fmt::format("{} happens at {}", trace_.event(t), t));
    }
    model_.for_each_atom([&](const compiler::AtomRef& atom) {
      if (!atom.time || *atom.time >= run_.observed.length) return;
      const auto t = static_cast<std::size_t>(*atom.time);
      if (atom.kind == AtomKind::kHappens && t < events_.size()) {
        state(atom.variable, events_[t] == atom.event());
      }
      if (atom.kind == AtomKind::kHoldsAt && t == 0) {
        state(atom.variable, holds_.contains(atom.fluent()));
      }
    });
    for (const auto& fluent : discrepancy.first) see(fluent);
    return std::move(run_);
  }

 private:
  /// Its start and events as far as the divergence, in the model's ids: the journal has its own.
  void read_trace() {
    const compiler::SymbolTable symbols(model_);
    for (const auto name : trace_.holds(0)) {
      if (const auto fluent = symbols.fluent(name)) holds_.insert(*fluent);
    }
    const auto length = static_cast<std::size_t>(run_.observed.length);
    for (std::size_t t = 0; t < std::min(length, trace_.event_count()); ++t) {
      events_.push_back(symbols.event(trace_.event(t)));
    }
  }
  void state(std::int32_t variable, bool value) {
    const auto literal = Literal::positive(variable);
    run_.observed.facts.push_back(value ? literal : ~literal);
  }
  void see(const ReportedDiscrepancy::Fluent& fluent) {
    const auto time = run_.observed.length;
    if (fluent.timepoint != time) return;
    run_.lines.push_back(
        fmt::format("{} {} at {}", fluent.name, fluent.observed ? "holds" : "does not hold", time));
    const auto atom = index_.find(AtomKind::kHoldsAt, fluent.name, time);
    if (atom) run_.observed.facts.push_back(fluent.observed ? *atom : ~*atom);
  }

  const compiler::CompiledModel& model_;
  const harness::CampaignTrace& trace_;
  compiler::AtomIndex index_;
  std::set<compiler::FluentId> holds_;                    // at the start
  std::vector<std::optional<compiler::EventId>> events_;  // by timepoint
  ObservedRun run_;
};

/// Does the journal show what the report tells?
bool is_what_was_seen(const ReportedDiscrepancy& reported, const harness::StateMapping& mapping,
                      const harness::CampaignTrace& trace, const harness::SampleRecord& record) {
  if (record.status != harness::SampleStatus::kOk) return false;
  const harness::ModelFluents fluents(*trace.symbols);
  const auto judgement = harness::judge(mapping, fluents, trace, record.observations);
  return judgement.first_divergence == reported.first_divergence &&
         std::equal(judgement.first.begin(), judgement.first.end(), reported.first.begin(),
                    reported.first.end(), [](const auto& seen, const auto& told) {
                      return seen.fluent == told.name && seen.timepoint == told.timepoint &&
                             seen.observed == told.observed;
                    });
}

/// A trace with a valuation of every variable.
struct ValuedTrace {
  compiler::Timepoint length = 0;
  std::vector<bool> values;
};

/// A trace by its number; else how many there are, in digits.
struct Found {
  std::optional<runtime::Trace> trace;
  std::string count;
};

Found find_planned(const compiler::CompiledModel& model, std::int64_t number,
                   const Context& context) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  runtime::PlanEnumerator enumerator(session);
  Found found;
  std::int64_t count = 0;
  for (; count < number; ++count) {
    found.trace = enumerator.next();
    if (!found.trace) break;
  }
  found.count = std::to_string(count);
  return found;
}

Found find_trace(const compiler::CompiledModel& model, std::int64_t number,
                 const Context& context) {
  if (model.has_constraints) return find_planned(model, number, context);
  runtime::TraceQuery query;
  query.wanted = number;
  query.stop = &context.stop();
  runtime::ModelTraces traces(model, query);
  traces.seek(static_cast<long>(number - 1));
  Found found;
  found.trace = traces.next();
  query.wanted = 0;
  if (!found.trace) found.count = runtime::count_traces(model, query).count.get_str();
  return found;
}

/// Every atom as the trace has it; what it does not show is the solver's choice.
std::optional<ValuedTrace> value(const compiler::CompiledModel& model, const runtime::Trace& trace,
                                 const Context& context) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  std::vector<Literal> assumptions;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const auto& [kind, time] = std::tie(atom.kind, atom.time);
    if (atom.needed_horizon(model.horizon) > trace.length()) return;
    const auto say = [&](bool is_true) {
      assumptions.push_back(is_true ? atom.literal() : ~atom.literal());
    };
    if (kind == AtomKind::kPredicate && !time) say(runtime::contains(trace.predicates, atom.name));
    if (!time) return;
    const auto& point = trace.points[static_cast<std::size_t>(*time)];
    if (kind == AtomKind::kHoldsAt) say(runtime::contains(point.holds, atom.fluent()));
    if (kind == AtomKind::kHappens) say(runtime::contains(point.happens, atom.event()));
    if (kind == AtomKind::kReleasedAt) say(runtime::contains(point.released, atom.fluent()));
  });
  if (session.solve(trace.length(), assumptions) != runtime::SolveStatus::kSatisfiable) {
    return std::nullopt;
  }
  ValuedTrace valued{trace.length(), {}};
  for (std::int32_t v = 1; v <= model.variable_count(); ++v) {
    valued.values.push_back(session.value(Literal::positive(v)));
  }
  return valued;
}

base::Result<ValuedTrace> load_trace(const compiler::CompiledModel& model, std::int64_t number,
                                     Context& context) {
  const auto found = find_trace(model, number, context);
  const auto valued = found.trace ? value(model, *found.trace, context) : std::nullopt;
  if (valued) return *valued;
  if (context.stopped()) {
    return context.sink().error_about(base::DiagnosticCode::kExplanationCutShort, "",
                                      fmt::format("trace {} was not reached", number));
  }
  return context.sink().error_about(
      base::DiagnosticCode::kNoSuchTrace, "--trace", number,
      found.count == "0" ? "the model has none" : fmt::format("the model has {}", found.count));
}

/// The last timepoint at which the atom of a fact can be.
bool is_within(const TraceFact& fact, compiler::Timepoint length) {
  return fact.time.value_or(0) + (fact.kind == AtomKind::kHappens ? 1 : 0) <= length;
}

}  // namespace

ContradictionSearch::ContradictionSearch(const compiler::CompiledModel& model,
                                         const std::optional<ObservedRun>& run, Context& context)
    : context_(context),
      formula_(model, run ? std::optional(run->observed) : std::nullopt),
      axioms_(runtime::group_axioms(model)),
      texts_(model),
      effort_(effort_of(context.form().time_limit_s)) {}

base::Result<runtime::MinimalSets> ContradictionSearch::sets(const SetOptions& options) {
  auto solver =
      runtime::load_axioms(formula_, axioms_, runtime::make_cadical_solver(&context_.stop()));
  auto found = options.all ? runtime::all_minimal_sets(
                                 solver, static_cast<std::size_t>(options.limit), &context_.stop())
                           : runtime::smallest_set(solver, &context_.stop());
  if (found.unknown) {
    return context_.sink().error_about(base::DiagnosticCode::kExplanationCutShort, "",
                                       "whether there is a contradiction is not known");
  }
  return found;
}

Contradiction ContradictionSearch::look_at(const runtime::IndexSet& set) {
  runtime::ProofLimits limits;
  limits.stop = &context_.stop();
  const auto ground = runtime::ground_contradiction(formula_, axioms_, set, limits, effort_);
  if (ground.proof.verdict == runtime::ProofVerdict::kRejected) {
    context_.sink().error_about(base::DiagnosticCode::kProofRejected, "", ground.proof.reason);
  }
  Contradiction out{{}, ground.minimal, ground.proof.verdict};
  for (const auto group : set) {
    out.axioms.push_back({axioms_.origins[group].front(), instances_of(group, ground.clauses)});
  }
  return out;
}

std::vector<std::string> ContradictionSearch::instances_of(
    std::uint32_t group, const std::vector<std::size_t>& clauses) const {
  std::vector<std::pair<compiler::Timepoint, std::string>> found;
  const auto& model = formula_.model();
  for (const auto clause : clauses) {
    if (axioms_.group_of[model.clause_origins[clause]] != group) continue;
    found.emplace_back(model.clause_timepoints[clause], texts_.clause(clause));
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> out;
  for (auto& [time, text] : found) out.push_back(std::move(text));
  return out;
}

base::Result<std::optional<ObservedDiscrepancy>> load_discrepancy(const RunFolderOptions& folder,
                                                                  const std::string& sample,
                                                                  Context& context) {
  auto& sink = context.sink();
  const auto journal = harness::read_journal(folder.folder, context.files(), sink);
  if (!journal) return sink.already_reported();
  const auto discrepancy = find_discrepancy(folder.folder, sample, sink);
  if (!discrepancy) return sink.already_reported();
  if (!*discrepancy || !journal->header) return std::optional<ObservedDiscrepancy>();
  const harness::SampleId id{(*discrepancy)->trace, (*discrepancy)->sample};
  if (!journal->samples.contains({id.trace, id.sample, harness::DrawPhase::kCertify})) {
    return sink
        .error_about(base::DiagnosticCode::kNoSuchSample, folder.folder, (*discrepancy)->id())
        .note("report.json tells of it, the journal does not");
  }
  const auto recorded = harness::recorded_run(*journal, id);
  if (!require_trace(folder.folder, recorded, sink)) return sink.already_reported();
  auto loaded = load_recorded_scenario(folder, recorded.header, ScenarioUse::kExplain, context);
  if (!loaded) return sink.already_reported();
  const auto trace = check_recorded_run(*loaded, recorded, context);
  if (!trace) return sink.already_reported();
  const auto& mapping = *loaded->scenario.mapping;
  if (!is_what_was_seen(**discrepancy, mapping, *trace, recorded.record)) {
    return sink.error(base::DiagnosticCode::kForeignJournalLine, recorded.source,
                      "what it observed is not the discrepancy that report.json tells of");
  }
  auto run = Observation(loaded->compilation.model, recorded.line).make(**discrepancy);
  return std::optional(ObservedDiscrepancy{*std::move(loaded), std::move(run)});
}

base::Result<FactExplanation> explain_why(const compiler::CompiledModel& model,
                                          const WhyQuery& query, Context& context) {
  auto& sink = context.sink();
  const auto fact = parse_fact(query.fact, model, context);
  if (!fact) return sink.already_reported();
  const auto trace = load_trace(model, query.trace, context);
  if (!trace) return sink.already_reported();
  if (!is_within(*fact, trace->length)) {
    return sink.error_about(
        base::DiagnosticCode::kNoSuchFact, "--why", query.fact,
        fmt::format("trace {} ends at {}{}", query.trace, trace->length,
                    fact->kind == AtomKind::kHappens ? ", where nothing happens any more" : ""));
  }
  FactExplanation out{*fact, query.trace, std::nullopt, {}};
  if (!fact->atom) return out;
  const bool holds = trace->values[static_cast<std::size_t>(fact->atom->var()) - 1];
  out.asked = holds ? *fact->atom : ~*fact->atom;
  runtime::WhyOptions options;
  options.alternatives = query.all;
  options.stop = &context.stop();
  out.steps = runtime::explain_fact(model, trace->length, trace->values, *out.asked, options);
  const bool undecided = std::any_of(out.steps.begin(), out.steps.end(), [](const auto& step) {
    return step.kind == runtime::WhyKind::kUndecided;
  });
  if (undecided) {
    sink.error_about(base::DiagnosticCode::kExplanationCutShort, "",
                     "whether every choice is one is not known");
  }
  return out;
}

}  // namespace parallax::tools
