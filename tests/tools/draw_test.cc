// `parallax draw` as users run it: pictures of worlds and of recorded simulations.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/support/xml.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

struct Box2 {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  double x() const { return 0.5 * (x0 + x1); }
  bool meets(const Box2& other) const {
    return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
  }
};

Box2 bounds_of_polygon(const XmlElement& polygon) {
  auto text = polygon.at("points");
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  Box2 out{1e9, 1e9, -1e9, -1e9};
  int corners = 0;
  for (double x = 0.0, y = 0.0; in >> x >> y; ++corners) {
    out = {std::min(out.x0, x), std::min(out.y0, y), std::max(out.x1, x), std::max(out.y1, y)};
  }
  CHECK(in.eof());
  CHECK(corners >= 3);
  return out;
}

double number(const XmlElement& element, const std::string& attribute) {
  return std::stod(element.at(attribute));
}

/// Bounds of a text that starts at x or is centred there, as wide as the average of a sans-serif
/// font makes it.
Box2 bounds_of_text(const XmlElement& text) {
  const double font = number(text, "font-size"), x = number(text, "x"), y = number(text, "y");
  const double width = 0.5 * font * static_cast<double>(text.text.size());
  const bool centred = text.attributes.contains("text-anchor");
  const double left = centred ? x - 0.5 * width : x;
  return {left, y - 0.7 * font, left + width, y};
}

Box2 view_box(const XmlElement& svg) {
  std::istringstream in(svg.at("viewBox"));
  Box2 out;
  in >> out.x0 >> out.y0 >> out.x1 >> out.y1;
  REQUIRE_FALSE(in.fail());
  CHECK(number(svg, "width") == out.x1);
  CHECK(number(svg, "height") == out.y1);
  return out;
}

/// Well-formed, everything within the view box, no label on another one.
XmlElement checked_picture(const std::string& text) {
  XmlElement svg = parse_xml(text);
  CHECK(svg.name == "svg");
  const Box2 view = view_box(svg);
  const auto check_within = [&](const Box2& box, const std::string& what) {
    CAPTURE(what);
    CHECK(box.x0 >= view.x0);
    CHECK(box.y0 >= view.y0);
    CHECK(box.x1 <= view.x1);
    CHECK(box.y1 <= view.y1);
  };
  for (const auto* polygon : svg.all("polygon")) {
    check_within(bounds_of_polygon(*polygon), polygon->children.at(0).text);
  }
  for (const auto* line : svg.all("line")) {
    const double x1 = number(*line, "x1"), x2 = number(*line, "x2");
    const double y1 = number(*line, "y1"), y2 = number(*line, "y2");
    check_within({std::min(x1, x2), std::min(y1, y2), std::max(x1, x2), std::max(y1, y2)}, "line");
  }
  for (const auto* rect : svg.all("rect")) {
    if (rect->at("width") == "100%") continue;
    const double x = number(*rect, "x"), y = number(*rect, "y");
    check_within({x, y, x + number(*rect, "width"), y + number(*rect, "height")}, "rect");
  }
  std::vector<Box2> labels;
  for (const auto* label : svg.all("text")) {
    CAPTURE(label->text);
    const Box2 box = bounds_of_text(*label);
    check_within(box, label->text);
    for (const Box2& other : labels) CHECK_FALSE(box.meets(other));
    labels.push_back(box);
  }
  return svg;
}

/// The polygon of a body of one box in the view from above, which comes first.
Box2 body(const XmlElement& svg, const std::string& name) {
  for (const auto* polygon : svg.all("polygon")) {
    if (polygon->children.at(0).text == name) return bounds_of_polygon(*polygon);
  }
  FAIL("no body " << name);
  return {};
}

bool has_text(const XmlElement& svg, const std::string& wanted) {
  const auto texts = svg.all("text");
  return std::any_of(texts.begin(), texts.end(),
                     [&](const XmlElement* text) { return text->text == wanted; });
}

/// The picture's scale, read from the bar at the lower right: its length in pixels and in metres.
double pixels_per_m(const XmlElement& svg) {
  for (const auto* label : svg.all("text")) {
    if (!label->text.ends_with(" m")) continue;
    const auto& bar = svg.all("path").back()->at("d");  // "M404.0 353.0v8m0 -4H514.0m0 -4v8"
    const double left = std::stod(bar.substr(1));
    return (std::stod(bar.substr(bar.find('H') + 1)) - left) / std::stod(label->text);
  }
  FAIL("no scale");
  return 0.0;
}

std::string fixed(double value, int digits) {
  char out[32];
  std::snprintf(out, sizeof out, "%.*f", digits, value);
  return out;
}

std::string absolute(const std::string& scenario) {
  return std::string(PARALLAX_SOURCE_DIR) + "/scenarios/" + scenario;
}

