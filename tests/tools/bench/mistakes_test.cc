// Mistakes that tools/bench puts into models, and how it judges repairs of them.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/tools/cli_fixture.h"
#include "tools/bench/mistakes/mistake_bench.h"
#include "tools/bench/mistakes/mistake_table.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using tools::Mistake;
using tools::MistakeKind;
using tools::MistakeTrial;
using tools::ModelText;
using tools::Shown;

constexpr const char* kWorlds = PARALLAX_SOURCE_DIR "/tools/bench/mistakes/worlds";

std::vector<std::string> file_lines(const std::string& name) {
  std::ifstream in(fs::path(kWorlds) / name);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  REQUIRE(!lines.empty());
  return lines;
}

ModelText model_text(const std::string& world) {
  return {file_lines(world + "/domain.e"), file_lines(world + "/rules.e"),
          file_lines(world + "/start.e")};
}

/// The line of the model's rules that is `text`.
std::size_t line_of(const ModelText& model, const std::string& text) {
  for (std::size_t i = 0; i < model.rules.size(); ++i) {
    if (model.rules[i] == text) return i;
  }
  FAIL("no rule " << text);
  return 0;
}

TEST_CASE("axioms are read and written as they stand in the worlds") {
  for (const auto& world : tools::mistake_worlds()) {
    for (const auto& line : model_text(world.name).rules) {
      const auto axiom = tools::read_axiom(line);
      if (axiom.kind != tools::AxiomText::Kind::kOther) CHECK(axiom.to_text() == line);
    }
  }
}

TEST_CASE("every world has mistakes of nearly every kind, each another text of one line") {
  std::size_t all = 0;
  for (const auto& world : tools::mistake_worlds()) {
    const auto model = model_text(world.name);
    const auto mistakes = tools::make_mistakes(model, 9);
    std::set<MistakeKind> kinds;
    std::set<std::string> texts;
    for (const auto& mistake : mistakes) {
      kinds.insert(mistake.kind);
      const auto& lines = mistake.in_start ? model.start : model.rules;
      REQUIRE(mistake.line < lines.size());
      CHECK(mistake.text != lines[mistake.line]);
      texts.insert(std::to_string(mistake.line) + (mistake.in_start ? "s" : "r") + mistake.text);
      const auto changed = tools::with_mistakes(lines, {mistake}, mistake.in_start);
      CHECK(changed.size() == lines.size() - (mistake.text.empty() ? 1 : 0));
    }
    CHECK_MESSAGE(kinds.size() == tools::kMistakeKinds, world.name);
    CHECK(texts.size() == mistakes.size());
    all += mistakes.size();
  }
  CHECK(all >= 700);
}

TEST_CASE("mistakes are wrong in the way that their kind says") {
  const ModelText model{
      {"sort cup", "cup A, B", "fluent Full(cup)", "fluent Clean(cup)", "event Fill(cup)"},
      {"[cup,time] HoldsAt(Clean(cup),time) -> Initiates(Fill(cup),Full(cup),time)."},
      {"[cup] !HoldsAt(Full(cup),0)."}};
  std::map<std::string, std::string> first;
  for (const auto& mistake : tools::make_mistakes(model, 1)) {
    first[to_string(mistake.kind)] = mistake.text;
  }
  CHECK(first["effect dropped"].empty());
  CHECK(first["wrong sign"] ==
        "[cup,time] HoldsAt(Clean(cup),time) -> Terminates(Fill(cup),Full(cup),time).");
  CHECK(first["wrong fluent"] ==
        "[cup,time] HoldsAt(Clean(cup),time) -> Initiates(Fill(cup),Clean(cup),time).");
  CHECK(first["wrong argument"] ==
        "[cup,time] HoldsAt(Clean(A),time) -> Initiates(Fill(cup),Full(cup),time).");
  CHECK(first["condition dropped"] == "[cup,time] Initiates(Fill(cup),Full(cup),time).");
  CHECK(first["condition added"] ==
        "[cup,time] HoldsAt(Clean(cup),time) & HoldsAt(Full(cup),time) -> "
        "Initiates(Fill(cup),Full(cup),time).");
  CHECK(first["initial fact wrong"] == "[cup] HoldsAt(Full(cup),0).");
}

