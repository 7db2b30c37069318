#include "tools/repair/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/repair/closed_triggers.h"
#include "compiler/repair/edit_grammar.h"
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

/// A model in which nothing happens that is neither performed nor demanded. Its text is empty where
/// the model demands no event.
struct StrictModel {
  std::string text;
  std::vector<std::string> closed;  // symbols of events
  std::set<std::string> undefined;  // fluents (undefined_fluents)

  explicit StrictModel(const std::string& of) {
    const auto domain = domain_of_text(of);
    if (domain == nullptr) return;
    undefined = compiler::undefined_fluents(domain->ast, *domain->typed, domain->forms);
    auto closing = compiler::closed_triggers(domain->ast, domain->files, *domain->typed);
    closed = std::move(closing.symbols);
    if (!closed.empty()) text = of + "\n" + closing.text;
  }

  /// The same run, with what was performed at each step.
  Evidence told(Evidence seen) const {
    for (std::size_t t = 0; t < seen.steps.size() && t < seen.states.size(); ++t) {
      const auto performed = base::symbol_of(seen.steps[t].event);
      for (const auto& symbol : closed) {
        seen.states[t][compiler::performed_fluent(symbol)] = symbol == performed;
      }
    }
    return seen;
  }
};

/// A model that runs are held against. What the strict model follows, the model follows, so that
/// the model itself is compiled only where the strict one says no.
class HeldModel {
 public:
  HeldModel(const std::string& text, std::size_t horizon, const Context& context)
      : text_(text),
        horizon_(static_cast<std::int64_t>(horizon)),
        context_(context),
        demanded_(text) {
    if (!demanded_.text.empty()) strict_ = asked(demanded_.text);
    if (!strict_) plain_ = asked(text_);
  }

  bool is_right() const { return strict_ || plain_; }
  const std::string& why_not() const { return why_; }

  /// `strictly`: with demanded events alone.
  EvidenceAdmission::Answer ask(const Evidence& seen, std::optional<std::size_t> refuse_at,
                                bool& strictly) {
    strictly = true;
    if (strict_) {
      const auto answer = ask_strictly(seen, refuse_at);
      if (answer.stopped || (answer.whole && !answer.refused)) return answer;
      strictly = false;
      if (!plain_) plain_ = asked(text_);
      if (!plain_) return {};
    }
    return plain_->admission.ask(seen, refuse_at);
  }
  EvidenceAdmission::Answer ask_strictly(const Evidence& seen,
                                         std::optional<std::size_t> refuse_at) {
    return strict_ ? strict_->admission.ask(demanded_.told(seen), refuse_at)
                   : plain_->admission.ask(seen, refuse_at);
  }
  EvidenceAdmission::Answer ask_whole_strictly(const Evidence& seen,
                                               std::optional<std::size_t> refuse_at) {
    return strict_ ? strict_->admission.ask_whole(demanded_.told(seen), refuse_at)
                   : plain_->admission.ask_whole(seen, refuse_at);
  }

  /// Fluents that it leaves open on the first of these; a few tell as much as all.
  std::string left_open(const std::vector<Evidence>& all) {
    constexpr std::size_t kMostAsked = 6;
    const auto most = demanded_.undefined.empty() ? 0 : std::min(all.size(), kMostAsked);
    for (std::size_t i = 0; i < most; ++i) {
      auto fluent = strict_
                        ? strict_->admission.left_open(demanded_.told(all[i]), demanded_.undefined)
                        : plain_->admission.left_open(all[i], demanded_.undefined);
      if (fluent) return *std::move(fluent);
    }
    return "";
  }

 private:
  struct Asked {
    Asked(compiler::CompiledModel compiled, const std::atomic<bool>& stop)
        : model(std::move(compiled)), admission(model, stop) {}
    const compiler::CompiledModel model;
    EvidenceAdmission admission;
  };

  std::unique_ptr<Asked> asked(const std::string& text) {
    auto model = compile_text(text, horizon_, context_, why_);
    if (!model) return nullptr;
    return std::make_unique<Asked>(*std::move(model), context_.stop());
  }

  const std::string& text_;
  const std::int64_t horizon_;
  const Context& context_;
  const StrictModel demanded_;
  std::string why_;
  std::unique_ptr<Asked> strict_, plain_;
};

