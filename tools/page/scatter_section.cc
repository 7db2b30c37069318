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
  /// `u`, `v`: among the plotted variables; `v` behind the last of them: the simulations' numbers.
  Panel(const PageData& page, const PlottedVariables& plotted, std::size_t u, std::size_t v)
      : page_(page), plotted_(plotted), u_(u), v_(v) {
    x_ = axis_of(u, kLeft, kSide - kPad);
    y_ = axis_of(v, kSide - kBottom, kPad + 14);
  }

  std::string svg() const {
    const auto& x = page_.variables[plotted_.chosen[u_]];
    auto out = fmt::format(
        "<div class=\"layered panel\"><svg class=\"plot\" viewBox=\"0 0 {0} {0}\" role=\"img\" "
        "aria-label=\"{1} against {2}\"{7}>\n<rect class=\"frame\" x=\"{3}\" y=\"{4}\" "
        "width=\"{5}\" height=\"{6}\"/>\n",
        px(kSide), html_short(y_name()), html_short(x), px(x_.from), px(y_.to), px(x_.to - x_.from),
        px(y_.from - y_.to), canvas_words());
    out += rule() + axes();
    const auto shown = dotted(plotted_.samples);
    for (const auto verdict : {PageVerdict::kClean, PageVerdict::kNotJudged, PageVerdict::kLost,
                               PageVerdict::kDiscrepancy}) {
      for (const bool aside : {true, false}) {
        DotPath dots;
        for (const auto* sample : shown) {
          if (sample->verdict != verdict || (sample->origin != SampleOrigin::kDrawn) != aside) {
            continue;
          }
          const double a = value_of(*sample, u_), b = value_of(*sample, v_);
          if (std::isfinite(a) && std::isfinite(b)) dots.add(x_.at(a), y_.at(b));
        }
        out += dots.element(dot_class(verdict, aside));
      }
    }
    return out + "</svg></div>\n";
  }

 private:
  double value_of(const PageSample& sample, std::size_t variable) const {
    return variable < plotted_.chosen.size() ? sample.start[plotted_.chosen[variable]]
                                             : static_cast<double>(sample.sample);
  }
  std::string y_name() const {
    return v_ < plotted_.chosen.size() ? page_.variables[plotted_.chosen[v_]] : "simulation";
  }

  /// Attributes from which assets/dots.js draws all dots.
  std::string canvas_words() const {
    if (plotted_.samples.size() <= kMostDots) return {};
    return fmt::format(
        " data-dots=\"starts\" data-u=\"{}\" data-v=\"{}\" data-trace=\"{}\" "
        "data-x=\"{:.6g} {:.6g} {:.6g} {:.6g}\" data-y=\"{:.6g} {:.6g} {:.6g} {:.6g}\"",
        u_, v_ < plotted_.chosen.size() ? std::to_string(v_) : "-1",
        plotted_.trace ? std::to_string(*plotted_.trace) : "", x_.low, x_.high, x_.from, x_.to,
        y_.low, y_.high, y_.from, y_.to);
  }

  PlotAxis axis_of(std::size_t variable, double from, double to) const {
    PlotAxis axis{INFINITY, -INFINITY, from, to};
    for (const auto* sample : plotted_.samples) {
      const double value = value_of(*sample, variable);
      if (!std::isfinite(value)) continue;
      axis.low = std::min(axis.low, value), axis.high = std::max(axis.high, value);
    }
    if (!(axis.high > axis.low)) axis.low -= 1.0, axis.high = axis.low + 2.0;
    const double pad = 0.05 * (axis.high - axis.low);
    axis.low -= pad, axis.high += pad;
    return axis;
  }

  /// The borders of the rule, the side on which simulations fail, and how many do.
  std::string rule() const {
    std::string out;
    if (!page_.rule) return out;
    const auto& x_variable = page_.variables[plotted_.chosen[u_]];
    for (const auto& border : page_.rule->borders) {
      const bool on_x = border.variable == x_variable;
      const bool on_y = !on_x && border.variable == y_name();
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
    if (out.empty()) return out;
    const auto inside = page_.rule->failures_inside + page_.rule->clean_inside;
    return out + label(x_.to, 14, "end rule-name",
                       fmt::format("fail there: {} of {}", page_.rule->failures_inside, inside));
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
    out += label(0.5 * (x_.from + x_.to), kSide - 6, "middle name",
                 html_short(page_.variables[plotted_.chosen[u_]])) +
           label(4, 14, "name", html_short(y_name()));
    return out + "</g>\n";
  }

  const PageData& page_;
  const PlottedVariables& plotted_;
  std::size_t u_, v_;
  PlotAxis x_, y_;
};

}  // namespace

PlottedVariables plotted_variables(const PageData& page) {
  PlottedVariables out;
  // Starts of different traces may have little in common: only the trace with the first discrepancy
  // is plotted.
  if (!page.discrepancies.empty()) out.trace = page.discrepancies.front().found.trace;
  for (const auto& sample : page.samples) {
    if (!out.trace || sample.trace == *out.trace) out.samples.push_back(&sample);
  }
  const auto varies = [&](std::size_t i) {
    double first = NAN;
    for (const auto* sample : out.samples) {
      const double value = sample->start[i];
      if (std::isnan(first)) first = value;
      if (std::isfinite(value) && value != first) return true;
    }
    return false;
  };
  const auto rank = [&](std::size_t i) -> std::size_t {
    if (page.rule) {
      for (std::size_t k = 0; k < page.rule->borders.size(); ++k) {
        if (page.rule->borders[k].variable == page.variables[i]) return k;
      }
    }
    return is_place(page.variables[i]) ? 101 : 100;
  };
  for (std::size_t i = 0; i < page.variables.size(); ++i) {
    if (varies(i)) out.chosen.push_back(i);
  }
  std::stable_sort(out.chosen.begin(), out.chosen.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  if (out.chosen.size() > kMostVariables) {
    out.left_out = out.chosen.size() - kMostVariables;
    out.chosen.resize(kMostVariables);
  }
  return out;
}

std::string scatter_section(const PageData& page) {
  const auto plotted = plotted_variables(page);
  const auto count = plotted.chosen.size();
  if (count == 0 || plotted.samples.size() < 2) return {};
  std::string out;
  if (plotted.trace && !page.closed_loop) {
    out += fmt::format("<p>Simulations of trace {}.</p>\n", *plotted.trace);
  }
  if (page.rule) {
    const auto& rule = *page.rule;
    out += fmt::format(
        "<p class=\"lead\">Simulations fail where {}: {} of {} failures and {} of {} clean ones "
        "lie "
        "there.</p>\n",
        rule_html(rule), rule.failures_inside, rule.failures, rule.clean_inside, rule.clean);
  }
  out += dots_hint(plotted.samples.size()) + "<div class=\"panels\">\n";
  if (count == 1) out += Panel(page, plotted, 0, 1).svg();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) out += Panel(page, plotted, i, k).svg();
  }
  out += "</div>\n";
  if (plotted.left_out > 0) {
    out +=
        fmt::format("<p class=\"hint\">{} further variables of the start are in the journal.</p>\n",
                    plotted.left_out);
  }
  return section_of("starts", "Variables of the start", out);
}

}  // namespace parallax::tools
