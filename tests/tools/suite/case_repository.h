#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {

/// A folder `repository` of forty small cases: 28 of two manifests, eight scenarios whose world is
/// a model, four in the physics of scenarios/two_regions. All pass, and the same ones every time.
class CaseRepository : public CliFixture {
 public:
  static constexpr int kCases = 40;

  CaseRepository() {
    namespace fs = std::filesystem;
    const auto root = folder() / "repository";
    for (const auto* part : {"switches", "errands", "drawers", "boxes"}) {
      fs::create_directories(root / part);
    }
    write_switches();
    write_errands();
    const auto scenarios = fs::path(PARALLAX_SOURCE_DIR) / "scenarios";
    copy_files(scenarios / "two_models", root / "drawers", {".e", ".lisp", ".bind"});
    copy_files(scenarios / "two_models", root / "drawers/world", {".e"});
    fs::copy(scenarios / "two_models/common.yaml", root / "drawers");
    write_drawers();
    copy_files(scenarios / "two_regions", root / "boxes", {".e", ".lisp", ".bind"});
    fs::copy(scenarios / "two_regions/common.yaml", root / "boxes");
    fs::copy(scenarios / "two_regions/world.yaml", root / "boxes");
    write_boxes();
    const auto golden = suite({"--only", "list", "--update-goldens", "--force", "--out", "golden"});
    if (golden.code != 0) throw std::runtime_error(golden.out + golden.err);
  }

  ProcessResult suite(std::vector<std::string> arguments, ProcessOptions options = {}) const {
    arguments.insert(arguments.begin(), {"suite", "repository"});
    return parallax(std::move(arguments), std::move(options));
  }

 private:
  static void copy_files(const std::filesystem::path& from, const std::filesystem::path& to,
                         const std::vector<std::string>& extensions) {
    std::filesystem::create_directories(to);
    for (const auto& entry : std::filesystem::directory_iterator(from)) {
      for (const auto& extension : extensions) {
        if (entry.path().extension() == extension) std::filesystem::copy(entry.path(), to);
      }
    }
  }

  static std::string trace_case(const std::string& id, const std::string& model, int horizon,
                                const std::string& until, const std::string& expect) {
    return "  - {id: " + id + ", model: " + model + ", horizon: " + std::to_string(horizon) +
           (until.empty() ? "" : ", constraints: '" + until + "'") + ", expect: {" + expect +
           "}}\n";
  }
  static std::string traces(long count) { return "traces: " + std::to_string(count); }

  /// Sixteen cases on two lamps, each of which may be switched or not at each timepoint.
  void write_switches() const {
    write("repository/switches/switch.e",
          "sort lamp\n"
          "lamp Desk, Floor\n"
          "fluent On(lamp)\n"
          "event Flip(lamp)\n"
          "[lamp,time] !HoldsAt(On(lamp),time) -> Initiates(Flip(lamp),On(lamp),time).\n"
          "[lamp,time] HoldsAt(On(lamp),time) -> Terminates(Flip(lamp),On(lamp),time).\n"
          "[lamp] !HoldsAt(On(lamp),0).\n");
    std::string text = "cases:\n";
    const auto add = [&](const std::string& id, int horizon, const std::string& until,
                         const std::string& expect) {
      text += trace_case(id, "switch.e", horizon, until, expect);
    };
    for (int h = 0; h <= 4; ++h) add("all" + std::to_string(h), h, "", traces(1L << (2 * h)));
    // Lit at t + 1 for the first time: at t the desk lamp is switched, before it is not.
    const std::string lit = "HoldsAt(On(Desk),time)";
    for (int h = 1; h <= 4; ++h) {
      add("lit" + std::to_string(h), h, lit, traces(2 * ((1L << h) - 1)));
    }
    // Dark again: switched twice, the second time at t, the first at any of t timepoints before.
    const std::string dark = "HoldsAt(On(Desk),time-1) & !HoldsAt(On(Desk),time)";
    long count = 0;
    for (int h = 2; h <= 4; ++h) {
      count += (h - 1) * (1L << h);
      add("dark" + std::to_string(h), h, dark, traces(count));
    }
    add("never_lit_at_once", 0, lit, traces(0));
    add("more_than_ten", 4, "", "traces: 10, complete: false");
    add("list1", 1, "", "golden: expected/list1.txt");
    add("list_dark", 2, dark, "golden: expected/list_dark.txt");
    write("repository/switches/suite.yaml", text);
  }

