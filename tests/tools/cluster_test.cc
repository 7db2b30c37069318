// Workers that are started through a command: reports as on one machine, places that are of no use,
// and the messages about them.

#include <signal.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "tests/tools/cluster_fixture.h"
#include "tests/tools/suite/suite_fixture.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

TEST_CASE("the report of workers elsewhere is that of one here, byte for byte") {
  const Cluster here, there;
  const std::vector<std::string> run = {"run", "edge.yaml", "--keep-going", "--record",
                                        "all", "--out",     "out"};
  const auto with = [&](std::vector<std::string> more) {
    auto all = run;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const auto one = here.parallax(run);
  CHECK(one.code == 1);
  const auto three = there.parallax(with({"--launcher", "env", "--jobs", "3"}));
  CAPTURE(three.err);
  CHECK(three.code == 1);
  CHECK(three.out == one.out);
  CHECK(differing_files(here, there, "out") == "");
}

TEST_CASE("a world that is a model is played there, and rates are the same") {
  const TwoModels cli;
  for (const auto* scenario : {"two/agree.yaml", "two/sticks.yaml", "two/unparks.yaml"}) {
    const std::vector<std::string> rates = {"rates", scenario, "--runs", "60", "--json"};
    auto there = rates;
    there.insert(there.end(), {"--launcher", "env", "--jobs", "2"});
    const auto expected = cli.parallax(rates);
    const auto found = cli.parallax(there);
    CAPTURE(found.err);
    CHECK(found.code == expected.code);
    CHECK(found.out == expected.out);
  }
}

TEST_CASE("rare events and executed plans take workers elsewhere as well") {
  const Cluster cli;
  const std::vector<std::string> commands[] = {
      {"rates", "edge.yaml", "--method", "importance", "--runs", "60", "--json"},
      {"run", "edge.yaml", "--execution", "closed-loop", "--json", "--out", "closed"},
      {"run", "edge.yaml", "--search", "10", "--json", "--out", "search"}};
  for (auto command : commands) {
    CAPTURE(command[1]);
    const auto expected = cli.parallax(command);
    command.insert(command.end(), {"--launcher", "env", "--jobs", "2"});
    for (const auto* folder : {"closed", "search"}) {
      std::filesystem::remove_all(cli.folder() / folder);
    }
    const auto found = cli.parallax(command);
    CAPTURE(found.err);
    CHECK(found.code == expected.code);
    CHECK(without_timing(found.out) == without_timing(expected.out));
  }
}

TEST_CASE("what launchers say before the handshake is passed over and told") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  const auto expected = cli.parallax({"rates", "coin.yaml", "--runs", "40"});
  const auto banner = cli.script(
      "banner.sh",
      "echo Welcome to lab3\necho\nprintf 'Last login: today\\r\\nprompt> '\nexec \"$@\"");
  const auto found =
      cli.parallax({"rates", "coin.yaml", "--runs", "40", "--launcher", banner, "--jobs", "2"});
  CAPTURE(found.err);
  CHECK(found.code == 0);
  CHECK(found.out == expected.out);
  CHECK(found.err.find("`sh banner.sh` says 3 lines before the handshake: Welcome to lab3") !=
        std::string::npos);
}

TEST_CASE("a launcher that never ceases to talk is given up") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  for (const auto* talk : {"yes", "head -c 100000 /dev/zero | tr '\\0' x; exec \"$@\""}) {
    const auto found = cli.parallax(
        {"rates", "coin.yaml", "--runs", "4", "--launcher", cli.script("talk.sh", talk)});
    CAPTURE(found.err);
    CHECK(found.code == 4);
    CHECK(found.err.find("W7133") != std::string::npos);
    CHECK(found.err.find("before the handshake") != std::string::npos);
    CHECK(found.err.find("E7131") != std::string::npos);
  }
}

TEST_CASE("without any worker nothing is said of a verdict, and a suite has no answer") {
  const Cluster cli;
  const auto ran = cli.parallax({"run", "scenario.yaml", "--launcher", "false", "--out", "out"});
  CAPTURE(ran.out);
  CHECK(ran.code == 4);
  CHECK(ran.out.find("it ended before anything was compared") != std::string::npos);
  CHECK(ran.out.find(", ,") == std::string::npos);
  CHECK(ran.err.find("E7131") != std::string::npos);
  const auto suite =
      cli.parallax({"suite", "scenario.yaml", "--launcher", "false", "--out", "all"});
  CAPTURE(suite.out);
  CHECK(suite.out.find("ERROR scenario.yaml") != std::string::npos);
  CHECK(suite.out.find("no worker was left to simulate it") != std::string::npos);
  CHECK(suite.out.find("0 passed, 0 failed, 1 without an answer") != std::string::npos);
}

