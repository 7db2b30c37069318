#include "harness/campaign/second_opinion.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/loop_judge.h"
#include "harness/campaign/loop_stream.h"
#include "harness/confidence/clean_runs.h"

namespace parallax::harness {
namespace {

/// The starts and seeds of recorded simulations; the sample number is the place in the list, from
/// 1.
class StartsAgain final : public SampleMaker {
 public:
  using Make = std::function<std::optional<SampleRecord>(const SampleRecord&, Simulator&,
                                                         const std::function<bool()>&)>;
  StartsAgain(std::vector<OpinionQuestion> questions, Make make)
      : questions_(std::move(questions)), make_(std::move(make)) {}

  const std::vector<OpinionQuestion>& questions() const { return questions_; }

  std::optional<SampleRecord> make(std::int64_t sample, Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override {
    auto again =
        make_(questions_[static_cast<std::size_t>(sample - 1)].record, simulator, abandoned);
    if (!again) return again;
    again->sample = sample;
    again->phase = DrawPhase::kCertify;
    return again;
  }
  std::optional<SampleRecord> repeat(const SampleRecord& record, Simulator& simulator,
                                     const std::function<bool()>& abandoned) const override {
    return make_(record, simulator, abandoned);
  }

 private:
  std::vector<OpinionQuestion> questions_;
  Make make_;
};

/// The answer to one question.
struct OtherVerdict {
  OpinionAnswer answer = OpinionAnswer::kNone;
  std::string words;
};
using Judge = std::function<base::Result<std::optional<OtherVerdict>>(const SampleRecord&)>;

base::DiagnosticBuilder report_unseen(const Scenario& scenario, const std::string& variable,
                                      base::DiagnosticSink& sink) {
  return sink.error(codes::kSimulatorRefused, scenario.mapping_source,
                    "does not show what is compared for the second opinion",
                    fmt::format("its observations lack `{}`", variable));
}

/// Lets the workers make all of them and judges each in its turn.
base::Result<std::optional<std::vector<Opinion>>> ask(
    const std::shared_ptr<const StartsAgain>& maker, const Scenario& scenario,
    SimulatorBench& bench, const Judge& judge_one, base::DiagnosticSink& sink) {
  const auto& questions = maker->questions();
  for (std::size_t i = 0; i < questions.size(); ++i) {
    bench.pool().submit(maker, static_cast<std::int64_t>(i) + 1);
  }
  std::vector<Opinion> out;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const auto& question = questions[i];
    auto record = bench.pool().wait(static_cast<std::int64_t>(i) + 1, DrawPhase::kCertify);
    if (!record || bench.stopped()) return std::optional<std::vector<Opinion>>();
    record->start_state = question.record.start_state;
    if (record->status == SampleStatus::kRefused) {
      return sink.error(codes::kSimulatorRefused, scenario.actions_source,
                        fmt::format("refused the start or an action of simulation {}.{}",
                                    question.record.trace, question.record.sample),
                        record->reason);
    }
    Opinion opinion{question.record.trace, question.record.sample, question.found,
                    question.cause,        OpinionAnswer::kNone,   record->reason};
    if (record->status == SampleStatus::kOk) {
      auto verdict = judge_one(*record);
      if (!verdict) return sink.already_reported();
      if (!*verdict) return std::optional<std::vector<Opinion>>();
      opinion.answer = (*verdict)->answer;
      opinion.other = std::move((*verdict)->words);
    } else if (record->status == SampleStatus::kRejected) {
      opinion.other = "its start is not valid there: " + record->reason;
    } else {
      opinion.other = "it was lost: " + record->reason;
    }
    out.push_back(std::move(opinion));
  }
  return std::optional(std::move(out));
}

std::string other_start(const DivergingFluent& differs) {
  return fmt::format("it begins otherwise there: `{}` is {}", differs.fluent, differs.observed);
}

}  // namespace

std::int64_t SecondOpinion::count(bool found, OpinionAnswer answer) const {
  return std::count_if(opinions.begin(), opinions.end(), [&](const Opinion& one) {
    return one.found == found && one.answer == answer;
  });
}

double SecondOpinion::disagreement_upper() const {
  const auto parted =
      count(false, OpinionAnswer::kDiscrepancy) + count(false, OpinionAnswer::kNone);
  const auto all = parted + count(false, OpinionAnswer::kClean);
  return all == 0 ? 1.0 : clopper_pearson_upper(parted, all, level);
}

std::vector<OpinionQuestion> opinion_questions(const std::vector<SampleRow>& rows,
                                               const std::map<SampleKey, SampleRecord>& samples,
                                               std::int64_t clean) {
  std::vector<OpinionQuestion> out;
  std::map<std::int64_t, std::vector<const SampleRecord*>> clean_by_trace;
  for (const auto& row : rows) {
    const auto found = samples.find({row.trace, row.sample, DrawPhase::kCertify});
    if (found == samples.end()) continue;
    const std::string_view outcome = row.outcome;
    if (outcome == "discrepancy") out.push_back({found->second, true, row.cause});
    if (row.drawn && (outcome == "clean" || outcome == "admitted")) {
      clean_by_trace[row.trace].push_back(&found->second);
    }
  }
  std::vector<OpinionQuestion> chosen;
  for (std::size_t turn = 0, left = 1; left > 0; ++turn) {
    left = 0;
    for (const auto& [trace, records] : clean_by_trace) {
      if (turn >= records.size() || std::ssize(chosen) >= clean) continue;
      chosen.push_back({*records[turn], false, {}});
      ++left;
    }
  }
  const auto in_order = [](const OpinionQuestion& a, const OpinionQuestion& b) {
    return std::pair(a.record.trace, a.record.sample) < std::pair(b.record.trace, b.record.sample);
  };
  std::sort(out.begin(), out.end(), in_order);
  std::sort(chosen.begin(), chosen.end(), in_order);
  std::move(chosen.begin(), chosen.end(), std::back_inserter(out));
  return out;
}

base::Result<std::optional<std::vector<Opinion>>> opinions_on_traces(
    const Scenario& scenario, SimulatorBench& bench, TraceFeed& feed, const TracesOfRun& traces,
    std::vector<OpinionQuestion> questions, base::DiagnosticSink& sink) {
  auto calls = std::make_shared<std::map<std::int64_t, std::vector<ActionCall>>>();
  for (const auto& question : questions) {
    const auto number = question.record.trace;
    if (calls->contains(number)) continue;
    auto made = action_calls(scenario, *traces.at({number, 0}), sink);
    if (!made) return sink.already_reported();
    calls->emplace(number, *std::move(made));
  }
  const bool repeats_losses = may_repeat_losses(bench.simulator());
  const auto maker = std::make_shared<const StartsAgain>(
      std::move(questions),
      [calls, repeats_losses](const SampleRecord& record, Simulator& simulator,
                              const std::function<bool()>& abandoned) {
        return repeat_sample(calls->at(record.trace), repeats_losses, record, simulator, abandoned);
      });
  const auto comparison = scenario.comparison();
  const auto judge_one =
      [&](const SampleRecord& record) -> base::Result<std::optional<OtherVerdict>> {
    // Predicted from the initial state that the sample begins in, which need not be the first one.
    const auto own = traces.find({record.trace, record.start_state});
    const auto& trace = own == traces.end() ? *traces.at({record.trace, 0}) : *own->second;
    const auto judgement = judge(*scenario.mapping, bench.fluents(), trace, record.observations);
    if (!judgement.missing.empty()) {
      return report_unseen(scenario, *judgement.missing.begin(), sink);
    }
    if (judgement.first_divergence == 0) {
      return std::optional(
          OtherVerdict{OpinionAnswer::kNone, other_start(judgement.first.front())});
    }
    if (judgement.matches(comparison))
      return std::optional(OtherVerdict{OpinionAnswer::kClean, {}});
    const auto admitted = admitted_by_model(scenario, feed, trace, judgement);
    if (admitted == base::Known::kUndecided) return std::optional<OtherVerdict>();
    if (admitted == base::Known::kYes)
      return std::optional(OtherVerdict{OpinionAnswer::kClean, {}});
    return std::optional(OtherVerdict{
        OpinionAnswer::kDiscrepancy, cause_of(trace, judgement, comparison, record.outcomes).text});
  };
  return ask(maker, scenario, bench, judge_one, sink);
}

base::Result<std::optional<std::vector<Opinion>>> opinions_on_executions(
    const Scenario& scenario, SimulatorBench& bench, LoopFeed& feed, std::uint64_t seed,
    std::vector<OpinionQuestion> questions, base::DiagnosticSink& sink) {
  LoopStream stream(scenario, feed, bench, seed, sink);
  const auto prepared = stream.prepare();
  if (!prepared) return sink.already_reported();
  if (!*prepared) return std::optional<std::vector<Opinion>>();
  const auto samples = stream.samples();
  const auto maker = std::make_shared<const StartsAgain>(
      std::move(questions), [samples](const SampleRecord& record, Simulator& simulator,
                                      const std::function<bool()>& abandoned) {
        return samples->make_at(record, record.sample, record.initial, simulator, abandoned);
      });
  const auto judge_one =
      [&](const SampleRecord& record) -> base::Result<std::optional<OtherVerdict>> {
    const auto& mapping = *scenario.mapping;
    const auto first = judge(mapping, bench.fluents(), *samples->start_of(record).state,
                             {record.observations.front()});
    if (first.missing.empty() && first.first_divergence) {
      return std::optional(OtherVerdict{OpinionAnswer::kNone, other_start(first.first.front())});
    }
    const auto judgement =
        judge_path(mapping, bench.fluents(), feed, record, scenario.comparison());
    if (!judgement.missing.empty()) return report_unseen(scenario, judgement.missing, sink);
    if (judgement.admitted == base::Known::kUndecided) return std::optional<OtherVerdict>();
    if (judgement.admitted == base::Known::kNo) {
      return std::optional(OtherVerdict{OpinionAnswer::kDiscrepancy, judgement.cause.text});
    }
    const auto end = record.path->end;
    if (end != PathEnd::kDone && end != PathEnd::kFailed) {
      return std::optional(OtherVerdict{OpinionAnswer::kNone, "the execution did not end there"});
    }
    return std::optional(OtherVerdict{OpinionAnswer::kClean, {}});
  };
  return ask(maker, scenario, bench, judge_one, sink);
}

}  // namespace parallax::harness
