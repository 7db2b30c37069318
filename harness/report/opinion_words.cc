#include "harness/report/opinion_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/base/json.h"
#include "compiler/base/words.h"
#include "harness/confidence/rounding.h"
#include "harness/report/report_words.h"

namespace parallax::harness {
namespace {

/// "ode" of "ode 0.16.2".
std::string name_of(const std::string& simulator) {
  return simulator.substr(0, simulator.find(' '));
}

std::string cause_sentence(const SecondOpinion& opinion, const CauseOpinion& of) {
  const auto first = name_of(opinion.first), other = name_of(opinion.other);
  const auto runs = [](std::int64_t count) {
    return base::counted(count, "simulation", "simulations");
  };
  std::string text;
  switch (of.doubt()) {
    case CauseOpinion::Doubt::kModel:
      text = fmt::format(
          "{}: both engines disagree with the model, {} and {}, in {}: the model is wrong",
          of.cause, first, other, runs(of.both));
      break;
    case CauseOpinion::Doubt::kSimulator:
      text = fmt::format(
          "{}: only {} does, in {} in which {} agrees with the model: the simulator is in doubt "
          "(parameters, contact model)",
          of.cause, first, runs(of.only), other);
      break;
    case CauseOpinion::Doubt::kEither:
      text = fmt::format(
          "{}: both engines disagree with the model in {}, only {} in {}: as often as both do the "
          "model is wrong, beyond that the simulator is in doubt (parameters, contact model)",
          of.cause, runs(of.both), first, runs(of.only));
      break;
    case CauseOpinion::Doubt::kNoAnswer:
      text = fmt::format("{}: {} gave no answer", of.cause, other);
      break;
  }
  if (!of.others.empty() && of.others != std::vector<std::string>{of.cause}) {
    text += fmt::format("; in {}: {}", other, fmt::join(of.others, "; "));
  }
  if (of.unanswered > 0) {
    text += fmt::format("; without an answer in {} ({})", runs(of.unanswered), of.why_unanswered);
  }
  return text;
}

std::string clean_sentence(const SecondOpinion& opinion) {
  const auto first = name_of(opinion.first), other = name_of(opinion.other);
  const auto clean = opinion.count(false, OpinionAnswer::kClean);
  const auto parted = opinion.count(false, OpinionAnswer::kDiscrepancy);
  const auto none = opinion.count(false, OpinionAnswer::kNone);
  const auto all = clean + parted + none;
  if (all == 0)
    return fmt::format("no simulation was clean in {}: nothing is said of those", first);
  auto text = fmt::format("of {} clean in {}, {} clean in {}",
                          base::counted(all, "simulation", "simulations"), first, clean, other);
  if (parted > 0) {
    text += fmt::format(", {} discrepancies of {} alone", parted, other);
    const auto at = std::find_if(
        opinion.opinions.begin(), opinion.opinions.end(),
        [](const auto& one) { return !one.found && one.answer == OpinionAnswer::kDiscrepancy; });
    text += fmt::format(" (such as {}.{}: {})", at->trace, at->sample, at->other);
  }
  if (none > 0) text += fmt::format(", {} without an answer", none);
  return text +
         fmt::format("; with {} confidence the engines part in less than {} of what is clean in {}",
                     level_text(opinion.level), percent_up(opinion.disagreement_upper()), first);
}

}  // namespace

CauseOpinion::Doubt CauseOpinion::doubt() const {
  if (both > 0 && only > 0) return Doubt::kEither;
  if (both > 0) return Doubt::kModel;
  return only > 0 ? Doubt::kSimulator : Doubt::kNoAnswer;
}

std::vector<CauseOpinion> opinions_by_cause(const SecondOpinion& opinion) {
  std::vector<CauseOpinion> out;
  for (const auto& one : opinion.opinions) {
    if (!one.found) continue;
    auto known = std::find_if(out.begin(), out.end(),
                              [&](const auto& other) { return other.cause == one.cause; });
    if (known == out.end()) {
      known = out.insert(out.end(), CauseOpinion{});
      known->cause = one.cause;
      known->trace = one.trace;
      known->sample = one.sample;
    }
    if (one.answer == OpinionAnswer::kClean) ++known->only;
    if (one.answer == OpinionAnswer::kNone && known->unanswered++ == 0)
      known->why_unanswered = one.other;
    if (one.answer != OpinionAnswer::kDiscrepancy) continue;
    ++known->both;
    if (std::find(known->others.begin(), known->others.end(), one.other) == known->others.end()) {
      known->others.push_back(one.other);
    }
  }
  return out;
}

std::vector<std::string> opinion_sentences(const SecondOpinion& opinion) {
  std::vector<std::string> out;
  for (const auto& cause : opinions_by_cause(opinion))
    out.push_back(cause_sentence(opinion, cause));
  if (opinion.clean_asked > 0) out.push_back(clean_sentence(opinion));
  return out;
}

std::string opinion_json(const SecondOpinion& opinion) {
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson causes = OrderedJson::array(), each = OrderedJson::array();
  for (const auto& cause : opinions_by_cause(opinion)) {
    causes.push_back({{"cause", cause.cause},
                      {"doubt", to_string(cause.doubt())},
                      {"both", cause.both},
                      {"only_first", cause.only},
                      {"unanswered", cause.unanswered}});
  }
  for (const auto& one : opinion.opinions) {
    each.push_back({{"trace", one.trace},
                    {"sample", one.sample},
                    {"run", one.found ? "discrepancy" : "clean"},
                    {"answer", to_string(one.answer)}});
    if (one.found) each.back()["cause"] = one.cause;
    if (!one.other.empty()) each.back()["words"] = one.other;
  }
  const OrderedJson out = {{"first", opinion.first},
                           {"other", opinion.other},
                           {"causes", std::move(causes)},
                           {"clean",
                            {{"asked", opinion.clean_asked},
                             {"clean", opinion.count(false, OpinionAnswer::kClean)},
                             {"discrepancies", opinion.count(false, OpinionAnswer::kDiscrepancy)},
                             {"unanswered", opinion.count(false, OpinionAnswer::kNone)},
                             {"confidence", opinion.level},
                             {"disagreement_below", opinion.disagreement_upper()}}},
                           {"simulations", std::move(each)},
                           {"words", opinion_sentences(opinion)}};
  return base::json_text(out);
}

}  // namespace parallax::harness
