// The workflows of docs/guide/regression.md and docs/guide/ci, step by step, in a scratch
// repository. The parts of a service are simulated: a checkout is a clone, an artifact a copy.
// Steps called `install` are not run, as the program is there.

#include <doctest/doctest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/support/xml.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Settings = std::map<std::string, std::string>;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string file_text(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The rules that the page shows and the files beside it, by the place that their first line names.
std::map<std::string, std::string> files_of_page() {
  const auto guide = fs::path(PARALLAX_SOURCE_DIR) / "docs/guide";
  std::map<std::string, std::string> out;
  const auto add = [&](const std::string& text) {
    REQUIRE(text.starts_with("# "));
    out[text.substr(2, text.find('\n') - 2)] = text;
  };
  for (const auto& file : fs::directory_iterator(guide / "ci")) add(file_text(file.path()));
  std::istringstream page(file_text(guide / "regression.md"));
  std::string rules;
  for (std::string line; std::getline(page, line);) {
    const bool begins = line == "    # gate.yaml";
    if (begins || (!rules.empty() && line.starts_with("    "))) {
      rules += line.substr(4) + '\n';
    } else if (!rules.empty()) {
      break;
    }
  }
  add(rules);
  return out;
}

constexpr const char* kLock =
    "range time 0 2\n"
    "fluent Open()\n"
    "fluent Unlocked()\n"
    "event Pull()\n"
    "event Unlock()\n"
    "[time] HoldsAt(Unlocked(),time) -> Initiates(Pull(),Open(),time).\n"
    "[time] Initiates(Unlock(),Unlocked(),time).\n"
    "!HoldsAt(Open(),0).\n"
    "!HoldsAt(Unlocked(),0).\n";

/// A repository with the cases that the page speaks of, and pull requests for it.
class Checkouts : public TwoModels {
 public:
  Checkouts() {
    for (const auto& [name, text] : page_) place("repository/" + name, text);
    fs::rename(folder() / "two", folder() / "repository/cases");
    fs::rename(folder() / "repository/cases/agree.yaml", folder() / "repository/cases/drawer.yaml");
    write("repository/cases/world.e", read("repository/cases/opens.e"));
    replace("repository/cases/drawer.yaml", "{model: opens.e}", "{model: world.e}");
    write("repository/cases/lock.e", kLock);
    // Two events at each of two timepoints: sixteen traces. Open after two: unlocked, then pulled.
    std::string manifest = "cases:\n";
    for (int i = 0; i < 6; ++i) {
      manifest += "  - {id: all" + std::to_string(i) + ", model: lock.e, expect: {traces: 16}}\n";
    }
    manifest +=
        "  - {id: open, model: lock.e, constraints: 'HoldsAt(Open(),time)', expect: {traces: 4}}\n";
    write("repository/cases/suite.yaml", manifest);
    git("repository", {"init", "-q"});
    commit("before");
    git("repository", {"branch", "base"});
  }

  const std::map<std::string, std::string>& page() const { return page_; }

  void place(const std::string& name, const std::string& text) const {
    fs::create_directories((folder() / name).parent_path());
    write(name, text);
  }
  void git(const std::string& where, std::vector<std::string> words) const {
    words.insert(words.begin(), {"/usr/bin/git", "-c", "user.name=t", "-c", "user.email=t@t"});
    ProcessOptions options;
    options.folder = (folder() / where).string();
    const auto result = run_process(words, options);
    REQUIRE_MESSAGE(result.code == 0, result.err);
  }
  void commit(const std::string& message) const {
    git("repository", {"add", "-A"});
    git("repository", {"commit", "-q", "-m", message});
  }
  /// Commits a change and keeps the commit before it as the branch `base`.
  void pull_request(const std::string& file, const std::string& from, const std::string& to) const {
    git("repository", {"branch", "-f", "base"});
    replace("repository/" + file, from, to);
    commit("after");
  }
  /// A folder of a job, whose checkout lies in `work` and sees the base as a commit.
  std::string checkout(const std::string& job) const {
    fs::remove_all(folder() / job);
    fs::create_directories(folder() / job);
    git(job, {"clone", "-q", "../repository", "work"});
    git(job + "/work", {"fetch", "-q", "origin", "base:base"});
    return job + "/work";
  }
  /// The commands of a step as a service runs them.
  ProcessResult shell(const std::string& where, const std::string& script,
                      const Settings& settings) const {
    std::vector<std::string> words = {"/usr/bin/env"};
    for (const auto* name : {"CI", "SLURM_ARRAY_TASK_ID", "PARALLAX_SHARD_INDEX",
                             "PARALLAX_SHARD_TOTAL", "CI_NODE_INDEX", "CI_NODE_TOTAL"}) {
      words.insert(words.end(), {"-u", name});
    }
    const char* path = std::getenv("PATH");
    words.push_back(std::string("PATH=") + PARALLAX_BINARY_DIR + ":" +
                    (path == nullptr ? "/usr/bin:/bin" : path));
    words.emplace_back("CI=true");
    for (const auto& [name, value] : settings) words.push_back(name + "=" + value);
    words.insert(words.end(), {"bash", "-e", "-o", "pipefail", "-c", script});
    ProcessOptions options;
    options.folder = (folder() / where).string();
    return run_process(words, options);
  }

