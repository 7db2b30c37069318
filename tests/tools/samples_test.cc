// `--samples` and `--plot` as users get them: the rows against the report's counts and the journal.

#include <doctest/doctest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/csv.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::string& text) {
  const auto table = parse_csv(text);
  REQUIRE_FALSE(table.empty());
  std::vector<Row> out;
  for (std::size_t i = 1; i < table.size(); ++i) {
    REQUIRE(table[i].size() == table[0].size());
    auto& row = out.emplace_back();
    for (std::size_t k = 0; k < table[i].size(); ++k) row[table[0][k]] = table[i][k];
  }
  return out;
}

std::vector<Json> lines_of(const std::string& text) {
  std::vector<Json> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(Json::parse(line));
  return out;
}

int count(const std::vector<Row>& rows, const std::string& column, const std::string& value) {
  int out = 0;
  for (const auto& row : rows) out += row.at(column) == value ? 1 : 0;
  return out;
}

TEST_CASE("rates: one row a simulation, which add up to the counts by cause") {
  const CliFixture cli;
  const std::vector<std::string> words = {"rates", "wrong_model.yaml", "--runs", "40"};
  auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return more;
  };
  const auto report = json_of(cli, with({"--samples", "one.csv"}));
  const auto rows = rows_of(cli.read("one.csv"));
  const auto& trace = report["traces"][0];
  CHECK(rows.size() == 40);
  CHECK(count(rows, "outcome", "discrepancy") == trace["any"]["count"]);
  CHECK(count(rows, "outcome", "clean") == 40 - trace["any"]["count"].get<int>());
  CHECK(count(rows, "start", "drawn") == 40);
  int rejected = 0;
  for (const auto& row : rows) rejected += std::stoi(row.at("rejected"));
  CHECK(rejected == trace["rejected"]);
  for (const auto& cause : trace["causes"]) {
    CHECK(count(rows, "cause", cause["cause"]) == cause["count"]);
    const auto& example = rows.at(cause["example"].get<std::size_t>() - 1);
    CHECK(example.at("reason") == cause["reason"]);
    CHECK(std::stod(example.at("start.robot.x")) == cause["start"]["robot.x"].get<double>());
  }
  // The arm ends 0.6 m from the base: the margin equals the geometry of the start.
  int refused = 0;
  for (const auto& row : rows) {
    const auto& margin = row.at("margin.0.reach");
    CHECK(row.at("event") == (row.at("outcome") == "discrepancy" ? "0" : ""));
    if (margin.empty()) continue;
    ++refused;
    const double apart = std::stod(row.at("start.box.x")) - std::stod(row.at("start.robot.x"));
    CHECK(std::stod(margin) == doctest::Approx(0.6 - apart).epsilon(0.02));
  }
  CHECK(refused > 20);

  REQUIRE(cli.parallax(with({"--jobs", "2", "--samples", "two.csv"})).code == 0);
  CHECK(cli.read("two.csv") == cli.read("one.csv"));
  REQUIRE(cli.parallax(with({"--samples", "one.csv"})).code == 0);  // its own file is replaced
  CHECK(cli.read("two.csv") == cli.read("one.csv"));

  REQUIRE(cli.parallax(with({"--samples", "one.jsonl"})).code == 0);
  const auto lines = lines_of(cli.read("one.jsonl"));
  REQUIRE(lines.size() == rows.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CHECK(lines[i]["outcome"] == rows[i].at("outcome"));
    CHECK(lines[i]["seed"] == std::stoull(rows[i].at("seed")));
    CHECK((lines[i]["cause"].is_null() ? "" : lines[i]["cause"]) == rows[i].at("cause"));
    CHECK(lines[i]["state"]["box.x"].get<double>() == std::stod(rows[i].at("start.box.x")));
  }
}

