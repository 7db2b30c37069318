#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/page/markup.h"
#include "tools/page/plot.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

constexpr double kWidth = 1160.0, kMargin = 40.0, kLeast = 240.0, kMost = 640.0;
constexpr std::array<PageVerdict, 4> kVerdicts = {PageVerdict::kClean, PageVerdict::kNotJudged,
                                                  PageVerdict::kLost, PageVerdict::kDiscrepancy};

struct Box2 {
  double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
  void add(double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
};

/// The part of the world in which something begins or ends, with regions near it.
Box2 frame_of(const PageData& page) {
  Box2 box;
  for (const auto& sample : page.samples) {
    for (const auto& way : sample.ways) {
      for (const auto& [x, y] : way) box.add(x, y);
    }
  }
  if (!(box.x1 >= box.x0)) return box;
  const auto inner = box;
  const double reach = std::max({inner.x1 - inner.x0, inner.y1 - inner.y0, 0.2});
  for (const auto& region : page.regions) {
    if (!region.x || (*region.x)[0] > inner.x1 + reach || (*region.x)[1] < inner.x0 - reach)
      continue;
    if (region.y && ((*region.y)[0] > inner.y1 + reach || (*region.y)[1] < inner.y0 - reach))
      continue;
    const double y = 0.5 * (inner.y0 + inner.y1);
    box.add((*region.x)[0], region.y ? (*region.y)[0] : y);
    box.add((*region.x)[1], region.y ? (*region.y)[1] : y);
  }
  const double pad = 0.04 * std::max(box.x1 - box.x0, box.y1 - box.y0) + 0.02;
  box.x0 -= pad, box.x1 += pad, box.y0 -= pad, box.y1 += pad;
  const double least = 0.22 * (box.x1 - box.x0) - (box.y1 - box.y0);
  if (least > 0.0) box.y0 -= 0.5 * least, box.y1 += 0.5 * least;
  return box;
}

class MapPlot {
 public:
  explicit MapPlot(const PageData& page) : page_(page), box_(frame_of(page)) {
    const double wide = box_.x1 - box_.x0, high = box_.y1 - box_.y0;
    const double scale = std::min((kWidth - 2 * kMargin) / wide, kMost / high);
    height_ = std::max(kLeast, high * scale + 2 * kMargin);
    const double left = 0.5 * (kWidth - wide * scale), top = 0.5 * (height_ - high * scale);
    x_ = {box_.x0, box_.x1, left, left + wide * scale};
    y_ = {box_.y0, box_.y1, top + high * scale, top};
  }

  bool is_empty() const { return !(box_.x1 > box_.x0); }

  std::string svg() const {
    std::string out = fmt::format(
        "<svg id=\"map-svg\" class=\"plot\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
        "aria-labelledby=\"map-t map-d\"{11} data-x=\"{2:.6g} {3:.6g} {4:.6g} {5:.6g}\" "
        "data-y=\"{6:.6g} {7:.6g} {8:.6g} {9:.6g}\">\n<title id=\"map-t\">Map of starts and ends"
        "</title><desc id=\"map-d\">{10}</desc>\n",
        px(kWidth), px(height_), x_.low, x_.high, x_.from, x_.to, y_.low, y_.high, y_.from, y_.to,
        html_short(summary()), page_.samples.size() > kMostDots ? " data-dots=\"map\"" : "");
    out += furniture() + regions() + axes();
    std::vector<const PageSample*> all;
    for (const auto& sample : page_.samples) all.push_back(&sample);
    const auto shown = dotted(all);
    for (std::size_t body = 0; body < page_.bodies.size(); ++body) out += dots(body, shown);
    out += ways() + names();
    return out + "<g id=\"map-hover\"></g></svg>\n";
  }

  std::string summary() const {
    std::array<std::size_t, 4> counts{};
    for (const auto& sample : page_.samples) ++counts[static_cast<std::size_t>(sample.verdict)];
    std::string out = fmt::format("{} simulations", page_.samples.size());
    for (const auto verdict : kVerdicts) {
      const auto count = counts[static_cast<std::size_t>(verdict)];
      if (count > 0) out += fmt::format(", {} {}", count, to_string(verdict));
    }
    return out;
  }

