// A gate over two folders, or over two revisions of one: that no change passes because the gate did
// not look at it.

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/tools/history/git_repository.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNames =
    "range time 0 1\nfluent Alive()\nfluent Loaded()\nevent Shoot()\nHoldsAt(Alive(),0).\n";
constexpr const char* kShot =
    "[time] HoldsAt(Loaded(),time) -> Terminates(Shoot(),Alive(),time).\n";
constexpr const char* kDeadlier = "[time] Terminates(Shoot(),Alive(),time).\n";

class Trees : public GitFixture {
 public:
  Trees() { write("rules.yaml", "models: {lost_traces: forbidden, gained_traces: forbidden}\n"); }

  void put(const std::string& name, const std::string& text) const {
    fs::create_directories((folder() / name).parent_path());
    write(name, text);
  }
  /// `TREE/cases`: a manifest, and its model, which loads a file.
  void project(const std::string& tree, const std::string& loaded) const {
    put(tree + "/.parallax-root", "");
    put(tree + "/cases/suite.yaml",
        "cases:\n  - {id: turkey, model: domain.e, expect: {traces: 4}}\n");
    put(tree + "/cases/domain.e", kNames + ("load " + loaded + "\n"));
  }
  ProcessResult gate(std::vector<std::string> trees, ProcessOptions options = {}) const {
    trees.insert(trees.begin(), {"diff", "--gate", (folder() / "rules.yaml").string()});
    return parallax(std::move(trees), std::move(options));
  }
  /// The gate's answer must have this exit code and these words.
  void check(const ProcessResult& answer, int code, const std::string& words) const {
    CHECK_MESSAGE(answer.code == code, answer.out, answer.err);
    CHECK_MESSAGE(answer.out.find(words) != std::string::npos, answer.out, answer.err);
  }
};

constexpr const char* kLost = "broken         domain.e: models.lost_traces";

TEST_CASE("a file that belongs to a model counts wherever it lies") {
  const Trees trees;
  struct Place {
    const char* loaded;
    const char* file;
  };
  for (const auto& place :
       {Place{"../shared/shot.e", "shared/shot.e"}, Place{".parts/shot.e", "cases/.parts/shot.e"},
        Place{"done/shot.e", "cases/done/shot.e"}, Place{"link.e", "cases/.parts/shot.e"}}) {
    CAPTURE(place.loaded);
    for (const std::string tree : {"a", "b"}) {
      fs::remove_all(trees.folder() / tree);
      trees.project(tree, place.loaded);
      trees.put(tree + "/" + place.file, kShot);
      trees.put(tree + "/cases/done/report.json", "{}\n");
      if (place.loaded == std::string("link.e")) {
        fs::create_symlink(".parts/shot.e", trees.folder() / tree / "cases/link.e");
      }
    }
    trees.check(trees.gate({"a/cases", "b/cases"}), 0, "no file of 1 scenario or model changed");
    trees.check(trees.gate({"a/cases", "b/cases"}), 0, "nothing changed that a rule is about");
    trees.put(std::string("b/") + place.file, kDeadlier);
    trees.check(trees.gate({"a/cases", "b/cases"}), 1, kLost);
  }
}

TEST_CASE("a model that a manifest names counts in a hidden folder, too") {
  const Trees trees;
  for (const std::string tree : {"a", "b"}) {
    trees.put(tree + "/suite.yaml",
              "cases:\n  - {id: turkey, model: .parts/domain.e, expect: {traces: 4}}\n");
    trees.put(tree + "/.parts/domain.e", kNames + std::string(kShot));
  }
  trees.check(trees.gate({"a", "b"}), 0, "no file of 1 scenario or model changed");
  trees.put("b/.parts/domain.e", kNames + std::string(kDeadlier));
  trees.check(trees.gate({"a", "b"}), 1, "broken         .parts/domain.e: models.lost_traces");
}

TEST_CASE("what lies beside the folder of two revisions counts") {
  const Trees trees;
  trees.project("a", "../shared/shot.e");
  trees.put("a/shared/shot.e", kShot);
  trees.commit("start");
  trees.put("a/shared/shot.e", kDeadlier);
  trees.commit("forget the condition");
  trees.check(trees.gate({"HEAD^", "HEAD", "a/cases"}), 1, kLost);
  trees.check(trees.gate({"HEAD", "HEAD", "a/cases"}), 0, "no file of 1 scenario or model changed");
}

