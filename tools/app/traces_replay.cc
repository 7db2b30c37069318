#include "tools/app/traces_replay.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/codes/artifacts.h"
#include "compiler/base/codes/campaigns.h"
#include "compiler/base/diagnostic.h"
#include "compiler/base/file_io.h"
#include "compiler/pipeline/compile.h"
#include "compiler/reference/reference_evaluator.h"
#include "runtime/replay/trace_replay.h"
#include "runtime/trace/trace_reader.h"
#include "tools/app/plan_reservations.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_check.h"

namespace parallax::tools {
namespace {

/// Why a trace is not one of the model: the first reason, and some of the others.
struct Blame {
  std::int64_t timepoint = 0;
  bool rests_on_plan = false;  // the axioms alone may admit it
  base::DiagnosticNote first;
  std::vector<base::DiagnosticNote> others;
};

/// The earliest violation that the evaluator finds in a trace that mentions every atom, among
/// equals the first of the text. None if it finds nothing.
std::optional<Blame> evaluated_blame(const runtime::ClaimedTrace& trace,
                                     const compiler::ReferenceEvaluator& evaluator);

/// A minimal set of axioms that cannot hold with the trace up to the verdict's timepoint. None if
/// the solver was stopped.
std::optional<Blame> core_blame(const compiler::Compilation& compilation,
                                const runtime::TraceReplay& replay,
                                const runtime::ClaimedTrace& trace,
                                const runtime::ReplayVerdict& verdict);

constexpr std::size_t kMaxNotes = 5;            // for one trace
constexpr std::size_t kMaxLookedThrough = 500;  // looked through for the first one

std::set<std::string> truths(const runtime::AtomClaims& claims) {
  std::set<std::string> names;
  for (const auto& [name, claim] : claims.listed) {
    if (claim.value) names.insert(name);
  }
  return names;
}

compiler::Valuation claimed_valuation(const runtime::ClaimedTrace& trace) {
  compiler::Valuation valuation;
  for (const auto& point : trace.points) {
    valuation.holds.push_back(truths(point.holds));
    valuation.happens.push_back(truths(point.happens));
    valuation.released.push_back(truths(point.released));
  }
  valuation.predicates = truths(trace.predicates);
  return valuation;
}

base::DiagnosticNote note_at(const base::SourceRange& source, std::string text) {
  const bool placed = source.end > source.begin;
  return {placed ? std::optional(source) : std::nullopt, std::move(text)};
}

std::optional<Blame> evaluated_blame(const runtime::ClaimedTrace& trace,
                                     const compiler::ReferenceEvaluator& evaluator) {
  auto found = evaluator.violations(claimed_valuation(trace), kMaxLookedThrough).violations;
  if (found.empty()) return std::nullopt;
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.timepoint < b.timepoint; });
  Blame blame{
      found.front().timepoint, false, note_at(found.front().source, found.front().text), {}};
  for (std::size_t i = 1; i < found.size() && i <= kMaxNotes; ++i) {
    blame.others.push_back(note_at(found[i].source, found[i].text));
  }
  return blame;
}

std::optional<Blame> core_blame(const compiler::Compilation& compilation,
                                const runtime::TraceReplay& replay,
                                const runtime::ClaimedTrace& trace,
                                const runtime::ReplayVerdict& verdict) {
  const auto core = replay.blame(trace, verdict.timepoint);
  if (core.status != runtime::SolveStatus::kUnsatisfiable) return std::nullopt;
  const auto& model = compilation.model;
  Blame blame{verdict.timepoint, model.plan.empty() && !model.plan_cuts.empty(), {}, {}};
  for (const auto index : core.origins) {
    const auto& origin = model.origins[index];
    blame.rests_on_plan = blame.rests_on_plan || origin.kind == compiler::OriginKind::kPlanStep;
    auto note = note_at(origin.source, std::string(to_string(origin.kind)));
    // In a compiled model the source is a line of that file.
    if (compilation.typed == nullptr) {
      note.text += fmt::format(" of {}:{}", origin.place.file, origin.place.begin.line);
    }
    if (blame.first.text.empty()) {
      note.text += ": it cannot hold with what the trace says";
      const auto others = core.origins.size() - 1;
      if (others > 0) note.text += fmt::format(" and {} others", others);
      if (verdict.hidden > 0) note.text += ", whatever it does not mention";
      blame.first = std::move(note);
    } else if (blame.others.size() < kMaxNotes) {
      blame.others.push_back(std::move(note));
    }
  }
  return blame;
}

