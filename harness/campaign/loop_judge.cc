#include "harness/campaign/loop_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <utility>

#include "harness/campaign/run_setup.h"
#include "harness/region/measured.h"

namespace parallax::harness {
namespace {

using base::Known;
using Fluents = LoopFeed::ObservedFluents;

class PathJudge {
 public:
  PathJudge(const StateMapping& mapping, const ModelFluents& fluents, LoopFeed& feed,
            const SampleRecord& record, Comparison comparison)
      : mapping_(mapping),
        fluents_(fluents),
        feed_(feed),
        record_(record),
        performs_(record.path->steps) {
    std::set<std::string> missing;
    seen_ = path_states(mapping, fluents, record, comparison, missing);
    for (const auto& seen : seen_) states_.push_back(seen.state.holds);
    if (!missing.empty()) out_.missing = *missing.begin();
  }

  LoopJudgement judge() {
    if (!out_.missing.empty()) return std::move(out_);
    const auto whole = performs_.size();
    out_.admitted = goes_up_to(whole);
    if (out_.admitted != Known::kNo) return std::move(out_);
    for (std::size_t length = 0; length <= whole; ++length) {
      const auto goes = length == whole ? Known::kNo : goes_up_to(length);
      if (goes == Known::kUndecided) return stopped();
      if (goes == Known::kNo) return parted_after(length);
    }
    return std::move(out_);
  }

 private:
  LoopJudgement stopped() {
    out_.admitted = Known::kUndecided;
    return std::move(out_);
  }

  Known ask(std::size_t performs, std::size_t outcomes, const std::vector<Fluents>& observed) {
    const auto answer = feed_.admits(performs_.first(performs), outcomes, observed);
    if (answer == Known::kUndecided) undecided_ = true;
    return answer;
  }

  std::vector<Fluents> states_before(std::size_t count) const {
    return {states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(count)};
  }

  /// Has the model the first `length` events with their outcomes and the states up to there?
  Known goes_up_to(std::size_t length) {
    for (std::size_t t = 0; t <= length; ++t) {
      if (seen_[t].state.in_no_state) return Known::kNo;
    }
    return ask(length, length, states_before(length + 1));
  }

  /// Finds what the model admits instead, where the first `length` events are too many.
  LoopJudgement parted_after(std::size_t length) {
    auto& divergence = out_.divergence;
    divergence.event = static_cast<std::int64_t>(length) - 1;
    auto outcomes = length;
    auto before = states_before(length);
    if (length > 0 && ask(length, length, before) == Known::kNo) {
      divergence.outcome = true;
      --outcomes;
      divergence.impossible = ask(length, outcomes, before) == Known::kNo;
      // In that case the state before tells what else there could be.
    }
    if (!divergence.impossible) note_fluents(length, outcomes, std::move(before));
    note_kind(length);
    if (undecided_) return stopped();
    note_cause(length);
    return std::move(out_);
  }

  bool possible(std::size_t length, std::size_t outcomes, const std::vector<Fluents>& before,
                Fluents state) {
    auto observed = before;
    observed.push_back(std::move(state));
    return ask(length, outcomes, observed) != Known::kNo;
  }

  void note(compiler::FluentId id, std::size_t length, bool observed) {
    out_.fluents.push_back({feed_.symbols()->name(id), static_cast<std::int64_t>(length), !observed,
                            observed,
                            measured_text(mapping_, ground_fluent(feed_.symbols()->name(id)),
                                          record_.observations[length])});
  }

  void note_fluents(std::size_t length, std::size_t outcomes, std::vector<Fluents> before) {
    const auto& seen = seen_[length];
    for (std::size_t i = 0; i < fluents_.ground().size(); ++i) {
      const auto id = fluents_.id(i);
      const auto found = seen.state.holds.find(id);
      if (found != seen.state.holds.end()) {
        if (!possible(length, outcomes, before, {{id, found->second}})) {
          note(id, length, found->second);
        }
      } else if (std::find(seen.neither.begin(), seen.neither.end(), id) != seen.neither.end()) {
        // It differs from both; what is said is that it is not what the model can have.
        note(id, length, !possible(length, outcomes, before, {{id, true}}));
      }
    }
    for (const auto& text : seen.outside) {
      // Where the model has the body somewhere, that fluent differs already.
      const auto inside = [&](const DivergingFluent& fluent) {
        return fluent.predicted && mapping_.outside_text(ground_fluent(fluent.fluent)) == text;
      };
      if (std::any_of(out_.fluents.begin(), out_.fluents.end(), inside)) continue;
      out_.fluents.push_back({text, static_cast<std::int64_t>(length), false, true});
    }
    if (!out_.fluents.empty() || out_.divergence.outcome) return;
    note_together(length, outcomes, before);
  }

