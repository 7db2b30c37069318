#include "tools/repair/evidence.h"

#include <algorithm>

#include "runtime/enumerate/path_admission.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::Literal;
using compiler::Timepoint;
using runtime::SolveStatus;

std::vector<Evidence> evidence_of(const std::vector<ObservedPath>& paths,
                                  const compiler::CompiledModel& model) {
  std::vector<Evidence> out;
  for (const auto& path : paths) {
    Evidence seen;
    seen.executed = path.executed;
    for (const auto& step : path.steps) {
      const bool failed = step.outcome.status != harness::SimStatus::kOk;
      seen.steps.push_back({step.name, failed, failed ? harness::reason_word(step.outcome) : ""});
    }
    for (std::size_t t = 0; t < path.states.size(); ++t) {
      auto& state = seen.states.emplace_back();
      for (const auto& [fluent, holds] : path.states[t]) {
        state.emplace(model.fluents[fluent.index()].name, holds);
      }
    }
    const auto id = (path.experiment ? "e" : "") + std::to_string(path.id.trace) + "." +
                    std::to_string(path.id.sample);
    const auto same = std::find_if(out.begin(), out.end(), [&](const auto& other) {
      return other.executed == seen.executed && other.steps == seen.steps &&
             other.states == seen.states;
    });
    if (same != out.end()) {
      same->ids.push_back(id);
    } else {
      seen.ids = {id};
      out.push_back(std::move(seen));
    }
  }
  return out;
}

bool add_states(const compiler::AtomIndex& index, const Evidence& evidence, std::size_t states,
                std::vector<Literal>& out) {
  for (std::size_t t = 0; t < states; ++t) {
    for (const auto& [fluent, holds] : evidence.states[t]) {
      const auto literal = index.find(AtomKind::kHoldsAt, fluent, static_cast<Timepoint>(t));
      if (!literal && holds) return false;
      if (literal) out.push_back(holds ? *literal : ~*literal);
    }
  }
  return true;
}

EvidenceAdmission::EvidenceAdmission(const compiler::CompiledModel& model,
                                     const std::atomic<bool>& stop)
    : session_(model, runtime::make_cadical_solver(&stop)),
      index_(model),
      undemanded_(runtime::undemanded_events(model)) {}

std::optional<std::vector<Literal>> EvidenceAdmission::facts(const Evidence& evidence,
                                                             std::size_t steps, std::size_t states,
                                                             std::optional<std::size_t> without) {
  const auto& model = session_.model();
  std::vector<Literal> out;
  for (std::size_t i = 0; i < steps; ++i) {
    const auto t = static_cast<Timepoint>(i);
    const auto happens = index_.find(AtomKind::kHappens, evidence.steps[i].event, t);
    const bool wanted = without != i;
    if (wanted && !happens) return std::nullopt;
    if (happens) out.push_back(wanted ? *happens : ~*happens);
    // There may be further events that the model demands.
    for (const auto slot : undemanded_) {
      const auto literal = Literal::positive(model.variable(slot, t));
      if (!happens || literal != *happens) out.push_back(~literal);
    }
  }
  if (!add_states(index_, evidence, states, out)) return std::nullopt;
  return out;
}

SolveStatus EvidenceAdmission::goes(const Evidence& evidence, std::size_t t,
                                    std::optional<std::size_t> without) {
  const auto assumptions = facts(evidence, t, t + 1, without);
  if (!assumptions) return SolveStatus::kUnsatisfiable;
  return session_.solve(static_cast<Timepoint>(t), *assumptions);
}

EvidenceAdmission::Answer EvidenceAdmission::ask(const Evidence& evidence,
                                                 std::optional<std::size_t> refuse_at) {
  Answer answer;
  std::optional<std::size_t> without;
  const auto possible = [&](std::size_t t) {
    const auto status = goes(evidence, t, without);
    answer.stopped = answer.stopped || status == SolveStatus::kUnknown;
    return status == SolveStatus::kSatisfiable;
  };
  const auto last = evidence.steps.size();
  if (possible(last)) {
    answer.reached = last;
    answer.whole = true;
    return answer;
  }
  for (std::size_t t = 0; t <= last && !answer.stopped; ++t) {
    if (possible(t)) {
      answer.reached = t;
      continue;
    }
    if (t == 0) answer.start = false;
    if (t == 0 || refuse_at != t - 1 || answer.stopped) return answer;
    // Does the model forbid the event by itself in the state before it?
    const auto with = facts(evidence, t, t, std::nullopt);
    if (with && session_.solve(static_cast<Timepoint>(t), *with) != SolveStatus::kUnsatisfiable) {
      return answer;
    }
    without = t - 1;
    if (!possible(t)) return answer;
    answer.refused = true;
    answer.reached = t;
  }
  answer.whole = answer.reached == last;
  return answer;
}

Evidence::State EvidenceAdmission::impossible(const Evidence& evidence, std::size_t t) {
  Evidence::State out;
  const auto before = facts(evidence, t, t, std::nullopt);
  for (const auto& [fluent, holds] : evidence.states[t]) {
    const auto literal = index_.find(AtomKind::kHoldsAt, fluent, static_cast<Timepoint>(t));
    bool possible = literal || !holds;
    if (possible && literal && before) {
      auto with = *before;
      with.push_back(holds ? *literal : ~*literal);
      possible = session_.solve(static_cast<Timepoint>(t), with) != SolveStatus::kUnsatisfiable;
    }
    if (!possible) out.emplace(fluent, holds);
  }
  return out.empty() ? evidence.states[t] : out;
}

bool says_not_possible(const std::string& reason) { return reason == "not-possible"; }

}  // namespace parallax::tools
