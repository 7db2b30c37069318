// The passes of grounding and encoding: their order is documented, and each can be looked at.

#include <fstream>
#include <set>
#include <sstream>

#include "compiler/cnf/encoder.h"
#include "compiler/ground/grounder.h"
#include "compiler/pipeline/compile.h"
#include "compiler/pipeline/compile_report.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::PassLog;

const char* const kSwitchModel =
    "range time 0 3\nsort lamp\nlamp L1, L2\nfluent On(lamp)\nfluent Broken(lamp)\n"
    "event Press(lamp)\npredicate Good(lamp)\n"
    "Good(L1).\n[lamp] !HoldsAt(On(lamp),0).\n"
    "[lamp,time] Good(lamp) -> Initiates(Press(lamp),On(lamp),time).\n"
    "[lamp,time] HoldsAt(Broken(lamp),time) -> !HoldsAt(On(lamp),time).\n"
    "completion Good\n";

/// The log of the passes, with the value after the pass `wanted`.
PassLog log_of(const std::string& wanted, const compiler::GroundOptions& options = {}) {
  CheckedText checked(kSwitchModel);
  REQUIRE_MESSAGE(checked.model, checked.text());
  PassLog log{wanted, &checked.files};
  auto ground = compiler::ground_model(*checked.model, options, checked.sink, &log);
  REQUIRE_MESSAGE(ground, checked.text());
  compiler::encode(*ground, &log);
  log.files = nullptr;
  return log;
}

std::string value_after(const std::string& pass) {
  const auto log = log_of(pass);
  REQUIRE(log.text);
  return *log.text;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("docs/internals/architecture.md lists the passes as they run") {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/internals/architecture.md");
  std::ostringstream document;
  document << in.rdbuf();
  std::string list;
  for (const auto& pass : compiler::compile_passes()) {
    list += fmt::format("    {:<18}{}\n", pass.name, pass.description);
  }
  CHECK_MESSAGE(has(document.str(), '\n' + list + '\n'),
                "docs/internals/architecture.md should say:\n"
                    << list);
}

TEST_CASE("every pass is logged, in the order of the table, under a name of its own") {
  const auto passes = compiler::compile_passes();
  const auto log = log_of("");
  REQUIRE(log.runs.size() == passes.size());
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    CHECK(log.runs[i].pass.name == passes[i].name);
    CHECK(names.insert(passes[i].name).second);
    CHECK(!passes[i].description.empty());
  }
  CHECK(!log.text);
}

TEST_CASE("every pass has a value, the same each time") {
  for (const auto& pass : compiler::compile_passes()) {
    CAPTURE(std::string(pass.name));
    const auto value = value_after(std::string(pass.name));
    CHECK(!value.empty());
    CHECK(value == value_after(std::string(pass.name)));
  }
}

TEST_CASE("the value after a pass shows what the pass did") {
  CHECK(has(value_after("rigid-axioms"), "m.e:8 axiom: Good(L1)\n"));
  CHECK(!has(value_after("rigid-axioms"), "HoldsAt(On(L1),0)"));
  CHECK(has(value_after("fixed-axioms"), "m.e:9 axiom: !HoldsAt(On(L1),0)"));
  CHECK(!has(value_after("narrative"), "Initiates"));
  CHECK(has(value_after("effects"),
            "m.e:10 effect axiom: Initiates(Press(L1),On(L1),time) if Good(L1)\n"));
  CHECK(!has(value_after("effects"), "Initiates(Press(L2)"));  // known not to be good
  CHECK(has(value_after("axioms"), "m.e:11 axiom (every timepoint, width 0): "));
  CHECK(has(value_after("inertia"), "m.e:4 frame axiom (every timepoint, width 1): "));
  CHECK(!has(value_after("axioms"), "frame axiom"));
  CHECK(has(value_after("clauses"), "; clauses at every timepoint, width 1\n"));
  CHECK(has(value_after("hashes"), " HoldsAt(On(L1),0)\n"));
  CHECK(has(value_after("slots"), " HoldsAt On(L1)\n"));
  CHECK(has(value_after("numbering"), "; section of width 1, 3 blocks\n"));
}

TEST_CASE("a pass without anything to do is marked, and its value is the one before it") {
  compiler::GroundOptions old;
  old.meaning = compiler::Meaning::kDecreasoner;
  std::string skipped, did;
  const auto log = log_of("", old);
  for (const auto& run : log.runs) {
    (run.applied ? did : skipped) += std::string(run.pass.name) + ' ';
  }
  CHECK(skipped ==
        "rigid-axioms predicate-tables fixed-axioms narrative reachability meetings "
        "trajectories invariants ");
  CHECK(has(did, "unmentioned-atoms "));
  CHECK(value_after("trajectories") == value_after("completion"));
}

TEST_CASE("sizes grow to those of the compiled model") {
  const auto log = log_of("");
  CHECK(log.runs.front().size.clauses == 0);
  CHECK(log.runs.back().size.clauses > 0);
  for (std::size_t i = 1; i < log.runs.size(); ++i) {
    CHECK(log.runs[i].size.nodes >= log.runs[i - 1].size.nodes);
    CHECK(log.runs[i].size.constraints >= log.runs[i - 1].size.constraints);
  }
}

TEST_CASE("the table has a line for every pass, the JSON the clock under `timing` only") {
  const auto log = log_of("");
  const auto table = compiler::pass_table(log);
  const auto json = compiler::pass_json(log);
  for (const auto& pass : compiler::compile_passes()) {
    CHECK(has(table, '\n' + std::string(pass.name) + ' '));
    CHECK(has(json, "{\"name\":\"" + std::string(pass.name) + "\","));
  }
  CHECK(has(json, "\"timing\":{\"seconds\":"));
}

}  // namespace parallax::test
