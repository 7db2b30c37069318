// Nothing that steers a terminal, a CI system or a spreadsheet leaves the program, whatever files,
// simulators, logs and file names contain: hostile texts are put into every place, every command
// runs, and all of its output is checked. Also a rule for the sources: standard output, standard
// error and files are written in few places.

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/base/utf8.h"
#include "tests/support/csv.h"
#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

/// A name that colours, rings, turns the direction of writing, begins lines, ends cells.
const std::string kEvil =
    "e\x1b[31m\x07\xC2\x9B"
    "31m\x7F\xE2\x80\xAE\n::error::own\n\nFORGED,\"|`<b>x";
/// The same in a YAML or JSON text.
std::string quoted(const std::string& before, const std::string& after) {
  return "\"" + before +
         R"(e\u001b[31m\u0007\u009b31m\u007f\u202e\n::error::own\n\nFORGED,\"|`<b>x)" + after +
         "\"";
}

/// The first fault in a text that people see; empty if there is none.
std::string fault_of(const std::string& text, bool has_lines = true) {
  for (std::size_t i = 0; i < text.size();) {
    const auto point = base::front_code_point(std::string_view(text).substr(i));
    const auto c = point.value;
    const bool layout = text[i] == '\n' || text[i] == '\t' || text.compare(i, 2, "\r\n") == 0;
    const bool steers = c < 0x20 || (c >= 0x7F && c < 0xA0) || (c >= 0x202A && c <= 0x202E);
    if (!point.valid || (steers && !layout)) {
      return "steered at: " + std::to_string(i) + " of " + text.substr(i > 60 ? i - 60 : 0, 120);
    }
    i += point.length;
  }
  std::istringstream lines(text);
  bool after_empty = false;
  for (std::string line; has_lines && std::getline(lines, line);) {
    const auto begin = std::min(line.find_first_not_of(" \t"), line.size());
    if (line.compare(begin, 2, "::") == 0) return "a command: " + line;
    // In a name the word follows two line ends; a sentence that is wrapped has no empty line.
    if (after_empty && line.compare(begin, 6, "FORGED") == 0) return "forged: " + line;
    after_empty = begin == line.size();
  }
  return {};
}

/// A cell that a spreadsheet would compute.
std::string formula_of(const std::string& csv) {
  for (const auto& row : parse_csv(csv)) {
    for (const auto& cell : row) {
      char* end = nullptr;
      std::strtod(cell.c_str(), &end);
      const bool number = end != cell.c_str() && *end == '\0';
      if (!cell.empty() && std::string("=+-@\t\r").find(cell[0]) != std::string::npos && !number) {
        return cell;
      }
    }
  }
  return {};
}

/// A folder of scenarios with hostile names, and who runs commands on it and looks at all answers.
class Hostile {
 public:
  Hostile() {
    auto world = cli.read("world.yaml");
    const std::string box = "  box:\n";
    world.replace(world.find(box), box.size(), "  " + quoted("", "") + ":\n");
    cli.write("world.yaml", world);
    cli.write("common.yaml",
              "world: {include: world.yaml}\n"
              "regions: {cells: {r1: {x: [0, 1]}, r2: {x: [1, 2]}}}\n"
              "mapping:\n"
              "  RobotIn(region): {inside: region, body: robot}\n"
              "  BoxIn(region): {inside: region, body: " +
                  quoted("", "") + ", unless: " + quoted("", ".held") +
                  "}\n"
                  "  Holding(): {flag: " +
                  quoted("", ".held") +
                  "}\n"
                  "actions:\n"
                  "  Go(region): {controller: going, time_limit_s: 30}\n"
                  "  PickUp(): {controller: picking-up, object: " +
                  quoted("", "") +
                  ", time_limit_s: 30, from_plan: {}}\n"
                  "  Place(region): {controller: placing, object: " +
                  quoted("", "") +
                  ", time_limit_s: 30, from_plan: {target.x: target.x, target.y: target.y, "
                  "target.yaw: target.yaw, target.z: target.z}}\n"
                  "sampling: {variables: {" +
                  quoted("", ".y") + ": 0, " + quoted("", ".yaw") + ": 0}}\n");
    scenario("wrong.yaml", "wrong_domain.e", "");
    scenario("right.yaml", "domain.e", "");
    cli.write(
        "suite.yaml",
        "cases:\n  - {id: first, model: [domain.e, start.e], horizon: 2, expect: {traces: 7}}\n"
        "  - {id: second, model: [domain.e, start.e], horizon: 2, constraints: [" +
            quoted("", "") + "], expect: {traces: 7}}\n");
    cli.write("quarantine.yaml",
              "quarantine:\n  - {case: wrong.yaml, because: " + quoted("", "") + "}\n");
    fs::create_directory(cli.folder() / kEvil);
    for (const char* name : {"domain.e", "start.e"}) {
      fs::copy_file(cli.folder() / name, cli.folder() / kEvil / name);
    }
    cli.write(kEvil + "/cases.yaml",
              "cases:\n  - {id: a, model: [domain.e, start.e], horizon: 2, expect: {traces: 7}}\n");
  }

