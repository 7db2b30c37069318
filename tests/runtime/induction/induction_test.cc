// Induction over time, compared with reachability through explicit states of random models
// (step_worlds.h), and with longer horizons of models in which any construct may occur.
#include "runtime/induction/induction.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>

#include "compiler/pipeline/induction_model.h"
#include "runtime/induction/model_question.h"
#include "tests/runtime/induction/step_worlds.h"
#include "tests/support/deep.h"

namespace parallax::test {
namespace {

using compiler::Timepoint;
using runtime::InductionVerdict;

/// A model and the property that it is asked about.
class Subject {
 public:
  Subject(const std::string& text, const std::string& property,
          std::optional<int> horizon = std::nullopt) {
    compiler::CompileInput input;
    input.text = files_.add("test.e", text);
    const auto formula = files_.add("--property", property);
    const base::SourceRange range{formula, 0, static_cast<std::uint32_t>(property.size())};
    input.constraints = {{range, range, true}};
    input.hits_at_start = true;
    input.horizon = horizon;
    auto compiled = compiler::compile_model(input, files_, sink_);
    if (!compiled) return;
    compilation_.emplace(*std::move(compiled));
    const auto shape = compiler::induction_shape(*compilation_, sink_);
    if (shape) shape_ = *shape;
    if (shape) whole_ = compile(std::nullopt);
  }
  /// Can induction speak of it? If not, `codes()` says why.
  bool is_fine() const { return whole_.has_value(); }
  std::string codes() const {
    std::string out;
    for (const auto& diagnostic : sink_.sorted()) {
      if (base::info(diagnostic.code).severity != base::Severity::kError) continue;
      out += (out.empty() ? "" : " ") + std::string(base::info(diagnostic.code).id);
    }
    return out;
  }
  std::string messages() const {
    std::string out;
    for (const auto& diagnostic : sink_.sorted()) out += diagnostic.message + "\n";
    return out;
  }

  runtime::InductionAnswer decide() {
    runtime::InductionTask task;
    task.whole = &*whole_;
    task.window = [this](Timepoint steps) -> base::Result<compiler::CompiledModel> {
      auto model = compile(steps);
      if (!model) return sink_.already_reported();
      return *std::move(model);
    };
    task.last_fixed = shape_->last_fixed;
    task.width = shape_->width;
    task.back = shape_->back;
    task.ahead = shape_->ahead;
    return runtime::decide_by_induction(task, [&](const runtime::ProofClaim& claim, auto name) {
      claims_.emplace_back(name);
      return checked(claim);
    });
  }
  const std::vector<std::string>& claims() const { return claims_; }
  const compiler::CompiledModel& whole() const { return *whole_; }
  const compiler::InductionShape& shape() const { return *shape_; }

