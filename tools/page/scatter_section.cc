#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/page/markup.h"
#include "tools/page/plot.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

constexpr double kSide = 270.0, kLeft = 52.0, kBottom = 40.0, kPad = 12.0;
constexpr std::size_t kMostVariables = 4;

bool is_place(const std::string& variable) {
  return variable.ends_with(".x") || variable.ends_with(".y") || variable.ends_with(".z") ||
         variable.ends_with(".bottom");
}

/// One panel: a variable against another one.
class Panel {
 public:
  Panel(const PageData& page, const std::vector<const PageSample*>& samples, std::size_t x,
        std::size_t y)
      : page_(page), samples_(samples), ix_(x), iy_(y) {
    x_ = axis_of(x, kLeft, kSide - kPad);
    y_ = axis_of(y, kSide - kBottom, kPad + 14);
  }

  std::string svg() const {
    const auto &x = page_.variables[ix_], &y = page_.variables[iy_];
    auto out = fmt::format(
        "<svg class=\"plot panel\" viewBox=\"0 0 {0} {0}\" role=\"img\" aria-label=\"{1} against "
        "{2}\">\n<rect class=\"frame\" x=\"{3}\" y=\"{4}\" width=\"{5}\" height=\"{6}\"/>\n",
        px(kSide), html_short(y), html_short(x), px(x_.from), px(y_.to), px(x_.to - x_.from),
        px(y_.from - y_.to));
    out += rule() + axes();
    for (const auto verdict : {SampleVerdict::kClean, SampleVerdict::kNotJudged,
                               SampleVerdict::kLost, SampleVerdict::kDiscrepancy}) {
      DotPath dots;
      for (const auto* sample : samples_) {
        if (sample->verdict != verdict) continue;
        const double a = sample->start[ix_], b = sample->start[iy_];
        if (std::isfinite(a) && std::isfinite(b)) dots.add(x_.at(a), y_.at(b));
      }
      out += dots.element(dot_class(verdict));
    }
    return out + "</svg>\n";
  }

 private:
  PlotAxis axis_of(std::size_t variable, double from, double to) const {
    PlotAxis axis{INFINITY, -INFINITY, from, to};
    for (const auto* sample : samples_) {
      const double value = sample->start[variable];
      if (!std::isfinite(value)) continue;
      axis.low = std::min(axis.low, value), axis.high = std::max(axis.high, value);
    }
    if (!(axis.high > axis.low)) axis.low -= 1.0, axis.high = axis.low + 2.0;
    const double pad = 0.05 * (axis.high - axis.low);
    axis.low -= pad, axis.high += pad;
    return axis;
  }

  /// The borders of the rule, and the side on which simulations fail.
  std::string rule() const {
    std::string out;
    if (!page_.blame) return out;
    for (const auto& border : page_.blame->rule) {
      const bool on_x = border.variable == page_.variables[ix_];
      const bool on_y = !on_x && border.variable == page_.variables[iy_];
      if (!on_x && !on_y) continue;
      const auto& axis = on_x ? x_ : y_;
      const double at = axis.at(std::clamp(border.value, axis.low, axis.high));
      const double end = border.above ? axis.to : axis.from;
      const double low = std::min(at, end), size = std::abs(end - at);
      out +=
          on_x ? fmt::format("<rect class=\"fails\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
                             px(low), px(y_.to), px(size), px(y_.from - y_.to)) +
                     line(at, y_.from, at, y_.to, "border")
               : fmt::format("<rect class=\"fails\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
                             px(x_.from), px(low), px(x_.to - x_.from), px(size)) +
                     line(x_.from, at, x_.to, at, "border");
    }
    return out;
  }

  std::string axes() const {
    std::string out = "<g class=\"axis\">";
    for (const double value : ticks(x_.low, x_.high, 4)) {
      out += line(x_.at(value), y_.from, x_.at(value), y_.from + 4, "tick") +
             label(x_.at(value), y_.from + 16, "middle", number(value));
    }
    for (const double value : ticks(y_.low, y_.high, 4)) {
      out += line(x_.from - 4, y_.at(value), x_.from, y_.at(value), "tick") +
             label(x_.from - 6, y_.at(value) + 4, "end", number(value));
    }
    out +=
        label(0.5 * (x_.from + x_.to), kSide - 6, "middle name", html_short(page_.variables[ix_])) +
        label(4, 14, "name", html_short(page_.variables[iy_]));
    return out + "</g>\n";
  }

  const PageData& page_;
  const std::vector<const PageSample*>& samples_;
  std::size_t ix_, iy_;
  PlotAxis x_, y_;
};

std::string rule_words(const PageBlame& blame) {
  std::string out;
  for (const auto& border : blame.rule) {
    out += fmt::format("{}<code>{} {} {}</code>", out.empty() ? "" : " and ",
                       html_short(border.variable), border.above ? "&gt;" : "&le;",
                       number(border.value, 6));
  }
  return out;
}

}  // namespace

std::string scatter_section(const PageData& page) {
  // What the traces' starts have in common need not be much: one trace, the one that parted.
  const bool one_trace = !page.discrepancies.empty();
  const std::int64_t trace = one_trace ? page.discrepancies.front().trace : 0;
  std::vector<const PageSample*> samples;
  for (const auto& sample : page.samples) {
    if (!one_trace || sample.trace == trace) samples.push_back(&sample);
  }
  const auto varies = [&](std::size_t i) {
    double first = NAN;
    for (const auto* sample : samples) {
      const double value = sample->start[i];
      if (std::isnan(first)) first = value;
      if (std::isfinite(value) && value != first) return true;
    }
    return false;
  };
  const auto rank = [&](std::size_t i) -> std::size_t {
    if (page.blame) {
      for (std::size_t k = 0; k < page.blame->rule.size(); ++k) {
        if (page.blame->rule[k].variable == page.variables[i]) return k;
      }
    }
    return is_place(page.variables[i]) ? 101 : 100;
  };
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < page.variables.size(); ++i) {
    if (varies(i)) chosen.push_back(i);
  }
  std::stable_sort(chosen.begin(), chosen.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  const auto left_out = chosen.size() > kMostVariables ? chosen.size() - kMostVariables : 0;
  if (left_out > 0) chosen.resize(kMostVariables);
  if (chosen.size() < 2) return {};
  std::string out;
  if (one_trace) out += fmt::format("<p>Simulations of trace {}.</p>\n", trace);
  if (page.blame && !page.blame->rule.empty()) {
    const auto& blame = *page.blame;
    out += fmt::format(
        "<p class=\"lead\">Simulations fail where {}: {} of {} failures and {} of {} clean ones "
        "lie "
        "there.</p>\n",
        rule_words(blame), blame.failures_inside, blame.failures, blame.clean_inside, blame.clean);
  }
  out += "<div class=\"panels\">\n";
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    for (std::size_t k = i + 1; k < chosen.size(); ++k) {
      out += Panel(page, samples, chosen[i], chosen[k]).svg();
    }
  }
  out += "</div>\n";
  if (left_out > 0) {
    out += fmt::format(
        "<p class=\"hint\">{} further variables of the start are in the journal.</p>\n", left_out);
  }
  return section_of("starts", "Variables of the start", out);
}

}  // namespace parallax::tools
