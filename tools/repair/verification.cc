#include "tools/repair/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/repair/closed_triggers.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/session/solver_session.h"

namespace parallax::tools {

namespace {

/// The steps of a sequence up to where the model leaves it.
std::string steps_of(const Evidence& seen, std::size_t count) {
  std::string out;
  for (std::size_t t = 0; t < std::min(count, seen.steps.size()); ++t) {
    out += (out.empty() ? "" : ", ") + seen.steps[t].event;
  }
  return out;
}

void validate(EvidenceAdmission& admission, const std::vector<Evidence>& further, Verdict& out) {
  for (const auto& seen : further) {
    std::optional<std::size_t> refuse_at;
    if (!seen.steps.empty() && seen.steps.back().failed) refuse_at = seen.steps.size() - 1;
    const auto answer = admission.ask(seen, refuse_at);
    if (answer.stopped) return;
    if (answer.whole) {
      ++out.validated;
    } else if (out.refuted_by.empty()) {
      out.refuted_by = steps_of(seen, answer.reached + 1);
    }
  }
}

/// A model in which nothing happens that is neither performed nor demanded. Its text is empty where
/// the model demands no event.
struct StrictModel {
  std::string text;
  std::vector<std::string> closed;  // symbols of events

  explicit StrictModel(const std::string& of) {
    const auto domain = domain_of_text(of);
    if (domain == nullptr) return;
    auto closing = compiler::closed_triggers(domain->ast, domain->files, *domain->typed);
    closed = std::move(closing.symbols);
    if (!closed.empty()) text = of + "\n" + closing.text;
  }

  /// The same runs, with what was performed at each step.
  std::vector<Evidence> told(std::vector<Evidence> all) const {
    for (auto& seen : all) {
      for (std::size_t t = 0; t < seen.steps.size() && t < seen.states.size(); ++t) {
        const auto performed = base::symbol_of(seen.steps[t].event);
        for (const auto& symbol : closed) {
          seen.states[t][compiler::performed_fluent(symbol)] = symbol == performed;
        }
      }
    }
    return all;
  }
};

/// How many of the runs that the model follows to their end it follows with demanded events alone.
std::size_t runs_undemanded(EvidenceAdmission& strict, const std::vector<Evidence>& whole) {
  std::size_t out = 0;
  for (const auto& seen : whole) {
    const auto answer = strict.ask(seen);
    if (!answer.stopped && !answer.whole) out += seen.runs();
  }
  return out;
}

}  // namespace

Verdict verify(const std::string& text, const std::vector<Evidence>& evidence,
               const std::vector<Evidence>& further, const Context& context, SequenceMemo* memo) {
  std::size_t horizon = 1;
  for (const auto& seen : evidence) horizon = std::max(horizon, seen.steps.size());
  for (const auto& seen : further) horizon = std::max(horizon, seen.steps.size());
  Verdict out;
  std::string wrong;
  const auto model = compile_text(text, static_cast<std::int64_t>(horizon), context, wrong);
  if (!model) {
    out.why = "no right model: " + wrong;
    return out;
  }
  EvidenceAdmission admission(*model, context.stop());
  std::vector<Evidence> whole;
  for (const auto& seen : evidence) {
    const auto needed = seen.needed();
    std::optional<std::size_t> refuse_at;
    if (seen.divergence && !seen.until && needed > 0 && seen.steps[needed - 1].failed)
      refuse_at = needed - 1;
    const auto answer = admission.ask(seen, refuse_at);
    if (answer.stopped || !answer.start || answer.reached < needed) {
      out.why = answer.stopped ? "stopped"
                               : fmt::format("run {} at {}", seen.ids.front(), answer.reached + 1);
      return out;
    }
    if (answer.whole) {
      out.runs_whole += seen.runs();
      if (!answer.refused) whole.push_back(seen);
    }
    if (answer.reached >= seen.seen_to()) out.runs_consistent += seen.runs();
    out.refuses = out.refuses || answer.refused;
  }
  out.admits = true;
  const auto known = memo == nullptr ? nullptr : memo->find(text);
  if (known != nullptr) {
    out.validated = known->validated;
    out.refuted_by = known->refuted_by;
    if (whole.empty()) return out;
  }
  const auto asked = known != nullptr ? std::vector<Evidence>() : further;
  const StrictModel demanded(text);
  const auto strict =
      demanded.text.empty()
          ? std::nullopt
          : compile_text(demanded.text, static_cast<std::int64_t>(horizon), context, wrong);
  if (!strict) {
    validate(admission, asked, out);
  } else {
    EvidenceAdmission strictly(*strict, context.stop());
    out.runs_undemanded = runs_undemanded(strictly, demanded.told(whole));
    validate(strictly, demanded.told(asked), out);
  }
  if (memo != nullptr && !context.stopped()) {
    memo->by_text.insert_or_assign(text, SequenceMemo::Said{out.validated, out.refuted_by});
  }
  return out;
}

void hold_against(const std::string& text, const std::vector<Evidence>& fresh,
                  const Context& context, Verdict& verdict) {
  const auto held = verify(text, {}, fresh, context);
  verdict.fresh_right = held.validated;
  if (!held.refuted_by.empty()) verdict.refuted_by = held.refuted_by;
}

TraceComparer::TraceComparer(const ScenarioModel& loaded, const std::string& text, Context& context)
    : loaded_(loaded), context_(context), original_(compile(text, false)) {
  if (original_) compared_.emplace(original_->model);
}

std::optional<compiler::Compilation> TraceComparer::compile(const std::string& text,
                                                            bool constraints) {
  // The scenario's texts are those of the context; what is said of an edited model is not reported.
  const auto before = context_.sink();
  auto compiled =
      compile_with_model(loaded_.scenario, text, loaded_.scenario.execution, constraints, context_);
  context_.sink() = before;
  if (!compiled) return std::nullopt;
  return *std::move(compiled);
}

TraceEffects TraceComparer::compare(const std::string& edited) {
  TraceEffects out;
  const auto other = compile(edited, false);
  if (!original_ || !other || context_.stopped()) return out;
  runtime::DifferenceOptions options;
  options.stop = &context_.stop();
  options.counts_only = true;
  runtime::ComparedModel edited_model(other->model);
  const auto difference = runtime::compare_traces(*compared_, edited_model, options);
  const auto number = [](const runtime::OneSided& side) -> std::optional<runtime::TraceNumber> {
    if (side.answer == runtime::DifferenceAnswer::kUnknown) return std::nullopt;
    return side.count;
  };
  out.lost = number(difference.lost);
  out.gained = number(difference.gained);
  const bool closed = loaded_.scenario.execution == harness::Execution::kClosedLoop;
  if (loaded_.scenario.constraints.empty() || closed) return out;
  const auto aimed = compile(edited, true);
  if (!aimed) return out;
  runtime::SolverSession session(aimed->model, runtime::make_cadical_solver(&context_.stop()));
  runtime::PlanEnumerator traces(session, {.order = runtime::TraceOrder::kAny});
  out.reaches = traces.next().has_value();
  if (!*out.reaches && context_.stopped()) out.reaches.reset();
  return out;
}

}  // namespace parallax::tools