 private:
  /// The proof is made and checked in memory: syncing files takes longer than all the rest.
  static runtime::ProofVerdict checked(const runtime::ProofClaim& claim) {
    char* bytes = nullptr;
    std::size_t size = 0;
    std::FILE* log = open_memstream(&bytes, &size);
    REQUIRE(log != nullptr);
    {
      const auto solver = runtime::make_proving_solver(log, runtime::ProofForm::kBinary);
      claim.for_each_clause([&](auto clause) { solver->add_clause(clause); });
      CHECK(solver->solve() == runtime::SolveStatus::kUnsatisfiable);
    }
    std::fclose(log);
    std::stringstream formula;
    claim.write_dimacs(formula);
    std::istringstream proof(std::string(bytes, size));
    std::free(bytes);
    return runtime::check_proof(formula, proof, runtime::DratFormat::kBinary).verdict;
  }
  std::optional<compiler::CompiledModel> compile(std::optional<Timepoint> stretch) {
    auto model = compiler::compile_breaks(*compilation_->typed, *shape_, stretch, {}, sink_);
    if (!model) return std::nullopt;
    return *std::move(model);
  }
  base::SourceFiles files_;
  base::DiagnosticSink sink_;
  std::optional<compiler::Compilation> compilation_;
  std::optional<compiler::InductionShape> shape_;
  std::optional<compiler::CompiledModel> whole_;
  std::vector<std::string> claims_;
};

const std::string kDoor =
    "fluent Open()\nfluent Locked()\nevent Push()\nevent Turn()\n"
    "[time] !HoldsAt(Locked(),time) -> Initiates(Push(),Open(),time).\n"
    "[time] !HoldsAt(Open(),time) -> Initiates(Turn(),Locked(),time).\n"
    "[time] Happens(Push(),time) -> !Happens(Turn(),time).\n"
    "!HoldsAt(Open(),0).\n!HoldsAt(Locked(),0).\n";

TEST_CASE("a property that each step keeps holds at every timepoint") {
  Subject door("range time 0 3\n" + kDoor, "!(HoldsAt(Open(),time) & HoldsAt(Locked(),time))");
  REQUIRE_MESSAGE(door.is_fine(), door.messages());
  const auto answer = door.decide();
  CHECK(answer.verdict == InductionVerdict::kHolds);
  CHECK(answer.steps == 1);
  CHECK(door.claims().front() == "beginning");
  CHECK(door.claims().back() == "step");
}

TEST_CASE("a property that a longer trace breaks is not decided, and broken at that horizon") {
  const std::string counter =
      "sort number: integer\nrange number 0 5\nfluent At(number)\nevent Tick()\n"
      "[number,time] HoldsAt(At(number),time) & number<5 -> Initiates(Tick(),At(number+1),time).\n"
      "[number,time] HoldsAt(At(number),time) & number<5 -> Terminates(Tick(),At(number),time).\n"
      "[number] HoldsAt(At(number),0) <-> number=0.\n";
  Subject soon("range time 0 4\n" + counter, "!HoldsAt(At(5),time)");
  REQUIRE_MESSAGE(soon.is_fine(), soon.messages());
  CHECK(soon.decide().verdict == InductionVerdict::kUndecided);
  Subject later("range time 0 6\n" + counter, "!HoldsAt(At(5),time)");
  const auto answer = later.decide();
  CHECK(answer.verdict == InductionVerdict::kBroken);
  CHECK(answer.broken_at == 5);
}

TEST_CASE("at most one place is an invariant that makes the step possible") {
  const std::string robot =
      "sort place\nplace A, B, C\nfluent At(place)\nevent Go(place)\n"
      "[place,time] Initiates(Go(place),At(place),time).\n"
      "[place1,place2,time] HoldsAt(At(place2),time) & place1!=place2 ->\n"
      "  Terminates(Go(place1),At(place2),time).\n"
      "[place1,place2,time] Happens(Go(place1),time) & Happens(Go(place2),time) ->\n"
      "  place1=place2.\n[place] HoldsAt(At(place),0) <-> place=A.\n";
  Subject here("range time 0 4\n" + robot,
               "!(HoldsAt(At(A),time) & HoldsAt(At(B),time)) & {place} HoldsAt(At(place),time)");
  REQUIRE_MESSAGE(here.is_fine(), here.messages());
  const auto answer = here.decide();
  CHECK(answer.verdict == InductionVerdict::kHolds);
  CHECK(answer.invariants > 0);
  CHECK(here.claims() == std::vector<std::string>{"beginning", "start", "kept", "step"});
}

TEST_CASE("different states decide what no fixed number of steps does") {
  // F1 and F2 run in a circle that never comes to both; an unreachable circle comes to it.
  const std::string circles =
      "fluent A()\nfluent B()\nfluent C()\nevent Tick()\n[time] Happens(Tick(),time).\n"
      "[time] HoldsAt(C(),time) & !HoldsAt(A(),time) -> Initiates(Tick(),A(),time).\n"
      "[time] HoldsAt(C(),time) & HoldsAt(A(),time) -> Terminates(Tick(),A(),time).\n"
      "[time] HoldsAt(C(),time) & HoldsAt(A(),time) & !HoldsAt(B(),time) ->\n"
      "  Initiates(Tick(),B(),time).\n"
      "!HoldsAt(A(),0).\n!HoldsAt(B(),0).\n!HoldsAt(C(),0).\n";
  Subject never("range time 0 8\n" + circles, "!HoldsAt(B(),time)");
  REQUIRE_MESSAGE(never.is_fine(), never.messages());
  CHECK(never.decide().verdict == InductionVerdict::kHolds);
}

/// The codes with which the model is refused.
std::string refused(const std::string& rest, const std::string& property = "HoldsAt(F(),time)") {
  Subject subject(
      "range time 0 4\nsort thing\nthing T\nfluent F()\nfluent G(thing)\nevent E()\n" + rest,
      property);
  REQUIRE_MESSAGE(subject.codes().size() <= 5, subject.messages());
  return subject.codes();
}

TEST_CASE("what is not the same at every timepoint is refused") {
  CHECK(refused("") == "");
  CHECK(refused("HoldsAt(F(),2).\nHappens(E(),3).\n") == "");
  CHECK(refused("{time} Happens(E(),time).\n") == "E3021");
  CHECK(refused("[time] time<2 -> HoldsAt(F(),time).\n") == "E3021");
  CHECK(refused("[time1,time2] time1<time2 & HoldsAt(F(),time1) -> HoldsAt(F(),time2).\n") ==
        "E3021");
  CHECK(refused("[time] HoldsAt(F(),0) -> HoldsAt(F(),time).\n") == "E3021");
  CHECK(refused("Initiates(E(),F(),1).\n") == "E3021");
  CHECK(refused("fluent Since(time)\n") == "E3021");
  CHECK(refused("predicate Due(time)\nDue(3).\n") == "E3021");
  CHECK(refused("range offset 1 2\nfluent H()\n[time] Initiates(E(),H(),time).\n"
                "[time] Terminates(E(),H(),time).\n"
                "[time,offset] Trajectory(H(),time,F(),offset).\n") == "E3021");
  // A reason that lies elsewhere than its event.
  CHECK(refused("[time] HoldsAt(F(),time-1) -> Happens(E(),time).\n") == "");
  CHECK(refused("[time] HoldsAt(F(),time-1) -> Happens(E(),time).\ncompletion Happens\n") ==
        "E3021");
  CHECK(refused("[time] HoldsAt(F(),time) -> Happens(E(),time).\ncompletion Happens\n") == "");
  CHECK(refused("predicate P()\nHoldsAt(F(),0) -> P().\ncompletion P\n") == "E3021");
}

TEST_CASE("a property is about one timepoint and those before it") {
  CHECK(refused("", "HoldsAt(F(),time-2) -> HoldsAt(F(),time)") == "");
  CHECK(refused("", "always HoldsAt(F(),time)") == "");
  CHECK(refused("", "always !Happens(E(),time)") == "");
  CHECK(refused("", "always Happens(E(),time)") == "E3021");
  CHECK(refused("", "eventually HoldsAt(F(),time)") == "E3021");
  CHECK(refused("", "once HoldsAt(F(),time)") == "E3021");
  CHECK(refused("", "time<3 | HoldsAt(F(),time)") == "E3021");
  CHECK(refused("", "[time1] time1<time -> HoldsAt(F(),time1)") == "E3021");
  CHECK(refused("", "HoldsAt(F(),0)") == "E3021");
}

TEST_CASE("what was released before the first fixed timepoint has passed stays open") {
  // E() happens at 1 and at no other timepoint; after it F() may change at any time.
  const std::string toss =
      "fluent F()\nevent E()\n[time] Releases(E(),F(),time).\n!HoldsAt(F(),0).\nHappens(E(),1).\n"
      "completion Happens\n";
  Subject changes("range time 0 5\n" + toss, "HoldsAt(F(),time-1) -> HoldsAt(F(),time)");
  REQUIRE_MESSAGE(changes.is_fine(), changes.messages());
  CHECK(changes.decide().verdict == InductionVerdict::kBroken);
}

TEST_CASE("induction agrees with reachability through explicit states") {
  std::map<std::string, int> counts;
  const std::uint64_t seeds = is_deep() ? 4000 : 400;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const StepWorld world(seed);
    const int horizon = seed % 3 == 0 ? 20 : 3 + static_cast<int>(seed % 5);
    CAPTURE(world.text(horizon));
    CAPTURE(world.property());
    Subject subject(world.text(horizon), world.property());
    if (!subject.is_fine()) {
      // A formula may be false, or say nothing; no construct asks for more.
      CHECK_MESSAGE(subject.codes() != "E3021", subject.messages());
      ++counts["refused"];
      continue;
    }
    const auto oracle = world.answer();
    REQUIRE(oracle.error.empty());
    const auto answer = subject.decide();
    switch (answer.verdict) {
      case InductionVerdict::kHolds:
        CHECK_FALSE(oracle.broken_at.has_value());
        ++counts["holds"];
        break;
      case InductionVerdict::kBroken:
        CHECK(oracle.broken_at == answer.broken_at);
        ++counts["broken"];
        break;
      case InductionVerdict::kUndecided:
        // Enough steps decide: there are at most 64 states, and far fewer are met.
        CHECK(horizon < 20);
        CHECK(oracle.broken_at.value_or(horizon + 1) + subject.shape().ahead > horizon);
        ++counts["undecided"];
        break;
      case InductionVerdict::kNotProved:
      case InductionVerdict::kStopped:
        FAIL_CHECK("no answer");
        break;
    }
    if (!oracle.broken_at) ++counts["true"];
  }
  MESSAGE(counts["holds"] << " hold of " << counts["true"] << ", " << counts["broken"]
                          << " broken, " << counts["undecided"] << " undecided, "
                          << counts["refused"] << " refused");
  CHECK(counts["holds"] * 10 > counts["true"] * 5);
  CHECK(counts["refused"] * 4 < static_cast<int>(seeds));
}

/// Does a trace of some horizon up to the model's break the property?
bool is_broken(const Subject& subject) {
  const auto& model = subject.whole();
  runtime::ModelQuestion question(model, "", nullptr);
  const compiler::AtomIndex index(model);
  for (auto t = subject.shape().back; t + subject.shape().ahead <= model.horizon; ++t) {
    const auto hit = index.hit(t);
    if (!hit) continue;
    std::vector<runtime::Literal> assumed = {*hit};
    if (t + subject.shape().ahead > 0)
      assumed.push_back(question.reaches(t + subject.shape().ahead));
    if (question.solve(std::move(assumed)) != runtime::SolveStatus::kUnsatisfiable) return true;
  }
  return false;
}

TEST_CASE("what induction says of models with any construct is so at longer horizons") {
  int holds = 0, asked = 0;
  const std::uint64_t seeds = is_deep() ? 20'000 : 2'000;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const auto text = random_model(seed, kBruteForceSize).print();
    CAPTURE(text);
    FuzzRandom random(seed);
    const std::string property =
        random.chance(50) ? "[fluent] !HoldsAt(fluent,time)" : "{fluent} HoldsAt(fluent,time)";
    for (const int horizon : {3, 5}) {
      Subject subject(text, property, horizon);
      if (!subject.is_fine()) continue;
      ++asked;
      const auto answer = subject.decide();
      CHECK(answer.verdict != InductionVerdict::kNotProved);
      CHECK((answer.verdict == InductionVerdict::kBroken) == is_broken(subject));
      if (answer.verdict != InductionVerdict::kHolds) continue;
      ++holds;
      for (const int longer : {horizon + 1, horizon + 2, horizon + 5}) {
        const Subject there(text, property, longer);
        if (there.is_fine()) CHECK_FALSE(is_broken(there));
      }
    }
  }
  MESSAGE(asked << " asked, " << holds << " hold");
  CHECK(holds > 10);
}

}  // namespace
}  // namespace parallax::test