TEST_CASE("a world is drawn with its bodies, regions and a scale") {
  const CliFixture cli;
  const auto result = cli.parallax({"draw", "edge.yaml", "-o", "sub/world.svg"});
  CHECK(result.code == 0);
  CHECK(result.out == "sub/world.svg\n");
  const auto svg = checked_picture(cli.read("sub/world.svg"));
  for (const auto* text : {"place the box at the edge of r1", "r1", "r2", "box", "0.5 m", "x", "y",
                           "z", "from above", "from the side, along y"}) {
    CAPTURE(text);
    CHECK(has_text(svg, text));
  }
  // As the scenario says: the box of 7 cm stands 1 m to the right of the base.
  const double scale = pixels_per_m(svg);
  const auto box = body(svg, "box");
  CHECK(box.x1 - box.x0 == doctest::Approx(0.07 * scale).epsilon(0.02));
  CHECK(box.x() - body(svg, "base").x() == doctest::Approx(1.0 * scale).epsilon(0.005));
  CHECK(svg.all("rect").size() == 3);  // the background and two regions

  REQUIRE(cli.parallax({"draw", "edge.yaml", "--no-regions", "-o", "bare.svg"}).code == 0);
  CHECK(checked_picture(cli.read("bare.svg")).all("rect").size() == 1);
  CHECK(json_of(cli, {"draw", "edge.yaml"})["pictures"] == Json({"scene.svg"}));
  CHECK(cli.read("scene.svg") == cli.read("sub/world.svg"));
}

TEST_CASE("the worlds of the repository are drawn whole, without a label on another") {
  const CliFixture cli;
  for (const std::string name : {"kitchen/plan2", "kitchen/plan3", "warehouse/restock"}) {
    CAPTURE(name);
    REQUIRE(cli.parallax({"draw", absolute(name + ".yaml"), "-o", "world.svg"}).code == 0);
    const auto svg = checked_picture(cli.read("world.svg"));
    CHECK(svg.all("polygon").size() > 20);
    CHECK(has_text(svg, name.starts_with("kitchen") ? "bWork" : "atBins"));
    CHECK(has_text(svg, name.starts_with("kitchen") ? "spoon1" : "drum"));
  }
}

TEST_CASE("each action of a recorded simulation has its picture, which shows what was observed") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--seed", "5", "--out", "run"}).code == 1);
  const auto result = cli.parallax({"draw", "run"});
  CHECK(result.code == 0);
  CHECK(result.out ==
        "run/pictures/00.svg\nrun/pictures/01.svg\nrun/pictures/02.svg\n"
        "run/pictures/03.svg\nrun/pictures/04.svg\nrun/pictures/index.html\n");
  Json sample;  // the second simulation is the one that went wrong
  std::istringstream journal(cli.read("run/journal.ndjson"));
  for (std::string line; std::getline(journal, line);) {
    const auto read = Json::parse(line);
    if (read.contains("observations") && read["sample"] == 2) sample = read;
  }
  REQUIRE(sample.contains("observations"));
  const std::vector<std::string> titles = {
      "start", "event 0: Go(r2) (going)", "event 1: PickUp() (picking-up)",
      "event 2: Go(r1) (going)", "event 3: Place(r1) (placing)"};
  for (std::size_t i = 0; i < titles.size(); ++i) {
    CAPTURE(i);
    const auto svg = checked_picture(cli.read("run/pictures/0" + std::to_string(i) + ".svg"));
    CHECK(has_text(svg, titles[i]));
    const auto& seen = sample["observations"][i];
    const double apart = seen["box.x"].get<double>() - seen["robot.x"].get<double>();
    CHECK(body(svg, "box").x() - body(svg, "base").x() ==
          doctest::Approx(apart * pixels_per_m(svg)).scale(100.0).epsilon(0.01));
    // Drives show their way and goal, grasps the hand's way and a moment in between.
    std::set<std::string> marks;
    for (const auto* group : svg.all("g")) marks.insert(group->at("class"));
    CHECK(marks.contains("track") == (i > 0));
    CHECK(marks.contains("goal") == (i % 2 == 1));
    CHECK(marks.contains("map"));
    // The box ends 5.5 mm beyond r1: this is shown where it comes to light, and nowhere else.
    CHECK(marks.contains("differs") == (i == 4));
    CHECK(marks.contains("measure") == (i == 4));
    CHECK(has_text(svg, "predicted: BoxIn(r1); observed: it does not hold") == (i == 4));
    CHECK(has_text(svg, "predicted: not BoxIn(r2); observed: it holds") == (i == 4));
    if (i == 4) {
      const double outside_m = seen["box.x"].get<double>() - 1.0;
      CHECK(outside_m > 0.0);
      CHECK(outside_m < 0.01);
      CHECK(has_text(svg, "`box` " + fixed(1000.0 * outside_m, 1) + " mm outside `r1`"));
      const auto texts = svg.all("text");
      CHECK(std::none_of(texts.begin(), texts.end(),
                         [](const auto* text) { return text->text.starts_with("ok "); }));
    }
  }
  CHECK(has_text(parse_xml(cli.read("run/pictures/00.svg")), "simulation 1.2, at 0.00 s"));

  const auto before = files_below(cli.folder() / "run/pictures");
  REQUIRE(cli.parallax({"draw", "run", "--sample", "1.2", "-o", "again"}).code == 0);
  CHECK(files_below(cli.folder() / "again") == before);
  const auto page = cli.read("run/pictures/index.html");
  CHECK(page.find("<h1>Model and simulation part</h1>") != std::string::npos);
  CHECK(page.find("event 3: Place(r1) (placing)") != std::string::npos);
  CHECK(page.find("edge.lisp:17") != std::string::npos);
  CHECK(page.find("\" style=") == std::string::npos);
  CHECK(page.find(" src=") == std::string::npos);
  REQUIRE(cli.parallax({"draw", "run", "--sample", "1.1", "-o", "other"}).code == 0);
  CHECK(files_below(cli.folder() / "other") != before);
  CHECK(cli.read("other/index.html").find("<h1>The simulation goes as the model says</h1>") !=
        std::string::npos);
}

