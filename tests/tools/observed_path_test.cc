// Recorded simulations as explanations and repairs read them: steps, states, where they part.

#include "tools/app/observed_path.h"

#include <doctest/doctest.h>

#include "runtime/session/solver_session.h"
#include "tests/tools/two_models.h"
#include "tools/app/recorded_run.h"

namespace parallax::test {
namespace {

using tools::ObservedPath;

/// A run folder, and the paths that are read from it.
struct Read {
  tools::Context context;
  std::optional<tools::ScenarioModel> loaded;
  std::vector<ObservedPath> paths;

  Read(const TwoModels& cli, const std::string& scenario, const std::string& folder) {
    const auto path = (cli.folder() / folder).string();
    const auto journal = harness::read_journal(path, context.files(), context.sink());
    REQUIRE(journal);
    auto model =
        tools::load_recorded_scenario({path, (cli.folder() / scenario).string()}, *journal->header,
                                      tools::ScenarioUse::kExplain, context);
    REQUIRE(model);
    loaded.emplace(*std::move(model));
    auto read = tools::observed_paths(*loaded, *journal, context);
    REQUIRE(read);
    paths = *std::move(read);
  }
  std::optional<std::size_t> parting(std::size_t path) const {
    const auto& model = loaded->compilation.model;
    runtime::SolverSession session(model, runtime::make_cadical_solver());
    const auto found = tools::parting_of(paths.at(path), tools::PathFacts(model), session);
    CHECK_FALSE(found.undecided);
    return found.after;
  }
  /// The observed value that is compared with the model; none: left open.
  std::optional<bool> seen(std::size_t path, std::size_t t, const std::string& fluent) const {
    const compiler::SymbolTable symbols(loaded->compilation.model);
    const auto& state = paths.at(path).states.at(t);
    const auto found = state.find(*symbols.fluent(fluent));
    return found == state.end() ? std::nullopt : std::optional(found->second);
  }
};

TEST_CASE("a trace that was simulated, with the timepoint at which the model cannot follow") {
  const TwoModels cli;
  REQUIRE(cli.parallax({"run", "two/unparks.yaml", "--out", "out"}).code == 1);
  const Read read(cli, "two/unparks.yaml", "out");
  REQUIRE(read.paths.size() == 1);
  const auto& path = read.paths.front();
  CHECK_FALSE(path.executed);
  REQUIRE(path.steps.size() == 3);
  CHECK(path.steps[0].name == "OpenDrawer(top)");
  CHECK(read.loaded->compilation.model.events[path.steps[2].event.index()].name == "Park()");
  CHECK(path.steps[0].source.find("open_and_close.lisp:4") != std::string::npos);
  CHECK(read.seen(0, 0, "Parked()") == true);
  CHECK(read.seen(0, 1, "Parked()") == false);
  CHECK(read.seen(0, 1, "Open(top)") == true);
  CHECK(read.parting(0) == 1);
}

TEST_CASE("a plan that was executed: the same steps, with its performs") {
  const TwoModels cli;
  REQUIRE(cli.parallax({"run", "two/unparks.yaml", "--execution", "closed-loop", "--out", "out"})
              .code == 1);
  const Read read(cli, "two/unparks.yaml", "out");
  REQUIRE(!read.paths.empty());
  const auto& path = read.paths.front();
  CHECK(path.executed);
  const auto& plan = read.loaded->compilation.model.plan;
  for (const auto& step : path.steps) {
    REQUIRE(step.perform);
    CHECK(plan[step.perform->index()].event == step.name);
    CHECK(step.succeeded);
  }
  CHECK(read.parting(0) == 1);
}

TEST_CASE("a clean run does not part, in either way of execution") {
  const TwoModels cli;
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    REQUIRE(cli.parallax({"run", "two/agree.yaml", "--execution", execution, "--epsilon", "0.5",
                          "--out", execution})
                .code == 0);
    const Read read(cli, "two/agree.yaml", execution);
    REQUIRE(read.paths.size() > 1);
    for (std::size_t i = 0; i < read.paths.size(); ++i) CHECK(read.parting(i) == std::nullopt);
  }
}

TEST_CASE("where the end alone is compared, what comes back is no difference on the way") {
  const TwoModels cli;
  // It leaves its parking place until it is parked again, and the drawer never closes.
  const auto scenario = cli.world(
      "sort drawer\ndrawer top\nfluent Open(drawer)\nfluent Parked()\nevent OpenDrawer(drawer)\n"
      "event CloseDrawer(drawer)\nevent Park()\nevent Reach()\n"
      "[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n"
      "[drawer,time] Terminates(OpenDrawer(drawer),Parked(),time).\n"
      "[time] Initiates(Park(),Parked(),time).\n");
  REQUIRE(cli.parallax({"run", scenario, "--compare", "final", "--out", "out"}).code == 1);
  const Read read(cli, scenario, "out");
  REQUIRE(read.paths.size() == 1);
  CHECK(read.seen(0, 1, "Parked()") == std::nullopt);
  CHECK(read.seen(0, 1, "Open(top)") == true);
  CHECK(read.seen(0, 2, "Open(top)") == true);
  CHECK(read.seen(0, 3, "Parked()") == true);
  CHECK(read.parting(0) == 2);
}

}  // namespace
}  // namespace parallax::test