 private:
  std::string furniture() const {
    std::string out = "<g class=\"furniture\">";
    for (const auto& corners : page_.furniture) {
      Box2 box;
      std::string points;
      for (const auto& [x, y] : corners) {
        box.add(x, y);
        points += px(x_.at(x)) + ',' + px(y_.at(y)) + ' ';
      }
      const bool is_seen =
          box.x1 > box_.x0 && box.x0 < box_.x1 && box.y1 > box_.y0 && box.y0 < box_.y1;
      const bool is_ground = box.x1 - box.x0 > 8.0 * (box_.x1 - box_.x0);
      if (is_seen && !is_ground) out += "<polygon points=\"" + points + "\"/>";
    }
    return out + "</g>\n";
  }

  std::string regions() const {
    std::string out;
    std::vector<std::array<double, 2>> taken;
    for (const auto& region : page_.regions) {
      if (!region.x && !region.y) continue;
      const double x0 = region.x ? std::max((*region.x)[0], box_.x0) : box_.x0;
      const double x1 = region.x ? std::min((*region.x)[1], box_.x1) : box_.x1;
      const double y0 = region.y ? std::max((*region.y)[0], box_.y0) : box_.y0;
      const double y1 = region.y ? std::min((*region.y)[1], box_.y1) : box_.y1;
      if (x0 >= x1 || y0 >= y1) continue;
      out += fmt::format("<rect class=\"region{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
                         region.moves ? " moves" : "", px(x_.at(x0)), px(y_.at(y1)),
                         px(x_.at(x1) - x_.at(x0)), px(y_.at(y0) - y_.at(y1)));
      const double name_x = x_.at(x0) + 4;
      double name_y = y_.at(y1) + 13;
      for (const auto& [other_x, other_y] : taken) {
        if (std::abs(other_x - name_x) < 30 && std::abs(other_y - name_y) < 12) name_y += 13;
      }
      taken.push_back({name_x, name_y});
      out += label(name_x, name_y, "region-name", html_short(region.name)) + '\n';
    }
    return out;
  }

  std::string axes() const {
    std::string out = "<g class=\"axis\">";
    for (const double x : ticks(box_.x0, box_.x1, 8)) {
      out += line(x_.at(x), height_ - 22, x_.at(x), height_ - 17, "tick");
      out += label(x_.at(x), height_ - 6, "middle", number(x));
    }
    for (const double y : ticks(box_.y0, box_.y1, 6)) {
      out += line(28, y_.at(y), 33, y_.at(y), "tick");
      out += label(26, y_.at(y) + 4, "end", number(y));
    }
    out += label(kWidth - 6, height_ - 6, "end", "x [m]") + label(6, 14, "", "y [m]");
    return out + "</g>\n";
  }

  std::string dots(std::size_t body, const std::vector<const PageSample*>& shown) const {
    std::string out = fmt::format("<g data-body=\"{}\">\n", body);
    for (const auto verdict : kVerdicts) {
      for (const bool aside : {true, false}) {
        DotPath starts, ends;
        for (const auto* sample : shown) {
          if (sample->verdict != verdict || sample->ways[body].empty()) continue;
          if ((sample->origin != SampleOrigin::kDrawn) != aside) continue;
          const auto& way = sample->ways[body];
          starts.add(x_.at(way.front()[0]), y_.at(way.front()[1]));
          ends.add(x_.at(way.back()[0]), y_.at(way.back()[1]));
        }
        const auto kind = dot_class(verdict, aside);
        out += ends.element(kind) + starts.element(kind + " ring") + starts.element(kind + " hole");
      }
    }
    return out + "</g>\n";
  }

