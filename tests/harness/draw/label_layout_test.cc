#include <doctest/doctest.h>

#include "harness/draw/scene_view.h"
#include "tests/support/xml.h"

namespace parallax::harness {
namespace {

/// Place of the text of an SVG fragment, with the largest width that a sans-serif font gives it.
Rectangle box_of(const std::string& svg) {
  const auto root = test::parse_xml("<g>" + svg + "</g>");
  const auto* text = root.all("text").at(0);
  const double x = std::stod(text->at("x")), y = std::stod(text->at("y"));
  return {{x, y - 8.0}, {x + 5.5 * static_cast<double>(text->text.size()), y}};
}

TEST_CASE("names of things that lie on each other stand apart, within the picture, or not at all") {
  const Rectangle area{{0.0, 0.0}, {200.0, 150.0}}, thing{{90.0, 60.0}, {120.0, 70.0}};
  LabelLayout layout(area);
  const Rectangle kept_free{{125.0, 55.0}, {160.0, 75.0}};
  layout.avoid(kept_free);
  std::vector<Rectangle> placed;
  for (int i = 0; i < 300; ++i) {
    const std::string svg = layout.place("name<" + std::to_string(i), "#000", thing);
    if (svg.empty()) continue;
    const Rectangle box = box_of(svg);
    CHECK(area.holds(box));
    for (const Rectangle& other : placed) CHECK_FALSE(box.meets(other));
    if (placed.empty()) CHECK_FALSE(box.meets(kept_free));
    placed.push_back(box);
  }
  CHECK(placed.size() > 8);
  CHECK(placed.size() < 300);
}

TEST_CASE("a name stands in what it names where there is room, and far away with a line to it") {
  const Rectangle area{{0.0, 0.0}, {200.0, 150.0}}, large{{10.0, 10.0}, {190.0, 140.0}};
  LabelLayout layout(area);
  CHECK(large.holds(box_of(layout.place("table", "#000", large))));
  layout.avoid({{50.0, 20.0}, {150.0, 120.0}});
  const std::string svg = layout.place("cup", "#000", {{95.0, 65.0}, {105.0, 75.0}});
  CHECK(svg.find("<line") != std::string::npos);
  CHECK_FALSE(box_of(svg).meets({{50.0, 20.0}, {150.0, 120.0}}));
}

}  // namespace
}  // namespace parallax::harness