 private:
  std::map<std::string, std::string> page_ = files_of_page();
};

/// Replaces every `${{ name }}`; a name that the context lacks fails the test.
std::string filled_in(std::string text, const Settings& context) {
  for (auto at = text.find("${{ "); at != std::string::npos; at = text.find("${{ ")) {
    const auto end = text.find(" }}", at);
    REQUIRE(end != std::string::npos);
    const auto name = text.substr(at + 4, end - at - 4);
    REQUIRE_MESSAGE(context.contains(name), name);
    text.replace(at, end + 3 - at, context.at(name));
  }
  return text;
}

/// The steps of a job of GitHub's, until one fails; afterwards those that run always.
class GitHubJob {
 public:
  GitHubJob(const Checkouts& cli, const std::string& name, Settings context)
      : cli_(cli), context_(std::move(context)), work_(cli.checkout(name)) {
    cli_.write("summary", "");
  }

  int run(const YAML::Node& job) {
    for (const auto& step : job["steps"]) {
      const bool always = step["if"] && step["if"].as<std::string>() == "always()";
      if (code_ != 0 && !always) continue;
      if (step["uses"]) {
        use(step);
      } else if (step["name"].as<std::string>() != "install") {
        command(step);
      }
    }
    return code_;
  }
  const std::string& work() const { return work_; }
  const std::string& err() const { return err_; }
  int commands() const { return commands_; }

 private:
  void command(const YAML::Node& step) {
    Settings settings = {{"GITHUB_STEP_SUMMARY", (cli_.folder() / "summary").string()}};
    for (const auto& entry : step["env"]) {
      settings[entry.first.as<std::string>()] = filled_in(entry.second.as<std::string>(), context_);
    }
    const auto result = cli_.shell(work_, step["run"].as<std::string>(), settings);
    err_ += result.err;
    code_ = result.code;
    ++commands_;
  }
  void use(const YAML::Node& step) {
    const auto action = step["uses"].as<std::string>();
    const auto with = [&](const char* key) {
      return filled_in(step["with"][key].as<std::string>(), context_);
    };
    const auto here = cli_.folder() / work_;
    if (action == "actions/checkout@v4") return;
    if (action == "actions/cache@v4") {
      (void)with("key");  // nothing is there to be restored
      return;
    }
    if (action == "actions/upload-artifact@v4") {
      const auto to = cli_.folder() / "artifacts" / with("name");
      fs::create_directories(to);
      const auto from = here / with("path");
      if (fs::exists(from)) {
        fs::copy(from, fs::is_directory(from) ? to : to / from.filename(),
                 fs::copy_options::recursive | fs::copy_options::overwrite_existing);
      }
      return;
    }
    REQUIRE(action == "actions/download-artifact@v4");
    fs::copy(cli_.folder() / "artifacts", here / with("path"), fs::copy_options::recursive);
  }

  const Checkouts& cli_;
  Settings context_;
  std::string work_, err_;
  int code_ = 0, commands_ = 0;
};

/// All parts and the report of the suite; the exit codes in their order, the report's last.
std::vector<int> github_suite(const Checkouts& cli, std::string& err, int without = 0) {
  const auto workflow = YAML::Load(cli.page().at(".github/workflows/suite.yml"));
  fs::remove_all(cli.folder() / "artifacts");
  std::vector<int> codes;
  const auto parts = workflow["jobs"]["part"]["strategy"]["matrix"]["part"];
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].as<int>() == without) continue;
    GitHubJob job(cli, "part" + std::to_string(i),
                  {{"strategy.job-index", std::to_string(i)},
                   {"strategy.job-total", std::to_string(parts.size())},
                   {"runner.arch", "X64"},
                   {"github.sha", "0123456789"}});
    codes.push_back(job.run(workflow["jobs"]["part"]));
    CHECK(job.commands() == 1);
    err += job.err();
  }
  GitHubJob report(cli, "report", {});
  codes.push_back(report.run(workflow["jobs"]["report"]));
  err += report.err();
  cli.write("suite.xml", cli.read(report.work() + "/suite.xml"));
  return codes;
}

TEST_CASE("the page has the files that it speaks of, and every step is run or named") {
  const auto page = files_of_page();
  REQUIRE(page.size() == 4);
  const std::set<std::string> played = {"actions/checkout@v4", "actions/cache@v4",
                                        "actions/upload-artifact@v4",
                                        "actions/download-artifact@v4"};
  int commands = 0;
  for (const auto* file : {".github/workflows/suite.yml", ".github/workflows/gate.yml"}) {
    for (const auto& job : YAML::Load(page.at(file))["jobs"]) {
      for (const auto& step : job.second["steps"]) {
        if (step["uses"]) {
          CHECK(played.contains(step["uses"].as<std::string>()));
        } else if (step["name"].as<std::string>() != "install") {
          ++commands;
        }
      }
    }
  }
  CHECK(commands == 5);
}

