#include "harness/draw/scene_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/base/utf8.h"
#include "compiler/base/xml_text.h"
#include "harness/draw/scene_marks.h"
#include "harness/draw/scene_view.h"
#include "harness/draw/shown_text.h"

namespace parallax::harness {
namespace {

constexpr double kGap_px = 30.0;   // between the views
constexpr double kFoot_px = 44.0;  // for the scale
constexpr double kMaxWidth_px = 6000.0;
constexpr double kViewWide_px = 640.0, kViewHigh_px = 520.0;  // of an action
constexpr double kMostPerMetre_px = 700.0;
constexpr double kMapWide_px = 170.0, kMapHigh_px = 84.0;
constexpr double kSmallFont_px = 12.0, kNoteFont_px = 11.0;

/// The greatest of 1, 2 and 5 times a power of ten that is not longer.
double round_length_m(double longest_m) {
  const double power = std::pow(10.0, std::floor(std::log10(longest_m)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= longest_m) return digit * power;
  }
  return power;
}

/// A bar of a round length, a tenth to a third of the view.
std::string scale_bar(const Projection& view, double right_px, double px_per_m) {
  const double length_m = round_length_m(0.3 * view.width_px() / px_per_m);
  const double y = view.area().high.y() + 20.0, left = right_px - length_m * px_per_m;
  return fmt::format(
      "<path d=\"M{0:.1f} {2:.1f}v8m0 -4H{1:.1f}m0 -4v8\" fill=\"none\" stroke=\"#444\"/>\n"
      "<text x=\"{3:.1f}\" y=\"{4:.1f}\" font-size=\"10\" text-anchor=\"middle\" "
      "fill=\"#444\">{5:g} m</text>\n",
      left, right_px, y, 0.5 * (left + right_px), y + 18.0, length_m);
}

/// At most `lines` lines of this width; what does not fit gives way to an ellipsis.
std::vector<std::string> wrapped(const std::string& whole, double width_px, double font_px,
                                 std::size_t lines) {
  constexpr std::size_t kLongest = 2000;
  std::string text = shown_text(whole, kLongest);
  std::vector<std::string> out;
  while (!text.empty() && out.size() < lines) {
    std::size_t cut = text.size();
    while (cut > 1 && text_width_px(std::string_view(text).substr(0, cut), font_px) > width_px) {
      const auto space = text.rfind(' ', cut - 1);
      cut = space != std::string::npos && space > cut / 2 ? space : cut - 1;
    }
    // Never inside a character.
    while (cut < text.size() && base::continues_code_point(text[cut])) ++cut;
    out.push_back(text.substr(0, cut));
    const auto rest = text.find_first_not_of(' ', cut);
    text.erase(0, rest == std::string::npos ? text.size() : rest);
  }
  if (!text.empty() && !out.empty()) out.back() += " \xE2\x80\xA6";
  return out;
}

std::string text_line(const std::string& text, double y_px, double font_px, const char* colour) {
  return fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" font-size=\"{:g}\" fill=\"{}\">{}</text>\n",
                     kGap_px, y_px, font_px, colour, base::xml_escaped(text));
}

/// The text above the views, and its height.
struct Head {
  std::string svg;
  double height_px = 0.0;
};

Head head_of(const SvgOptions& options, const std::vector<std::string>& notes, double width_px) {
  Head head;
  double y = 24.0;
  const auto add = [&](const std::string& text, double font_px, const char* colour,
                       std::size_t lines, double step_px) {
    for (const auto& line : wrapped(text, width_px - 2.0 * font_px, font_px, lines)) {
      head.svg += text_line(line, y, font_px, colour);
      y += step_px;
    }
  };
  add(options.title, 16.0, "#000", 1, 18.0);
  add(options.subtitle, kSmallFont_px, options.warns ? kWarningColour : "#444", 2, 16.0);
  for (const auto& line : options.differences) add(line, kSmallFont_px, kWarningColour, 1, 16.0);
  y += 4.0;
  std::string all;
  for (const auto& note : notes) all += note + "; ";
  all += "dotted: behind what is nearer";
  add(all, kNoteFont_px, "#444", 3, 14.0);
  head.height_px = std::max(y + 16.0, 112.0);
  return head;
}

std::string caption(const char* text, double left_px, double y_px) {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"11\" fill=\"#444\" "
      "font-style=\"italic\">{}</text>\n",
      left_px, y_px, text);
}

/// The whole world from above, small, with the part that the picture shows.
std::string map_of(const Scene& scene, const SceneFrame& shown, double right_px) {
  SceneFrame world = frame_around({{scene, {}}}, nullptr);
  world = frame_of_both(world, shown);
  const Eigen::Vector3d size = world.high - world.low;
  const double scale = std::min(kMapWide_px / size.x(), kMapHigh_px / size.y());
  const Projection projection(world, ViewKind::kAbove, right_px - scale * size.x(), 12.0, scale);
  std::string out;
  for (const SceneBox& item : scene.boxes) {
    const auto outline = projection.outline(item.box);
    if (outline.empty()) continue;
    out += fmt::format(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"0.6\" "
        "stroke-opacity=\"0.6\"/>\n",
        point_list(closed(outline)), line_colour(item.kind));
  }
  const Eigen::Vector2d a = projection.pixel(shown.low), b = projection.pixel(shown.high);
  const Rectangle here = around({a, b});
  out += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"#2b6cb8\" stroke-width=\"1.4\"/>\n",
      here.low.x(), here.low.y(), here.size().x(), here.size().y());
  return "<g class=\"map\"><title>this picture in the world</title>\n" + out + "</g>\n";
}