TEST_CASE("workers of another version are refused, and both are named") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  const auto old = cli.script("old.sh",
                              "\"$@\" | sed -u '/parallax_worker/s/\"version\":\"[^\"]*\"/"
                              "\"version\":\"0.0.9\"/'");
  const auto other = cli.script(
      "other.sh",
      "\"$@\" | sed -u '/parallax_worker/s/\"build\":\"[^\"]*\"/\"build\":\"0123456789abcdef\"/'");
  const auto own = cli.parallax({"--version"}).out;
  const auto version = own.substr(9, own.find(' ', 9) - 9);
  const auto alone = cli.parallax({"rates", "coin.yaml", "--runs", "4", "--launcher", old});
  CAPTURE(alone.err);
  CHECK(alone.code == 4);
  CHECK(alone.err.find("sh old.sh") != std::string::npos);
  CHECK(alone.err.find("there it is parallax 0.0.9 (build ") != std::string::npos);
  CHECK(alone.err.find("here " + version + " (build ") != std::string::npos);
  CHECK(alone.err.find("E7131") != std::string::npos);

  cli.write("hosts", "2 " + old + "\n2 " + cli.meets("other", "good", other) + "\n1 " +
                         cli.meets("good", "other", "env", true) + "\n");
  const auto expected = cli.parallax({"rates", "coin.yaml", "--runs", "30"});
  const auto mixed = cli.parallax({"rates", "coin.yaml", "--runs", "30", "--hosts", "hosts"});
  CAPTURE(mixed.err);
  CHECK(mixed.code == 0);
  CHECK(mixed.out == expected.out);
  CHECK(mixed.err.find("build 0123456789abcdef") != std::string::npos);
}

std::string cpu_flags() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("flags")) return line + ' ';
  }
  return {};
}

TEST_CASE("workers on processors that calculate otherwise are refused") {
  const Cluster cli;
  if (cpu_flags().find(" fma ") == std::string::npos) {
    MESSAGE("SKIPPED: this processor has no FMA that the C library could be told not to use");
    return;
  }
  cli.coin(0.3, "seeded");
  const std::string older =
      "env GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable";
  const auto alone = cli.parallax({"rates", "coin.yaml", "--runs", "4", "--launcher", older});
  CAPTURE(alone.err);
  CHECK(alone.code == 4);
  CHECK(alone.err.find("warning[W7135]: processors there calculate otherwise") !=
        std::string::npos);
  CHECK(alone.err.find("E7131") != std::string::npos);

  cli.write("hosts", "2 " + cli.meets("older", "good", older) + "\n1 " +
                         cli.meets("good", "older", "env", true) + "\n");
  const auto expected = cli.parallax({"rates", "coin.yaml", "--runs", "30"});
  const auto mixed = cli.parallax({"rates", "coin.yaml", "--runs", "30", "--hosts", "hosts"});
  CAPTURE(mixed.err);
  CHECK(mixed.code == 0);
  CHECK(mixed.out == expected.out);
  CHECK(mixed.err.find("W7135") != std::string::npos);
}

TEST_CASE("hosts that are not there, come late or vanish leave the work to the others") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  cli.script("late.sh", "sleep 1000");
  cli.script("vanish.sh",
             "test -e gone && exit 3\n( sleep 0.7; touch gone; kill -9 $$ ) >/dev/null 2>&1 &\n"
             "exec \"$@\"");
  cli.write(
      "hosts",
      "1 no_such_program\n1 sh late.sh\n1 sh vanish.sh\n1 false\n# the only good one:\n1 env\n");
  const auto expected = cli.parallax({"rates", "coin.yaml", "--runs", "200"});
  const auto found = cli.parallax(
      {"rates", "coin.yaml", "--runs", "200", "--hosts", "hosts", "--worker-start", "0.5"});
  CAPTURE(found.err);
  CHECK(found.code == 0);
  CHECK(found.out == expected.out);
  CHECK(found.err.find("E7131") == std::string::npos);

  cli.write("hosts", "1 no_such_program\n1 sh late.sh\n2 false\n");
  const auto none = cli.parallax(
      {"run", "coin.yaml", "--hosts", "hosts", "--worker-start", "0.3", "--out", "none"});
  CAPTURE(none.err);
  CHECK(none.code == 4);
  CHECK(none.err.find("no_such_program") != std::string::npos);
  CHECK(none.err.find("no handshake within 0.3 s") != std::string::npos);
  CHECK(none.err.find("2 of 2 slots were given up") != std::string::npos);
  CHECK(none.err.find("exit status 1") != std::string::npos);
  CHECK(none.err.find("E7131") != std::string::npos);
}

