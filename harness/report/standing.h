#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/campaign/campaign_result.h"
#include "harness/campaign/second_opinion.h"

namespace parallax::harness {

/// Whether a discrepancy shows elsewhere than in the simulation that found it: repeated with other
/// seeds and half the step (`parallax confirm`), or in another simulator (`--second-opinion`).
enum class Standing : std::uint8_t {
  kNotAsked,  // nobody was asked, or nobody answered
  kStands,    // it shows there as well
  kInDoubt,   // it does not
};
inline constexpr auto kStandingWords =
    base::word_table<Standing>("not-asked", "stands", "in-doubt");
constexpr std::string_view to_string(Standing standing) { return kStandingWords.of(standing); }
/// kNotAsked for any other word.
constexpr Standing standing_named(std::string_view word) {
  return kStandingWords.find(word).value_or(Standing::kNotAsked);
}

/// A standing with the clause that goes with it below a headline.
struct DiscrepancyStanding {
  Standing is = Standing::kNotAsked;
  std::string words;  // "in doubt: mujoco agrees with the model"
};

/// Joins two opinions: a doubt of either is a doubt, and one that was not asked does not count.
DiscrepancyStanding both_standings(const DiscrepancyStanding& a, const DiscrepancyStanding& b);

/// The standing of a discrepancy about which nobody was asked, with the command that asks.
/// `is_first`: of the run, so that the command need not name the simulation.
DiscrepancyStanding standing_not_asked(const std::string& run_dir, std::int64_t trace,
                                       std::int64_t sample, bool is_first);

/// The standing of a discrepancy of the run, by its second opinion.
DiscrepancyStanding standing_of(const CampaignResult& result, const Discrepancy& found);

/// The discrepancies of a run in the order in which they are told: those in doubt come last, so
/// that none of them stands in the headline of a run that has another one.
std::vector<const Discrepancy*> headline_order(const CampaignResult& result);

/// The name of a discrepancy in a headline.
inline constexpr auto kStandingHeadlines = base::word_table<Standing>(
    "discrepancy, not confirmed", "discrepancy, confirmed", "discrepancy in doubt");
constexpr std::string_view headline_word(Standing standing) {
  return kStandingHeadlines.of(standing);
}

/// The verdict of a run in its colour, as its headline has it: of a discrepancy with its standing.
std::string headline_verdict(const CampaignResult& result, bool color);

}  // namespace parallax::harness
