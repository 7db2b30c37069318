#include "tools/page/plot.h"

#include <fmt/format.h>

#include <cmath>

namespace parallax::tools {

std::vector<double> ticks(double low, double high, int count) {
  std::vector<double> out;
  const double width = high - low;
  if (!(width > 0.0) || !std::isfinite(width)) return out;
  const double rough = width / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const auto ticks_in = [&](double step) {
    return std::floor(high / step + 1e-9) - std::ceil(low / step) + 1.0;
  };
  // The finest step that is not below the rough one, or the one before it where that gives a single
  // tick.
  double step = power;
  for (const double factor : {2.0, 5.0, 10.0}) {
    if (step >= rough || ticks_in(factor * power) < 2.0) break;
    step = factor * power;
  }
  for (double i = std::ceil(low / step); i * step <= high + 1e-9 * step && out.size() < 50; ++i) {
    out.push_back(std::abs(i * step) < 1e-12 ? 0.0 : i * step);
  }
  return out;
}

std::string px(double value) {
  auto text = fmt::format("{:.1f}", std::isfinite(value) ? value : 0.0);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

void DotPath::add(double x, double y) {
  // Not of length zero: printed as PDF, square caps of such a line vanish.
  if (std::isfinite(x) && std::isfinite(y)) d_ += 'M' + px(x) + ' ' + px(y) + "h.01";
}

std::string DotPath::element(std::string_view classes) const {
  if (d_.empty()) return {};
  return fmt::format("<path class=\"{}\" d=\"{}\"/>\n", classes, d_);
}

std::string dot_class(PageVerdict verdict, bool aside) {
  const std::string more = aside ? " aside" : "";
  switch (verdict) {
    case PageVerdict::kClean:
      return "dot clean" + more;
    case PageVerdict::kDiscrepancy:
      return "dot bad" + more;
    case PageVerdict::kLost:
      return "dot lost" + more;
    case PageVerdict::kNotJudged:
      break;
  }
  return "dot open" + more;
}

std::vector<const PageSample*> dotted(const std::vector<const PageSample*>& samples) {
  if (samples.size() <= kMostDots) return samples;
  std::vector<const PageSample*> out;
  for (const bool wrong : {true, false}) {
    const auto most = wrong ? kMostDots / 2 : kMostDots;
    for (const auto* sample : samples) {
      const bool is_wrong = sample->verdict != PageVerdict::kClean;
      if (is_wrong == wrong && out.size() < most) out.push_back(sample);
    }
  }
  return out;
}

std::string dots_hint(std::size_t samples) {
  if (samples <= kMostDots) return {};
  return fmt::format(
      "<noscript><p class=\"hint\">Of {} simulations {} are drawn; all of them are where scripts "
      "may run.</p></noscript>\n",
      samples, kMostDots);
}

std::string line(double x1, double y1, double x2, double y2, std::string_view classes) {
  return fmt::format("<line class=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>", classes,
                     px(x1), px(y1), px(x2), px(y2));
}

std::string label(double x, double y, std::string_view classes, std::string_view escaped) {
  return fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>", classes, px(x), px(y),
                     escaped);
}

}  // namespace parallax::tools