TEST_CASE("the suite of the page on GitHub: all green, then a mistake, then a part that is gone") {
  const Checkouts cli;
  std::string err;
  CHECK(github_suite(cli, err) == std::vector<int>{0, 0, 0, 0, 0});
  CHECK(holds(cli.read("summary"), "10 passed, 0 failed"));
  CHECK(parse_xml(cli.read("suite.xml")).all("testcase").size() == 10);

  cli.pull_request("cases/lock.e", "HoldsAt(Unlocked(),time) -> ", "");
  err.clear();
  auto codes = github_suite(cli, err);
  CHECK(codes.back() == 1);
  CHECK(std::count(codes.begin(), codes.end() - 1, 1) >= 1);
  CHECK(holds(cli.read("summary"), "cases/suite"));
  CHECK(holds(err, "::error file=cases/suite.yaml,line="));

  cli.pull_request("cases/lock.e", "Initiates(Pull()",
                   "HoldsAt(Unlocked(),time) -> Initiates(Pull()");
  codes = github_suite(cli, err, 3);
  CHECK(codes == std::vector<int>{0, 0, 0, 4});
  CHECK(holds(err, "shard 3/4 is missing"));
}

TEST_CASE("the gate of the page on GitHub") {
  const Checkouts cli;
  const auto workflow = YAML::Load(cli.page().at(".github/workflows/gate.yml"));
  const auto gate = [&] {
    fs::remove_all(cli.folder() / "artifacts");
    GitHubJob job(cli, "gate", {{"github.event.pull_request.base.sha", "base"}});
    const int code = job.run(workflow["jobs"]["gate"]);
    CHECK(job.commands() == 3);
    CAPTURE(job.err());
    CHECK(fs::exists(cli.folder() / "artifacts/gate/models.md"));
    return code;
  };
  cli.pull_request("cases/lock.e", "range time 0 2\n", "; better said\nrange time 0 2\n");
  CHECK(gate() == 0);
  CHECK(holds(cli.read("summary"), "### Gate passed"));
  cli.pull_request("cases/lock.e", "HoldsAt(Unlocked(),time) -> ", "");
  CHECK(gate() == 1);
  CHECK(holds(cli.read("summary"), "**broken** | models\\.lost\\_traces"));
  CHECK(holds(cli.read("summary"), "**broken** | models\\.properties"));
  CHECK(holds(cli.read("summary"), "kept | rates\\.worse"));
  // The model stays as it is, and the world sticks.
  cli.pull_request("cases/world.e", "load domain.e\n",
                   "load domain.e\nfluent Sticks()\nnoninertial Sticks\n");
  cli.pull_request("cases/world.e", "[drawer,time] Initiates(OpenDrawer",
                   "[drawer,time] !HoldsAt(Sticks(),time) -> Initiates(OpenDrawer");
  CHECK(gate() == 1);
  CHECK(holds(cli.read("summary"), "**broken** | rates\\.worse"));
  CHECK(holds(cli.read("summary"), "kept | models\\.lost\\_traces"));
}

/// The lines of a job of GitLab's, as one script, until one fails.
ProcessResult gitlab(const Checkouts& cli, const YAML::Node& job, const std::string& work,
                     const Settings& settings) {
  std::string script;
  for (const auto& line : job["script"]) script += line.as<std::string>() + '\n';
  return cli.shell(work, script, settings);
}

TEST_CASE("the suite and the gate of the page on GitLab") {
  const Checkouts cli;
  const auto file = YAML::Load(cli.page().at(".gitlab-ci.yml"));
  const auto parts = file["part"]["parallel"].as<int>();
  const auto suite = [&](const std::string& work) {
    for (int i = 1; i <= parts; ++i) {
      const auto part = cli.checkout("part" + std::to_string(i));
      const auto result =
          gitlab(cli, file["part"], part,
                 {{"CI_NODE_INDEX", std::to_string(i)}, {"CI_NODE_TOTAL", std::to_string(parts)}});
      CHECK((result.code == 0 || result.code == 1));
      const auto to = cli.folder() / work / "out" / std::to_string(i);
      fs::create_directories(to);
      fs::copy(cli.folder() / part / "out" / std::to_string(i) / "results.json", to);
    }
    return gitlab(cli, file["report"], work, {}).code;
  };
  auto work = cli.checkout("report");
  CHECK(suite(work) == 0);
  CHECK(parse_xml(cli.read(work + "/suite.xml")).all("testcase").size() == 10);
  const auto gate = [&] {
    const auto checked = cli.checkout("gate");
    return gitlab(cli, file["gate"], checked, {{"CI_MERGE_REQUEST_DIFF_BASE_SHA", "base"}}).code;
  };
  cli.pull_request("cases/lock.e", "HoldsAt(Unlocked(),time) -> ", "");
  CHECK(gate() == 1);
  work = cli.checkout("report");
  CHECK(suite(work) == 1);
  CHECK(holds(cli.read(work + "/summary.md"), "cases/suite"));
}

}  // namespace
}  // namespace parallax::test
