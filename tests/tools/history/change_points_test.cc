// Histories of suites: how they are read, and which changes are named.

#include "tools/history/change_points.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "harness/confidence/spending.h"
#include "tests/support/temporary_folder.h"
#include "tools/history/history_file.h"

namespace parallax::tools {
namespace {

MeasuredRate rate(std::int64_t count, std::int64_t runs,
                  std::string of = "trace 1: any discrepancy") {
  MeasuredRate out;
  out.of = std::move(of);
  out.count = count;
  out.runs = runs;
  return out;
}

HistoryLine line(const std::string& revision, const std::string& outcome,
                 std::vector<MeasuredRate> rates = {}) {
  HistoryLine out;
  out.revision = revision;
  out.paths = {"scenarios"};
  out.cases["a.yaml"] = {outcome, "no-discrepancy", std::move(rates), "f", false, 1.0};
  return out;
}

History history_of(std::vector<HistoryLine> lines) {
  History out;
  out.lines = std::move(lines);
  for (std::size_t i = 0; i < out.lines.size(); ++i) out.numbers.push_back(i + 1);
  return out;
}

Changes changes_in(const History& history) {
  const auto suites = suites_of(history);
  REQUIRE(suites.size() == 1);
  return find_changes(history, suites.front(), 0.95);
}

TEST_CASE("outcomes, verdicts, and cases that come and go") {
  auto history = history_of({line("1", "passed"), line("2", "not finished"), line("3", "passed"),
                             line("4", "failed"), line("5", "failed")});
  history.lines[3].cases["a.yaml"].files = "g";
  history.lines[4].cases["b.yaml"] = {"passed", "", {}, "", false, 0.1};
  history.lines.push_back(line("6", "failed"));
  history.numbers.push_back(6);
  history.lines[5].cases["a.yaml"].verdict = "discrepancy";
  const auto points = changes_in(history).points;
  const auto text = [&](std::size_t i) {
    return change_text(points[i], history, {0, 1, 2, 3, 4, 5});
  };
  REQUIRE(points.size() == 4);
  CHECK(text(0) ==
        "4: a.yaml: passed (no-discrepancy), then failed (no-discrepancy); files that it reads "
        "changed");
  CHECK(text(1) == "5: b.yaml: is new: passed");
  CHECK(text(2).starts_with("6: a.yaml: failed (no-discrepancy), then failed (discrepancy)"));
  CHECK(text(3) == "6: b.yaml: is no case any more");
}

TEST_CASE("a rate changes where an exact test says so, once") {
  std::vector<HistoryLine> lines;
  for (const auto count : {20, 22, 19, 60, 58, 61}) {
    lines.push_back(line(std::to_string(count), "passed", {rate(count, 200)}));
  }
  const auto changes = changes_in(history_of(lines));
  CHECK(changes.comparisons == 5);
  REQUIRE(changes.points.size() == 1);
  CHECK(changes.points[0].line == 3);
  CHECK(changes.points[0].p_value < 1e-4);
}

TEST_CASE("a slow drift is held against where it began") {
  std::vector<HistoryLine> lines;
  for (int i = 0; i < 8; ++i) {
    lines.push_back(line(std::to_string(i), "passed", {rate(20 + 8 * i, 200)}));
  }
  const auto points = changes_in(history_of(lines)).points;
  REQUIRE(!points.empty());
  CHECK(points[0].line > 1);
  // Each step by itself is no change.
  CHECK(changes_in(history_of({lines[0], lines[1]})).points.empty());
}

TEST_CASE("a cause that was never seen came in none of the runs") {
  const auto cause = std::string("trace 1: Go(r2): path-blocked");
  const auto points =
      changes_in(history_of({line("1", "passed", {rate(10, 200)}),
                             line("2", "passed", {rate(12, 200), rate(12, 200, cause)}),
                             line("3", "passed", {rate(11, 200), rate(1, 200, cause)})}))
          .points;
  REQUIRE(points.size() == 2);
  CHECK(points[0].words.starts_with(cause + ": 0 of 200 (0 to 1.83 %), then 12 of 200"));
  CHECK(points[1].line == 2);
}

TEST_CASE("lost runs count for what is less remarkable") {
  auto less = rate(0, 150), more = rate(30, 200);
  CHECK(changes_in(history_of({line("1", "passed", {less}), line("2", "passed", {more})}))
            .points.size() == 1);
  less.lost = 50;
  CHECK(changes_in(history_of({line("1", "passed", {less}), line("2", "passed", {more})}))
            .points.empty());
}

/// Histories of four cases under no change, and the changes named at each of their beginnings.
struct Looks {
  int named = 0;     // histories of which some change was named at some look
  bool kept = true;  // changes once named stayed named when the history grew
};
Looks look_at_growing(int histories, int lines_each, unsigned seed) {
  std::mt19937 random(seed);
  std::binomial_distribution<std::int64_t> draw(100, 0.3);
  Looks out;
  for (int i = 0; i < histories; ++i) {
    std::vector<HistoryLine> lines;
    std::size_t points = 0;
    for (int k = 0; k < lines_each; ++k) {
      auto one = line(std::to_string(k), "passed", {rate(draw(random), 100)});
      for (const auto* name : {"b.yaml", "c.yaml", "d.yaml"}) {
        one.cases[name] = {"passed", "", {rate(draw(random), 100)}, "", false, 1.0};
      }
      lines.push_back(std::move(one));
      const auto now = changes_in(history_of(lines)).points.size();
      out.kept = out.kept && now >= points;
      points = std::max(points, now);
    }
    out.named += points > 0 ? 1 : 0;
  }
  return out;
}

// With no change at all, some change is ever named in at most 5 % of histories, which are looked at
// after each line. 400 histories: more than 45 of them named have a probability below 1e-6 if each
// has 5 %.
TEST_CASE("chance is ever named in at most 5 % of histories, however often one looks") {
  const auto looks = look_at_growing(400, 16, 17);
  MESSAGE("named: " << looks.named << " of 400");
  CHECK(looks.named <= 45);
  CHECK(looks.kept);
}

TEST_CASE("other suites are other histories, and times are remarks") {
  auto history = history_of({line("1", "passed"), line("2", "failed"), line("3", "passed")});
  history.lines[1].fast = true;
  const auto suites = suites_of(history);
  REQUIRE(suites.size() == 2);
  CHECK(find_changes(history, suites[0], 0.95).points.empty());
  history.lines[2].cases["a.yaml"].wall_s = 4.5;
  CHECK(slower_cases(history, suites[0]).size() == 1);
  history.lines[2].cases["a.yaml"].wall_s = 2.5;
  CHECK(slower_cases(history, suites[0]).empty());
}

TEST_CASE("a line is read back as it was, whatever is in its names") {
  auto one = line("r\"\\\n\x01", "passed", {rate(3, 7, "trace 1: \xE2\x80\xAE x")});
  one.only = "</script>";
  one.seed = (std::uint64_t{1} << 53U) - 1;
  one.cases["a.yaml"].flaky = true;
  const test::TemporaryFolder folder;
  base::DiagnosticSink sink;
  const auto path = folder.path() / "h.jsonl";
  REQUIRE(append_history(path, one, sink));
  REQUIRE(append_history(path, one, sink));
  const auto read = read_history(path, sink);
  REQUIRE(read);
  REQUIRE(read->lines.size() == 2);
  CHECK(encode(read->lines[1]) == encode(one));
  CHECK(read->lines[0].revision == one.revision);
}

TEST_CASE("cut anywhere, a history keeps its whole lines, and goes on behind them") {
  const auto whole = encode(line("1", "passed")) + '\n' + encode(line("2", "failed")) + '\n';
  const auto first = whole.find('\n') + 1;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "h.jsonl";
  for (std::size_t length = 0; length <= whole.size(); length += 7) {
    CAPTURE(length);
    std::ofstream(path, std::ios::binary) << whole.substr(0, length);
    base::DiagnosticSink sink;
    const auto cut = read_history(path, sink);
    const bool is_head = length >= 11 || length == 0;  // {"history":
    CHECK(cut.has_value() == is_head);
    if (!cut) continue;
    CHECK(cut->lines.size() == (length >= whole.size() ? 2U : length >= first ? 1U : 0U));
    CHECK(cut->half_written == (length > 0 && whole[length - 1] != '\n'));
    REQUIRE(append_history(path, line("3", "passed"), sink));
    const auto more = read_history(path, sink);
    REQUIRE(more);
    CHECK(more->lines.size() == cut->lines.size() + 1);
    CHECK(more->lines.back().revision == "3");
    CHECK(remarks_on(*more, "h").size() == (cut->half_written ? 1U : 0U));
  }
}

TEST_CASE("appended to by many at once, no line is lost or mixed") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "h.jsonl";
  constexpr int kWriters = 4, kLines = 25;
  std::vector<std::thread> writers;
  for (int i = 0; i < kWriters; ++i) {
    writers.emplace_back([&, i] {
      for (int k = 0; k < kLines; ++k) {
        base::DiagnosticSink sink;
        (void)append_history(path, line(std::string(5000, 'x') + std::to_string(i), "passed"),
                             sink);
      }
    });
  }
  for (auto& writer : writers) writer.join();
  base::DiagnosticSink sink;
  const auto read = read_history(path, sink);
  REQUIRE(read);
  CHECK(read->lines.size() == kWriters * kLines);
  CHECK(read->unreadable.empty());
}

TEST_CASE("the exact test against sums over all tables, and with as many runs as one likes") {
  const auto choose = [](std::int64_t n, std::int64_t k) {
    double out = 1.0;
    for (std::int64_t i = 1; i <= k; ++i) {
      out *= static_cast<double>(n - k + i) / static_cast<double>(i);
    }
    return out;
  };
  for (const std::int64_t a : {0, 1, 4, 9, 12}) {
    for (const std::int64_t b : {0, 3, 8, 15}) {
      const std::int64_t runs_a = 12, runs_b = 15, failures = a + b;
      double more = 0.0, fewer = 0.0;
      for (std::int64_t k = std::max<std::int64_t>(0, failures - runs_a);
           k <= std::min(failures, runs_b); ++k) {
        const double p =
            choose(runs_b, k) * choose(runs_a, failures - k) / choose(runs_a + runs_b, failures);
        if (k >= b) more += p;
        if (k <= b) fewer += p;
      }
      // The second line is the first look.
      const double share = harness::SpendingRule(std::nullopt).share(1);
      const double expected = std::min(1.0, 2.0 * std::min(more, fewer) / share);
      CAPTURE(a);
      CAPTURE(b);
      const auto points = changes_in(history_of({line("1", "passed", {rate(a, runs_a)}),
                                                 line("2", "passed", {rate(b, runs_b)})}))
                              .points;
      CHECK(points.empty() == (expected > 0.05));
      if (!points.empty()) CHECK(points[0].p_value == doctest::Approx(expected).epsilon(1e-9));
    }
  }
  const auto many = std::int64_t{1'000'000'000};
  CHECK(changes_in(history_of({line("1", "passed", {rate(many / 3, many)}),
                               line("2", "passed", {rate(many / 3 + 1, many)})}))
            .points.empty());
  CHECK(changes_in(history_of({line("1", "passed", {rate(many / 3, many)}),
                               line("2", "passed", {rate(many / 2, many)})}))
            .points.size() == 1);
}

TEST_CASE("rates that are none are left out") {
  const auto read = decode_rates(
      R"([{"of":"x","count":3,"runs":2},{"of":"x","count":-1,"runs":2},{"of":"","count":1,"runs":2},
          {"of":"x","count":1,"runs":1e300},{"of":"x","count":1,"runs":9223372036854775807},
          {"of":"x","count":1,"runs":2,"lower":0.9,"upper":0.1},7,{"of":"y","count":1,"runs":2}])");
  REQUIRE(read.size() == 1);
  CHECK(read[0].of == "y");
  CHECK(decode_rates("{").empty());
}

}  // namespace
}  // namespace parallax::tools
