// The journal of an executed plan that was changed by hand: every command that reads it says so,
// and names the line.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

/// The drawer sticks or not, which the model does not know of: a discrepancy behind some clean
/// runs.
class ExecutedJournal : public TwoModels {
 public:
  ExecutedJournal() {
    write("two/start.e", "[drawer] !HoldsAt(Open(drawer),0).\n");
    write("two/plan.lisp",
          "(def-cram-function open-it ()\n"
          "  (unless (holds '(parked)) (perform (an action (type parking-arms))))\n"
          "  (with-failure-handling ((manipulation-low-level-failure (e) (return)))\n"
          "    (perform (an action (type opening) (object (an object (name top)))))))\n"
          "(open-it)\n");
    write("two/world.e",
          "load domain.e\nfluent Sticks()\nnoninertial Sticks\n[drawer,time] "
          "!HoldsAt(Sticks(),time) -> Initiates(OpenDrawer(drawer),Open(drawer),time).\n");
    write("two/own.yaml",
          "include: common.yaml\nsimulator: {model: world.e}\nexecution: closed-loop\n"
          "model: [opens.e, start.e]\nplan: plan.lisp\n"
          "mapping: {Parked(): {flag: \"Parked()\", drawn: true}}\n");
    json_of(*this, {"run", "two/own.yaml", "--out", "out", "--seed", "3"}, 1);
    journal_ = read("out/journal.ndjson");
  }
  /// Checks that every reader refuses the line with `from` changed to `to` in the line of the
  /// discrepancy and in that of its repetition, or in the latter alone.
  void refused(const std::string& from, const std::string& to, const std::string& why,
               bool repetition = false) const {
    const auto line_of = journal_.find("\"phase\":\"confirm\"");
    REQUIRE(line_of != std::string::npos);
    auto changed = journal_;
    const auto change_line_at = [&](std::size_t inside) {
      const auto begin = changed.rfind('\n', inside) + 1, end = changed.find('\n', inside);
      const auto at = changed.find(from, begin);
      REQUIRE(at < end);
      changed.replace(at, from.size(), to);
    };
    change_line_at(line_of);  // the later one first: the place of the other stays
    if (!repetition) change_line_at(changed.rfind('\n', line_of) - 1);
    write("out/journal.ndjson", changed);
    const std::vector<std::vector<std::string>> commands = {
        {"replay", "out"},   {"explain", "out"},
        {"draw", "out"},     {"monitor", "two/own.yaml", "out"},
        {"coverage", "out"}, {"run", "two/own.yaml", "--out", "out", "--seed", "3", "--resume"},
    };
    for (const auto& command : commands) {
      const auto result = parallax(command);
      CAPTURE(command.front());
      CAPTURE(result.err);
      CHECK(result.code == 3);
      CHECK(result.err.find("error[E7103]") != std::string::npos);
      CHECK(result.err.find("out/journal.ndjson:") != std::string::npos);
      CHECK(result.err.find(why) != std::string::npos);
    }
  }

 private:
  std::string journal_;
};

TEST_CASE("a changed journal of an executed plan is refused by all that read it") {
  const ExecutedJournal cli;
  SUBCASE("an outcome that the plan did not make of what it was told") {
    cli.refused("\"succeeded\":false", "\"succeeded\":true", "is not what the plan makes of");
  }
  SUBCASE("another end of the plan") {
    cli.refused("\"end\":\"done\"", "\"end\":\"failed\"", "does not end like that");
  }
  SUBCASE("a repetition with another event") {
    cli.refused("\"event\":\"OpenDrawer(top)\"", "\"event\":\"OpenDrawer(mid)\"",
                "it repeats a simulation with another path", true);
  }
  SUBCASE("a repetition with another end") {
    cli.refused("\"end\":\"done\"", "\"end\":\"failed\"",
                "it repeats a simulation with another path", true);
  }
  SUBCASE("a repetition with another count") {
    cli.refused("\"attempt\":0", "\"attempt\":1",
                "it repeats a simulation with other counts of what was drawn", true);
  }
  SUBCASE("a repetition without a path") {
    cli.refused("\"path\":", "\"way\":", "`path` is missing, and the run executed a plan", true);
  }
  SUBCASE("another initial state") {
    const auto journal = cli.read("out/journal.ndjson");
    const auto confirm = journal.find("\"phase\":\"confirm\"");
    const auto at = journal.rfind("\"start_state\":", confirm);
    const bool first = journal.compare(at, 15, "\"start_state\":1") == 0;
    cli.refused(first ? "\"start_state\":1" : "\"start_state\":2",
                first ? "\"start_state\":2" : "\"start_state\":1",
                "its initial state is not that of its number");
  }
}

}  // namespace
}  // namespace parallax::test
