// A project of thirty revisions of ten kinds: what `diff` and a gate over the whole folder say of
// each, what a suite says, and which revision broke its case.

#include <doctest/doctest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/tools/cli_json.h"
#include "tests/tools/history/git_repository.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The facts of a revision.
enum class Kind : std::uint8_t {
  kRefactoring,
  kFormatting,
  kComment,
  kSplit,
  kWorld,
  kRegion,
  kMapping,
  kCriterion,
  kPlan,
  kModel
};

struct Revision {
  Kind kind;
  const char* subject;
  std::function<void()> edit;
  const char* told;  // by diff; empty: no difference
};

/// The files of scenarios/two_regions/scenario.yaml and a manifest about its traces, in `p`.
class Project : public GitFixture {
 public:
  Project() {
    fs::create_directories(folder() / "p");
    for (const auto* name : {"scenario.yaml", "common.yaml", "world.yaml", "domain.e", "start.e",
                             "fetch.lisp", "robot.bind"}) {
      fs::copy(folder() / name, folder() / "p" / name);
    }
    for (const auto& entry : fs::directory_iterator(folder())) {
      if (entry.is_regular_file()) fs::remove(entry.path());
    }
    write("p/other.e",
          "range time 0 1\nfluent On()\nevent Press()\n[time] Initiates(Press(),On(),time).\n");
    write("p/suite.yaml",
          "cases:\n  - {id: fetched, model: scenario.yaml, expect: {traces: 1}}\n"
          "  - {id: other, model: other.e, expect: {traces: 4}}\n");
    write(".gitignore", "out\nbefore\n*.yaml.md\n*.jsonl\n");
    write(
        "gate.yaml",
        "models: {lost_traces: forbidden, gained_traces: forbidden, axioms: forbidden,\n"
        "  declarations: forbidden, starts: forbidden, physics: forbidden, judgement: forbidden,\n"
        "  claim: forbidden}\n");
  }

  void edit(const std::string& name, const std::string& from, const std::string& to) const {
    replace("p/" + name, from, to);
  }
  void append(const std::string& name, const std::string& text) const {
    write("p/" + name, read("p/" + name) + text);
  }
  /// Moves the part of a file from `from` up to `to` into another one.
  void move_part(const std::string& name, const std::string& from, const std::string& to,
                 const std::string& into, const std::string& instead) const {
    const auto text = read("p/" + name);
    const auto begin = text.find(from), end = to.empty() ? text.size() : text.find(to);
    REQUIRE(begin < end);
    write("p/" + into, text.substr(begin, end - begin));
    write("p/" + name, text.substr(0, begin) + instead + text.substr(end));
  }
};