  void scenario(const std::string& name, const std::string& model, const std::string& more) const {
    cli.write(name, "include: common.yaml\nname: " + quoted("the ", "") + "\nmodel: [" + model +
                        ", start.e]\nplan: hasty.lisp\nbind: robot.bind\nhorizon: 6\n"
                        "constraints: [\"{region} (Happens(Place(region),time-1) & "
                        "HoldsAt(BoxIn(region),time))\"]\n"
                        "expect: {verdict: no-discrepancy, fast: true}\n" +
                        more);
  }

  /// Runs a command; its answers are looked at. Returns the exit code.
  int run(const std::vector<std::string>& words, bool commands = false) {
    const auto result = cli.parallax(words);
    std::string line;
    for (const auto& word : words) line += word + ' ';
    INFO(line);
    INFO(result.err.substr(0, 400));
    CHECK(result.code != 5);
    CHECK(result.code < 128);
    CHECK(fault_of(result.out) == "");
    if (!commands) CHECK(fault_of(result.err) == "");
    evil_ += (result.out + result.err).find("\\u001b[31m") != std::string::npos ? 1 : 0;
    return result.code;
  }

  /// Every file that people open and that was written since the last call.
  void look_at_files() {
    for (const auto& [name, text] : files_below(cli.folder())) {
      auto& seen = seen_[name];
      if (seen == text) continue;
      seen = text;
      const auto ending = fs::path(name).extension().string();
      if (!kShown.contains(ending)) continue;
      INFO(name);
      const bool has_lines = ending != ".html" && ending != ".svg" && ending != ".xml";
      CHECK(fault_of(text, has_lines) == "");
      if (ending == ".csv") CHECK(formula_of(text) == "");
      kinds_.insert(ending);
    }
  }
  void pass_over_inputs() {
    for (const auto& [name, text] : files_below(cli.folder())) seen_[name] = text;
  }

  int evil() const { return evil_; }
  const std::set<std::string>& kinds() const { return kinds_; }

  CliFixture cli;

 private:
  inline static const std::set<std::string> kShown = {".txt",    ".md",    ".csv",  ".html",
                                                      ".svg",    ".xml",   ".dot",  ".json",
                                                      ".ndjson", ".jsonl", ".lcov", ".yaml"};
  int evil_ = 0;
  std::map<std::string, std::string> seen_;
  std::set<std::string> kinds_;
};

