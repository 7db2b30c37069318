#include <fmt/format.h>

#include "harness/report/report.h"
#include "harness/report/text_layout.h"

namespace parallax::harness {

std::string replay_text(const ReplayResult& result, const ReportStyle& style) {
  const auto paint = [&](std::string_view text, const char* color) {
    return style.color ? fmt::format("\x1b[{}m{}\x1b[0m", color, text) : std::string(text);
  };
  const auto head =
      fmt::format("simulation {}.{}, seed {}: ", result.id.trace, result.id.sample, result.seed);
  switch (result.outcome) {
    case ReplayOutcome::kIdentical:
      return head + paint("identical", "1;32") +
             fmt::format(", {} {} compared bit for bit{}\n", result.timepoints,
                         result.timepoints == 1 ? "observation" : "observations",
                         result.digest.empty() ? "" : ", digest " + result.digest);
    case ReplayOutcome::kCannot:
      return head + paint("cannot be repeated", "1;33") + '\n' + wrapped("  ", result.reason, 2);
    case ReplayOutcome::kDiffers:
      break;
  }
  const auto& difference = *result.difference;
  return head + paint("differs", "1;31") +
         fmt::format(" first at timepoint {} in {}\n", difference.timepoint, difference.variable) +
         table({{"recorded", difference.recorded}, {"repeated", difference.repeated}}, 2);
}

}  // namespace parallax::harness