TEST_CASE("what is out of reach shows how far, and files of others stay") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "wrong_model.yaml", "--out", "run"}).code == 1);
  std::filesystem::create_directory(cli.folder() / "pictures");
  cli.write("pictures/01.svg", "<svg>mine</svg>");
  auto refused = cli.parallax({"draw", "run", "-o", "pictures"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("it is there already") != std::string::npos);
  CHECK(cli.read("pictures/01.svg") == "<svg>mine</svg>");
  CHECK_FALSE(std::filesystem::exists(cli.folder() / "pictures/00.svg"));
  cli.write("mine.svg", "<svg>mine</svg>");
  CHECK(cli.parallax({"draw", "edge.yaml", "-o", "mine.svg"}).code == 2);

  REQUIRE(cli.parallax({"draw", "run"}).code == 0);
  REQUIRE(cli.parallax({"draw", "run"}).code == 0);  // its own are replaced
  const auto svg = checked_picture(cli.read("run/pictures/01.svg"));
  std::set<std::string> marks;
  for (const auto* group : svg.all("g")) marks.insert(group->at("class"));
  CHECK(marks.contains("reach"));
  CHECK(marks.contains("measure"));
  Json sample;
  std::istringstream journal(cli.read("run/journal.ndjson"));
  for (std::string line; std::getline(journal, line) && !sample.contains("outcomes");) {
    sample = Json::parse(line);
  }
  const double beyond_m = -sample["outcomes"][0]["margins"]["reach"].get<double>();
  CHECK(has_text(svg, "`box` " + fixed(1000.0 * beyond_m, 0) + " mm out of reach"));
}

TEST_CASE("an action that failed says so in red, with its time and reason") {
  const CliFixture cli;
  const auto scenario = absolute("warehouse/oily_pads.yaml");
  REQUIRE(cli.parallax({"run", scenario, "--seed", "1", "--out", "run"}).code == 1);
  REQUIRE(cli.parallax({"draw", "run"}).code == 0);
  int warnings = 0;
  for (const auto& [path, text] : files_below(cli.folder() / "run/pictures")) {
    if (path.ends_with(".html")) continue;
    const auto svg = checked_picture(text);
    for (const auto* line : svg.all("text")) {
      const bool failed = line->text.starts_with("failed after ");
      if (!failed && !line->text.starts_with("ok after ")) continue;
      CHECK((line->at("fill") == "#c00020") == failed);
      CHECK(line->text.find(" s, at ") != std::string::npos);
      if (failed) CHECK(line->text.find(" s: ") != std::string::npos);
      warnings += failed ? 1 : 0;
    }
  }
  CHECK(warnings > 0);
}

TEST_CASE("names that XML cannot hold, a far body and a long reason leave the picture whole") {
  const CliFixture cli;
  cli.replace("edge.yaml", "name: place the box at the edge of r1",
              "name: \"a < b & \\\"c\\\" > d \\u0007 " + std::string(400, 'w') + "\"");
  cli.replace("common.yaml", "include: world.yaml",
              "include: world.yaml\n  bodies: {'<far & \"high\">': {size_m: [0.1, 0.1, 0.1], "
              "mass_kg: 0, material: steel, position_m: [90, 3, 0.2]}}");
  const auto result = cli.parallax({"draw", "edge.yaml", "-o", "world.svg"});
  CAPTURE(result.err);
  REQUIRE(result.code == 0);
  const auto svg = checked_picture(cli.read("world.svg"));
  CHECK(number(svg, "width") < 10000.0);
  bool far = false;
  for (const auto* polygon : svg.all("polygon")) {
    far = far || polygon->children.at(0).text == "<far & \"high\">";
  }
  CHECK(far);
}

}  // namespace
}  // namespace parallax::test
