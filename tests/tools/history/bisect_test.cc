// Search for the revision that changed a verdict: real git repositories.

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/history/git_repository.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A scenario `s/s.yaml` whose model and plan come from the two that the folder has.
class BisectFixture : public GitFixture {
 public:
  BisectFixture() {
    fs::create_directories(folder() / "s");
    write(".parallax-root", "");
    write("s/s.yaml",
          "include: ../common.yaml\nmodel: [m.e, ../start.e]\nplan: p.lisp\nbind: ../robot.bind\n"
          "horizon: 6\ncriterion: {epsilon: 0.5, confidence: 0.7}\nconstraints:\n"
          "  - \"{region} (Happens(Place(region),time-1) & HoldsAt(BoxIn(region),time))\"\n");
    right();
  }
  void right() const {
    write("s/m.e", read("domain.e"));
    write("s/p.lisp", read("fetch.lisp"));
  }
  void wrong() const {
    write("s/m.e", read("wrong_domain.e"));
    write("s/p.lisp", read("hasty.lisp"));
  }
  std::string noise(int i) const {
    write("s/m.e", read("s/m.e") + "; " + std::to_string(i) + "\n");
    return commit("noise " + std::to_string(i));
  }
  Json bisect(std::vector<std::string> arguments, int code) const {
    arguments.insert(arguments.begin(), "bisect");
    auto split = std::find(arguments.begin(), arguments.end(), "--");
    arguments.insert(split, "--json");
    const auto result = parallax(arguments);
    CAPTURE(result.err);
    CHECK(result.code == code);
    REQUIRE(Json::accept(result.out));
    return Json::parse(result.out);
  }
};

TEST_CASE("the revision that changed the verdict, in either direction, and what it changed") {
  const BisectFixture repository;
  const auto first = repository.commit("first");
  for (int i = 0; i < 3; ++i) repository.noise(i);
  repository.wrong();
  const auto broken = repository.commit("Pick up\x1b[2J from anywhere");
  for (int i = 3; i < 6; ++i) repository.noise(i);
  const auto late = repository.git({"rev-parse", "HEAD"});
  repository.right();
  const auto mended = repository.commit("mend");
  const auto last = repository.noise(7);
  // The user's work in progress is left alone: a change, the index, a branch.
  repository.write("s/m.e", "not a model\n");
  const auto before = repository.git({"status", "--porcelain=v2", "--branch"});
  const auto refs = repository.git({"for-each-ref"}) + repository.git({"worktree", "list"});

  const auto result = repository.bisect({first, late, "--", "s/s.yaml"}, 1);
  REQUIRE(result["changed_by"].size() == 1);
  CHECK(result["changed_by"][0]["revision"] == broken);
  CHECK(result["old"]["verdict"] == "no-discrepancy");
  CHECK(result["new"]["verdict"] == "discrepancy");
  CHECK(result["tried"].size() <= 3);  // of seven revisions, by bisection
  CHECK_MESSAGE(holds(result["difference"].get<std::string>(), "axiom"), result.dump());
  CHECK(repository.bisect({late, last, "--", "s/s.yaml"}, 1)["changed_by"][0]["revision"] ==
        mended);
  // Equal at both ends, although it was another one between them.
  CHECK(repository.bisect({first, last, "--", "s/s.yaml"}, 0)["changed_by"].empty());

  const auto text =
      repository.parallax({"bisect", "HEAD~8", "HEAD~2", "--", "s/s.yaml", "--seed", "3"});
  CHECK(text.code == 1);
  CHECK_MESSAGE(holds(text.out, "changes the verdict from no-discrepancy to discrepancy"),
                text.out);
  CHECK(text.out.find('\x1b') == std::string::npos);
  CHECK(text.err.find('\x1b') == std::string::npos);
  CHECK(holds(text.out, "PickUp() fails (out of reach"));

  CHECK(repository.git({"status", "--porcelain=v2", "--branch"}) == before);
  CHECK(repository.git({"for-each-ref"}) + repository.git({"worktree", "list"}) == refs);
  CHECK(repository.read("s/m.e") == "not a model\n");
}

TEST_CASE("what gives no verdict is skipped and named, never guessed") {
  const BisectFixture repository;
  const auto first = repository.commit("first");
  const auto model = repository.read("s/m.e");
  repository.write("s/m.e", "fluent On(\n");
  const auto broken = repository.commit("does not compile");
  fs::remove(repository.folder() / "s/s.yaml");
  const auto missing = repository.commit("without the scenario");
  repository.git({"checkout", "--quiet", first, "--", "s/s.yaml"});
  repository.wrong();
  const auto last = repository.commit("wrong");
  const auto result = repository.bisect({first, last, "--", "s/s.yaml"}, 4);
  std::vector<std::string> left;
  for (const auto& one : result["changed_by"]) left.push_back(one["revision"]);
  std::sort(left.begin(), left.end());
  std::vector<std::string> expected = {broken, missing, last};
  std::sort(expected.begin(), expected.end());
  CHECK(left == expected);
  const auto text = repository.parallax({"bisect", first, last, "--", "s/s.yaml"});
  CHECK(text.code == 4);
  CHECK(holds(text.out, "skipped: the scenario is missing"));
  CHECK(holds(text.out, "without the scenario"));
  // At an end there is nothing to look for.
  CHECK(repository.parallax({"bisect", first, missing, "--", "s/s.yaml"}).code == 3);
  CHECK(repository.parallax({"bisect", broken, last, "--", "s/s.yaml"}).code == 3);
  const auto limited =
      repository.parallax({"bisect", first, last, "--", "s/s.yaml", "--max-runs", "1"});
  CHECK(limited.code == 4);
  CHECK_MESSAGE(holds(limited.out, "inconclusive"), limited.out);
}

