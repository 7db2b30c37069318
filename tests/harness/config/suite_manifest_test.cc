#include "harness/config/suite_manifest.h"

#include "tests/harness/config/scenario_text.h"

namespace parallax::harness::test {
namespace {

/// A folder with a model, and the result of loading a manifest in it.
class ManifestWorkspace : public Workspace {
 public:
  std::optional<SuiteManifest> load_suite(const std::string& text) {
    sink = base::DiagnosticSink();
    auto result = load_manifest(write("suite.yaml", text), files, sink);
    if (!result) return std::nullopt;
    return std::move(*result);
  }

  /// The one report of a manifest that is refused.
  std::string report(const std::string& text) {
    CAPTURE(text);
    CHECK_FALSE(load_suite(text).has_value());
    const auto all = reports();
    REQUIRE(all.size() == 1);
    return all.front();
  }
};

const std::string kOneCase =
    "cases:\n"
    "  - id: one\n"
    "    model: domain.e\n"
    "    expect: {traces: 3}\n";

TEST_CASE("a manifest is read with its defaults under every case") {
  ManifestWorkspace workspace;
  const auto manifest = workspace.load_suite(
      "defaults:\n"
      "  horizon: 4\n"
      "  limits: {time_s: 5, memory_mb: 64}\n"
      "  expect: {complete: false}\n"
      "cases:\n"
      "  - id: one\n"
      "    model: [domain.e, start.e]\n"
      "    constraints: ['HoldsAt(On(),time)']\n"
      "    expect: {traces: 3, golden: expected/one.txt}\n"
      "  - id: two-b.2\n"
      "    model: ./domain.e\n"
      "    horizon: 7\n"
      "    limits: {time_s: 9}\n"
      "    expect: {traces: 0, complete: true}\n");
  REQUIRE_MESSAGE(manifest.has_value(), workspace.reports().front());
  REQUIRE(manifest->cases.size() == 2);
  const auto& one = manifest->cases[0];
  CHECK(one.id == "one");
  REQUIRE(one.models.size() == 2);
  CHECK(one.models[1].text == (workspace.folder() / "start.e").string());
  CHECK(one.horizon == 4);
  REQUIRE(one.constraints.size() == 1);
  CHECK(one.constraints[0].text == "HoldsAt(On(),time)");
  CHECK(one.time_limit_s == 5.0);
  CHECK(one.memory_limit_mb == 64);
  CHECK(one.expect.traces == 3);
  CHECK_FALSE(one.expect.complete);
  CHECK(one.expect.golden->text == (workspace.folder() / "expected/one.txt").string());
  const auto& two = manifest->cases[1];
  CHECK(two.models[0].text == (workspace.folder() / "domain.e").string());
  CHECK(two.horizon == 7);
  CHECK(two.time_limit_s == 9.0);
  CHECK(two.memory_limit_mb == 64);
  CHECK(two.expect.traces == 0);
  CHECK(two.expect.complete);
}

TEST_CASE("unknown keys of a manifest are refused where they stand, with the near one") {
  ManifestWorkspace workspace;
  CHECK(workspace.report(replaced(kOneCase, "model:", "modle: a\n    model:")) ==
        "E5102 at 3:5: `modle` is not a key of the case fix: replace `modle` with `model`");
  CHECK(workspace.report(replaced(kOneCase, "{traces: 3}", "{traces: 3, tracse: 2}")) ==
        "E5102 at 4:25: `tracse` is not a key of `expect` of a case fix: replace `tracse` with "
        "`traces`");
  CHECK(workspace.report("case: []\n" + kOneCase).starts_with("E5102 at 1:1: `case` is not a key"));
  CHECK(workspace.report("defaults: {model: domain.e}\n" + kOneCase)
            .starts_with("E5102 at 1:12: `model` is not a key of `defaults`"));
  CHECK(workspace.report("defaults: {expect: {traces: 3}}\n" + kOneCase)
            .starts_with("E5102 at 1:21: `traces` is not a key of `expect` of `defaults`"));
}

TEST_CASE("two cases of a manifest do not share an id") {
  ManifestWorkspace workspace;
  const auto again = kOneCase.substr(kOneCase.find('\n') + 1);
  CHECK(workspace.report(kOneCase + again) == "E5131 at 5:9: the case `one` stands here twice");
}

TEST_CASE("an id is a safe file name") {
  ManifestWorkspace workspace;
  for (const std::string id : {"../up", "a/b", "-x", ".hidden", "'a b'", "\"a\\nb\"", "é"}) {
    CHECK(workspace.report(replaced(kOneCase, "id: one", "id: " + id)).starts_with("E5130 at 2:"));
  }
  CHECK(workspace.report(replaced(kOneCase, "one", "''")).starts_with("E5107 at 2:"));
  CHECK(workspace.report(replaced(kOneCase, "one", std::string(101, 'a'))).starts_with("E5130"));
  CHECK(workspace.load_suite(replaced(kOneCase, "one", std::string(100, 'a'))).has_value());
}

TEST_CASE("a missing model is reported at its name") {
  ManifestWorkspace workspace;
  CHECK(workspace.report(replaced(kOneCase, "domain.e", "dmain.e"))
            .starts_with("E0001 at 3:12: cannot open"));
  CHECK(workspace.sink.exit_code() == 3);
  CHECK(workspace.report(replaced(kOneCase, "    model: domain.e\n", ""))
            .starts_with("E5106 at 2:5: the case lacks the key `model`"));
  CHECK(workspace.report(replaced(kOneCase, "domain.e", "[]"))
            .starts_with("E5107 at 3:5: `model` is empty"));
}

TEST_CASE("a number of traces is a whole number that is not negative") {
  ManifestWorkspace workspace;
  CHECK(workspace.report(replaced(kOneCase, "3", "three")).starts_with("E5107 at 4:22: `traces`"));
  CHECK(workspace.report(replaced(kOneCase, "3", "-1")).starts_with("E5109 at 4:22: `traces`"));
  CHECK(workspace.report(replaced(kOneCase, "3", "1.5")).starts_with("E5107 at 4:22: `traces`"));
  CHECK(workspace.report(replaced(kOneCase, "3", "0, complete: false")) ==
        "E5109 at 4:22: `traces` is 0, but must be at least 1 where `complete` is false");
}

TEST_CASE("a case expects something, and a manifest has cases") {
  ManifestWorkspace workspace;
  CHECK(workspace.report(replaced(kOneCase, "    expect: {traces: 3}\n", "")) ==
        "E5132 at 2:9: `one` expects nothing");
  CHECK(workspace.report(replaced(kOneCase, "traces: 3", "complete: true")) ==
        "E5132 at 2:9: `one` expects nothing");
  CHECK(workspace.report("cases: []\n").starts_with("E5107 at 1:1: `cases` is empty"));
  CHECK(workspace.report("cases: {id: one}\n").starts_with("E5107 at 1:1: `cases` is a map"));
  CHECK(workspace.report("cases:\n  - one\n").starts_with("E5107 at 2:5: the case is"));
}

TEST_CASE("a manifest is told by its outermost key, however that is written") {
  ManifestWorkspace workspace;
  const auto kind = [&](const std::string& text) {
    return suite_file_kind(workspace.write("file.yaml", text), false);
  };
  for (const auto* manifest :
       {kOneCase.c_str(), "defaults: {}\ncases: []\n", "\"cases\": []\n", "'cases' : []\n",
        "{cases: []}\n", "--- {\"cases\": []}\n",
        "\xEF\xBB\xBF"
        "cases: []\n",
        "? cases\n: []\n", "\"c\\x61ses\": []\n", "%YAML 1.2\n---\ncases: []\n", "  cases: []\n",
        "x: 1\r\ncases: []\r\n", "include: gone.yaml\ncases: []\n"}) {
    CAPTURE(manifest);
    CHECK(kind(manifest) == SuiteFileKind::kManifest);
  }
  workspace.write("base.yaml", kOneCase);
  CHECK(kind("include: base.yaml\n") == SuiteFileKind::kManifest);
  CHECK(kind(kScenario) == SuiteFileKind::kScenario);
  CHECK(kind("{\"expect\": {verdict: discrepancy}}") == SuiteFileKind::kScenario);
  for (const auto* other : {"limits:\n  cases: 3\n", "- cases: []\n", "cases\n", "", "# cases:\n",
                            "text: |\n  cases:\n"}) {
    CAPTURE(other);
    CHECK(kind(other) == SuiteFileKind::kOther);
  }
  for (const auto* broken : {"cases: [\n", "include: gone.yaml\n", "a: b: c\n", "x: {\n"}) {
    CAPTURE(broken);
    CHECK(kind(broken) == SuiteFileKind::kBroken);
  }
}

}  // namespace
}  // namespace parallax::harness::test