std::vector<Revision> revisions_of(const Project& p) {
  const auto change = [&p](const char* name, const char* from, const char* to) {
    return [&p, name, from, to] { p.edit(name, from, to); };
  };
  const auto more = [&p](const char* name, const char* text) {
    return [&p, name, text] { p.append(name, text); };
  };
  return {
      {Kind::kRefactoring, "Turn an axiom's operands around",
       change("domain.e",
              "HoldsAt(RobotIn(region1),time) & HoldsAt(RobotIn(region2),time) -> region1=region2",
              "HoldsAt(RobotIn(region2),time) & HoldsAt(RobotIn(region1),time) -> region2=region1"),
       ""},
      {Kind::kWorld, "Take a heavier box", change("world.yaml", "mass_kg: 0.3", "mass_kg: 0.35"),
       "world.bodies.box.mass_kg 0.3 -> 0.35"},
      {Kind::kComment, "Say more about the world", more("world.yaml", "# That is all.\n"), ""},
      {Kind::kRefactoring, "Call a variable otherwise",
       change("domain.e", "[region,time] Initiates(Go(region),RobotIn(region),time).",
              "[region1,time] Initiates(Go(region1),RobotIn(region1),time)."),
       ""},
      {Kind::kSplit, "Put the effects into a file of their own",
       [&p] {
         p.move_part("domain.e", "; Going always arrives.", "; The box can be picked", "going.e",
                     "load going.e\n");
       },
       ""},
      {Kind::kCriterion, "Claim with less confidence",
       more("scenario.yaml", "criterion: {confidence: 0.9}\n"), "criterion.confidence"},
      {Kind::kFormatting, "Lay out the start",
       change("start.e", "HoldsAt(BoxIn(r2),0).", "HoldsAt( BoxIn( r2 ),\n  0 )."), ""},
      {Kind::kRegion, "Move the border of the second cell",
       change("common.yaml", "r2: {x: [1, 2]}", "r2: {x: [1, 1.98]}"),
       "regions.cells.r2.x [1, 2] -> [1, 1.98]"},
      {Kind::kPlan, "Place the box farther",
       change("fetch.lisp", "(make-3d-vector 0.5 0 0)", "(make-3d-vector 0.55 0 0)"), "0.55"},
      {Kind::kComment, "Explain the start", more("start.e", "; Nothing else is known.\n"), ""},
      {Kind::kMapping, "See the box in the hand",
       change("common.yaml", "{inside: region, body: box, unless: box.held}",
              "{inside: region, body: box}"),
       "mapping.BoxIn(region)"},
      {Kind::kWorld, "Take a smoother floor",
       change("world.yaml", "box-floor: 0.5", "box-floor: 0.4"), "world.friction"},
      {Kind::kSplit, "Put the friction into a file of its own",
       [&p] {
         p.move_part("world.yaml", "friction:", "bodies:", "friction.yaml",
                     "include: friction.yaml\n");
       },
       ""},
      {Kind::kMapping, "See the box on the lane again",
       change("common.yaml", "{inside: region, body: box}",
              "{inside: region, body: box, unless: box.held}"),
       "mapping.BoxIn(region)"},
      {Kind::kFormatting, "Write regions as blocks",
       change("common.yaml", "    r1: {x: [0, 1]}", "    r1:\n      x: [0.0, 1.0]"), ""},
      {Kind::kCriterion, "Exclude smaller rates",
       change("scenario.yaml", "{confidence: 0.9}", "{confidence: 0.9, epsilon: 0.03}"),
       "criterion.epsilon"},
      {Kind::kRegion, "Widen the second cell again", change("common.yaml", "[1, 1.98]", "[1, 2]"),
       "regions.cells.r2.x [1, 1.98] -> [1, 2]"},
      {Kind::kModel, "Pick up in the first cell only",
       change("domain.e", "& HoldsAt(BoxIn(region),time) -> Initiates(PickUp()",
              "& HoldsAt(BoxIn(region),time) & region=r1 -> Initiates(PickUp()"),
       "axioms: 1 changed"},
      {Kind::kRefactoring, "Group two quantifiers",
       change("domain.e", "[time] {region} HoldsAt(RobotIn(region),time).",
              "[time] ({region} (HoldsAt(RobotIn(region),time)))."),
       ""},
      {Kind::kPlan, "Stand somewhere else",
       change("fetch.lisp", "(make-3d-vector 1.5 0 0)", "(make-3d-vector 1.45 0 0)"), "1.45"},
      {Kind::kComment, "Explain the plan", more("fetch.lisp", ";; The end.\n"), ""},
      {Kind::kModel, "Pick up in every cell again", change("domain.e", " & region=r1", ""),
       "axioms: 1 changed"},
      {Kind::kFormatting, "Indent the plan",
       change("fetch.lisp", "(fetch-box)\n", "( fetch-box\n  )\n"), ""},
      {Kind::kSplit, "Put the actions into a file of their own",
       [&p] {
         p.move_part("common.yaml", "actions:", "sampling:", "actions.yaml", "");
         p.write("p/common.yaml", "include: actions.yaml\n" + p.read("p/common.yaml"));
       },
       ""},
      {Kind::kWorld, "Grip with less force",
       change("world.yaml", "grip_force_n: 20", "grip_force_n: 18"),
       "world.robot.grip_force_n 20 -> 18"},
      {Kind::kMapping, "Ignore what is held",
       change("common.yaml", "Holding(): {flag: box.held}", "Holding(): ignored"),
       "mapping.Holding()"},
      {Kind::kCriterion, "Claim for each trace by itself",
       change("scenario.yaml", "epsilon: 0.03}", "epsilon: 0.03, family: per-trace}"),
       "criterion.family"},
      {Kind::kRegion, "Narrow the first cell",
       change("common.yaml", "x: [0.0, 1.0]", "x: [0.1, 1.0]"),
       "regions.cells.r1.x [0, 1] -> [0.1, 1]"},
      {Kind::kPlan, "Place the box where it was",
       change("fetch.lisp", "(make-3d-vector 0.55 0 0)", "(make-3d-vector 0.5 0 0)"), "0.5"},
      {Kind::kModel, "Hold nothing at the start", more("start.e", "!HoldsAt(Holding(),0).\n"),
       "axioms: 1 added"},
  };
}

/// The part of a gate's rule that such a change breaks.
const char* rule_of(Kind kind) {
  switch (kind) {
    case Kind::kWorld:
      return "models.physics";
    case Kind::kRegion:
      return "models.starts";
    case Kind::kMapping:
      return "models.judgement";
    case Kind::kCriterion:
      return "models.claim";
    case Kind::kPlan:
    case Kind::kModel:
      return "models.axioms";
    case Kind::kRefactoring:
    case Kind::kFormatting:
    case Kind::kComment:
    case Kind::kSplit:
      break;
  }
  return "";
}

