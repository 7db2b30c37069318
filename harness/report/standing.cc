#include "harness/report/standing.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/report/report_words.h"
#include "harness/report/text_layout.h"

namespace parallax::harness {
DiscrepancyStanding both_standings(const DiscrepancyStanding& a, const DiscrepancyStanding& b) {
  if (b.is == Standing::kNotAsked) return a;
  if (a.is == Standing::kNotAsked) return b;
  const auto &first = b.is == Standing::kInDoubt ? b : a, &second = &first == &a ? b : a;
  return {first.is, first.words + "; " + second.words};
}

DiscrepancyStanding standing_not_asked(const std::string& run_dir, std::int64_t trace,
                                       std::int64_t sample, bool is_first) {
  return {Standing::kNotAsked,
          fmt::format("not confirmed: `parallax confirm {}{}` repeats it with other seeds and half "
                      "the step",
                      shell_word(run_dir),
                      is_first ? "" : fmt::format(" --sample {}.{}", trace, sample))};
}

DiscrepancyStanding standing_of(const CampaignResult& result, const Discrepancy& found) {
  const auto& first = result.discrepancies.front();
  auto out = standing_not_asked(result.replay_folder, found.trace, found.sample,
                                found.trace == first.trace && found.sample == first.sample);
  if (!result.second_opinion) return out;
  const auto& opinion = *result.second_opinion;
  const auto other = opinion.other.substr(0, opinion.other.find(' '));
  for (const auto& one : opinion.opinions) {
    if (!one.found || one.trace != found.trace || one.sample != found.sample) continue;
    switch (one.answer) {
      case OpinionAnswer::kDiscrepancy:
        return {Standing::kStands,
                fmt::format("confirmed: {} disagrees with the model as well", other)};
      case OpinionAnswer::kClean:
        return {Standing::kInDoubt, fmt::format("in doubt: {} agrees with the model", other)};
      case OpinionAnswer::kNone:
        break;
    }
    out.words += fmt::format("; {} gave no answer", other);
    break;
  }
  return out;
}

std::vector<const Discrepancy*> headline_order(const CampaignResult& result) {
  std::vector<const Discrepancy*> out;
  for (const auto& found : result.discrepancies) out.push_back(&found);
  std::stable_partition(out.begin(), out.end(), [&](const Discrepancy* one) {
    return standing_of(result, *one).is != Standing::kInDoubt;
  });
  return out;
}

std::string headline_verdict(const CampaignResult& result, bool color) {
  if (result.verdict != CampaignVerdict::kDiscrepancy || result.discrepancies.empty()) {
    return verdict_word(result.verdict, color);
  }
  const auto is = standing_of(result, *headline_order(result).front()).is;
  return painted(headline_word(is), is == Standing::kInDoubt ? "1;33" : "1;31", color);
}

}  // namespace parallax::harness
