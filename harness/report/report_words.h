#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/campaign/campaign_result.h"

namespace parallax::harness {

/// Wording shared by the reports of a run for people.

/// `text` in a colour of the terminal, as an SGR code: "1;31".
std::string painted(std::string_view text, const char* color, bool is_on);
/// "no discrepancy found", "discrepancy", "inconclusive", in its colour.
std::string verdict_word(CampaignVerdict verdict, bool color);
/// "the plan fails with grasp-failed"
std::string end_of(PathEnd end, const std::string& detail);
inline constexpr auto kRepeatResultWords =
    base::word_table<RepeatResult>("bit-equal", "differs", "lost");
constexpr std::string_view confirmation_key(RepeatResult confirmation) {
  return kRepeatResultWords.of(confirmation);
}
/// "repeated bit for bit"
std::string confirmation(const Discrepancy& found);
/// "stopped before all were explored"
std::string exploration_text(const CampaignResult& result);
/// "4 of 4 performs, 5 of 8 branches"; empty if it was not looked at.
std::string coverage_shares_text(const CampaignResult& result);
/// "of several kinds (--mixed), not repeated bit for bit: 80 simulations by 5f2c.../81d0..., ..."
std::string kinds_text(const std::vector<KindCount>& kinds);
/// "12 runs, 30 % (95 % interval 21.2 to 40.1 %)"
std::string rate_words(const LoopResult& loop, const CauseRate& rate);
/// "12 of 14 behaviours of plan and model were shown; each of the others comes ..."
std::string cover_text(const CoverResult& cover);
/// "of the solver (2), it ended during `act` (1)": how many were lost by reason
std::string loss_words(const std::vector<LossCount>& losses);
/// Adds the counts of one trace to those of others.
void add_losses(const std::vector<LossCount>& losses, std::vector<LossCount>& all);
/// "Go(r2) (fetch.lisp:4)"
std::string event_at(const CampaignTrace& trace, std::size_t t);

}  // namespace parallax::harness