TEST_CASE("diff and the gate say what is true of thirty revisions") {
  const Project p;
  const auto revisions = revisions_of(p);
  CHECK(revisions.size() == 30);
  for (const auto& revision : revisions) {
    CAPTURE(revision.subject);
    fs::remove_all(p.folder() / "before");
    fs::copy(p.folder() / "p", p.folder() / "before", fs::copy_options::recursive);
    revision.edit();
    const bool changes = *revision.told != '\0';
    const auto diff = p.parallax({"diff", "before/scenario.yaml", "p/scenario.yaml"});
    CHECK_MESSAGE(diff.code == (changes ? 1 : 0), diff.out);
    CHECK_MESSAGE(has(diff.out, changes ? revision.told : "no difference"), diff.out);
    const auto gate =
        p.parallax({"diff", "--gate", "gate.yaml", "before", "p", "--markdown", "gate.yaml.md"});
    CHECK_MESSAGE(gate.code == (changes ? 1 : 0), gate.out);
    const auto markdown = p.read("gate.yaml.md");
    if (changes) {
      const auto rule = std::string("scenario.yaml: ") + rule_of(revision.kind);
      CHECK_MESSAGE(has(gate.out, "broken         " + rule), gate.out);
      // A person who reads only this can name the change.
      auto plain = std::regex_replace(markdown, std::regex("\\\\"), "");
      CHECK_MESSAGE(has(plain, revision.told[0] == 'a' ? "axioms" : revision.told), plain);
    } else {
      CHECK(has(gate.out, "kept           scenario.yaml: it changed, and all 8 rules are kept"));
    }
    // The other model has no part in it, and is not even compiled.
    CHECK(has(gate.out, "no file of 1 scenario or model changed"));
  }
}

const std::vector<std::string> kHistory = {"suite",    "p/suite.yaml", "--out",
                                           "out/told", "--history",    "told.jsonl"};

/// The line of a history says by value what a revision changed, and nothing where nothing did.
void check_history(const Project& p, const Revision& revision) {
  CAPTURE(revision.subject);
  const auto told = p.parallax(kHistory).err;
  const bool changes = *revision.told != '\0';
  CHECK_MESSAGE(has(told, "p/suite.yaml:fetched: ") == changes, told);
  // diff counts axioms, and the history says which.
  const bool counts = revision.told == std::string("axioms: 1 changed");
  const bool adds = revision.told == std::string("axioms: 1 added");
  CHECK_MESSAGE(has(told, adds ? "added: " : counts ? ", now " : revision.told), told);
}

TEST_CASE("the suite, its history and bisect name the revision that broke a case") {
  const Project p;
  p.commit("start");
  const auto first = p.git({"rev-parse", "HEAD"});
  p.parallax(kHistory);
  std::string broken, mended;
  for (const auto& revision : revisions_of(p)) {
    revision.edit();
    const auto hash = p.commit(revision.subject);
    if (std::string(revision.subject) == "Pick up in the first cell only") broken = hash;
    if (std::string(revision.subject) == "Pick up in every cell again") mended = hash;
    check_history(p, revision);
    if (revision.kind != Kind::kModel && revision.kind != Kind::kComment) continue;
    const auto suite =
        p.parallax({"suite", "p/suite.yaml", "--cache", "out/cache", "--history", "h.jsonl"});
    const bool is_broken = !broken.empty() && mended.empty();
    CHECK_MESSAGE(suite.code == (is_broken ? 1 : 0), suite.out);
    if (hash == broken) {
      CHECK(has(suite.out, "FAIL  p/suite.yaml:fetched"));
      CHECK_MESSAGE(has(suite.out, "since it passed last, p/common.yaml, p/domain.e"), suite.out);
      CHECK(has(suite.out, "world.friction.box-floor 0.5 -> 0.4"));
    }
  }
  const auto answer =
      p.parallax({"bisect", "--json", first, mended + "^", "--", "p/suite.yaml:fetched"});
  CHECK_MESSAGE(answer.code == 1, answer.err);
  REQUIRE(Json::accept(answer.out));
  const auto found = Json::parse(answer.out);
  REQUIRE(found["changed_by"].size() == 1);
  CHECK(found["changed_by"][0]["revision"] == broken);
  CHECK(found["new"]["verdict"] == "failed");
  CHECK(has(found["difference"].get<std::string>(), "axioms: 1 changed"));
  // The same change as the gate of the repository sees it, without a checkout.
  const auto gate = p.parallax({"diff", "--gate", "gate.yaml", broken + "^", broken, "p"});
  CHECK(gate.code == 1);
  CHECK_MESSAGE(has(gate.out, "broken         scenario.yaml: models.axioms"), gate.out);
  CHECK_FALSE(has(gate.out, "/tmp/"));
  CHECK(p.parallax({"diff", "--gate", "gate.yaml", "HEAD", "HEAD"}).code == 0);
  CHECK(p.parallax({"diff", "--gate", "gate.yaml", "HEAD", "nowhere"}).code == 2);
  CHECK(p.git({"status", "--porcelain"}).empty());
  const auto history = p.parallax({"report", "--history", "h.jsonl", "-o", "h.html"});
  CHECK(has(history.out, broken.substr(0, 12) + ": p/suite.yaml:fetched: passed, then failed"));
}

}  // namespace
}  // namespace parallax::test
