// Kept passes against a fresh run, for random changes of the files around a case: whatever a case
// would read now, its kept result has seen.

#include <doctest/doctest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kFour = "event Turn()\n[time] Initiates(Turn(),Wet(),time).\n";
constexpr const char* kEight = "event Turn()\nevent Shut()\n[time] Initiates(Turn(),Wet(),time).\n";

/// A project whose case loads a text that may lie at several places, and random changes of it.
class Project {
 public:
  Project(const CliFixture& cli, std::mt19937& random)
      : random_(random), top_(cli.folder() / "project") {
    fs::remove_all(top_);
    for (const auto* folder : {"m/deep", "m/foundations", "shared/foundations", "work/deep"}) {
      fs::create_directories(top_ / folder);
    }
    if (pick(2) == 0) write(".parallax-root", "");
    const std::vector<std::string> loads = {"x.e", "deep/x.e", "../shared/x.e",
                                            "foundations/more.e"};
    load_ = loads[pick(loads.size())];
    write("m/tap.e", "range time 0 1\nfluent Wet()\nload foundations/EC.e\nload " + load_ + '\n');
    write(fs::path("work") / load_, kFour);
    if (pick(3) == 0) write(fs::path("m") / load_, kFour);
    write("shared/x.e", kFour);
    write("m/suite.yaml", "cases:\n  - {id: tap, model: tap.e, expect: {traces: 4}}\n");
  }

  /// One change of a kind that a look-up, a gate or a reader may see.
  void change() {
    static const std::vector<std::string> kTexts = {
        "m/x.e",         "m/deep/x.e", "m/foundations/EC.e",  "m/foundations/more.e",
        "work/deep/x.e", "shared/x.e", "m/foundations/Root.e"};
    if (pick(3) == 0) return write(fs::path("m") / load_, kEight);
    if (pick(3) == 0) return write(kTexts[pick(kTexts.size())], kEight);
    static const std::vector<std::string> kPlaces = {"m",      "m/deep",        "work", "work/deep",
                                                     "shared", "m/foundations", "."};
    static const std::vector<std::string> kNames = {"x.e", "more.e", "EC.e", "Root.e",
                                                    ".parallax-root"};
    const auto path = fs::path(kPlaces[pick(kPlaces.size())]) / kNames[pick(kNames.size())];
    const auto place = (top_ / path).lexically_normal();
    switch (pick(4)) {
      case 0:  // the same text, behind a link that leads out of the project
        if (fs::exists(place)) {
          const auto outside = top_.parent_path() / "outside.e";
          fs::copy_file(place, outside, fs::copy_options::overwrite_existing);
          fs::remove(place);
          fs::create_symlink(outside, place);
          return;
        }
        [[fallthrough]];
      case 1:
        fs::remove(place);
        return;
      case 2:
        fs::permissions(place.parent_path(), fs::perms::others_write, fs::perm_options::add);
        return;
      default:
        write(path, path.filename() == ".parallax-root" ? "" : kEight);
    }
  }

  /// `parallax suite ../m ARGUMENTS...` in `work`: the exit code, the outcome and the problems.
  std::string suite(const std::vector<std::string>& arguments) const {
    std::vector<std::string> command = {CliFixture::program(), "suite", "../m", "--json", "-q"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    ProcessOptions options;
    options.folder = (top_ / "work").string();
    const auto result = run_process(command, options);
    const auto json = Json::parse(result.out, nullptr, false);
    if (!json.is_object() || !json.contains("cases")) return result.err;
    const auto& one = json["cases"][0];
    // Further problems describe the changes since a pass that was kept.
    const auto& problems = one["problems"];
    return std::to_string(result.code) + ' ' + one["outcome"].get<std::string>() + ' ' +
           (problems.empty() ? "" : problems[0].dump());
  }

 private:
  std::size_t pick(std::size_t count) { return random_() % count; }
  void write(const fs::path& path, const std::string& text) const {
    fs::create_directories((top_ / path).parent_path());
    fs::remove(top_ / path);
    std::ofstream(top_ / path) << text;
  }

  std::mt19937& random_;
  fs::path top_;
  std::string load_;
};

TEST_CASE("a kept result is that of a fresh run, whatever file appeared or went") {
  const CliFixture cli;
  std::mt19937 random(7);
  int changed = 0;
  for (int trial = 0; trial < 7; ++trial) {
    CAPTURE(trial);
    Project project(cli, random);
    const auto before = project.suite({"--cache", "../kept", "--out", "../first"});
    for (int i = 0; i < 2; ++i) project.change();
    const auto fresh = project.suite({"--no-cache", "--out", "../fresh"});
    CHECK(project.suite({"--cache", "../kept", "--out", "../second"}) == fresh);
    CHECK(project.suite({"--no-cache", "--resume", "--out", "../first"}) == fresh);
    changed += fresh == before ? 0 : 1;
  }
  CHECK(changed >= 3);  // else the changes were none that matter
}

TEST_CASE("what is expected of a case is part of it") {
  const SuiteFixture cli;
  cli.write("s/suite.yaml", "cases:\n  - {id: both, model: lamp.e, expect: {traces: 2}}\n");
  REQUIRE(cli.suite({"--no-cache"}).code == 0);
  cli.replace("s/suite.yaml", "traces: 2", "traces: 3");
  CHECK(cli.suite({"--no-cache", "--resume"}).code == 1);
  cli.replace("s/suite.yaml", "traces: 3", "traces: 2");
  CHECK(cli.suite({"--no-cache", "--resume"}).code == 0);
}

}  // namespace
}  // namespace parallax::test