  /// Twelve cases on errands between three rooms: at each timepoint one room to go to, or none.
  void write_errands() const {
    write("repository/errands/errand.e",
          "sort room\n"
          "room Hall, Kitchen, Study\n"
          "fluent At(room)\n"
          "event Go(room)\n"
          "[room,time] Initiates(Go(room),At(room),time).\n"
          "[room1,room2,time] HoldsAt(At(room1),time) & room1!=room2 ->\n"
          "  Terminates(Go(room2),At(room1),time).\n"
          "[room1,room2,time]\n"
          "  Happens(Go(room1),time) & Happens(Go(room2),time) -> room1=room2.\n"
          "HoldsAt(At(Hall),0).\n"
          "!HoldsAt(At(Kitchen),0).\n"
          "!HoldsAt(At(Study),0).\n");
    std::string text = "cases:\n";
    long all = 1, there = 0, elsewhere = 1;
    for (int h = 1; h <= 4; ++h) {
      all *= 4;
      // There for the first time after t + 1: any of three choices at each timepoint before.
      there += elsewhere;
      elsewhere *= 3;
      const auto n = std::to_string(h);
      text += trace_case("all" + n, "errand.e", h, "", traces(all));
      text += trace_case("kitchen" + n, "errand.e", h, "HoldsAt(At(Kitchen),time)", traces(there));
      text += trace_case("study" + n, "errand.e", h, "HoldsAt(At(Study),time)", traces(there));
    }
    write("repository/errands/suite.yaml", text);
  }

  void scenario(const std::string& name, const std::string& text) const {
    write("repository/" + name + ".yaml", "include: common.yaml\n" + text);
  }

  /// Eight scenarios on a drawer; their worlds are models of their own.
  void write_drawers() const {
    const auto add = [&](const std::string& name, const std::string& world,
                         const std::string& expect, const std::string& more = "") {
      scenario("drawers/" + name, "model: [opens.e, start.e]\nsimulator: {model: world/" + world +
                                      ".e}\n" + more + "expect: " + expect + "\n");
    };
    add("agree", "opens", "{verdict: no-discrepancy, iterations: 1}");
    add("agree_loosely", "opens", "{verdict: no-discrepancy, max_simulations: 25}",
        "criterion: {confidence: 0.99, epsilon: 0.2}\n");
    add("agree_at_the_end", "opens", "{verdict: no-discrepancy}", "compare: final\n");
    add("agree_always", "opens", "{rate: {below: 0.05, confidence: 0.99}}");
    add("unparks", "unparks",
        "{verdict: discrepancy, cause: {event: OpenDrawer(top), fluent: Parked()}}");
    add("unparks_at_the_end", "unparks", "{verdict: no-discrepancy}", "compare: final\n");
    add("sticks", "sticks", "{rate: {between: [0.4, 0.6], confidence: 0.95, runs: 500}}");
    add("sticks_by_chance", "sticks",
        "{rate: {above: 0.3, cause: {event: OpenDrawer(top), fluent: Open(top), kind: random}}}");
  }

  /// Four scenarios with a robot and a box.
  void write_boxes() const {
    const std::string goal =
        "bind: robot.bind\nhorizon: 6\n"
        "constraints: '{region} (Happens(Place(region),time-1) & HoldsAt(BoxIn(region),time))'\n"
        "criterion: {confidence: 0.9, epsilon: 0.4}\n";
    scenario("boxes/fetch", "model: [domain.e, start.e]\nplan: fetch.lisp\n" + goal +
                                "expect: {verdict: no-discrepancy, iterations: 1}\n");
    const auto hasty = "model: [wrong_domain.e, start.e]\nplan: hasty.lisp\n" + goal + "expect: ";
    scenario("boxes/hasty", hasty + "{verdict: discrepancy, fluents: [BoxIn(r1)]}\n");
    scenario("boxes/hasty_reach",
             hasty + "{cause: {event: PickUp(), reason: out of reach, fluent: Holding()}}\n");
    scenario("boxes/hasty_mostly", hasty + "{rate: {above: 0.5, runs: 40}}\n");
  }
};

}  // namespace parallax::test
