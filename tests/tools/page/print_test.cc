// Pages printed to PDF by Chromium, and drawn again by poppler: is there on paper what is on the
// screen?

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

#include "tests/tools/cli_fixture.h"
#include "tests/tools/page/browser.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

bool has_printer() {
  if (!has_browser()) return false;
  if (fs::exists("/usr/bin/pdftoppm")) return true;
  std::puts("SKIPPED: no pdftoppm; `tools/setup --browser` installs it");
  return false;
}

struct Picture {
  int width = 0, height = 0;
  std::string rgb;
  bool is(int x, int y, const std::vector<int>& color) const {
    const auto at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(x));
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::abs(static_cast<unsigned char>(rgb[at + i]) - color[i]) > 8) return false;
    }
    return true;
  }
};

/// A binary PPM as pdftoppm writes it, without comments.
Picture picture_of(const std::string& ppm) {
  Picture out;
  std::istringstream in(ppm);
  std::string magic;
  int most = 0;
  in >> magic >> out.width >> out.height >> most;
  REQUIRE(magic == "P6");
  REQUIRE(most == 255);
  in.get();
  out.rgb = ppm.substr(static_cast<std::size_t>(in.tellg()));
  REQUIRE(out.rgb.size() ==
          3 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  return out;
}

/// How many upright squares of one colour the picture has, with sides of `least` to `most` pixels.
int squares(const Picture& picture, const std::vector<int>& color, int least, int most) {
  const auto is = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < picture.width && y < picture.height && picture.is(x, y, color);
  };
  int count = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (!is(x, y) || is(x - 1, y) || is(x, y - 1)) continue;
      int width = 0, height = 0;
      while (is(x + width, y)) ++width;
      while (is(x, y + height)) ++height;
      bool is_full = width >= least && width <= most && std::abs(width - height) <= 1;
      for (int i = 0; is_full && i < width; ++i) {
        for (int k = 0; is_full && k < height; ++k) is_full = is(x + i, y + k);
      }
      if (is_full) ++count;
    }
  }
  return count;
}

/// The pages of an HTML file on paper.
std::vector<Picture> printed(const CliFixture& cli, const std::string& name) {
  const auto path = (cli.folder() / name).string();
  const auto result = run_process(
      {browser(), "--headless", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu",
       "--disable-3d-apis", "--no-first-run",
       "--user-data-dir=" + (cli.folder() / "profile").string(), "--virtual-time-budget=20000",
       "--print-to-pdf=" + path + ".pdf", "file://" + path});
  REQUIRE(fs::exists(path + ".pdf"));
  REQUIRE(run_process({"/usr/bin/pdftoppm", "-r", "144", "-aa", "no", path + ".pdf", path}).code ==
          0);
  std::map<std::string, Picture> pages;  // pdftoppm numbers pages with leading zeros
  for (const auto& entry : fs::directory_iterator(cli.folder())) {
    const auto file = entry.path().filename().string();
    if (file.starts_with(name + "-") && file.ends_with(".ppm")) {
      pages[file] = picture_of(cli.read(file));
    }
  }
  std::vector<Picture> out;
  for (auto& [file, page] : pages) out.push_back(std::move(page));
  REQUIRE_FALSE(out.empty());
  return out;
}

TEST_CASE("marks of discrepancies are on paper, too") {
  if (!has_printer()) return;
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--execution", "closed-loop", "--keep-going",
                        "--max-runs", "30", "--out", "loop"})
              .code <= 4);
  REQUIRE(cli.parallax({"report", "loop", "-o", "loop.html"}).code == 0);
  // Letters have square dots, too: the same page without its marks tells how many.
  auto page = cli.read("loop.html");
  const std::string mark = "class=\"dot bad";
  int plots = 0;
  for (auto at = page.find(mark); at != std::string::npos; at = page.find(mark, at)) {
    page.replace(at, mark.size(), "class=\"none bad");
    ++plots;
  }
  REQUIRE(plots > 2);
  cli.write("bare.html", page);
  const auto red_squares = [&](const char* name) {
    int count = 0;
    for (const auto& sheet : printed(cli, name)) count += squares(sheet, {184, 41, 15}, 5, 16);
    return count;
  };
  // At least one mark in each plot of starts; others may overlap or be rings.
  const int marks = red_squares("loop.html") - red_squares("bare.html");
  CAPTURE(plots);
  CHECK(marks >= 4);
}

}  // namespace
}  // namespace parallax::test