TEST_CASE("names of bodies, variables, scenarios and cases are inert in every command") {
  Hostile evil;
  evil.pass_over_inputs();
  CHECK(evil.run({"check", "wrong.yaml"}) == 0);
  CHECK(evil.run({"run", "wrong.yaml", "--out", "r", "--samples", "r.csv"}) == 1);
  CHECK(evil.run({"run", "right.yaml", "--out", "b", "--max-runs", "2", "-v"}) == 4);
  evil.run({"run", "wrong.yaml", "--out", "j", "--json", "--keep-going", "--samples", "j.jsonl"});
  for (const char* command :
       {"report", "explain", "confirm", "coverage", "draw", "export", "repair", "replay"}) {
    evil.run({command, "r"});
    evil.run({command, "r", "--json"});
  }
  evil.run({"explain", "r", "--html", "explained.html"});
  evil.run({"threshold", "r", "--parameter", "robot.x"});
  evil.run({"threshold", "r", "--parameter", kEvil});
  evil.run({"coverage", "r", "--lcov", "c.lcov"});
  evil.run({"export", "r", "-o", "motion.csv"});
  evil.run({"replay", "r", "--record"});
  evil.run({"report", "r", "b", "-o", "two.html"});
  evil.run({"repair", "r", "--loop", "--out", "repaired"});
  evil.run({"rates", "wrong.yaml", "--runs", "2", "--samples", "s.csv", "--plot", "rates.html",
            "--cause-kinds"});
  evil.run({"ledger", "add", "r"});
  evil.run({"ledger", "list"});
  evil.run({"ledger", "check", "r", "b"});
  evil.run({"report", "r", "--ledger", "ledger.yaml", "-o", "known.html"});
  evil.run({"diff", "wrong.yaml", "right.yaml"});
  evil.run({"diff", "wrong.yaml", "right.yaml", "--json"});
  evil.run({"traces", "wrong.yaml"});
  evil.run({"verify", "wrong.yaml", "--property", "!HoldsAt(Holding(),time)"});
  evil.run({"consequences", "wrong.yaml"});
  evil.run({"compile", "wrong.yaml", "--emit=cfg"});
  evil.run({"compile", "wrong.yaml", "--emit=cfg-dot", "-o", "plan.dot"});
  evil.run({"prove", "right.yaml", "--time-limit", "1"});
  const std::vector<std::string> cases = {"suite.yaml", "wrong.yaml", kEvil};
  const auto suite = [&](std::vector<std::string> more, bool commands = false) {
    more.insert(more.begin(), {"suite", "--no-cache"});
    more.insert(more.end(), cases.begin(), cases.end());
    CHECK(evil.run(more, commands) != 2);
  };
  suite({"--out", "s", "--junit", "j.xml", "--markdown", "m.md", "--history", "h.jsonl",
         "--quarantine", "quarantine.yaml"});
  suite({"--out", "a", "--annotations", "github"}, true);
  suite({"--out", "s1", "--shard", "1/2"});
  suite({"--out", "s2", "--shard", "2/2"});
  evil.run({"suite", "--merge", "s1", "s2", "--out", "s3", "--junit", "k.xml"});
  evil.run({"report", "--history", "h.jsonl", "-o", "history.html"});
  evil.look_at_files();
  CHECK(evil.evil() > 15);
  CHECK(evil.kinds().size() > 9);
}