TEST_CASE("what cannot be read does not pass as new or untouched") {
  const Trees trees;
  for (const std::string tree : {"a", "b"}) {
    trees.project(tree, "shot.e");
    trees.put(tree + "/cases/shot.e", kShot);
  }
  const auto suite = trees.read("a/cases/suite.yaml");
  const auto gate = [&] { return trees.gate({"a/cases", "b/cases"}); };
  trees.check(gate(), 0, "no file of 1 scenario or model changed");
  // A manifest that no longer can be read, and one that could not before.
  trees.put("b/cases/suite.yaml", "cases: [\n");
  trees.check(gate(), 1, "suite.yaml: it cannot be read on the new side");
  trees.put("a/cases/suite.yaml", "cases: 3\n");
  trees.put("b/cases/suite.yaml", suite);
  trees.check(gate(), 1, "suite.yaml: it cannot be read on the old side");
  trees.put("a/cases/suite.yaml", suite);
  // A scenario that was broken and is good now.
  trees.put("a/cases/fetch.yaml", "include: absent.yaml\nmodel: domain.e\n");
  trees.put("b/cases/fetch.yaml", "model: domain.e\nexpect: {fast: true}\nworld: {}\n");
  const auto mended = gate();
  trees.check(mended, 1, "fetch.yaml: it cannot be read on the old side");
  CHECK(mended.out.find("fetch.yaml is new") == std::string::npos);
  // One that was none before: the file is not new, and as a scenario it has mistakes.
  trees.put("a/cases/fetch.yaml", "fast: true\n");
  const auto other = gate();
  trees.check(other, 1, "fetch.yaml: it cannot be compared");
  CHECK(other.out.find("fetch.yaml is new") == std::string::npos);
  fs::remove(trees.folder() / "a/cases/fetch.yaml");
  trees.check(gate(), 1, "fetch.yaml: it is new, and cannot be read");
  fs::remove(trees.folder() / "b/cases/fetch.yaml");
  trees.put("b/cases/other.e", kNames);
  trees.check(gate(), 0, "other.e is new");
  // A file that neither side has.
  for (const std::string tree : {"a", "b"}) fs::remove(trees.folder() / tree / "cases/shot.e");
  trees.check(gate(), 1, "domain.e: it cannot be compared");
}

TEST_CASE("folders without a scenario or manifest are compared by their models, if they have any") {
  const Trees trees;
  for (const std::string tree : {"a", "b"}) {
    trees.put(tree + "/notes.txt", tree);
  }
  trees.check(trees.gate({"a", "b"}), 1, "neither folder has a scenario or a model");
  for (const std::string tree : {"a", "b"}) {
    trees.put(tree + "/domain.e", kNames + std::string("load shot.e\n"));
    trees.put(tree + "/shot.e", kShot);
  }
  trees.check(trees.gate({"a", "b"}), 0, "no file of 1 scenario or model changed");
  trees.put("b/shot.e", kDeadlier);
  trees.check(trees.gate({"a", "b"}), 1, kLost);
}

TEST_CASE("what both sides would read from the current folder is not decided") {
  const Trees trees;
  trees.put("p/domain.e", kNames + std::string("load shared/shot.e\n"));
  trees.put("shared/shot.e", kShot);
  trees.commit("start");
  trees.put("shared/shot.e", kDeadlier);
  trees.commit("forget the condition");
  trees.check(trees.gate({"HEAD^", "HEAD", "p"}), 1,
              "domain.e: shared/shot.e is looked up from the current folder");
}

TEST_CASE("no temporary folder is named, and two calls say the same") {
  const Trees trees;
  trees.put("p/domain.e", kNames + std::string(kShot));
  trees.put("p/cut.e", "range time 0 1\nfluent On()\n");
  trees.commit("start");
  trees.put("p/domain.e", kNames + std::string(kDeadlier));
  trees.put("p/cut.e", "range time 0 1\nfluent On(\n");
  trees.commit("forget the condition");
  ProcessOptions inside;
  inside.folder = (trees.folder() / "p").string();
  struct Call {
    std::vector<std::string> arguments;
    ProcessOptions options;
  };
  for (const auto& [arguments, options] :
       {Call{{"HEAD^", "HEAD"}, {}}, Call{{"HEAD^", "HEAD", "."}, {}},
        Call{{"HEAD^", "HEAD", "p"}, {}}, Call{{"HEAD^", "HEAD"}, inside}}) {
    for (const bool as_document : {false, true}) {
      auto words = arguments;
      if (as_document) words.emplace_back("--json");
      const auto answer = trees.gate(words, options);
      trees.check(answer, 1, "models.lost_traces");
      CHECK_MESSAGE(answer.out.find("p/domain.e:6") != std::string::npos, answer.out);
      CHECK_MESSAGE(answer.out.find("/p/domain.e") == std::string::npos, answer.out);
      CHECK_MESSAGE(answer.out.find("/new") == std::string::npos, answer.out);
      CHECK_MESSAGE(answer.out.find("/old") == std::string::npos, answer.out);
      CHECK(answer.out == trees.gate(words, options).out);
    }
  }
}

constexpr const char* kOtherProgram = "broken         own.yaml: models.physics";

