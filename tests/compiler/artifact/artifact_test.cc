#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "tests/compiler/artifact/written_model.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Lines of `b` that `a` does not have, counted with multiplicity.
std::vector<std::string> added(const std::string& a, const std::string& b) {
  auto before = lines_of(a), after = lines_of(b);
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  std::vector<std::string> out;
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                      std::back_inserter(out));
  return out;
}

void check_round_trip(const WrittenModel& written) {
  const auto text = written.artifact();
  const ReadText read(text);
  REQUIRE_MESSAGE(read.model, read.codes() << " in line " << read.line());
  const auto &a = written.compiled, &b = *read.model;
  CHECK(compiler::to_artifact(b) == text);
  CHECK(a.clauses == b.clauses);
  CHECK(a.clause_timepoints == b.clause_timepoints);
  CHECK(a.clause_origins == b.clause_origins);
  CHECK(a.clause_is_definition == b.clause_is_definition);
  CHECK(a.fluents == b.fluents);
  CHECK(a.events == b.events);
  CHECK(a.release_slots == b.release_slots);
  CHECK(a.fixed == b.fixed);
  CHECK(a.slots == b.slots);
  CHECK(a.state_slots == b.state_slots);
  CHECK(a.horizon == b.horizon);
  CHECK(a.sources == b.sources);
}

}  // namespace

TEST_CASE("what is written is read as an equal model and written as equal bytes") {
  for (const auto& text : {kReleases, kFall}) {
    const WrittenModel written(text);
    REQUIRE(written.codes() == "");
    check_round_trip(written);
  }
}

TEST_CASE("random models survive writing and reading") {
  std::size_t compiled = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const auto text = random_model(seed, kSolverSize).print();
    const WrittenModel written(text);
    if (written.ground == nullptr) continue;
    CAPTURE(text);
    check_round_trip(written);
    ++compiled;
  }
  CHECK(compiled > 100);
}

TEST_CASE("without the projection line nothing else changes") {
  const WrittenModel written(kReleases);
  const auto with = lines_of(written.artifact());
  const auto without =
      lines_of(compiler::to_artifact(written.compiled, {.projection_line = false}));
  std::vector<std::string> kept;
  for (const auto& line : with) {
    if (!line.starts_with("c p show") && line != "c t pmc") kept.push_back(line);
  }
  CHECK(kept == without);
  CHECK(kept.size() + 2 == with.size());
  const ReadText read(compiler::to_artifact(written.compiled, {.projection_line = false}));
  CHECK(read.model);
}

TEST_CASE("a comment in the model moves one place and the hashes, nothing else") {
  const WrittenModel before(kReleases);
  auto text = kReleases;
  const std::string axiom = "[time] Releases(Kick(),Door(),time).\n";
  text.replace(text.find(axiom), axiom.size(), "; the lock is worn\n" + axiom);
  const WrittenModel after(text);
  const auto changed = added(before.artifact(), after.artifact());
  REQUIRE(changed.size() == 3);
  CHECK(changed[0].starts_with("c dec axiom "));
  CHECK(changed[0].find("Releases(Kick(),Door(),time)") != std::string::npos);
  CHECK(changed[1].starts_with("c dec hash "));
  CHECK(changed[2].starts_with("c dec source "));
}

TEST_CASE("an axiom that goes takes its own clauses along, and nothing else moves") {
  const WrittenModel before(kReleases);
  auto text = kReleases;
  const std::string axiom = "HoldsAt(Door(),0).\n";
  text.replace(text.find(axiom), axiom.size(), "\n");
  const WrittenModel after(text);
  const auto gone = added(after.artifact(), before.artifact());
  const auto came = added(before.artifact(), after.artifact());
  // Gone: the hashes of text and lines, the axiom, its run, its clause, the header. Came: hashes
  // and header; the next axiom's place is relative to the one that went.
  CHECK(gone.size() == 7);
  CHECK(came.size() == 4);
  CHECK(std::any_of(came.begin(), came.end(),
                    [](const std::string& line) { return line.starts_with("p cnf "); }));
}

TEST_CASE("words with blanks, quotes and other bytes come back as they were") {
  WrittenModel written(kFall);
  written.compiled.producer = "a \"b\" \\ \x01 \xc3\xa4";
  written.compiled.options["key with blank"] = "";
  const ReadText read(written.artifact());
  REQUIRE(read.model);
  CHECK(read.model->producer == written.compiled.producer);
  CHECK(read.model->options == written.compiled.options);
}

TEST_CASE("ids of axioms depend on their text alone") {
  const WrittenModel model(
      "range time 0 1\nfluent F()\nHoldsAt(F(),0).\nHoldsAt( F(), 0 ).\n!HoldsAt(F(),1).\n");
  std::set<std::string> ids;
  for (const auto& origin : model.compiled.origins) ids.insert(origin.id);
  CHECK(ids.size() == model.compiled.origins.size());
  std::vector<std::string> equal;
  for (const auto& origin : model.compiled.origins) {
    if (origin.kind == compiler::OriginKind::kAxiom && !origin.text.starts_with("!"))
      equal.push_back(origin.id);
  }
  REQUIRE(equal.size() == 2);
  CHECK(equal[1] == equal[0] + ".2");
}

}  // namespace parallax::test