using runtime::ClaimedTrace;
using runtime::ReplayVerdict;

class TraceFileReplay {
 public:
  TraceFileReplay(const compiler::Compilation& compilation,
                  const std::function<void(const ReplayedTrace&)>& hear, Context& context)
      : compilation_(compilation),
        model_(compilation.model),
        hear_(hear),
        context_(context),
        sink_(context.sink()),
        replay_(model_, [&context] { return runtime::make_cadical_solver(&context.stop()); }) {}

  /// False, reported, if the file is at fault.
  bool run(const runtime::TraceFileHead& head) {
    const auto vocabulary = runtime::vocabulary_of(model_);
    runtime::ClaimReader reader(vocabulary, sink_);
    for (const auto& place : head.traces) {
      if (context_.stopped()) return true;
      const auto trace = runtime::read_trace(place, result_.seen + 1, context_.files(), reader);
      if (!trace || !has_right_length(*trace)) return false;
      if (!judge(*trace)) return true;
      ++result_.seen;
    }
    result_.finished = true;
    return true;
  }

  ReplayedTraces result() && { return std::move(result_); }

 private:
  bool has_right_length(const ClaimedTrace& trace) {
    const auto [least, most] = replay_.lengths();
    const auto length = trace.length();
    if (length >= least && length <= most) return true;
    const auto wanted = least == most ? fmt::format("the model at {}", most)
                                      : fmt::format("a trace of it at {} to {}", least, most);
    sink_.error(codes::kTraceWrongLength, trace.source, length, wanted);
    return false;
  }

  /// False if the run was stopped on the way.
  bool judge(const ClaimedTrace& trace) {
    const auto verdict = replay_.replay(trace);
    switch (verdict.kind) {
      case ReplayVerdict::Kind::kUnknown:
        return false;
      case ReplayVerdict::Kind::kAgrees:
        return judge_completion(trace, verdict);
      case ReplayVerdict::Kind::kFails: {
        const auto blame = find_blame(trace, verdict);
        if (blame && blame->rests_on_plan && is_open(blame->timepoint)) {
          note_undecided(trace, blame->timepoint);
        } else if (blame) {
          report(trace, *blame);
        }
        return blame.has_value();
      }
      case ReplayVerdict::Kind::kNoFirstHit:
        // Behind a cut constraints are never met.
        if (verdict.timepoint == trace.length() && is_behind_cut(verdict.timepoint)) {
          note_undecided(trace, verdict.timepoint);
        } else {
          report_end(trace, verdict.timepoint);
        }
        return true;
    }
    return false;
  }

  /// The solver has found values for what is not mentioned: does the evaluator agree?
  bool judge_completion(const ClaimedTrace& trace, const ReplayVerdict& verdict) {
    if (const auto* evaluator = usable_evaluator()) {
      const auto result = evaluator->violations(valuation_of(verdict.completion), 1);
      if (!result.violations.empty()) {
        result_.sound = false;
        sink_.error_about(codes::kTraceDisagrees, "", trace.number, result.violations.front().text);
        return true;
      }
      if (result.finished) ++result_.checked;
    }
    note({trace.number, true, false, verdict.hidden, 0, {}, std::nullopt});
    return true;
  }

  const compiler::ReferenceEvaluator* usable_evaluator() {
    if (compilation_.typed == nullptr || model_.options.contains("compat")) return nullptr;
    if (!evaluator_) {
      compiler::ReferenceLimits limits;
      limits.stop = &context_.stop();
      evaluator_ = std::make_unique<compiler::ReferenceEvaluator>(*compilation_.typed, limits);
      if (const auto reason = evaluator_->refusal(); reason && !context_.stopped()) {
        context_.remark("not checked a second time: " + *reason);
      }
    }
    return evaluator_->refusal() ? nullptr : evaluator_.get();
  }

  /// The evaluator names the atoms that decide. Where it finds no fault, because the trace leaves
  /// atoms open or a plan is to blame, a minimal core is used instead.
  std::optional<Blame> find_blame(const ClaimedTrace& trace, const ReplayVerdict& verdict) {
    if (verdict.hidden == 0) {
      if (const auto* evaluator = usable_evaluator()) {
        if (auto blame = evaluated_blame(trace, *evaluator)) return blame;
        if (!model_.has_constraints && model_.plan.empty()) return disagreement(trace);
      }
    }
    if (verdict.impossible) {
      const auto text = verdict.impossible_atom + " is false in every trace of the model";
      const bool has_plan = !model_.plan.empty() || !model_.plan_cuts.empty();
      return Blame{verdict.timepoint, has_plan, {verdict.impossible->source, text}, {}};
    }
    return core_blame(compilation_, replay_, trace, verdict);
  }