/// Regions in which the model says that something is.
std::string predicted_regions(const SceneAction& action, const RegionMap& regions,
                              const SceneView& view) {
  std::string out;
  for (const auto& name : action.predicted_regions) {
    const Region* region = regions.find(name);
    if (region != nullptr) out += view.region(*region, kPredictedColour);
  }
  return out;
}

double scale_of(const Eigen::Vector3d& size, ViewKind side, const SvgOptions& options) {
  const double wide_m = side == ViewKind::kFront ? size.y() : size.x();
  const double longest_m = std::max({size.x() + wide_m, size.y(), size.z()});
  if (!options.is_of_action) return std::min(options.pixels_per_m, kMaxWidth_px / longest_m);
  return std::min({kMostPerMetre_px, kViewWide_px / std::max(size.x(), wide_m),
                   kViewHigh_px / std::max(size.y(), size.z())});
}

/// Light and dark of each colour that pictures have.
constexpr std::array<std::array<const char*, 2>, 22> kColours = {{
    {"white", "#10151b"},   {"#000", "#e4e9ef"},    {"#444", "#b4bfca"},    {"#666", "#7d8894"},
    {"#eeeae2", "#232a31"}, {"#e6d0ae", "#54452c"}, {"#bcd0e4", "#28435f"}, {"#4d7299", "#5d8fc4"},
    {"#d8604c", "#b8432f"}, {"#6e6453", "#b5a98f"}, {"#7a5a2a", "#d0a868"}, {"#33567a", "#8fb8e0"},
    {"#1d3550", "#9cc3ee"}, {"#7c2517", "#ff9d8a"}, {"#1d6b2c", "#7fd08e"}, {"#2a7a3a", "#5fb872"},
    {"#c00020", "#ff6b7d"}, {"#6a1fb0", "#c79bff"}, {"#1d7a2c", "#6fd080"}, {"#b08a00", "#d9b640"},
    {"#2b6cb8", "#6fa8ec"}, {"#ffd633", "#ffd633"},
}};

}  // namespace

std::string scene_style() {
  std::string out = "@media (prefers-color-scheme: dark) {\n";
  for (const auto& [light, dark] : kColours) {
    for (const char* what : {"fill", "stroke"}) {
      out += fmt::format(".scene [{0}=\"{1}\"] {{ {0}: {2}; }}\n", what, light, dark);
    }
  }
  return out + "}\n";
}

std::string scene_svg(const Picture& picture, const SceneFrame& frame, const SvgOptions& options) {
  const Eigen::Vector3d size = frame.high - frame.low;
  const auto side_kind = options.is_of_action ? side_of(picture) : ViewKind::kSide;
  const double px_per_m = scale_of(size, side_kind, options);
  const double wide_m = size.x() + (side_kind == ViewKind::kFront ? size.y() : size.x());
  const double width =
      std::max(3.0 * kGap_px + px_per_m * wide_m, options.is_of_action ? 900.0 : 0.0);
  const double text_px = width - 2.0 * kGap_px - (options.is_of_action ? kMapWide_px : 0.0);
  const Head head = head_of(options, picture.action.notes, text_px);
  const double side_px = 2.0 * kGap_px + px_per_m * size.x();
  const Projection from_above(frame, ViewKind::kAbove, kGap_px, head.height_px, px_per_m);
  const Projection from_side(frame, side_kind, side_px, head.height_px, px_per_m);
  const auto bright = taking_part(picture);
  const auto* faint = options.is_of_action ? &bright : nullptr;
  SceneView above(from_above, picture.scene, faint), side(from_side, picture.scene, faint);
  const double height =
      head.height_px + kFoot_px + std::max(from_above.height_px(), from_side.height_px());
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"scene\" role=\"img\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\">\n"
      "<title>{2}</title>\n",
      std::ceil(width), std::ceil(height), shown_in_full(options.title));
  if (options.has_style) out += "<style>" + scene_style() + "</style>\n";
  out += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n" + head.svg;
  out +=
      caption("from above", kGap_px, head.height_px - 6.0) +
      caption(side_kind == ViewKind::kFront ? "from the side, against x" : "from the side, along y",
              side_px, head.height_px - 6.0);
  const auto& warned =
      picture.action.differing.empty() ? picture.action.met : picture.action.differing;
  out += above.bodies();
  if (options.regions != nullptr) {
    out += above.regions(*options.regions);
    out += predicted_regions(picture.action, *options.regions, above);
  }
  out += scene_marks(picture.action, picture.scene, from_above);
  out += mark_labels(picture.action, above) + above.body_names(warned);
  if (options.regions != nullptr) out += above.region_names(*options.regions);
  out += side.floor() + side.bodies() + scene_marks(picture.action, picture.scene, from_side);
  if (!picture.action.predicted.boxes.empty()) {
    SceneAction predicted;
    predicted.predicted = picture.action.predicted;
    out += mark_labels(predicted, side);
  }
  out += side.body_names(warned);
  if (options.is_of_action) out += map_of(picture.scene, frame, width - kGap_px);
  out += above.axes() + side.axes();
  out += scale_bar(from_above, kGap_px + from_above.width_px(), px_per_m);
  return out + "</svg>\n";
}

}  // namespace parallax::harness
