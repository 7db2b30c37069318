// Pictures of made-up worlds: their contents, and that names are escaped.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <set>

#include "harness/draw/scene_svg.h"
#include "harness/draw/shown_text.h"
#include "tests/support/xml.h"

namespace parallax::harness {
namespace {

SceneBox box(const std::string& name, SceneKind kind, const Eigen::Vector3d& p,
             const Eigen::Vector3d& size, double yaw_rad = 0.0) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {name, kind, {size, p, turn}, p};
}

RegionMap regions_of(const std::vector<std::string>& names) {
  base::DiagnosticSink sink;
  std::vector<Region> regions;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Region region;
    region.name = names[i];
    const auto low = static_cast<double>(i);
    region.on(RegionAxis::kX) = Interval{low, low + 1.0};
    region.on(RegionAxis::kY) = Interval{-1.0, 1.0};
    regions.push_back(std::move(region));
  }
  auto set = RegionSet::make(std::move(regions), true, sink);
  REQUIRE(set.has_value());
  return *std::move(set);
}

Rectangle box_of_text(const test::XmlElement& text) {
  const double font = std::stod(text.at("font-size"));
  double x = std::stod(text.at("x"));
  const double y = std::stod(text.at("y")), width = text_width_px(text.text, font);
  if (text.attributes.contains("text-anchor")) x -= 0.5 * width;
  return {{x, y - 0.75 * font}, {x + width, y}};
}

/// Well-formed, within its border, no text on another one.
test::XmlElement checked(const std::string& svg) {
  auto root = test::parse_xml(svg);
  const Rectangle view{{0.0, 0.0}, {std::stod(root.at("width")), std::stod(root.at("height"))}};
  std::vector<Rectangle> texts;
  for (const auto* text : root.all("text")) {
    CAPTURE(text->text);
    const Rectangle here = box_of_text(*text);
    CHECK(view.holds(here));
    for (const Rectangle& other : texts) CHECK_FALSE(here.meets(other));
    texts.push_back(here);
  }
  return root;
}

/// A robot that was to put something into a region.
Picture failed_placing(const std::string& thing, const std::string& region) {
  Picture picture;
  picture.scene.base = "base";
  picture.scene.boxes = {
      box("base", SceneKind::kRobot, {0.0, 0.0, 0.4}, {0.5, 0.5, 0.8}),
      box("hall", SceneKind::kFurniture, {20.0, 0.0, 1.0}, {0.2, 40.0, 2.0}),
      box(thing, SceneKind::kItem, {0.8, 0.1, 0.05}, {0.1, 0.1, 0.1}, 0.3),
  };
  auto& action = picture.action;
  action.differing = {thing};
  action.predicted_regions = {region};
  action.predicted.boxes = {box(thing, SceneKind::kItem, {1.2, 0.1, 0.05}, {0.1, 0.1, 0.1})};
  action.measures = {{{1.0, 0.1, 0.05}, {0.8, 0.1, 0.05}, "`" + thing + "` 200 mm outside"}};
  action.reach = SceneReach{{0.0, 0.0, 0.6}, 0.9};
  action.tracks = {{thing, SceneKind::kItem, {{0.6, 0.1, 0.3}, {0.8, 0.1, 0.05}}}};
  return picture;
}

TEST_CASE("a picture of an action shows where it was, not the world around it") {
  const auto regions = regions_of({"near", "shelf", "far"});
  const auto picture = failed_placing("cup", "shelf");
  const auto frame = action_frame(picture, regions);
  CHECK(frame.high.x() < 2.5);
  CHECK(frame.low.x() < -0.25);
  CHECK(frame.high.y() - frame.low.y() >= 1.0);
  const auto svg = checked(scene_svg(picture, frame,
                                     {.title = "event 3",
                                      .subtitle = "not as predicted",
                                      .warns = true,
                                      .differences = {"predicted: In(cup,shelf)"},
                                      .regions = &regions,
                                      .is_of_action = true}));
  std::set<std::string> groups, bodies;
  for (const auto* group : svg.all("g")) groups.insert(group->at("class"));
  CHECK(groups ==
        std::set<std::string>{"differs", "map", "measure", "predicted", "reach", "track"});
  for (const auto* polygon : svg.all("polygon")) bodies.insert(polygon->children.at(0).text);
  CHECK(bodies == std::set<std::string>{"base", "cup"});  // the hall is on the map alone
  std::set<std::string> texts;
  for (const auto* text : svg.all("text")) texts.insert(text->text);
  CHECK(texts.contains("`cup` 200 mm outside"));
  CHECK(texts.contains("predicted: In(cup,shelf)"));
  CHECK(texts.contains("shelf"));
  CHECK_FALSE(texts.contains("far"));
}

TEST_CASE("an action along y is looked at along x from the side") {
  auto picture = failed_placing("cup", "shelf");
  CHECK(side_of(picture) == ViewKind::kSide);
  picture.action = {};
  picture.action.tracks = {{"cup", SceneKind::kItem, {{0.8, -1.0, 0.0}, {0.8, 1.0, 0.0}}}};
  CHECK(side_of(picture) == ViewKind::kFront);
  const Projection front({{0.0, -2.0, 0.0}, {1.0, 2.0, 1.0}}, ViewKind::kFront, 10.0, 20.0, 100.0);
  CHECK(front.pixel({0.5, -2.0, 1.0}) == Eigen::Vector2d(10.0, 20.0));
  CHECK(front.pixel({0.5, 2.0, 0.0}) == Eigen::Vector2d(410.0, 120.0));
}