TEST_CASE("texts of models, plans, tables and command lines are inert in messages") {
  Hostile evil;
  const auto& cli = evil.cli;
  cli.write("bad.e", "range time 0 1\nfluent A" + kEvil + "()\n");
  cli.write("bad.lisp", "(perform (an action (type |" + kEvil + "|)))\n(print \"" + "::x" + "\")");
  cli.write("bad.bind", "motion " + kEvil + " -> Go()\n");
  cli.write("plan.yaml", "include: wrong.yaml\nplan: bad.lisp\n");
  cli.write("bind.yaml", "include: wrong.yaml\nbind: bad.bind\n");
  cli.write("key.yaml", "include: wrong.yaml\n" + quoted("", "") + ": 1\n");
  cli.write("cell.yaml",
            "include: wrong.yaml\nregions: {cells: {" + quoted("", "") + ": {x: [2, 3]}}}\n");
  cli.write("raw.yaml", "include: wrong.yaml\nname: " + kEvil + "\n");
  cli.write(kEvil + ".e", "fluent A(\n");
  cli.write("log.csv", "t,event,outcome," + quoted("robot.x", "") + ",x\n0,,,0.5,1.5\n");
  cli.write("log2.csv", "t,event,outcome\n0," + quoted("", "") + ",\n");
  cli.write("log.jsonl", "{\"t\":0,\"event\":" + quoted("", "") + "}\n");
  cli.write("gate.yaml", "models: {" + quoted("", "") + ": 1}\n");
  for (const char* form : {"text", "json", "sarif"}) {
    const auto as = std::string("--diagnostics=") + form;
    for (const char* file : {"bad.e", "plan.yaml", "bind.yaml", "key.yaml", "raw.yaml"}) {
      CHECK(evil.run({"check", file, as}) == 3);
    }
  }
  CHECK(evil.run({"check", "cell.yaml"}) == 0);
  for (const bool json : {false, true}) {
    const std::string as = json ? "--json" : "--quiet";
    evil.run({"check", kEvil + ".e", as});
    evil.run({"traces", kEvil + ".e", as});
    evil.run({"traces", kEvil, as});
    evil.run({"fmt", "bad.e", "--check", as});
    evil.run({"run", "wrong.yaml", "--out", kEvil, as, "--max-runs", "1"});
    evil.run({"explain", kEvil, as});
    evil.run({"draw", kEvil, as});
    evil.run({"monitor", "wrong.yaml", "log.csv", as});
    evil.run({"monitor", "wrong.yaml", "log2.csv", as});
    evil.run({"monitor", "wrong.yaml", "log.jsonl", as});
    evil.run({"diff", "wrong.yaml", "right.yaml", "--gate", "gate.yaml", as});
    evil.run({"verify", "wrong.yaml", "--property", kEvil, as});
    evil.run({"traces", "domain.e", "--format", kEvil, as});
    evil.run({"new", kEvil, as});
    evil.run({"help", kEvil, as});
    evil.run({kEvil, as});
    evil.run({"--" + kEvil, as});
    evil.run({"adapter-check", as, "--", kEvil});
    evil.run({"record", "-o", "x.ndjson", as, "--", kEvil});
  }
  CHECK(evil.evil() > 30);
}

TEST_CASE("names of files and folders are inert in what is said of them") {
  Hostile evil;
  const auto& cli = evil.cli;
  for (const char* name : {"wrong_domain.e", "common.yaml", "world.yaml", "wrong.yaml",
                           "right.yaml", "hasty.lisp", "robot.bind"}) {
    fs::copy_file(cli.folder() / name, cli.folder() / kEvil / name);
  }
  evil.pass_over_inputs();
  const auto in = [](const std::string& name) { return kEvil + "/" + name; };
  CHECK(evil.run({"run", in("wrong.yaml"), "--out", in("r")}) == 1);
  for (const char* command : {"report", "explain", "confirm", "coverage", "draw", "repair"}) {
    CHECK(evil.run({command, in("r")}) < 2);
  }
  evil.run({"coverage", in("r"), "--lcov", in("c.lcov")});
  evil.run({"rates", in("wrong.yaml"), "--runs", "2"});
  evil.run({"diff", in("wrong.yaml"), in("right.yaml")});
  evil.run({"diff", in("domain.e"), in("wrong_domain.e")});
  evil.run({"compile", in("wrong.yaml"), "--emit=cfg-dot", "-o", in("p.dot")});
  evil.run({"compile", in("domain.e"), "--horizon", "2", "--stats", "-o", in("d.dec.cnf")});
  evil.run({"traces", in("d.dec.cnf"), "--limit", "2"});
  evil.run({"suite", in("wrong.yaml"), "--no-cache", "--out", in("s")});
  evil.run({"ledger", "add", in("r"), "--ledger", in("l.yaml")});
  evil.run({"new", in("fresh")});
  // The name stands in a comment of the formula, which a line end would break.
  CHECK(evil.run({"traces", in("domain.e"), "--horizon", "1", "--limit", "0",
                  "--certify=" + in("d.drat")}) == 0);
  evil.look_at_files();
  CHECK(evil.evil() > 10);
}

