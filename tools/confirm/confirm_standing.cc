// The standing of a discrepancy in headlines, after a confirmation.

#include <fmt/format.h>

#include "tools/confirm/confirm.h"

namespace parallax::tools {
namespace {

using harness::Persistence;
using harness::Standing;

/// "it happens in 5 of 5 runs with other seeds and in 0 of 5 with half the step"; empty where none
/// of them tells.
std::string repetition_counts(const Confirmation& confirmation) {
  std::string out;
  const auto add = [&](const std::optional<Persistence>& seen, std::string_view with) {
    if (!seen || seen->runs == 0) return;
    out += fmt::format("{} in {} of {}{} with {}", out.empty() ? "it happens" : " and",
                       seen->failures, seen->runs, out.empty() ? " runs" : "", with);
  };
  add(confirmation.other_seeds, confirmation.has_seeds ? "other seeds" : "the same start");
  add(confirmation.half_step, "half the step");
  return out;
}

}  // namespace

harness::DiscrepancyStanding standing_of(const Confirmation& confirmation) {
  switch (confirmation.verdict()) {
    case ConfirmVerdict::kOpen:
      return {Standing::kNotAsked, "not confirmed: no repetition was simulated"};
    case ConfirmVerdict::kNotRepeated:
      return {Standing::kInDoubt, "in doubt: the same start and seed do not always show it"};
    case ConfirmVerdict::kSeed:
      // Chance is part of a world that is a model.
      if (confirmation.world_is_model) {
        return {Standing::kStands,
                fmt::format("confirmed: the world's model leaves it open, and {}",
                            repetition_counts(confirmation))};
      }
      return {Standing::kInDoubt, "in doubt: " + repetition_counts(confirmation)};
    case ConfirmVerdict::kStep:
      return {Standing::kInDoubt, "in doubt: " + repetition_counts(confirmation)};
    case ConfirmVerdict::kConfirmed:
    case ConfirmVerdict::kPartly:
      break;
  }
  if (const auto seen = repetition_counts(confirmation); !seen.empty()) {
    return {Standing::kStands, "confirmed: " + seen};
  }
  return {Standing::kNotAsked,
          "not confirmed: the same start and seed show it again, and no run with other seeds or "
          "half the step tells"};
}

}  // namespace parallax::tools
