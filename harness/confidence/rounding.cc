#include "harness/confidence/rounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

// A number that was typed, like 0.05, is not rounded away for its last binary digits.
constexpr double kNoise = 1e-13;
constexpr double kMostNoise = 0.01;  // of the last decimal shown
constexpr int kMostDecimals = 15;
constexpr int kFigures = 3;
constexpr int kLevelFigures = 6;

/// Decimals that show `figures` significant digits of `distance`, which is above 0.
int decimals_for(double distance, int figures) {
  return figures - 1 - static_cast<int>(std::floor(std::log10(distance)));
}

double rounded(double value, int decimals, Round round) {
  const double scale = std::pow(10.0, decimals);
  const double scaled = value * scale, noise = std::min(kNoise * std::abs(scaled), kMostNoise);
  switch (round) {
    case Round::kDown:
      return std::floor(scaled + noise) / scale;
    case Round::kUp:
      return std::ceil(scaled - noise) / scale;
    case Round::kNearest:
      break;
  }
  return std::round(scaled) / scale;
}

std::string without_trailing_zeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string figure_of_percent(double probability, int figures, Round round) {
  const double value = 100.0 * probability;
  if (!(value > 0.0)) return "0";
  if (value >= 100.0) return "100";
  const int decimals =
      std::clamp(decimals_for(std::min(value, 100.0 - value), figures), 0, kMostDecimals);
  const double shown = rounded(value, decimals, round);
  constexpr double kLeastPlain = 1e-4;
  if (value < kLeastPlain) return fmt::format("{:.{}g}", shown, figures);
  return without_trailing_zeros(fmt::format("{:.{}f}", shown, decimals));
}

}  // namespace

std::string percent_figure(double probability, Round round) {
  return figure_of_percent(probability, kFigures, round);
}

std::string percent_up(double probability) {
  return percent_figure(probability, Round::kUp) + " %";
}

std::string percent_down(double probability) {
  return percent_figure(probability, Round::kDown) + " %";
}

std::string percent_about(double probability) {
  return percent_figure(probability, Round::kNearest) + " %";
}

std::string percent_interval(double lower, double upper) {
  return fmt::format("{} to {} %", percent_figure(lower, Round::kDown),
                     percent_figure(upper, Round::kUp));
}

std::string level_text(double confidence) {
  return figure_of_percent(confidence, kLevelFigures, Round::kDown) + " %";
}

std::string small_figure(double probability, Round round) {
  if (!(probability > 0.0)) return "0";
  if (probability >= 1.0) return "1";
  const int decimals = decimals_for(probability, kFigures);
  return fmt::format("{:.{}g}", rounded(probability, decimals, round), kFigures);
}

std::string decimal_figure(double value, int decimals, Round round) {
  if (decimals > kMostDecimals) return fmt::format("{}", value);
  // `fmt` rounds the exact value of the number, so it alone may round to nearest.
  auto out = fmt::format(
      "{:.{}f}", round == Round::kNearest ? value : rounded(value, decimals, round), decimals);
  if (out.front() == '-' && out.find_first_not_of("-0.") == std::string::npos) out.erase(0, 1);
  return out;
}

std::string p_text(double p_value) {
  constexpr int kDigits = 2;
  if (!(p_value > 0.0)) return "p = 0";
  if (p_value >= 1.0) return "p = 1";
  return fmt::format("p = {:.{}g}", rounded(p_value, decimals_for(p_value, kDigits), Round::kUp),
                     kDigits);
}

}  // namespace parallax::harness