TEST_CASE("what a simulator says is inert") {
  Hostile evil;
  const auto& cli = evil.cli;
  // Failing acts whose reason begins with a sign of formulas; names and messages likewise.
  cli.write(
      "says.sh",
      R"sh(echo "$NOISE" >&2
end='}'
while IFS= read -r line; do
  id=${line#*\"id\":}; id=${id%%,*}; id=${id%%"$end"*}
  case $line in
    *'"hello"'*) said='{"protocol":1,"name":)sh" +
          quoted("", "") + R"sh(,"version":)sh" + quoted("=", "") +
          R"sh(,"determinism":"bitwise","seeds":true,"time_step":0.01,"params":[{"name":"robot.x","unit":"m","settable":true},{"name":"box.x","unit":"m","settable":true},{"name":"box.held","unit":"1","settable":false}],"actions":[{"name":"going"},{"name":"picking-up"},{"name":"placing"}]}';;
    *'"reset"'*) state=${line#*\"state\":}; state=${state%%"$end"*}; said='{"status":"ok","sim_time":0}';;
    *'"act"'*) [ -n "$DIES" ] && { echo "$NOISE" >&2; exit 3; }
      said='{"status":"failed","sim_time":1,"reason":)sh" +
          quoted("=1+1", "") + R"sh(}';;
    *'"observe"'*) said="{\"state\":$state,\"box.held\":false}}";;
    *) said='{"status":"ok"}';;
  esac
  printf '{"id":%s,"result":%s}\n' "$id" "$said"
done
)sh");
  cli.write("common.yaml",
            "regions: {cells: {r1: {x: [0, 1]}, r2: {x: [1, 2]}}}\n"
            "mapping:\n"
            "  RobotIn(region): {inside: region, body: robot}\n"
            "  BoxIn(region): {inside: region, body: box, unless: box.held}\n"
            "  Holding(): {flag: box.held}\n"
            "actions:\n"
            "  Go(region): {controller: going, time_limit_s: 30}\n"
            "  PickUp(): {controller: picking-up, object: box, time_limit_s: 30}\n"
            "  Place(region): {controller: placing, object: box, time_limit_s: 30}\n"
            "sampling: {variables: {}}\n");
  evil.scenario("fails.yaml", "wrong_domain.e", "simulator: {command: [sh, says.sh]}\n");
  evil.pass_over_inputs();
  ::setenv("NOISE", (kEvil + "\n::error::noise").c_str(), 1);
  for (const bool dies : {false, true}) {
    dies ? ::setenv("DIES", "1", 1) : ::unsetenv("DIES");
    const std::string out = dies ? "lost" : "failed";
    const auto code = evil.run({"run", "fails.yaml", "--allow-commands", "--out", out, "--max-runs",
                                "2", "--samples", out + ".csv"});
    CHECK(code == (dies ? 4 : 1));
    evil.run({"rates", "fails.yaml", "--allow-commands", "--runs", "2", "--samples",
              out + "_rates.csv"});
    evil.run({"adapter-check", "--", "sh", "says.sh"});
    evil.run({"adapter-check", "--json", "--", "sh", "says.sh"});
    evil.run({"adapter-check", "fails.yaml"});
    evil.run({"explain", out});
    evil.run({"report", out});
  }
  ::unsetenv("DIES");
  ::unsetenv("NOISE");
  evil.look_at_files();
  CHECK(evil.evil() > 4);
  CHECK(evil.kinds().contains(".csv"));
}

/// The sources of the program, without those of separate programs.
std::vector<std::string> sources() {
  const fs::path root = PARALLAX_SOURCE_DIR;
  std::vector<std::string> files;
  for (const char* folder : {"compiler", "runtime", "harness", "tools"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const auto name = fs::relative(entry.path(), root).generic_string();
      if (name.starts_with("tools/bench/") || name.starts_with("tools/adapters/")) continue;
      if (name.ends_with(".h") || name.ends_with(".cc")) files.push_back(name);
    }
  }
  return files;
}