TEST_CASE("nothing of the repository is executed, and its settings do not count") {
  const BisectFixture repository;
  const auto mark = (repository.folder() / "executed").string();
  repository.write("s/.gitattributes", "*.e filter=evil\n");
  const auto first = repository.commit("first");
  repository.wrong();
  const auto last = repository.commit("wrong");
  const auto script = repository.folder() / "evil.sh";
  repository.write("evil.sh", "#!/bin/sh\necho $0 >> '" + mark + "'\ncat\n");
  fs::permissions(script, fs::perms::owner_all);
  for (const auto* hook : {"post-checkout", "reference-transaction", "post-index-change"}) {
    fs::copy_file(script, repository.folder() / ".git/hooks" / hook);
  }
  fs::remove(mark);
  std::string config = repository.read(".git/config");
  for (const std::string setting :
       {"[core]\n\tfsmonitor = ", "[filter \"evil\"]\n\trequired = true\n\tsmudge = ",
        "[core]\n\tpager = ", "[gpg]\n\tprogram = "}) {
    config += setting + script.string() + "\n";
  }
  repository.write(".git/config", config + "[log]\n\tshowSignature = true\n");
  fs::remove(mark);
  CHECK(repository.bisect({first, last, "--", "s/s.yaml"}, 1)["changed_by"][0]["revision"] == last);
  CHECK_MESSAGE(!fs::exists(mark), repository.read("executed"));
}

TEST_CASE("a scenario that names a command is run only where that is permitted") {
  const BisectFixture repository;
  const auto mark = repository.folder() / "started";
  const auto first = repository.commit("first");
  repository.write("s/s.yaml", repository.read("s/s.yaml") + "simulator: {command: [touch, '" +
                                   mark.string() + "']}\n");
  const auto last = repository.commit("a command");
  const auto refused = repository.parallax({"bisect", first, last, "--", "s/s.yaml"});
  CHECK(refused.code == 3);
  CHECK_MESSAGE(holds(refused.out, "E7114"), refused.out);
  CHECK(!fs::exists(mark));
  CHECK(repository.parallax({"bisect", first, last, "--", "s/s.yaml", "--allow-commands"}).code ==
        2);
  CHECK(!fs::exists(mark));
  (void)repository.parallax({"bisect", "--allow-commands", first, last, "--", "s/s.yaml"});
  CHECK(fs::exists(mark));
}

TEST_CASE("what git does not know, and what is no checkout") {
  const BisectFixture repository;
  const auto first = repository.commit("first");
  const auto code = [&](const std::vector<std::string>& words) {
    std::vector<std::string> arguments = {"bisect"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    return repository.parallax(arguments).code;
  };
  CHECK(code({first, "nowhere", "--", "s/s.yaml"}) == 2);
  CHECK(code({first, "", "--", "s/s.yaml"}) == 2);
  CHECK(code({"--", "--all", first, "s/s.yaml"}) == 2);
  CHECK(code({first, first}) == 2);
  CHECK(code({first, first, "--", "../../../../../etc/passwd"}) == 2);
  CHECK(code({first, first, "--", "/nowhere/at/all.yaml"}) == 2);
  CHECK(code({first, first, "--", "s/s.yaml", "--out", "x"}) == 2);
  CHECK(code({first, first, "--", "s/other.yaml"}) == 3);
  CHECK(code({first, first, "--", "s/s.yaml"}) == 0);
}

TEST_CASE("from a subfolder, with a folder that is gone, from a linked worktree, and when ended") {
  const BisectFixture repository;
  const auto first = repository.commit("first");
  repository.wrong();
  const auto middle = repository.commit("wrong");
  const auto last = repository.noise(1);
  repository.git({"worktree", "add", "--quiet", "linked", last});
  repository.write("linked/linked", "x");
  ProcessOptions there;
  there.folder = (repository.folder() / "linked/s").string();
  const auto linked = repository.parallax({"bisect", first, last, "--", "s.yaml"}, there);
  CHECK_MESSAGE(linked.code == 1, linked.err);
  CHECK(holds(linked.out, middle.substr(0, 12)));
  fs::remove_all(repository.folder() / "s");
  const auto gone = repository.parallax({"bisect", first, last, "--", "s/s.yaml"});
  CHECK_MESSAGE(gone.code == 1, gone.err);
  ProcessOptions ended;
  int looks = 20;
  ended.signal_when = [&looks] { return looks-- == 0 ? SIGTERM : 0; };
  const auto stopped = repository.parallax({"bisect", first, last, "--", "s/s.yaml"}, ended);
  CHECK((stopped.code == 143 || stopped.code == 1));
}

}  // namespace
}  // namespace parallax::test