/// A folder of its own for trials of one world.
struct TrialFolder {
  CliFixture cli;

  tools::TrialOptions options(const std::string& program) const {
    return {kWorlds, program, (cli.folder() / "trials").string(), 60.0};
  }
  MistakeTrial trial(const std::string& world, const std::string& program) const {
    std::string error;
    auto made = MistakeTrial::make({world, false}, options(program), error);
    REQUIRE_MESSAGE(made, error);
    return std::move(*made);
  }
};

const std::string kDroppedEffect = "[parcel,time] Initiates(Stamp(parcel),Stamped(parcel),time).";

TEST_CASE("three mistakes of a world: one is shown and repaired, one is invisible, one no model") {
  const TrialFolder folder;
  const auto trial = folder.trial("post", CliFixture::program());
  const auto& model = trial.model();
  const auto dropped =
      trial.measure({{MistakeKind::kEffectDropped, false, line_of(model, kDroppedEffect), ""}}, 1);
  CHECK(dropped.shown == Shown::kFirstPlan);
  CHECK(dropped.right_rank == 1);
  CHECK(dropped.right_second);
  CHECK(dropped.right_random);
  CHECK(dropped.list_s > 0.0);
  const std::string unneeded =
      "[parcel,time] HoldsAt(OnBelt(parcel),time) -> HoldsAt(Stamped(parcel),time).";
  const auto invisible =
      trial.measure({{MistakeKind::kConstraintWrong, false, line_of(model, unneeded), ""}}, 2);
  CHECK(invisible.shown == Shown::kInvisible);
  const auto broken =
      trial.measure({{MistakeKind::kWrongFluent, false, line_of(model, kDroppedEffect),
                      "[parcel,time] Initiates(Stamp(parcel),Nothing(parcel),time)."}},
                    3);
  CHECK(broken.shown == Shown::kNoModel);
  const auto again = tools::read_outcome(to_json(dropped));
  REQUIRE(again);
  CHECK(to_json(*again) == to_json(dropped));
}

/// A patch that puts `line` in front of the model.
std::string patch_with(const std::string& line) {
  return "--- a/model.e\n+++ b/model.e\n@@ -1,1 +1,2 @@\n+" + line + "\n load domain.e\n";
}

TEST_CASE("a proposal that is wrong counts as wrong, whatever it says of itself") {
  const TrialFolder folder;
  const auto proposals = nlohmann::json::array(
      {{{"words", "wrong"},
        {"patch", patch_with("[parcel,time] Terminates(Stamp(parcel),Stamped(parcel),time).")},
        {"patch_folder", ""}},
       {{"words", "right"}, {"patch", patch_with(kDroppedEffect)}, {"patch_folder", ""}}});
  folder.cli.write("answer.json", nlohmann::json{{"proposals", proposals}}.dump());
  const auto program = (folder.cli.folder() / "program").string();
  folder.cli.write("program", "#!/bin/sh\nif [ \"$1\" = repair ]; then cat '" +
                                  (folder.cli.folder() / "answer.json").string() +
                                  "'; exit 1; fi\nexec '" + CliFixture::program() + "' \"$@\"\n");
  fs::permissions(program, fs::perms::owner_all);
  const auto trial = folder.trial("post", program);
  const auto outcome = trial.measure(
      {{MistakeKind::kEffectDropped, false, line_of(trial.model(), kDroppedEffect), ""}}, 1);
  CHECK(outcome.proposals == 2);
  CHECK(outcome.right_rank == 2);
  CHECK(!outcome.first_is_marked);
  const auto counts = tools::count_mistakes({outcome});
  REQUIRE(!counts.empty());
  CHECK(counts[0].name == "post");
  CHECK(counts[0].shown == 1);
  CHECK(counts[0].first == 0);
  CHECK(counts[0].three == 1);
  CHECK(counts[0].silent == 1);
}

}  // namespace
}  // namespace parallax::test