  /// The ways of the bodies in the first simulations that went wrong.
  std::string ways() const {
    std::string out;
    std::size_t shown = 0;
    for (const auto& sample : page_.samples) {
      if (sample.verdict != PageVerdict::kDiscrepancy || shown >= 3 ||
          sample.origin == SampleOrigin::kFurther)
        continue;
      ++shown;
      for (std::size_t body = 0; body < sample.ways.size(); ++body) {
        std::string points;
        for (const auto& [x, y] : sample.ways[body]) {
          points += px(x_.at(x)) + ',' + px(y_.at(y)) + ' ';
        }
        out += fmt::format("<polyline data-body=\"{}\" class=\"way bad\" points=\"{}\"/>\n", body,
                           points);
      }
    }
    return out;
  }

  std::string names() const {
    std::string out;
    std::vector<std::array<double, 2>> taken;
    for (std::size_t body = 0; body < page_.bodies.size(); ++body) {
      double x = 0.0, y = 0.0, count = 0.0;
      for (const auto& sample : page_.samples) {
        if (sample.ways[body].empty()) continue;
        x += sample.ways[body].front()[0], y += sample.ways[body].front()[1], ++count;
      }
      if (count == 0.0) continue;
      double at_x = x_.at(x / count) + 8, at_y = y_.at(y / count) - 8;
      for (const auto& [other_x, other_y] : taken) {
        if (std::abs(other_x - at_x) < 70 && std::abs(other_y - at_y) < 13) at_y = other_y - 14;
      }
      taken.push_back({at_x, at_y});
      out += label(at_x, at_y, "body-name", html_short(page_.bodies[body])) + '\n';
    }
    return out;
  }

  const PageData& page_;
  Box2 box_;
  double height_ = kLeast;
  PlotAxis x_, y_;
};

}  // namespace

namespace {

/// The marks that are on the map.
std::string key_of(const PageData& page) {
  std::string out;
  for (const auto verdict : kVerdicts) {
    const bool is_there =
        std::any_of(page.samples.begin(), page.samples.end(),
                    [&](const PageSample& sample) { return sample.verdict == verdict; });
    if (!is_there) continue;
    out += fmt::format("<span class=\"mark {}\"></span> {} ", verdict_class(to_string(verdict)),
                       to_string(verdict));
  }
  const auto aside = std::count_if(page.samples.begin(), page.samples.end(), [](const auto& one) {
    return one.origin != SampleOrigin::kDrawn;
  });
  if (aside > 0) {
    out += fmt::format(
        "<span class=\"mark aside\"></span> pale: {} whose starts were not drawn for the claim "
        "(chosen, searched for, or made afterwards)",
        aside);
  }
  return out;
}

}  // namespace

std::string map_section(const PageData& page) {
  if (page.samples.empty() || page.bodies.empty()) return {};
  const MapPlot plot(page);
  if (plot.is_empty()) return {};
  std::string bodies = "<option value=\"\">all bodies</option>";
  for (std::size_t i = 0; i < page.bodies.size(); ++i) {
    bodies += fmt::format("<option value=\"{}\">{}</option>", i, html_short(page.bodies[i]));
  }
  auto body = fmt::format(
      "<p>The world from above. Rings are starts, filled marks are ends; {}.</p>\n"
      "<p class=\"key\">{}</p>\n<div class=\"controls\" hidden><label>Show <select "
      "id=\"map-body\">{}</select>"
      "</label> <button type=\"button\" id=\"map-in\">Zoom in</button> <button type=\"button\" "
      "id=\"map-out\">Zoom out</button> <button type=\"button\" id=\"map-all\">Whole map</button> "
      "<span class=\"hint\">Point at a mark, or use the arrow keys on the map, to see one "
      "simulation&#39;s ways.</span></div>\n<div class=\"plot-box\" "
      "id=\"map-box\"><div class=\"layered\">{}</div></div>\n{}<p id=\"map-says\" class=\"says\" "
      "aria-live=\"polite\"></p>\n",
      html_short(plot.summary()), key_of(page), bodies, plot.svg(), dots_hint(page.samples.size()));
  return section_of("map", "Map of starts and ends", body);
}

}  // namespace parallax::tools
