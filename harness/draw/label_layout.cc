#include "harness/draw/label_layout.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/utf8.h"
#include "compiler/base/xml_text.h"

namespace parallax::harness {
namespace {

constexpr double kFont_px = 10.0;
constexpr double kHeight_px = kFont_px + 1.0;
constexpr double kCharacter_px = 0.6 * kFont_px;  // of a sans-serif font, on average
constexpr double kNear_px = 3.0, kStep_px = 10.0;
constexpr int kRings = 10;

double text_width_px(const std::string& text) {
  return kCharacter_px * static_cast<double>(base::count_code_points(text));
}

/// Lower left corners of a text of this size inside of what it names, the best first.
std::vector<Eigen::Vector2d> inside(const Rectangle& named, const Eigen::Vector2d& size) {
  if ((named.size().array() < size.array() + 4.0).any()) return {};
  const double left = named.low.x() + 2.0, right = named.high.x() - size.x() - 2.0;
  const double upper = named.low.y() + size.y() + 1.0, lower = named.high.y() - 3.0;
  const double x = 0.5 * (left + right), y = 0.5 * (upper + lower);
  return {{left, upper}, {left, lower}, {right, lower}, {right, upper}, {x, y}, {x, lower}};
}

/// The same round it, `gap` away.
std::vector<Eigen::Vector2d> outside(const Rectangle& named, const Eigen::Vector2d& size,
                                     double gap) {
  const double right = named.high.x() + gap, left = named.low.x() - gap - size.x();
  const double below = named.high.y() + gap + size.y(), above = named.low.y() - gap;
  const double x = 0.5 * (named.low.x() + named.high.x() - size.x());
  const double y = 0.5 * (named.low.y() + named.high.y() + size.y());
  return {{right, y},     {left, y},      {x, below},    {x, above},
          {right, above}, {right, below}, {left, below}, {left, above}};
}

}  // namespace

bool LabelLayout::is_free(const Rectangle& box, bool strict) const {
  const auto meets = [&](const Rectangle& other) { return box.meets(other); };
  return area_.holds(box) && std::none_of(texts_.begin(), texts_.end(), meets) &&
         !(strict && std::any_of(avoided_.begin(), avoided_.end(), meets));
}

std::string LabelLayout::place(const std::string& text, const char* colour,
                               const Rectangle& named) {
  const Eigen::Vector2d size(text_width_px(text), kHeight_px);
  auto corners = inside(named, size);
  for (int ring = 0; ring < kRings; ++ring) {
    const auto more = outside(named, size, kNear_px + kStep_px * ring);
    corners.insert(corners.end(), more.begin(), more.end());
  }
  for (const bool strict : {true, false}) {
    for (const Eigen::Vector2d& corner : corners) {
      const Rectangle box{{corner.x(), corner.y() - size.y()}, {corner.x() + size.x(), corner.y()}};
      if (!is_free(box, strict)) continue;
      texts_.push_back(box);
      const Eigen::Vector2d end = box.low.cwiseMax(named.low.cwiseMin(box.high));
      const Eigen::Vector2d start = named.low.cwiseMax(end.cwiseMin(named.high));
      std::string out;
      if ((start - end).norm() > kNear_px + kStep_px) {
        out = fmt::format(
            "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
            "stroke-width=\"0.6\"/>\n",
            start.x(), start.y(), end.x(), end.y(), colour);
      }
      return out + fmt::format(
                       "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:g}\" fill=\"{}\" "
                       "stroke=\"white\" stroke-width=\"2.5\" stroke-opacity=\"0.8\" "
                       "paint-order=\"stroke\">{}</text>\n",
                       box.low.x(), box.high.y() - 2.0, kFont_px, colour, base::xml_escaped(text));
    }
  }
  return {};
}

}  // namespace parallax::harness
