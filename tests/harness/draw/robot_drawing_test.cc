#include "harness/draw/robot_drawing.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "harness/config/scenario.h"

namespace parallax::harness {
namespace {

const std::string kFolder = PARALLAX_SOURCE_DIR "/scenarios/robots/";
const std::vector<std::string> kRobots = {"line", "mobile_palm", "mobile_six_joint", "two_armed",
                                          "two_armed_palms"};

WorldSpec world_in(const std::string& file) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto world = load_world(file, files, sink);
  std::string reports;
  for (const auto& d : sink.sorted()) reports += d.message + "\n";
  CAPTURE(reports);
  REQUIRE(world.has_value());
  return *world;
}

TEST_CASE("the drawings of the library's robots are what the program makes of them now") {
  for (const std::string& name : kRobots) {
    CAPTURE(name);
    std::ifstream in(kFolder + name + ".svg", std::ios::binary);
    const std::string kept{std::istreambuf_iterator<char>(in), {}};
    const std::string made = robot_svg(world_in(kFolder + name + ".yaml"), name + ".yaml");
    // Made anew by `parallax draw scenarios/robots/NAME.yaml --robot -o scenarios/robots/NAME.svg`.
    CHECK(kept == made);
  }
}

TEST_CASE("no label lies over another, and each role and number is named") {
  for (const std::string& name : kRobots) {
    CAPTURE(name);
    const WorldSpec world = world_in(kFolder + name + ".yaml");
    const std::string svg = robot_svg(world, "");
    std::map<std::string, std::vector<double>> columns;  // of one x, from top to bottom
    const std::regex text("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\"[^>]*>`?[A-Za-z]");
    for (auto at = std::sregex_iterator(svg.begin(), svg.end(), text); at != std::sregex_iterator();
         ++at) {
      columns[(*at)[1]].push_back(std::stod((*at)[2]));
    }
    std::size_t labels = 0;
    for (const auto& [x, heights] : columns) {
      labels += heights.size();
      for (std::size_t i = 1; i < heights.size(); ++i) {
        CHECK(std::abs(heights[i] - heights[i - 1]) > 15.0);
      }
    }
    CHECK(labels > 8);
    for (const char* word : {"tool point", "near_pad_body", "far_pad_body", "opening_m"}) {
      CHECK(svg.find(word) != std::string::npos);
    }
    if (!world.mobile) continue;
    for (const char* word : {"carry_m", "wrist_rad", "palm_body", "B: frame of"}) {
      CHECK(svg.find(word) != std::string::npos);
    }
    for (const ArmSpec& arm : world.mobile->arms) CHECK(svg.find(arm.palm_body) != svg.npos);
    for (const std::string& joint : world.mobile->arms.front().chain) {
      CHECK(svg.find("`" + joint + "`") != std::string::npos);
    }
  }
}

}  // namespace
}  // namespace parallax::harness