TEST_CASE("the program of an external simulator is that of each revision") {
  const Trees trees;
  trees.write("rules.yaml", "models: {physics: forbidden}\n");
  trees.put("own.yaml", "include: scenario.yaml\nsimulator: {command: [sh, tools/sim.sh]}\n");
  trees.put("tools/sim.sh", "exit 1\n");
  trees.commit("start");
  trees.put("tools/sim.sh", "exit 2\n");
  trees.commit("simulate otherwise");
  const auto answer = trees.gate({"HEAD^", "HEAD"});
  trees.check(answer, 1, kOtherProgram);
  CHECK_MESSAGE(answer.out.find("simulator.command.files") != std::string::npos, answer.out);
  CHECK(trees.gate({"HEAD", "HEAD"}).code == 0);
  // From a folder of the checkout, where the command is written for it.
  trees.put("own.yaml", "include: scenario.yaml\nsimulator: {command: [sh, ./sim.sh]}\n");
  trees.commit("start it in its folder");
  trees.put("tools/sim.sh", "exit 3\n");
  trees.commit("simulate otherwise again");
  ProcessOptions inside;
  inside.folder = (trees.folder() / "tools").string();
  trees.check(trees.gate({"HEAD^", "HEAD", ".."}, inside), 1, kOtherProgram);
}

TEST_CASE("the program of an external simulator is that of each folder") {
  const Trees trees;
  trees.write("rules.yaml", "models: {physics: forbidden}\n");
  for (const std::string tree : {"a", "b"}) {
    fs::create_directories(trees.folder() / tree);
    for (const auto* name : {"scenario.yaml", "common.yaml", "world.yaml", "domain.e", "start.e",
                             "fetch.lisp", "robot.bind"}) {
      fs::copy(trees.folder() / name, trees.folder() / tree / name);
    }
    trees.put(tree + "/own.yaml",
              "include: scenario.yaml\nsimulator: {command: [sh, tools/sim.sh]}\n");
    trees.put(tree + "/tools/sim.sh", "exit 1\n");
  }
  ProcessOptions inside;
  inside.folder = (trees.folder() / "b").string();
  trees.check(trees.gate({"../a", "."}, inside), 0, "no file of 2 scenarios and models changed");
  trees.put("b/tools/sim.sh", "exit 2\n");
  trees.check(trees.gate({"../a", "."}, inside), 1, kOtherProgram);
  trees.check(trees.gate({"a", "b"}), 1, kOtherProgram);
  // Without it nothing can be started.
  fs::remove(trees.folder() / "b/tools/sim.sh");
  trees.check(trees.gate({"../a", "."}, inside), 1, kOtherProgram);
}

/// scenarios/two_models below each of two folders, with the plan in a folder of its own.
void put_two_models(const Trees& trees) {
  for (const std::string tree : {"a", "b"}) {
    fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios" / "two_models", trees.folder() / tree);
    fs::create_directory(trees.folder() / tree / "plan");
    fs::rename(trees.folder() / tree / "open_and_close.lisp",
               trees.folder() / tree / "plan" / "a.lisp");
    trees.replace(tree + "/common.yaml", "plan: open_and_close.lisp", "plan: plan");
  }
}

TEST_CASE("a file that only one side has in a plan's folder is a change") {
  const Trees trees;
  put_two_models(trees);
  trees.put("rules.yaml", "models: {axioms: forbidden, declarations: forbidden}\n");
  trees.check(trees.gate({"a", "b"}), 0, "no file of 3 scenarios and models changed");
  trees.put("b/plan/b.lisp",
            "(def-cram-function more () (perform (an action (type parking-arms))))\n");
  const auto more = trees.gate({"a", "b"});
  CHECK_MESSAGE(more.code == 1, more.out, more.err);
  trees.put("b/plan/b.lisp", "(def-cram-function more (\n");
  const auto broken = trees.gate({"a", "b"});
  CHECK_MESSAGE(broken.code != 0, broken.out, broken.err);
}

TEST_CASE("a model that is the world belongs to the physics") {
  const Trees trees;
  put_two_models(trees);
  trees.put("rules.yaml", "models: {physics: forbidden}\n");
  trees.check(trees.gate({"a", "b"}), 0, "no file of 3 scenarios and models changed");
  trees.replace("b/unparks.e", "Terminates(", "Releases(");
  trees.check(trees.gate({"a", "b"}), 1, "in the model that is the world");
  // With evidence instead the two are run.
  trees.put("rules.yaml", "models: {physics: {rerun: {runs: 20, seconds: 60}}}\n");
  const auto run = trees.gate({"a", "b"});
  CHECK_MESSAGE(run.out.find("20 runs of each trace") != std::string::npos, run.out, run.err);
}

}  // namespace
}  // namespace parallax::test