TEST_CASE("a run whose last worker vanished is continued as if nothing had been") {
  const Cluster cli;
  cli.coin(0.0, "seeded");
  CHECK(cli.parallax({"run", "coin.yaml", "--out", "whole"}).code == 0);
  // So many lines go through, then nothing is there any more.
  const auto brief = cli.script(
      "brief.sh", "test -e over && exit 3\n\"$@\" | (sed -u 120q; touch over; kill -9 0)");
  const auto cut = cli.parallax(
      {"run", "coin.yaml", "--out", "cut", "--launcher", brief, "--worker-silence", "5"});
  CAPTURE(cut.err);
  CHECK(cut.code == 4);
  CHECK(cut.err.find("E7131") != std::string::npos);
  CHECK(cli.lines_of("cut/journal.ndjson") > 5);
  CHECK(cli.read("cut/journal.ndjson") != cli.read("whole/journal.ndjson"));
  const auto rest = cli.parallax(
      {"run", "coin.yaml", "--out", "cut", "--resume", "--launcher", "env", "--jobs", "2"});
  CAPTURE(rest.err);
  CHECK(rest.code == 0);
  CHECK(cli.read("cut/journal.ndjson") == cli.read("whole/journal.ndjson"));
}

TEST_CASE("an action that takes longer than a silence is no silence") {
  const Cluster cli;
  cli.coin(0.3, "unseeded");  // so that a loss would show
  const auto report =
      json_of(cli, {"rates", "coin.yaml", "--runs", "3", "--launcher", "env COIN_SECONDS=2",
                    "--jobs", "3", "--worker-silence", "0.5"});
  CHECK(report.at("traces").at(0).at("lost") == 0);
  CHECK(report.at("traces").at(0).at("runs") == 3);
}

TEST_CASE("clocks of other machines have no part in it") {
  // Another time since the start of the machine, which is what durations are measured by.
  const std::vector<std::string> ahead = {"unshare", "--time",     "--monotonic",
                                          "5000000", "--boottime", "5000000"};
  auto probe = ahead;
  probe.emplace_back("true");
  if (run_process(probe).code != 0) {
    MESSAGE("SKIPPED: this machine has no time namespaces");
    return;
  }
  const Cluster cli;
  cli.coin(0.3, "seeded");
  const auto expected = cli.parallax({"rates", "coin.yaml", "--runs", "60"});
  cli.write("hosts",
            "1 unshare --time --monotonic 5000000 --boottime 5000000\n1 env TZ=Asia/Tokyo\n");
  const auto found = cli.parallax(
      {"rates", "coin.yaml", "--runs", "60", "--hosts", "hosts", "--worker-silence", "5"});
  CAPTURE(found.err);
  CHECK(found.code == 0);
  CHECK(found.out == expected.out);
  CHECK(found.err.find("lost") == std::string::npos);
}

TEST_CASE("campaigns may begin at different places of one file") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  const auto note = [&](const std::string& name) {
    return cli.script(name + ".sh", "echo started >> " + name + ".log\nexec \"$@\"");
  };
  cli.write("hosts", "1 " + note("a") + "\n2 " + note("b") + "\n");
  const auto expected = cli.parallax({"rates", "coin.yaml", "--runs", "20"});
  for (const auto* slot : {"1", "2", "5"}) {
    const auto found = cli.parallax({"rates", "coin.yaml", "--runs", "20", "--hosts", "hosts",
                                     "--jobs", "1", "--first-slot", slot});
    CAPTURE(found.err);
    CHECK(found.out == expected.out);
  }
  CHECK(cli.lines_of("b.log") == 3);
  CHECK_FALSE(std::filesystem::exists(cli.folder() / "a.log"));
  CHECK(cli.parallax({"rates", "coin.yaml", "--launcher", "env", "--first-slot", "1"}).code == 2);
}

TEST_CASE("workers with different simulators end the work, and both are named") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  cli.write("hosts", "1 env COIN_VERSION=1.5\n1 env COIN_VERSION=1.6\n");
  const auto found = cli.parallax({"rates", "coin.yaml", "--runs", "100000", "--hosts", "hosts"});
  CAPTURE(found.err);
  CHECK(found.code == 3);
  CHECK(found.err.find("E7134") != std::string::npos);
  CHECK(found.err.find("`env COIN_VERSION=1.5` brings coin 1.5, `env COIN_VERSION=1.6` brings coin "
                       "1.6") != std::string::npos);
}

TEST_CASE("a scenario that is another one there is refused") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  const auto edits = cli.script("edits.sh", "echo '# later' >> coin.yaml\nexec \"$@\"");
  const auto found = cli.parallax({"rates", "coin.yaml", "--runs", "4", "--launcher", edits});
  CAPTURE(found.err);
  CHECK(found.code == 4);
  CHECK(found.err.find("E7005") != std::string::npos);
}

