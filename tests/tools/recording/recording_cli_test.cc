// Recorded motion, as users get it: kept by `run`, made by `replay`, written by `export`.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "tests/tools/cli_json.h"
#include "tests/tools/recording/csv_rows.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::set<std::string> recordings(const CliFixture& cli, const std::string& run) {
  std::set<std::string> out;
  for (const auto& [path, bytes] : files_below(cli.folder() / run / "recordings")) {
    out.insert(fs::path(path).filename().string());
  }
  return out;
}

TEST_CASE("run keeps discrepancies and three clean simulations, as the journal saw them") {
  const CliFixture cli;
  const auto report = json_of(cli, {"run", "edge.yaml", "--out", "run"}, 1);
  const auto& found = report.at("discrepancies").at(0);
  const auto sample = std::to_string(found.at("trace").get<int>()) + "." +
                      std::to_string(found.at("sample").get<int>());
  const auto kept = recordings(cli, "run");
  CHECK(kept.contains(sample + ".rec"));
  CHECK(kept.size() <= 4);

  const auto done = json_of(cli, {"export", "run", "-o", "motion.csv"});
  CHECK(done.at("status") == "ok");
  CHECK(done.at("sample") == sample);
  CHECK(done.at("frames").get<int>() > 20);
  const auto csv = cli.read("motion.csv");
  CHECK(csv.starts_with("time,body,x,y,z,qw,qx,qy,qz,event\r\n"));
  CHECK(cli.parallax({"export", "run", "--sample", sample}).out == csv);

  // The box is where the journal's first and last observation have it, to a millimetre.
  Json record;
  std::istringstream lines(cli.read("run/journal.ndjson"));
  for (std::string line; std::getline(lines, line);) {
    auto json = Json::parse(line);
    if (json.contains("phase") && json.at("phase") == "certify" &&
        json.at("sample") == found.at("sample")) {
      record = std::move(json);
    }
  }
  REQUIRE_FALSE(record.is_null());
  const auto box = rows_of(csv, "box");
  REQUIRE_FALSE(box.empty());
  const auto check_at = [&](const std::array<double, 4>& row, const Json& state) {
    CHECK(std::abs(row[1] - state.at("box.x").get<double>()) <= 1e-3);
    CHECK(std::abs(row[2] - state.at("box.y").get<double>()) <= 1e-3);
    CHECK(std::abs(row[3] - state.at("box.z").get<double>()) <= 1e-3);
  };
  check_at(box.front(), record.at("observations").front());
  check_at(box.back(), record.at("observations").back());
  // At least ten poses a second while the base drives.
  double gap_s = 0.0;
  const auto base = rows_of(csv, "base");
  REQUIRE(base.size() > 10);
  for (std::size_t i = 1; i < base.size(); ++i) {
    if (std::abs(base[i][1] - base[i - 1][1]) > 0.02) {
      gap_s = std::max(gap_s, base[i][0] - base[i - 1][0]);
    }
  }
  CHECK(gap_s <= 0.1001);
  // Events begin where the ones before them end.
  double simulated_s = 0.0;
  for (const auto& outcome : record.at("outcomes")) {
    simulated_s += outcome.at("sim_time_s").get<double>();
  }
  std::ostringstream end;
  end.setf(std::ios::fixed);
  end.precision(3);
  end << simulated_s;
  CHECK(holds_text(csv, "\r\n" + end.str() + ",,,,,,,,,"));
  CHECK(holds_text(csv, "holds box"));
}

TEST_CASE("the same recordings with any number of jobs, with all of them, and repeated") {
  const CliFixture cli;
  const std::vector<std::string> run = {"run", "edge.yaml", "--quiet", "--out"};
  const auto with = [&](std::vector<std::string> more) {
    auto words = run;
    words.insert(words.end(), more.begin(), more.end());
    CHECK(cli.parallax(words).code == 1);
  };
  with({"one"});
  with({"three", "--jobs", "3"});
  with({"all", "--record", "all", "--jobs", "2"});
  with({"none", "--record", "none"});
  const auto kept = recordings(cli, "one");
  CHECK(recordings(cli, "three") == kept);
  CHECK_FALSE(fs::exists(cli.folder() / "none/recordings"));
  const auto all = recordings(cli, "all");
  CHECK(std::includes(all.begin(), all.end(), kept.begin(), kept.end()));
  for (const auto& name : kept) {
    const auto bytes = cli.read("one/recordings/" + name);
    CHECK(cli.read("three/recordings/" + name) == bytes);
    CHECK(cli.read("all/recordings/" + name) == bytes);
    // A run without recordings gets them afterwards, and they are the same.
    const auto id = name.substr(0, name.size() - 4);
    const auto replayed = cli.parallax({"replay", "none", "--sample", id, "--record"});
    CHECK(replayed.code == 0);
    CHECK(holds_text(replayed.err, "none/recordings/" + name));
    CHECK(cli.read("none/recordings/" + name) == bytes);
  }
  CHECK(cli.read("none/journal.ndjson") == cli.read("one/journal.ndjson"));
}

