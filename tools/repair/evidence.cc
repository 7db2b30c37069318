#include "tools/repair/evidence.h"

#include <algorithm>

#include "compiler/base/ground_name.h"
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

/// Can it go on like that up to `t`?
bool EvidenceAdmission::possible(const Evidence& evidence, std::size_t t,
                                 std::optional<std::size_t> without, Answer& answer) {
  const auto status = goes(evidence, t, without);
  answer.stopped = answer.stopped || status == SolveStatus::kUnknown;
  return status == SolveStatus::kSatisfiable;
}

/// Does the model forbid the event by itself in the state before it, and go on without it?
bool EvidenceAdmission::refuses(const Evidence& evidence, std::size_t step, Answer& answer) {
  const auto t = step + 1;
  const auto with = facts(evidence, t, t, std::nullopt);
  if (with && session_.solve(static_cast<Timepoint>(t), *with) != SolveStatus::kUnsatisfiable) {
    return false;
  }
  return possible(evidence, t, step, answer);
}

EvidenceAdmission::Answer EvidenceAdmission::ask(const Evidence& evidence,
                                                 std::optional<std::size_t> refuse_at) {
  Answer answer;
  const auto last = evidence.steps.size();
  if (possible(evidence, last, std::nullopt, answer)) {
    answer.reached = last;
    answer.whole = true;
    return answer;
  }
  // The first timepoint that it cannot reach, of which the last is one.
  const auto first_impossible = [&](std::size_t from, std::optional<std::size_t> without) {
    auto beyond = last;
    while (from < beyond && !answer.stopped) {
      const auto middle = from + (beyond - from) / 2;
      if (possible(evidence, middle, without, answer)) {
        from = middle + 1;
      } else {
        beyond = middle;
      }
    }
    return beyond;
  };
  const auto t = first_impossible(0, std::nullopt);
  if (t == 0) answer.start = false;
  if (t > 0) answer.reached = t - 1;
  if (t == 0 || refuse_at != t - 1 || answer.stopped) return answer;
  if (!refuses(evidence, t - 1, answer)) return answer;
  answer.refused = true;
  answer.whole = possible(evidence, last, t - 1, answer);
  answer.reached = answer.whole ? last : first_impossible(t, t - 1) - 1;
  return answer;
}

EvidenceAdmission::Answer EvidenceAdmission::ask_whole(const Evidence& evidence,
                                                       std::optional<std::size_t> refuse_at) {
  Answer answer;
  const auto last = evidence.steps.size();
  answer.whole = possible(evidence, last, std::nullopt, answer);
  if (answer.whole || answer.stopped || !refuse_at) return answer;
  // It may go on without the event only if it comes to it, and no further.
  const auto at = *refuse_at;
  answer.refused = (at + 1 == last || !possible(evidence, at + 1, std::nullopt, answer)) &&
                   possible(evidence, at, std::nullopt, answer) && refuses(evidence, at, answer);
  answer.whole = answer.refused && (at + 1 == last || possible(evidence, last, at, answer));
  return answer;
}

std::optional<std::string> EvidenceAdmission::left_open(const Evidence& evidence,
                                                        const std::set<std::string>& symbols) {
  const auto of_these = [&](const auto& each) {
    return symbols.contains(base::symbol_of(each.first));
  };
  const bool failed = !evidence.steps.empty() && evidence.steps.back().failed;
  const auto last = evidence.steps.size() - (failed ? 1 : 0);
  auto others = evidence;
  for (auto& state : others.states) std::erase_if(state, of_these);
  auto known = facts(others, last, last + 1, std::nullopt);
  if (!known) return std::nullopt;
  for (std::size_t t = 0; t <= last; ++t) {
    for (const auto& each : evidence.states[t]) {
      if (!of_these(each)) continue;
      const auto literal = index_.find(AtomKind::kHoldsAt, each.first, static_cast<Timepoint>(t));
      if (!literal) continue;
      known->push_back(each.second ? ~*literal : *literal);
      const auto other = session_.solve(static_cast<Timepoint>(last), *known);
      known->pop_back();
      if (other == SolveStatus::kSatisfiable) return each.first;
    }
  }
  return std::nullopt;
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