  bool is_behind_cut(std::int64_t timepoint) const {
    const auto cut = first_cut(model_);
    return cut && *cut < timepoint;
  }

  /// May the plan have executions up to `timepoint` that were not explored?
  bool is_open(std::int64_t timepoint) const {
    return reservations_of(compilation_.plan).any() || is_behind_cut(timepoint);
  }

  void note_undecided(const ClaimedTrace& trace, std::int64_t timepoint) {
    ++result_.undecided;
    ReplayedTrace out;
    out.number = trace.number;
    out.undecided = true;
    out.timepoint = timepoint;
    const auto texts = reservation_texts(compilation_, context_);
    out.reason = fmt::format("the plan may have executions that were not explored ({})",
                             fmt::join(texts, "; "));
    note(std::move(out));
  }

  /// The solver finds no values, but nothing is open and the evaluator sees nothing wrong.
  std::optional<Blame> disagreement(const ClaimedTrace& trace) {
    result_.sound = false;
    sink_.error_about(codes::kTraceDisagrees, "", trace.number,
                      "by the solver; the evaluation of its axioms finds nothing wrong");
    return std::nullopt;
  }

  void report(const ClaimedTrace& trace, const Blame& blame) {
    const auto code = codes::kTraceFails;
    auto built =
        blame.first.range
            ? sink_.error(code, *blame.first.range, trace.number, blame.timepoint, blame.first.text)
            : sink_.error_about(code, "", trace.number, blame.timepoint, blame.first.text);
    for (const auto& note : blame.others) {
      if (note.range) {
        built.note(*note.range, note.text);
      } else {
        built.note(note.text);
      }
    }
    note_failure(trace, blame.timepoint, blame.first);
  }

  void report_end(const ClaimedTrace& trace, compiler::Timepoint timepoint) {
    const auto text = timepoint < trace.length() ? fmt::format("hold before, at {}", timepoint)
                                                 : fmt::format("do not hold at {}", timepoint);
    base::DiagnosticNote note{std::nullopt, "the state constraints " + text};
    for (const auto& origin : model_.origins) {
      if (origin.kind == compiler::OriginKind::kStateConstraint && !note.range)
        note.range = origin.source;
    }
    const auto range = note.range.value_or(trace.source);
    sink_.error(codes::kTraceNoFirstHit, range, trace.number, text);
    note_failure(trace, timepoint, note);
  }

  void note_failure(const ClaimedTrace& trace, std::int64_t timepoint,
                    const base::DiagnosticNote& first) {
    ++result_.failed;
    note({trace.number, false, false, 0, timepoint, first.text, first.range});
  }

  void note(ReplayedTrace trace) {
    result_.traces.push_back(std::move(trace));
    hear_(result_.traces.back());
  }

  const compiler::Compilation& compilation_;
  const compiler::CompiledModel& model_;
  const std::function<void(const ReplayedTrace&)>& hear_;
  Context& context_;
  base::DiagnosticSink& sink_;
  runtime::TraceReplay replay_;
  std::unique_ptr<compiler::ReferenceEvaluator> evaluator_;  // made for the first trace
  ReplayedTraces result_;
};

}  // namespace

base::Result<ReplayedTraces> replay_traces(const ModelOptions& model,
                                           const ReplayTracesOptions& options,
                                           const std::function<void(const ReplayedTrace&)>& report,
                                           Context& context) {
  auto& sink = context.sink();
  const auto compilation = compile_models(model, context);
  if (!compilation) return sink.already_reported();
  const auto file = base::load_text(options.file, context.files(), sink);
  if (!file) return sink.already_reported();
  const auto head = runtime::open_trace_file(*file, context.files(), sink);
  if (!head) return sink.already_reported();
  const auto hash = runtime::model_hash(compilation->model);
  if (!options.other_model && head->model && *head->model != hash) {
    return sink.error(codes::kTraceOtherModel, head->model_source, *head->model, hash);
  }
  TraceFileReplay replay(*compilation, report, context);
  if (!replay.run(*head)) return sink.already_reported();
  auto result = std::move(replay).result();
  result.closed = head->closed;
  return result;
}

}  // namespace parallax::tools
