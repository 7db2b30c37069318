// Tables of simulations, read back by readers that share nothing with their writers.

#include "harness/report/sample_table.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/csv.h"

namespace parallax::harness {
namespace {

std::vector<SampleRow> hostile_rows() {
  SampleRow clean;
  clean.trace = 1;
  clean.sample = 1;
  clean.seed = (std::uint64_t{1} << 53U) - 1;
  clean.sim_time_s = 0.1 + 0.2;
  clean.start = {{"box.x", 1.0 / 3.0}, {"say, \"hi\"", true}, {"n", std::int64_t{-7}}};
  clean.margins = {{}, {{"goal", 5e-324}}};
  SampleRow bad = clean;
  bad.sample = 2;
  bad.outcome = "discrepancy";
  bad.event = 0;
  bad.drawn = false;
  bad.cause = "Go(<script>alert(1)</script>): a,\"b\"\r\nc \xE2\x80\xAE rtl";
  bad.reason = std::string(1U << 20U, 'w') + "\"";
  bad.start = {{"box.x", std::numeric_limits<double>::max()}, {"kind", std::string("=1+1,")}};
  bad.margins.resize(11);
  bad.margins[10]["reach"] = -0.261;
  bad.margins[2]["reach"] = 0.5;
  return {clean, bad};
}

TEST_CASE("a table of values after RFC 4180 reads back to the same bits, its texts shown") {
  const auto table = parallax::test::parse_csv(samples_csv(hostile_rows()));
  REQUIRE(table.size() == 3);
  const std::vector<std::string> header = {
      "trace",         "sample",         "seed",           "start",   "rejected",
      "retries",       "outcome",        "event",          "cause",   "reason",
      "sim_time_s",    "start.box.x",    "start.kind",     "start.n", "start.say, \"hi\"",
      "margin.1.goal", "margin.2.reach", "margin.10.reach"};
  CHECK(table[0] == header);
  const auto rows = hostile_rows();
  for (const auto& row : table) REQUIRE(row.size() == header.size());
  CHECK(table[1][2] == "9007199254740991");
  CHECK(table[1][3] == "drawn");
  CHECK(table[1][7].empty());
  CHECK(std::stod(table[1][10]) == 0.1 + 0.2);
  CHECK(std::stod(table[1][11]) == 1.0 / 3.0);
  CHECK(table[1][12].empty());
  CHECK(table[1][13] == "-7");
  CHECK(table[1][14] == "true");
  CHECK(std::strtod(table[1][15].c_str(), nullptr) == 5e-324);
  CHECK(table[2][3] == "chosen");
  CHECK(table[2][7] == "0");
  // Control characters are escaped here; the table of JSON lines has the bytes.
  CHECK(table[2][8] == "Go(<script>alert(1)</script>): a,\"b\"\\u000d\\u000ac \\u202e rtl");
  CHECK(table[2][9] == rows[1].reason);
  CHECK(std::stod(table[2][11]) == std::numeric_limits<double>::max());
  CHECK(table[2][12] == "'=1+1,");
  CHECK(std::stod(table[2][17]) == -0.261);
}

TEST_CASE("a table of JSON lines reads back to the same texts and the same bits") {
  std::istringstream in(samples_jsonl(hostile_rows()));
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
  REQUIRE(lines.size() == 2);
  const auto rows = hostile_rows();
  CHECK(lines[0]["state"]["box.x"] == 1.0 / 3.0);
  CHECK(lines[0]["state"]["say, \"hi\""] == true);
  CHECK(lines[0]["cause"].is_null());
  CHECK(lines[0]["event"].is_null());
  CHECK(lines[0]["margins"][0]["event"] == 1);
  CHECK(lines[1]["cause"] == rows[1].cause);
  CHECK(lines[1]["reason"] == rows[1].reason);
  CHECK(lines[1]["start"] == "chosen");
  CHECK(lines[1]["margins"].size() == 3);
  CHECK(lines[1]["margins"][2]["margins"]["reach"] == -0.261);
}

TEST_CASE("a table is known by its beginning, other lists of this program are none") {
  CHECK(is_sample_table(samples_csv({})));
  CHECK(is_sample_table(samples_csv(hostile_rows())));
  CHECK(is_sample_table(samples_jsonl(hostile_rows())));
  CHECK_FALSE(is_sample_table("{\"trace\":1,\"timepoints\":[{\"time\":0}]}"));
  CHECK_FALSE(is_sample_table("{\"trace\":1,\"sample\":1,\"attempt\":0,\"phase\":\"certify\"}"));
  CHECK_FALSE(is_sample_table("trace,time,Holds()"));
  CHECK_FALSE(is_sample_table("a letter to the editor"));
}

}  // namespace
}  // namespace parallax::harness
