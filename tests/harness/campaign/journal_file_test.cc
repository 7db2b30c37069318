// The journal as a file: lines appended, read back, continued and rewritten.

#include <algorithm>
#include <atomic>
#include <thread>

#include "harness/campaign/journal.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

JournalHeader header() {
  JournalHeader out;
  out.scenario = "a.yaml";
  out.scenario_hash = "5ce0";
  out.seed = 7;
  out.tool_version = "0.1.0";
  out.simulator = {"scripted", "1", "bitwise", true, {}, {}, 0.002};
  out.options = R"({"keep_going":false})";
  return out;
}

TraceLine line(std::int64_t number) {
  auto trace = named_trace(number, "key " + std::to_string(number), {{"A()"}, {"B()"}},
                           {{"Go(r2)", {"plan.lisp:4", {}}}});
  return {std::make_shared<const CampaignTrace>(std::move(trace)),
          {{"going", {{"target.x", 1.25}}, 30.0}}};
}

SampleRecord record(std::int64_t trace, std::int64_t sample,
                    SampleStatus status = SampleStatus::kOk) {
  SampleRecord out;
  out.trace = trace;
  out.sample = sample;
  out.seed = 11;
  out.status = status;
  out.initial = {{"box.x", 0.1}};
  if (status == SampleStatus::kLost) {
    out.reason = "crashed";
    return out;
  }
  out.observations = {{{"box.x", 0.1}}, {{"box.x", 0.1 + 0.2}, {"digest", std::string("ab")}}};
  out.outcomes = {{SimStatus::kFailed, "blocked", 1.5}};
  out.digest = "ab";
  return out;
}

struct File {
  TempFolder parent;
  std::filesystem::path path = parent.path() / "run";
  base::SourceFiles files;
  base::DiagnosticSink sink;

  std::unique_ptr<Journal> open(const JournalHeader& with, std::int64_t max_lost = 3) {
    auto folder = RunFolder::claim(path, true, sink);
    REQUIRE(folder.has_value());
    auto recorded = read_for_continuation(*folder, with, files, sink);
    if (!recorded) return nullptr;
    auto journal =
        Journal::open(*std::move(folder), with, *std::move(recorded), max_lost, files, sink);
    return journal ? *std::move(journal) : nullptr;
  }
  std::string text() const { return slurp(path / kJournalName); }
};

TEST_CASE("what was appended is found by the next one that opens the journal") {
  File file;
  {
    const auto journal = file.open(header());
    REQUIRE(journal != nullptr);
    CHECK_FALSE(journal->recorded().header.has_value());
    journal->append(line(1));
    journal->append(record(1, 2));
    journal->append(record(1, 1));
    CHECK(journal->write_error().empty());
    CHECK(journal->find(1) == nullptr);  // it was not there when it was opened
  }
  CHECK(file.text() == encode(header()) + "\n" + encode(line(1)) + "\n" + encode(record(1, 2)) +
                           "\n" + encode(record(1, 1)) + "\n");
  const auto again = file.open(header());
  REQUIRE(again != nullptr);
  REQUIRE(again->find(1) != nullptr);
  CHECK(*again->find(1) == line(1));
  REQUIRE(again->find(1, 2, DrawPhase::kCertify) != nullptr);
  CHECK(*again->find(1, 2, DrawPhase::kCertify) == record(1, 2));
  CHECK(again->find(1, 2, DrawPhase::kConfirm) == nullptr);
  CHECK(again->find(2) == nullptr);
}

TEST_CASE("what many threads append is on disk when each goes on, in no more batches than lines") {
  constexpr int kThreads = 24, kEach = 6;
  File file;
  const auto journal = file.open(header());
  REQUIRE(journal != nullptr);
  journal->append(line(1));
  std::atomic<int> missing{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] {
      for (int k = 1; k <= kEach; ++k) {
        const auto mine = record(1, i * kEach + k);
        journal->append(mine);
        if (file.text().find("\n" + encode(mine) + "\n") == std::string::npos) ++missing;
      }
    });
  }
  for (auto& thread : threads) thread.join();
  CHECK(missing == 0);
  CHECK(journal->write_error().empty());
  CHECK(journal->batches() <= 2 + kThreads * kEach);
  const auto text = file.text();
  CHECK(std::count(text.begin(), text.end(), '\n') == 2 + kThreads * kEach);
}

TEST_CASE("a rewritten journal is in order, whatever the order of completion was") {
  File file;
  auto confirmed = record(1, 2);
  confirmed.phase = DrawPhase::kConfirm;
  {
    const auto journal = file.open(header());
    REQUIRE(journal != nullptr);
    REQUIRE(journal
                ->rewrite({line(1), line(2)}, {record(2, 1), confirmed, record(1, 2), record(1, 1)},
                          file.sink)
                .has_value());
  }
  CHECK(file.text() == encode(header()) + "\n" + encode(line(1)) + "\n" + encode(record(1, 1)) +
                           "\n" + encode(record(1, 2)) + "\n" + encode(confirmed) + "\n" +
                           encode(line(2)) + "\n" + encode(record(2, 1)) + "\n");
}

TEST_CASE("losses are taken out where they may be repeated, and stay where they may not") {
  auto with = header();
  bool repeated = true;
  SUBCASE("the simulator repeats a run to the last bit") {}
  SUBCASE("it does not") { with.simulator.determinism = "none", repeated = false; }
  File file;
  const auto lost = SampleStatus::kLost;
  {
    const auto journal = file.open(with, 2);
    REQUIRE(journal != nullptr);
    journal->append(line(1));
    // One alone, two in a row, and one at the end.
    for (const auto& each : {record(1, 1, lost), record(1, 2), record(1, 3, lost),
                             record(1, 4, lost), record(1, 5), record(1, 6, lost)}) {
      journal->append(each);
    }
  }
  const auto before = file.text();
  const auto again = file.open(with, 2);
  REQUIRE(again != nullptr);
  CHECK(again->find(1, 1, DrawPhase::kCertify) != nullptr);
  for (const int sample : {3, 4, 6}) {
    CHECK((again->find(1, sample, DrawPhase::kCertify) == nullptr) == repeated);
  }
  CHECK((file.text() == before) == !repeated);
}

TEST_CASE("a journal of another run is refused before and after the simulator is known") {
  File file;
  REQUIRE(file.open(header()) != nullptr);
  auto other = header();
  SUBCASE("inputs") { other.scenario_hash = "1"; }
  SUBCASE("options") { other.options = R"({"keep_going":true})"; }
  SUBCASE("simulator") { other.simulator.version = "2"; }
  CHECK(file.open(other) == nullptr);
  CHECK(codes(file.sink) == std::vector<std::string>{"E7102"});
}

}  // namespace
}  // namespace parallax::harness::test