TEST_CASE("an executed plan is recorded like a trace") {
  const CliFixture cli;
  CHECK(cli.parallax({"run", "edge.yaml", "--execution", "closed-loop", "--out", "loop"}).code <=
        4);
  const auto kept = recordings(cli, "loop");
  CHECK_FALSE(kept.empty());
  const auto csv = cli.parallax({"export", "loop"}).out;
  CHECK(rows_of(csv, "box").size() > 1);
  CHECK(holds_text(csv, " begins"));
  CHECK(cli.parallax(
               {"run", "edge.yaml", "--execution", "closed-loop", "--jobs", "3", "--out", "again"})
            .code <= 4);
  CHECK(recordings(cli, "again") == kept);
  for (const auto& name : kept) {
    CHECK(cli.read("again/recordings/" + name) == cli.read("loop/recordings/" + name));
  }
}

TEST_CASE("a recording of another run is not exported as this one's") {
  const CliFixture cli;
  for (const auto* seed : {"1", "7"}) {
    const auto run = std::string("run") + seed;
    CHECK(cli.parallax({"run", "edge.yaml", "--out", run, "--seed", seed, "--record", "all",
                        "--max-runs", "1"})
              .code != 2);
  }
  CHECK(cli.parallax({"export", "run1", "--sample", "1.1"}).code == 0);
  fs::copy_file(cli.folder() / "run7/recordings/1.1.rec", cli.folder() / "run1/recordings/1.1.rec",
                fs::copy_options::overwrite_existing);
  const auto result = cli.parallax({"export", "run1", "--sample", "1.1"});
  CHECK(result.code == 3);
  CHECK(result.out.empty());
  CHECK(result.err.find("it is that of another run, of seed") != std::string::npos);
  // Without a journal nothing is known of the run.
  fs::remove(cli.folder() / "run1/journal.ndjson");
  CHECK(cli.parallax({"export", "run1", "--sample", "1.1"}).code != 5);
}

TEST_CASE("what is missing or broken is told with the command that makes it") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--record", "none", "--out", "my run"}).code == 1);
  const auto missing = cli.parallax({"export", "my run", "--sample", "1.1"});
  CHECK(missing.code == 2);
  CHECK(missing.out.empty());
  CHECK(holds_text(missing.err, "E7115"));
  CHECK(holds_text(missing.err, "parallax replay 'my run' --sample 1.1 --record"));
  CHECK(cli.parallax({"replay", "my run", "--sample", "1.1", "--record"}).code == 0);
  const auto whole = cli.read("my run/recordings/1.1.rec");
  CHECK(cli.parallax({"export", "my run", "--sample", "1.1"}).code == 0);

  // An existing file is replaced if it is an earlier export; otherwise the export is refused.
  const auto journal = cli.read("my run/journal.ndjson");
  for (const auto* format : {"csv", "mcap"}) {
    const auto over = cli.parallax(
        {"export", "my run", "--sample", "1.1", "--format", format, "-o", "my run/journal.ndjson"});
    CHECK(over.code == 2);
    CHECK(holds_text(over.err, "E0005"));
    CHECK(cli.read("my run/journal.ndjson") == journal);
    const auto out = std::string("out.") + format;
    for (int time = 0; time < 2; ++time) {
      CHECK(cli.parallax({"export", "my run", "--sample", "1.1", "--format", format, "-o", out})
                .code == 0);
    }
  }

  for (const auto& [bytes, why] : std::vector<std::pair<std::string, std::string>>{
           {whole.substr(0, whole.size() / 2), "the file ends within its frames"},
           {"", "the file does not begin as a recording does"},
           {whole + "x", "something follows its end"}}) {
    cli.write("my run/recordings/1.1.rec", bytes);
    const auto broken = cli.parallax({"export", "my run", "--sample", "1.1", "--format", "mcap"});
    CHECK(broken.code == 3);
    CHECK(holds_text(broken.err, "E7116"));
    CHECK(holds_text(broken.err, why));
    CHECK_FALSE(fs::exists(cli.folder() / "my run/1.1.mcap"));
  }
  // Nothing else minds.
  for (const auto& words :
       std::vector<std::vector<std::string>>{{"replay", "my run"},
                                             {"coverage", "my run"},
                                             {"diff", "my run", "my run"},
                                             {"run", "edge.yaml", "--out", "my run", "--resume"}}) {
    const auto result = cli.parallax(words);
    CAPTURE(words.front());
    CAPTURE(result.err);
    CHECK(result.code <= 1);
    CHECK_FALSE(holds_text(result.err, "recordings"));
  }
  CHECK(cli.parallax({"export", "."}).code == 2);
  CHECK(cli.parallax({"export", "my run", "--sample", "x"}).code == 2);
  const auto never = cli.parallax({"export", "my run", "--sample", "9.9"});
  CHECK(never.code == 2);
  CHECK(holds_text(never.err, "E7110"));
  CHECK(json_of(cli, {"export", "my run", "-o", "-", "--sample", "1.1"}, 3).at("status") ==
        "error");
}

}  // namespace
}  // namespace parallax::test