void validate(HeldModel& model, const std::vector<Evidence>& further, Verdict& out) {
  for (const auto& seen : further) {
    std::optional<std::size_t> refuse_at;
    if (!seen.steps.empty() && seen.steps.back().failed) refuse_at = seen.steps.size() - 1;
    // How far it goes is told of the first one that it does not follow.
    const auto answer = out.refuted_by.empty() ? model.ask_strictly(seen, refuse_at)
                                               : model.ask_whole_strictly(seen, refuse_at);
    if (answer.stopped) return;
    if (answer.whole) {
      ++out.validated;
    } else if (out.refuted_by.empty()) {
      out.refuted_by = steps_of(seen, answer.reached + 1);
    }
  }
}

/// The step of a failed run whose event the model may forbid.
std::optional<std::size_t> step_to_refuse(const Evidence& seen) {
  const auto needed = seen.needed();
  const bool failed = seen.divergence && !seen.until && needed > 0 && seen.steps[needed - 1].failed;
  return failed ? std::optional(needed - 1) : std::nullopt;
}

using RunAnswer = SequenceMemo::RunAnswer;

const RunAnswer* find_answer(const std::vector<RunAnswer>& known, const Evidence& seen,
                             std::optional<std::size_t> refuse_at) {
  const auto found = std::find_if(known.begin(), known.end(), [&](const RunAnswer& each) {
    return each.refuse_at == refuse_at && each.steps == seen.steps && each.states == seen.states;
  });
  return found == known.end() ? nullptr : &*found;
}

}  // namespace

Verdict verify(const std::string& text, const std::vector<Evidence>& evidence,
               const std::vector<Evidence>& further, const Context& context, SequenceMemo* memo) {
  Verdict out;
  std::vector<RunAnswer> unkept;
  auto& answers = memo == nullptr ? unkept : memo->of_runs[text];
  const auto* of_sequences = memo == nullptr ? nullptr : memo->find(text);
  std::size_t horizon = 1;
  bool all_known = of_sequences != nullptr;
  for (const auto& seen : evidence) {
    if (find_answer(answers, seen, step_to_refuse(seen)) != nullptr) continue;
    horizon = std::max(horizon, seen.steps.size());
    all_known = false;
  }
  for (const auto& seen : further) {
    if (of_sequences == nullptr) horizon = std::max(horizon, seen.steps.size());
  }
  std::optional<HeldModel> model;
  if (!all_known) {
    model.emplace(text, horizon, context);
    if (!model->is_right()) {
      out.why = "no right model: " + model->why_not();
      return out;
    }
  }
  std::vector<Evidence> whole;
  for (const auto& seen : evidence) {
    const auto refuse_at = step_to_refuse(seen);
    const auto* known = find_answer(answers, seen, refuse_at);
    if (known == nullptr) {
      RunAnswer asked{seen.steps, seen.states, refuse_at, {}, true};
      asked.answer = model->ask(seen, refuse_at, asked.strictly);
      answers.push_back(std::move(asked));
      known = &answers.back();
    }
    const auto answer = known->answer;
    const bool strictly = known->strictly;
    if (answer.stopped) answers.pop_back();
    if (answer.stopped || !answer.start || answer.reached < seen.needed()) {
      out.why = answer.stopped ? "stopped"
                               : fmt::format("run {} at {}", seen.ids.front(), answer.reached + 1);
      return out;
    }
    if (answer.whole) {
      out.runs_whole += seen.runs();
      if (!answer.refused && !strictly) out.runs_undemanded += seen.runs();
      if (!answer.refused) whole.push_back(seen);
    }
    if (answer.reached >= seen.seen_to()) out.runs_consistent += seen.runs();
    out.refuses = out.refuses || answer.refused;
  }
  out.admits = true;
  if (of_sequences != nullptr) {
    out.validated = of_sequences->validated;
    out.refuted_by = of_sequences->refuted_by;
    out.leaves_open = of_sequences->leaves_open;
    return out;
  }
  validate(*model, further, out);
  out.leaves_open = model->left_open(whole);
  if (out.leaves_open.empty()) out.leaves_open = model->left_open(further);
  if (memo != nullptr && !context.stopped()) {
    memo->by_text.insert_or_assign(
        text, SequenceMemo::Said{out.validated, out.refuted_by, out.leaves_open});
  }
  return out;
}

void hold_against(const std::string& text, const std::vector<Evidence>& fresh,
                  const Context& context, Verdict& verdict) {
  const auto held = verify(text, {}, fresh, context);
  verdict.fresh_right = held.validated;
  if (!held.refuted_by.empty()) verdict.refuted_by = held.refuted_by;
  if (verdict.leaves_open.empty()) verdict.leaves_open = held.leaves_open;
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
