#include "harness/report/report_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/base/words.h"
#include "harness/confidence/rounding.h"

namespace parallax::harness {

std::string painted(std::string_view text, const char* color, bool is_on) {
  return is_on ? fmt::format("\x1b[{}m{}\x1b[0m", color, text) : std::string(text);
}

std::string verdict_word(CampaignVerdict verdict, bool color) {
  switch (verdict) {
    case CampaignVerdict::kNoDiscrepancy:
      return painted("no discrepancy found", "1;32", color);
    case CampaignVerdict::kDiscrepancy:
      return painted("discrepancy", "1;31", color);
    case CampaignVerdict::kInconclusive:
      break;
  }
  return painted("inconclusive", "1;33", color);
}

std::string end_of(PathEnd end, const std::string& detail) {
  switch (end) {
    case PathEnd::kDone:
      return "the plan is done";
    case PathEnd::kFailed:
      return fmt::format("the plan fails with {}", detail);
    case PathEnd::kCut:
      return fmt::format("unrolled no further: {}", detail);
    case PathEnd::kPerformLimit:
    case PathEnd::kTimeLimit:
    case PathEnd::kUnboundReason:
    case PathEnd::kUnnamedObject:
      break;
  }
  return fmt::format("ended by {}", to_string(end));
}

std::string confirmation(const Discrepancy& found) {
  switch (found.confirmation) {
    case RepeatResult::kBitEqual:
      return "repeated bit for bit";
    case RepeatResult::kDiffers:
      return "NOT repeatable: the simulator is not deterministic";
    case RepeatResult::kLost:
      break;
  }
  return "not repeated: the simulator was lost";
}

std::string exploration_text(const CampaignResult& result) {
  return result.exploration == "stopped" ? "stopped before all were explored" : result.exploration;
}

std::string kinds_text(const std::vector<KindCount>& kinds) {
  std::vector<std::string> parts;
  for (const auto& one : kinds) {
    parts.push_back(fmt::format("{} {} by {}", one.simulations,
                                base::agreed(one.simulations, "simulation", "simulations"),
                                one.kind));
  }
  return fmt::format("of {} (--mixed), not repeated bit for bit: {}",
                     kinds.size() == 1 ? "one kind" : "several kinds", fmt::join(parts, ", "));
}

std::string coverage_shares_text(const CampaignResult& result) {
  std::string out;
  for (const auto& share : result.coverage) {
    if (!out.empty()) out += ", ";
    out += fmt::format("{} of {} {}", share.covered, share.all, share.group);
  }
  return out;
}

std::string rate_words(const LoopResult& loop, const CauseRate& rate) {
  return fmt::format("{}, {} ({} interval {})", base::counted(rate.count, "run", "runs"),
                     percent_about(rate.rate), level_text(loop.causes_level),
                     percent_interval(rate.lower, rate.upper));
}

std::string cover_text(const CoverResult& cover) {
  using End = CoverResult::End;
  const auto left = std::ssize(cover.left);
  if (cover.items == 0) return "plan and model have nothing to show";
  auto text = left == 0 ? fmt::format("all of {} of plan and model",
                                      base::counted(cover.items, "behaviour", "behaviours"))
                        : fmt::format("{} of {} of plan and model", cover.items - left,
                                      base::counted(cover.items, "behaviour", "behaviours"));
  if (left == 0) return text;
  if (cover.bound < 1.0) {
    text += fmt::format("; {} comes in fewer than {} of executions ({} confidence{}, {})",
                        left == 1 ? "the other one" : "each of the others", percent_up(cover.bound),
                        level_text(cover.confidence), left == 1 ? "" : " in all of them together",
                        base::counted(cover.drawn + cover.lost, "execution with a drawn start",
                                      "executions with a drawn start"));
  }
  if (cover.end == End::kRunLimit) {
    text += fmt::format("; max_runs came before that was {}", percent_up(cover.epsilon));
  }
  if (cover.end == End::kStopped) text += "; the run was ended before that was settled";
  return text;
}

std::string loss_words(const std::vector<LossCount>& losses) {
  std::string out;
  for (const auto& one : losses) {
    out += fmt::format("{}{} ({})", out.empty() ? "" : ", ", one.kind, one.count);
  }
  return out;
}

void add_losses(const std::vector<LossCount>& losses, std::vector<LossCount>& all) {
  for (const auto& one : losses) {
    const auto known = std::find_if(all.begin(), all.end(),
                                    [&](const auto& other) { return other.kind == one.kind; });
    if (known == all.end()) {
      all.push_back(one);
    } else {
      known->count += one.count;
    }
  }
}

std::string event_at(const CampaignTrace& trace, std::size_t t) {
  const auto& source = trace.plan[t].source;
  return trace.event(t) + (source.empty() ? "" : fmt::format(" ({})", source));
}

}  // namespace parallax::harness