TEST_CASE("run: rows are the simulations of the journal, also of a run that is continued") {
  const CliFixture cli;
  const auto report =
      json_of(cli, {"run", "edge.yaml", "--seed", "5", "--out", "run", "--samples", "run.csv"}, 1);
  const auto rows = rows_of(cli.read("run.csv"));
  CHECK(static_cast<int>(rows.size()) == report["simulations"]);
  std::size_t found = 0;
  for (const auto& line : lines_of(cli.read("run/journal.ndjson"))) {
    if (!line.contains("observations") || line["phase"] != "certify") continue;
    const auto& row = rows.at(found++);
    CHECK(row.at("sample") == std::to_string(line["sample"].get<int>()));
    CHECK(row.at("seed") == std::to_string(line["seed"].get<std::uint64_t>()));
    CHECK(std::stod(row.at("start.box.x")) == line["initial"]["box.x"].get<double>());
    const auto& margins = line["outcomes"][0]["margins"];
    CHECK(std::stod(row.at("margin.0.goal")) == margins["goal"].get<double>());
  }
  CHECK(found == rows.size());
  const auto& first = report["discrepancies"][0];
  CHECK(rows.back().at("cause") == first["cause"]["text"]);
  CHECK(rows.back().at("event") == std::to_string(first["first_divergence"].get<int>() - 1));
  REQUIRE(cli.parallax({"run", "edge.yaml", "--seed", "5", "--out", "run", "--resume", "--samples",
                        "again.csv"})
              .code == 1);
  CHECK(cli.read("again.csv") == cli.read("run.csv"));
}

TEST_CASE("run in closed loop: chosen starts are told from drawn ones") {
  const CliFixture cli;
  const auto report =
      json_of(cli,
              {"run", "edge.yaml", "--execution", "closed-loop", "--keep-going", "--starts",
               "guided", "--max-runs", "12", "--out", "loop", "--samples", "loop.jsonl"},
              1);
  const auto lines = lines_of(cli.read("loop.jsonl"));
  CHECK(static_cast<int>(lines.size()) == report["simulations"]);
  std::map<std::string, int> by_start, by_outcome;
  for (const auto& line : lines) {
    ++by_start[line["start"]];
    ++by_outcome[line["outcome"]];
  }
  CHECK(by_start["chosen"] == report["traces"][0]["chosen_starts"]);
  CHECK(by_outcome["clean"] == report["traces"][0].value("clean", by_outcome["clean"]));
  CHECK(by_outcome["discrepancy"] > 0);
}

TEST_CASE("files of others stay as they are, and names say what is written") {
  const CliFixture cli;
  const auto refused = [&](const std::vector<std::string>& more, const std::string& part) {
    for (const auto* command : {"rates", "run"}) {
      std::vector<std::string> words = {command, "edge.yaml"};
      if (more[0] == "--plot" && std::string(command) == "run") continue;
      words.insert(words.end(), more.begin(), more.end());
      const auto result = cli.parallax(words);
      CAPTURE(result.err);
      CHECK(result.code == 2);
      CHECK(result.err.find(part) != std::string::npos);
      CHECK_FALSE(std::filesystem::exists(cli.folder() / "out"));  // nothing was simulated
    }
  };
  cli.write("letter.csv", "dear reader,\n");
  cli.write("letter.html", "<p>dear reader\n");
  refused({"--samples", "letter.csv"}, "it is there already");
  refused({"--samples", "rows.txt"}, ".jsonl");
  refused({"--samples", "edge.yaml"}, "");
  refused({"--plot", "letter.html"}, "it is there already");
  refused({"--plot", "plot.png"}, ".html");
  std::filesystem::create_directory(cli.folder() / "folder.csv");
  refused({"--samples", "folder.csv"}, "folder.csv");
  CHECK(cli.read("letter.csv") == "dear reader,\n");
}

TEST_CASE("plots of rates: a page of every cause, without anything from a network") {
  const CliFixture cli;
  const auto report = json_of(
      cli, {"rates", "wrong_model.yaml", "--runs", "60", "--plot", "a.html", "--jobs", "2"});
  const auto page = cli.read("a.html");
  for (const auto& cause : report["traces"][0]["causes"]) {
    CHECK(page.find(cause["cause"].get<std::string>()) != std::string::npos);
    CHECK(page.find(cause["count"].dump() + " of 60") != std::string::npos);
  }
  for (const auto* part : {"class=\"plot causes\"", "class=\"plot settling\"",
                           "class=\"plot variable\"", "Content-Security-Policy"}) {
    CAPTURE(part);
    CHECK(page.find(part) != std::string::npos);
  }
  for (const auto* part : {" src=", "href=\"http", "url(", "@import"}) {
    CAPTURE(part);
    CHECK(page.find(part) == std::string::npos);
  }
  CHECK(page.find("\" style=") == std::string::npos);
  REQUIRE(cli.parallax({"rates", "wrong_model.yaml", "--runs", "60", "--plot", "b.html"}).code ==
          0);
  CHECK(cli.read("b.html") == page);
  REQUIRE(cli.parallax({"rates", "scenario.yaml", "--runs", "1", "--plot", "b.html"}).code == 0);
  CHECK(cli.read("b.html").find("0 of 1 runs give a discrepancy") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