  /// Each value is possible, all together are not: leaves out what is not needed for that.
  void note_together(std::size_t length, std::size_t outcomes, const std::vector<Fluents>& before) {
    out_.divergence.together = true;
    auto needed = states_[length];
    for (std::size_t i = 0; i < fluents_.ground().size(); ++i) {
      auto fewer = needed;
      if (fewer.erase(fluents_.id(i)) == 0) continue;
      if (!possible(length, outcomes, before, fewer)) needed = std::move(fewer);
    }
    for (const auto& [id, holds] : needed) note(id, length, holds);
  }

  /// Has the model these events and outcomes with this start and this end?
  void note_kind(std::size_t length) {
    const auto whole = performs_.size();
    if (length == whole || out_.divergence.outcome || seen_.back().state.in_no_state) return;
    std::vector<Fluents> ends(states_.size());
    ends.front() = states_.front();
    ends.back() = states_.back();
    if (ask(whole, whole, ends) == Known::kYes) out_.kind = DiscrepancyKind::kTransient;
  }

  void note_cause(std::size_t length) {
    out_.cause = {"start"};
    if (length > 0) name_cause(length);
    for (const auto& fluent : out_.fluents) out_.cause.fluents.push_back(fluent.fluent);
  }

  void name_cause(std::size_t length) {
    const auto& step = performs_[length - 1];
    const auto& outcome = record_.outcomes[length - 1];
    if (outcome.status != SimStatus::kOk) {
      out_.cause = {fmt::format("{}: {}", step.event, reason_word(outcome)), outcome.reason};
    } else if (out_.divergence.impossible) {
      out_.cause = {fmt::format("{}: happens", step.event)};
    } else if (out_.divergence.outcome && !step.object.empty()) {
      out_.cause = {fmt::format("{}: found {}", step.event, step.object)};
    } else if (out_.divergence.outcome) {
      out_.cause = {fmt::format("{}: {}", step.event, step.succeeded ? "succeeds" : "fails")};
    } else {
      const auto& first = out_.fluents.front();
      out_.cause = {
          fmt::format("{}: {}{}", step.event, first.observed ? "" : "not ", first.fluent)};
    }
    out_.cause.event = step.event;
  }

  const StateMapping& mapping_;
  const ModelFluents& fluents_;
  LoopFeed& feed_;
  const SampleRecord& record_;
  std::span<const PathStep> performs_;
  std::vector<LoopState> seen_;  // by timepoint
  std::vector<Fluents> states_;  // what is compared of them
  bool undecided_ = false;
  LoopJudgement out_;
};

}  // namespace

std::vector<LoopState> path_states(const StateMapping& mapping, const ModelFluents& fluents,
                                   const SampleRecord& record, Comparison comparison,
                                   std::set<std::string>& missing) {
  std::vector<LoopState> states;
  const auto last = record.observations.size() - 1;
  for (std::size_t t = 0; t <= last; ++t) {
    const auto moment = moment_at(t, last);
    auto& seen =
        states.emplace_back(loop_state(mapping, fluents, record.observations[t], moment, &missing));
    if (moment == Moment::kOnTheWay && comparison == Comparison::kFinal) seen = {};
  }
  return states;
}

LoopJudgement judge_path(const StateMapping& mapping, const ModelFluents& fluents, LoopFeed& feed,
                         const SampleRecord& record, Comparison comparison) {
  return PathJudge(mapping, fluents, feed, record, comparison).judge();
}

Discrepancy path_discrepancy(const SampleRecord& record, const LoopJudgement& judgement,
                             const SampleRecord& again) {
  Discrepancy found;
  found.kind = judgement.kind;
  found.trace = record.trace;
  found.sample = record.sample;
  found.seed = record.seed;
  found.first_divergence = judgement.divergence.event + 1;
  found.first = judgement.fluents;
  if (judgement.kind == DiscrepancyKind::kLasting) found.fluents = judgement.fluents;
  found.cause = judgement.cause;
  found.confirmation = confirmation_of(record, again);
  found.path = judgement.divergence;
  found.record = record;
  return found;
}

}  // namespace parallax::harness
