#include "tools/app/traces_replay.h"

#include <memory>
#include <optional>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/reference/reference_evaluator.h"
#include "runtime/replay/trace_replay.h"
#include "runtime/trace/trace_reader.h"
#include "tools/app/replay_blame.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_valuation.h"

namespace parallax::tools {
namespace {

using base::DiagnosticCode;
using runtime::ClaimedTrace;
using runtime::ReplayVerdict;
using Json = nlohmann::ordered_json;

class TraceFileReplay {
 public:
  TraceFileReplay(const compiler::Compilation& compilation, Context& context)
      : compilation_(compilation),
        model_(compilation.model),
        context_(context),
        sink_(context.sink()),
        replay_(model_, [&context] { return runtime::make_cadical_solver(&context.stop()); }) {}

  /// False, reported, if the file is at fault.
  bool run(const runtime::TraceFileHead& head) {
    const auto vocabulary = runtime::vocabulary_of(model_);
    runtime::ClaimReader reader(vocabulary, sink_);
    for (const auto& place : head.traces) {
      if (context_.stopped()) return true;
      const auto trace = runtime::read_trace(place, seen_ + 1, context_.files(), reader);
      if (!trace || !has_right_length(*trace)) return false;
      if (!judge(*trace)) return true;
      ++seen_;
    }
    finished_ = true;
    return true;
  }

  void close(const runtime::TraceFileHead& head) {
    const char* state = finished_ ? "complete" : "stopped";
    if (!head.closed) {
      context_.remark("the file does not say how its list ended: there may be more traces");
    }
    if (context_.stopped()) context_.remark("stopped before the last trace");
    if (context_.form().json) {
      context_.document(base::json_text(Json{{"status", sound_ ? "ok" : "error"},
                                             {"traces", seen_},
                                             {"agree", seen_ - failed_},
                                             {"fail", failed_},
                                             {"checked", checked_},
                                             {"complete", finished_},
                                             {"list", list_}}) +
                        '\n');
      return;
    }
    context_.result(fmt::format("{} {} replayed, {}: {} agree, {} fail, {} checked\n", seen_,
                                seen_ == 1 ? "trace" : "traces", state, seen_ - failed_, failed_,
                                checked_));
  }

  int exit_code() const {
    if (!sound_) return 5;
    if (failed_ > 0) return 1;
    return finished_ ? 0 : 4;
  }

 private:
  bool has_right_length(const ClaimedTrace& trace) {
    const auto [least, most] = replay_.lengths();
    const auto length = trace.length();
    if (length >= least && length <= most) return true;
    const auto wanted = least == most ? fmt::format("the model at {}", most)
                                      : fmt::format("a trace of it at {} to {}", least, most);
    sink_.error(DiagnosticCode::kTraceWrongLength, trace.source, length, wanted);
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
        if (blame) report(trace, *blame);
        return blame.has_value();
      }
      case ReplayVerdict::Kind::kNoFirstHit:
        report_end(trace, verdict.timepoint);
        return true;
    }
    return false;
  }

  /// The solver has found values for what is not mentioned: does the evaluator agree?
  bool judge_completion(const ClaimedTrace& trace, const ReplayVerdict& verdict) {
    if (const auto* evaluator = usable_evaluator()) {
      const auto result = evaluator->violations(valuation_of(verdict.completion), 1);
      if (!result.violations.empty()) {
        sound_ = false;
        sink_.error_about(DiagnosticCode::kTraceDisagrees, "", trace.number,
                          result.violations.front().text);
        return true;
      }
      if (result.finished) ++checked_;
    }
    list_.push_back({{"trace", trace.number}, {"agrees", true}, {"hidden", verdict.hidden}});
    say(fmt::format(
        "trace {}: agrees{}\n", trace.number,
        verdict.hidden == 0
            ? ""
            : fmt::format(", with values for {} atoms that it does not mention", verdict.hidden)));
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

  /// The evaluator names the atoms that decide; where it sees nothing wrong, because the trace
  /// leaves atoms open or a plan is to blame, a minimal core does.
  std::optional<Blame> find_blame(const ClaimedTrace& trace, const ReplayVerdict& verdict) {
    if (verdict.hidden == 0) {
      if (const auto* evaluator = usable_evaluator()) {
        if (auto blame = evaluated_blame(trace, *evaluator)) return blame;
        if (!model_.has_constraints && model_.plan.empty()) return disagreement(trace);
      }
    }
    if (verdict.impossible) {
      const auto text = verdict.impossible_atom + " is false in every trace of the model";
      return Blame{verdict.timepoint, {verdict.impossible->source, text}, {}};
    }
    return core_blame(compilation_, replay_, trace, verdict);
  }

  /// The solver finds no values, but nothing is open and the evaluator sees nothing wrong.
  std::optional<Blame> disagreement(const ClaimedTrace& trace) {
    sound_ = false;
    sink_.error_about(DiagnosticCode::kTraceDisagrees, "", trace.number,
                      "by the solver; the evaluation of its axioms finds nothing wrong");
    return std::nullopt;
  }

  void report(const ClaimedTrace& trace, const Blame& blame) {
    const auto code = DiagnosticCode::kTraceFails;
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
    sink_.error(DiagnosticCode::kTraceNoFirstHit, range, trace.number, text);
    note_failure(trace, timepoint, note);
  }

  void note_failure(const ClaimedTrace& trace, std::int64_t timepoint,
                    const base::DiagnosticNote& first) {
    ++failed_;
    const auto place = first.range ? context_.files().place(*first.range) : std::string();
    Json entry = {
        {"trace", trace.number}, {"agrees", false}, {"timepoint", timepoint}, {"text", first.text}};
    if (first.range) {
      const auto& file = context_.files()[first.range->file];
      const auto position = file.position(first.range->begin);
      entry["file"] = file.name();
      entry["line"] = position.line;
      entry["column"] = position.column;
    }
    list_.push_back(std::move(entry));
    say(fmt::format("trace {}: fails at timepoint {}{}\n", trace.number, timepoint,
                    place.empty() ? "" : ", " + place));
  }

  void say(const std::string& line) {
    if (!context_.form().json) context_.result(line);
  }

  const compiler::Compilation& compilation_;
  const compiler::CompiledModel& model_;
  Context& context_;
  base::DiagnosticSink& sink_;
  runtime::TraceReplay replay_;
  std::unique_ptr<compiler::ReferenceEvaluator> evaluator_;  // made for the first trace
  std::int64_t seen_ = 0, failed_ = 0, checked_ = 0;
  bool finished_ = false, sound_ = true;
  Json list_ = Json::array();
};

}  // namespace

int replay_traces(const ModelOptions& model, const ReplayTracesOptions& options, Context& context) {
  const auto compilation = compile_models(model, context);
  if (!compilation) return 0;
  auto& sink = context.sink();
  const auto file = base::load_text(options.file, context.files(), sink);
  if (!file) return 0;
  const auto head = runtime::open_trace_file(*file, context.files(), sink);
  if (!head) return 0;
  const auto hash = runtime::model_hash(compilation->model);
  if (!options.other_model && head->model && *head->model != hash) {
    sink.error(DiagnosticCode::kTraceOtherModel, head->model_source, *head->model, hash);
    return 0;
  }
  TraceFileReplay replay(*compilation, context);
  if (!replay.run(*head)) return 0;
  replay.close(*head);
  return replay.exit_code();
}

}  // namespace parallax::tools