TEST_CASE("a simulator that does not start there is told as it is here") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  cli.replace("coin.yaml", "\"" PARALLAX_COIN_SIMULATOR "\"", "sh, -c, 'echo no licence >&2'");
  const auto found = cli.parallax({"rates", "coin.yaml", "--runs", "4", "--launcher", "env"});
  CAPTURE(found.err);
  CHECK(found.code == 4);
  CHECK(found.err.find("no licence") != std::string::npos);
  CHECK(found.err.find("E7131") != std::string::npos);
}

TEST_CASE("bad launchers and hosts are refused where they are wrong") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  const auto refused = [&](std::vector<std::string> more, int code, const std::string& words) {
    std::vector<std::string> all = {"rates", "coin.yaml", "--runs", "4"};
    all.insert(all.end(), more.begin(), more.end());
    const auto found = cli.parallax(all);
    CAPTURE(found.err);
    CHECK(found.code == code);
    CHECK(found.err.find(words) != std::string::npos);
  };
  refused({"--launcher", "ssh $HOST"}, 2, "E7129");
  refused({"--launcher", "ssh 'lab"}, 2, "the quote is not closed (byte 5)");
  cli.write("hosts", "# none\n2 env\nlab3\n");
  refused({"--hosts", "hosts"}, 3, "hosts:3:1");
  refused({"--hosts", "nowhere"}, 2, "nowhere");
  refused({"--hosts", "hosts", "--launcher", "env"}, 2, "--launcher");
  refused({"--launcher", "env", "--worker-silence", "0"}, 2, "--worker-silence");
}

TEST_CASE("cases of a suite simulate elsewhere, with the results of one machine") {
  const TwoModels cli;
  cli.write("elsewhere.sh", "echo started >> elsewhere.log\nexec \"$@\"\n");
  cli.write("two/rate.yaml",
            "include: common.yaml\nmodel: [opens.e, start.e]\nsimulator: {model: sticks.e}\n"
            "expect: {rate: {at_least: 0.9}}\n");
  // A case that is wrong on purpose is wrong there in the same words.
  cli.replace("two/agree.yaml", "verdict: no-discrepancy", "verdict: discrepancy");
  const auto results = [&](std::vector<std::string> more, const std::string& out) {
    std::vector<std::string> suite = {"suite", "two",     "--no-cache", "--out",
                                      out,     "--junit", out + ".xml"};
    suite.insert(suite.end(), more.begin(), more.end());
    const auto found = cli.parallax(suite);
    CAPTURE(found.err);
    CHECK(found.code == 1);
    auto text = without_times(cli.read(out + ".xml"));
    for (auto at = text.find(out + "/"); at != std::string::npos; at = text.find(out + "/")) {
      text.replace(at, out.size() + 1, "OUT ");
    }
    return text;
  };
  const auto expected = results({}, "here");
  CHECK(results({"--launcher", "sh elsewhere.sh", "--jobs", "2"}, "launched") == expected);
  CHECK(std::filesystem::exists(cli.folder() / "elsewhere.log"));
  cli.write("hosts", "1 sh elsewhere.sh\n1 false\n1 env\n");
  CHECK(results({"--hosts", "hosts"}, "hosted") == expected);
  const auto refused = [&](std::vector<std::string> more, const std::string& word) {
    std::vector<std::string> suite = {"suite", "two"};
    suite.insert(suite.end(), more.begin(), more.end());
    const auto found = cli.parallax(suite);
    CHECK(found.code == 2);
    CHECK(found.err.find(word) != std::string::npos);
  };
  refused({"--launcher", "ssh $HOST"}, "E7129");
  refused({"--mutate", "--launcher", "env"}, "--launcher");
}

/// A process that can still do something.
bool is_alive(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  const auto end = text.rfind(") ");
  return end != std::string::npos && text[end + 2] != 'Z' && text[end + 2] != 'X';
}

TEST_CASE("nothing is left where parallax is ended, by whatever") {
  for (const int signal : {SIGTERM, SIGKILL}) {
    const Cluster cli;
    cli.coin(0.3, "unseeded");
    // The shell stays between parallax and the worker.
    const auto between = cli.script("between.sh", "\"$@\"\nexit $?");
    const auto started = [&] {
      return std::filesystem::exists(cli.folder() / "coin.log") && cli.lines_of("coin.log") > 20;
    };
    ProcessOptions options;
    options.signal_when = [&] { return started() ? signal : 0; };
    const auto ended = cli.parallax(
        {"rates", "coin.yaml", "--runs", "100000", "--launcher", between, "--jobs", "3"}, options);
    CHECK(ended.code == 128 + signal);
    std::istringstream log(cli.read("coin.log"));
    std::string word;
    for (pid_t pid = 0; log >> word >> pid;) {
      for (int i = 0; is_alive(pid) && i < 3000; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
      CHECK_FALSE(is_alive(pid));
      if (is_alive(pid)) ::kill(pid, SIGKILL);
    }
  }
}

}  // namespace
}  // namespace parallax::test
