// Files that a proposal writes: all of them, or none. Runs that are set aside.

#include "tools/repair/apply.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/tools/cli_fixture.h"
#include "tools/repair/repair_input.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

Evidence seen(const std::string& id, bool failed, bool open) {
  Evidence out;
  out.steps = {{"Wait()", false, ""}, {"Pull()", failed, failed ? "stuck" : ""}};
  out.states = {{{"Open()", false}}, {{"Open()", false}}, {{"Open()", open}}};
  out.ids = {id};
  if (failed) out.divergence = 2;
  return out;
}

TEST_CASE("several files are written as one") {
  const test::CliFixture cli;
  Context context;
  Proposal proposal;
  for (const auto* name : {"a.e", "b.e", "c.e"}) {
    cli.write(name, "before\n");
    proposal.files.push_back({(cli.folder() / name).string(), "before\n", "after\n"});
  }
  const auto count = [&] {
    return std::distance(fs::directory_iterator(cli.folder()), fs::directory_iterator());
  };
  const auto files = count();
  SUBCASE("all of them") {
    REQUIRE(apply_proposal(proposal, base::WriteGate(true), context));
    for (const auto* name : {"a.e", "b.e", "c.e"}) CHECK(cli.read(name) == "after\n");
  }
  SUBCASE("none, if one lies where nothing may be changed") {
    proposal.files.back().name = (fs::temp_directory_path() / "c.e").string();
    CHECK_FALSE(apply_proposal(proposal, base::WriteGate(false), context));
    for (const auto* name : {"a.e", "b.e"}) CHECK(cli.read(name) == "before\n");
  }
  SUBCASE("none, if one is read-only, whoever asks") {
    fs::permissions(cli.folder() / "c.e", fs::perms::owner_read);
    CHECK_FALSE(apply_proposal(proposal, base::WriteGate(true), context));
    for (const auto* name : {"a.e", "b.e", "c.e"}) CHECK(cli.read(name) == "before\n");
  }
  SUBCASE("none, if one changed meanwhile") {
    cli.write("c.e", "else\n");
    CHECK_FALSE(apply_proposal(proposal, base::WriteGate(true), context));
    for (const auto* name : {"a.e", "b.e"}) CHECK(cli.read(name) == "before\n");
  }
  SUBCASE("none, if the last name is taken by a folder meanwhile") {
    proposal.files.back().name = (cli.folder() / "gone.e").string();
    CHECK_FALSE(apply_proposal(proposal, base::WriteGate(true), context));
    for (const auto* name : {"a.e", "b.e"}) CHECK(cli.read(name) == "before\n");
  }
  CHECK(count() == files);  // no temporary file is left
}

TEST_CASE("what a failed run takes to fail is set aside in runs of earlier rounds, too") {
  const std::vector<Evidence> failed = {seen("2.1", true, false)};
  std::vector<Evidence> earlier = {seen("1.1", false, true), seen("1.2", false, false)};
  earlier[1].states[0]["Open()"] = true;  // began elsewhere
  REQUIRE(set_aside(failed, earlier));
  CHECK(earlier[0].until == std::size_t{1});
  CHECK(earlier[0].needed() == 1);
  CHECK_FALSE(earlier[1].until);
  // Without a refusal of the world there is nothing to be careful about.
  std::vector<Evidence> other = {seen("1.1", false, true)};
  auto went_otherwise = failed;
  went_otherwise[0].steps[1].failed = false;
  CHECK_FALSE(set_aside(went_otherwise, other));
  CHECK_FALSE(other[0].until);
}

}  // namespace
}  // namespace parallax::tools
