// Injects faults into campaigns on the Slurm that tools/cluster-test has started, one fault each,
// and counts what was lost. A table is printed at the end; the build keeps it as cluster_faults.md.

#include <algorithm>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/tools/slurm_fixture.h"

namespace parallax::test {
namespace {

const std::string kWorker = "srun --quiet -n1 -c1";

/// A row of the table.
struct Row {
  std::string fault, how, told;
  std::int64_t lost = -1;
  std::string differing;
};

class Table {
 public:
  ~Table() {
    std::string text =
        "| fault | how it was injected | what parallax said | simulations lost | files that differ "
        "from one machine's |\n|---|---|---|---|---|\n";
    for (const auto& row : rows_) {
      text += fmt::format("| {} | {} | {} | {} | {} |\n", row.fault, row.how, row.told, row.lost,
                          row.differing.empty() ? "none" : row.differing);
    }
    std::fputs(text.c_str(), stdout);
    std::ofstream(std::string(PARALLAX_BINARY_DIR) + "/cluster_faults.md") << text;
  }
  void add(Row row) { rows_.push_back(std::move(row)); }

 private:
  std::vector<Row> rows_;
};

Table& table() {
  static Table made;
  return made;
}

/// The same run on one machine, made once.
const CliFixture& here() {
  static const CliFixture cli;
  static const int code = cli.parallax(kRun).code;
  REQUIRE(code == 0);
  return cli;
}

/// Counts lost simulations, and compares the files with those of one machine.
Row row_of(const CliFixture& there, std::string fault, std::string how, std::string told) {
  Row row{std::move(fault), std::move(how), std::move(told), 0, ""};
  row.differing = differing_files(here(), there, "run");
  std::replace(row.differing.begin(), row.differing.end(), '\n', ' ');
  const auto report = nlohmann::json::parse(there.read("run/report.json"));
  for (const auto& trace : report.at("traces")) row.lost += trace.at("lost").get<std::int64_t>();
  CHECK(row.lost == 0);
  CHECK(row.differing == "");
  table().add(row);
  return row;
}

/// The first line of standard error with these words, without what differs from run to run.
std::string line_with(const std::string& text, const std::string& words) {
  if (words.empty()) return "nothing";
  for (auto line : lines(text)) {
    const auto at = line.find(words);
    if (at == std::string::npos) continue;
    for (auto& letter : line) {
      if (letter == '|' || letter == '`') letter = '\'';
    }
    return "`" + line.substr(at, 70) + "`";
  }
  CAPTURE(text);
  CHECK_MESSAGE(false, words);
  return "other words";
}

/// Injects a fault once some simulations are done.
void amid(const std::string& fault, const std::string& how,
          const std::function<bool(const CliFixture&)>& inject, const std::string& words,
          const char* silence = "20") {
  const CliFixture there;
  bool is_done = false;
  ProcessOptions options;
  options.signal_when = [&] {
    if (!is_done && journal_lines(there) >= 10) is_done = inject(there);
    return 0;
  };
  const auto found = there.parallax(
      with(kRun, {"--launcher", kWorker, "--jobs", "4", "--worker-silence", silence}), options);
  CAPTURE(found.err);
  CHECK(found.code == 0);
  CHECK(is_done);
  row_of(there, fault, how, line_with(found.err, words));
  wait_for_no_job(there);
}

bool signal_one(const CliFixture& cli, const std::string& signal) {
  const auto running = jobs(cli, "%i", {"-t", "R"});
  if (running.empty()) return false;
  std::vector<std::string> command = {"scancel"};
  if (!signal.empty()) command.insert(command.end(), {"--signal=" + signal, "--full"});
  command.push_back(running.front());
  return slurm(cli, command).code == 0;
}

bool set_node(const CliFixture& cli, const std::string& state) {
  return slurm(cli, {"scontrol", "update", "NodeName=two", "State=" + state, "Reason=test"}).code ==
         0;
}

TEST_CASE("faults: a worker is killed") {
  amid(
      "killed worker", "`scancel --signal=KILL --full`",
      [](const auto& cli) { return signal_one(cli, "KILL"); }, "a worker was lost");
}

TEST_CASE("faults: a worker freezes") {
  amid(
      "frozen worker", "`scancel --signal=STOP --full`",
      [](const auto& cli) { return signal_one(cli, "STOP"); }, "", "2");
}

TEST_CASE("faults: a worker's job is cancelled") {
  amid(
      "cancelled job", "`scancel`", [](const auto& cli) { return signal_one(cli, ""); },
      "a worker was lost");
}

TEST_CASE("faults: a node is drained") {
  amid(
      "drained node", "`scontrol update NodeName=two State=DRAIN`, and a worker is killed",
      [](const auto& cli) { return set_node(cli, "DRAIN") && signal_one(cli, "KILL"); },
      "a worker was lost");
  const CliFixture cli;
  CHECK(set_node(cli, "RESUME"));
}

TEST_CASE("faults: a campaign that is a job is requeued") {
  const CliFixture there;
  there.write("campaign.sh", script_of_page("campaign.sh"));
  there.replace("campaign.sh", "cases/drawer.yaml", "scenario.yaml");
  there.replace("campaign.sh", "out/drawer/journal.ndjson", "run/journal.ndjson");
  there.replace("campaign.sh", "--out out/drawer", "--record all --out run");
  const auto job = submit(there, {"campaign.sh"});
  std::size_t before = 0;
  for (int i = 0; i < 3000 && before < 20; ++i) {
    before = journal_lines(there);
    run_process({"sleep", "0.02"});
  }
  const auto requeued = slurm(there, {"scontrol", "requeue", job});
  CAPTURE(requeued.err);
  CHECK(requeued.code == 0);
  wait_for_no_job(there);
  CAPTURE(there.read("campaign.txt"));
  row_of(there, "requeued campaign",
         fmt::format("`scontrol requeue` after {} lines of the journal", before), "nothing");
}

/// One place of three goes wrong from the start.
void at_a_place(const std::string& fault, const std::string& how, const std::string& script,
                const std::string& words) {
  const CliFixture there;
  there.write("odd.sh", script);
  there.write("hosts", "2 " + kWorker + "\n1 " + kWorker + " sh odd.sh\n1 " + kWorker + "\n");
  const auto found = there.parallax(with(kRun, {"--hosts", "hosts", "--worker-silence", "20"}));
  CAPTURE(found.err);
  CHECK(found.code == 0);
  row_of(there, fault, how, line_with(found.err, words));
  wait_for_no_job(there);
}

TEST_CASE("faults: a place is slow") {
  at_a_place("slow place", "0.3 s before each request",
             "while read -r line; do sleep 0.3; printf '%s\\n' \"$line\"; done | \"$@\"\n", "");
}

TEST_CASE("faults: a place has another version") {
  at_a_place("other version", "its greeting says 0.0.9",
             "\"$@\" | sed -u '/parallax_worker/s/\"version\":\"[^\"]*\"/\"version\":\"0.0.9\"/'\n",
             "the workers are another program");
}

TEST_CASE("faults: a place has another processor") {
  std::ifstream in("/proc/cpuinfo");
  bool has_fma = false;
  for (std::string line; std::getline(in, line) && !has_fma;) {
    has_fma = line.starts_with("flags") && (line + ' ').find(" fma ") != std::string::npos;
  }
  if (!has_fma) {
    MESSAGE("SKIPPED: this processor has no FMA that the C library could be told not to use");
    return;
  }
  at_a_place("other processor", "its C library uses no AVX2 and no FMA",
             "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable exec \"$@\"\n",
             "processors there calculate otherwise");
}

TEST_CASE("faults: a place lacks the folder") {
  at_a_place("missing folder", "the worker is told to start in a folder that is not there",
             "program=$1 word=$2 elsewhere=$3 name=$4\nshift 5\n"
             "exec \"$program\" \"$word\" \"$elsewhere\" \"$name\" /no/such/folder \"$@\"\n",
             "it cannot be entered here");
}

}  // namespace
}  // namespace parallax::test