/// Does the line have the word, not as the end of a longer name?
bool has_word(const std::string& line, const std::string& word) {
  for (auto at = line.find(word); at != std::string::npos; at = line.find(word, at + 1)) {
    const char before = at == 0 ? ' ' : line[at - 1];
    if (std::isalnum(static_cast<unsigned char>(before)) == 0 && before != '_') return true;
  }
  return false;
}

/// The files whose code, comments aside, has one of the words, a line each.
std::string users_of(const std::vector<std::string>& words) {
  std::set<std::string> users;
  for (const auto& name : sources()) {
    std::ifstream in(fs::path(PARALLAX_SOURCE_DIR) / name);
    for (std::string line; std::getline(in, line);) {
      line.resize(std::min(line.find("//"), line.size()));
      for (const auto& word : words) {
        if (has_word(line, word)) users.insert(name);
      }
    }
  }
  std::string out;
  for (const auto& name : users) out += name + '\n';
  return out;
}

TEST_CASE("standard output and standard error are written by one file") {
  CHECK(users_of({"std::cout", "std::cerr", "std::clog", "stdout)", "stdout,", "stderr)", "stderr,",
                  "fmt::print", "printf(", "puts(", "putchar(", "perror(", "fwrite("}) ==
        "tools/cli/output.cc\n");
}

TEST_CASE("who writes to descriptors and files by other ways than the gate is known") {
  // Protocols, journals and recordings: JSON, or bytes that no terminal is shown.
  CHECK(users_of({"::write(", "base::write_all("}) ==
        "compiler/base/file_io.cc\n"
        "compiler/base/subprocess.cc\n"
        "harness/calibration/synthetic_simulator.cc\n"
        "harness/campaign/journal.cc\n"
        "harness/conformance/adapter_recording.cc\n"
        "harness/engine/mujoco_errors.cc\n"
        "harness/import/limited_child.cc\n"
        "harness/recording/recording_file.cc\n"
        "harness/simulator/process_simulator.cc\n"
        "harness/simulator/worker.cc\n"
        "tools/cli/record_command.cc\n"
        "tools/history/history_file.cc\n"
        "tools/lsp/frames.cc\n"
        "tools/mutate/judged_mutants.cc\n");
  // Proofs; the others read.
  CHECK(users_of({"ofstream", "fopen("}) ==
        "harness/import/mesh_reader.cc\n"
        "harness/simulator/process_memory.cc\n"
        "runtime/certify/certificate.cc\n");
  // Copies of inputs and new inputs, byte by byte; JSON, which is escaped already; and files that
  // name another form.
  CHECK(users_of({"write_file_atomically(", "TextForm::kExact"}) ==
        "compiler/base/file_io.cc\n"
        "compiler/base/file_io.h\n"
        "compiler/base/shown_text.cc\n"
        "harness/calibration/protocol_loops.cc\n"
        "harness/campaign/journal.cc\n"
        "harness/report/report_json.cc\n"
        "tools/app/kept_inputs.cc\n"
        "tools/app/trace_listing.cc\n"
        "tools/cli/export_command.cc\n"
        "tools/cli/fmt_command.cc\n"
        "tools/cli/learn_command.cc\n"
        "tools/cli/ledger_command.cc\n"
        "tools/confirm/confirm_record.cc\n"
        "tools/doctor/trials.cc\n"
        "tools/history/borrowed_repository.cc\n"
        "tools/learn/learn.cc\n"
        "tools/learn/round_folder.cc\n"
        "tools/mutate/judged_mutants.cc\n"
        "tools/repair/apply.cc\n"
        "tools/repair/repair_loop.cc\n"
        "tools/repair/scenario_copy.cc\n"
        "tools/scaffold/scaffold.cc\n"
        "tools/suite/last_pass.cc\n"
        "tools/suite/result_cache.cc\n"
        "tools/suite/scratch_copy.cc\n"
        "tools/suite/since_last_pass.cc\n"
        "tools/suite/suite_record.cc\n"
        "tools/suite/suite_results.cc\n"
        "tools/suite/trace_case.cc\n");
}

}  // namespace
}  // namespace parallax::test