TEST_CASE("no name lies on another one, whatever stands where") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1.0, 1.0), size(0.02, 0.6);
  const auto regions = regions_of({"a long name of a region", "r2", "r3"});
  for (int world = 0; world < 60; ++world) {
    CAPTURE(world);
    Picture picture = failed_placing("Wide Wooden Mug WWWW", "r2");
    for (int i = 0; i < 25; ++i) {
      const auto kind = static_cast<SceneKind>(i % 5);
      picture.scene.boxes.push_back(box("thing " + std::to_string(i * i), kind,
                                        {place(random), place(random), std::abs(place(random))},
                                        {size(random), size(random), size(random)}, place(random)));
    }
    std::stable_sort(picture.scene.boxes.begin(), picture.scene.boxes.end(),
                     [](const auto& a, const auto& b) { return a.body < b.body; });
    const auto frame = action_frame(picture, regions);
    checked(
        scene_svg(picture, frame, {.title = "title", .regions = &regions, .is_of_action = true}));
  }
}

TEST_CASE("hostile names are inert and cut, in each place where they stand") {
  const std::string evil = "</title></svg><script>alert(\"1\")</script>&'\xE2\x80\xAE\x07";
  for (const auto& name : {evil, evil + std::string(std::size_t{1} << 20U, 'W')}) {
    const auto regions = regions_of({name, "other"});
    auto picture = failed_placing(name, name);
    picture.action.notes = {name};
    picture.scene.arms = {{name, {0.0, 0.0, 0.6}, {0.5, 0.0, 0.6}}};
    picture.action.sought = {{name, {0.8, 0.1, 0.05}, false}};
    const auto frame = action_frame(picture, regions);
    const auto svg = scene_svg(picture, frame,
                               {.title = name,
                                .subtitle = name,
                                .warns = true,
                                .differences = {name},
                                .regions = &regions,
                                .is_of_action = true});
    checked(svg);
    CHECK(svg.find("<script") == std::string::npos);
    CHECK(svg.find("\xE2\x80\xAE") == std::string::npos);
    CHECK(svg.size() < 60'000);
  }
}

TEST_CASE("each colour of a picture has a dark one, and a page may bring the style itself") {
  const auto regions = regions_of({"near", "shelf"});
  auto picture = failed_placing("cup", "shelf");
  picture.action.goal = SceneGoal{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, true};
  picture.action.gaze =
      SceneGaze{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {{1.0, 0.1, 0.0}, {1.0, -0.1, 0.0}}};
  picture.action.sought = {{"cup", {0.8, 0.1, 0.05}, true}};
  picture.scene.boxes.push_back(box("flap", SceneKind::kDrawer, {0.5, 0.3, 0.3}, {0.1, 0.1, 0.1}));
  picture.scene.boxes.push_back(box("pad", SceneKind::kGripper, {0.5, 0.1, 0.3}, {0.1, 0.1, 0.1}));
  const auto frame = action_frame(picture, regions);
  SvgOptions options{.title = "t", .subtitle = "s", .warns = true, .regions = &regions};
  options.is_of_action = true;
  const auto svg = scene_svg(picture, frame, options);
  options.has_style = false;
  const auto bare = scene_svg(picture, frame, options);
  CHECK(bare.find("<style") == std::string::npos);
  CHECK(svg.size() == bare.size() + scene_style().size() + std::string("<style></style>\n").size());
  for (const auto* attribute : {"fill", "stroke"}) {
    const auto key = std::string(" ") + attribute + "=\"";
    for (auto at = bare.find(key); at != std::string::npos; at = bare.find(key, at + 1)) {
      const auto begin = at + key.size();
      const auto colour = bare.substr(begin, bare.find('"', begin) - begin);
      if (colour == "none") continue;
      CAPTURE(colour);
      CHECK(scene_style().find("[" + std::string(attribute) + "=\"" + colour + "\"]") !=
            std::string::npos);
    }
  }
}

TEST_CASE("a convex polygon is cut at a rectangle as points inside of both say") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  const Rectangle area{{-1.0, -0.5}, {1.0, 0.7}};
  const auto inside = [](const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if ((b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x()) < 0.0) return false;
    }
    return polygon.size() >= 3;
  };
  for (int round = 0; round < 200; ++round) {
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 6; ++i) points.emplace_back(place(random), place(random));
    const auto whole = hull(points), part = clipped(whole, area);
    for (const auto& p : part) {
      CHECK((p.array() >= area.low.array() - 1e-9).all());
      CHECK((p.array() <= area.high.array() + 1e-9).all());
    }
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector2d p(place(random), place(random));
      const bool expected = inside(whole, p) && area.holds({p, p});
      CHECK(inside(part, p) == expected);
    }
  }
}

TEST_CASE("long texts are cut between characters") {
  CHECK(shown_text("abc", 3) == "abc");
  CHECK(shown_text("abcd", 3) == "abc\xE2\x80\xA6");
  CHECK(shown_text("\xC3\xA4\xC3\xB6\xC3\xBC", 2) == "\xC3\xA4\xC3\xB6\xE2\x80\xA6");
  CHECK(shown_text(std::string(std::size_t{1} << 20U, 'x'), 10).size() == 13);
}

}  // namespace
}  // namespace parallax::harness
