#include "runtime/certify/certificate.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <optional>

#include "runtime/enumerate/model_enumerator.h"
#include "tests/support/planned_model.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using runtime::ProofVerdict;

/// A folder that goes with the object.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "parallax_proof_XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path file(const std::string& name) const { return path_ / name; }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  fs::path path_;
};

/// The codes that were reported and whether the proof was accepted: "ok" or "E7301".
std::string prove(const runtime::CompletenessClaim& claim, const Folder& folder) {
  base::DiagnosticSink sink;
  auto files = runtime::ProofFiles::create(folder.file("p.drat"), sink);
  REQUIRE(files);
  const auto certificate = runtime::prove(claim, *files, {}, sink);
  if (certificate.verdict == ProofVerdict::kAccepted) return sink.has_errors() ? "both" : "ok";
  std::string codes;
  for (const auto& entry : sink.sorted()) codes += base::info(entry.code).id;
  return codes;
}

std::vector<runtime::Trace> list(const compiler::CompiledModel& model, std::size_t limit) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::vector<runtime::Trace> traces;
  while (traces.size() <= limit) {
    auto trace = enumerator.next();
    if (!trace) break;
    traces.push_back(*std::move(trace));
  }
  return traces;
}

TEST_CASE("the proof of a complete list is accepted, that of a list without one of them is not") {
  const Folder folder;
  int complete = 0, unsatisfiable = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const TextModel model(random_model(seed, kSolverSize).print());
    if (model.sink.has_errors()) continue;
    const auto traces = list(model.compiled, 60);
    if (traces.size() > 60) continue;
    ++complete;
    unsatisfiable += traces.empty() ? 1 : 0;
    for (std::size_t left_out = 0; left_out <= traces.size(); left_out += traces.size() / 2 + 1) {
      runtime::CompletenessClaim claim(model.compiled);
      for (std::size_t i = 0; i < traces.size(); ++i) {
        if (i != left_out) claim.add(traces[i]);
      }
      CHECK(prove(claim, folder) == (left_out < traces.size() ? "E7301" : "ok"));
    }
    runtime::CompletenessClaim claim(model.compiled);
    for (const auto& trace : traces) claim.add(trace);
    CHECK(prove(claim, folder) == "ok");
  }
  CHECK(complete > 60);
  CHECK(unsatisfiable > 5);
  CHECK(folder.names() == std::vector<std::string>{"p.drat", "p.drat.cnf"});
}

/// Lists all traces in a search that is logged, unless there are more than 60; has the log checked
/// after `damage`.
std::optional<runtime::Certificate> prove_by_log(const compiler::CompiledModel& model,
                                                 const Folder& folder,
                                                 const std::function<void(std::FILE*)>& damage) {
  base::DiagnosticSink sink;
  auto files = runtime::ProofFiles::create(folder.file("p.drat"), sink);
  REQUIRE(files);
  runtime::CompletenessClaim claim(model);
  {
    runtime::SolverSession session(model, runtime::make_logged_solver(files->proof(), claim),
                                   runtime::Loading::kWhole);
    runtime::ModelEnumerator enumerator(session);
    while (const auto trace = enumerator.next()) {
      claim.add(*trace);
      if (claim.traces() > 60) return std::nullopt;
    }
  }
  damage(files->proof());
  const auto certificate = runtime::prove(claim, *files, {}, sink, true);
  CHECK(sink.error_count() == 0);
  CHECK(certificate.verdict == ProofVerdict::kAccepted);
  return certificate;
}

TEST_CASE("the log of a search is accepted; where it is not, a fresh solve makes the proof") {
  const Folder folder;
  int searched = 0, fresh = 0;
  std::int64_t traces = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const TextModel model(random_model(seed, kSolverSize).print());
    if (model.sink.has_errors()) continue;
    CAPTURE(seed);
    const auto whole = prove_by_log(model.compiled, folder, [](std::FILE*) {});
    if (!whole) continue;
    CHECK(whole->origin == runtime::ProofOrigin::kSearch);
    traces += whole->statistics.lemmas > 0 ? 1 : 0;
    ++searched;
    if (seed % 4 != 0) continue;
    // Damaged logs: text that is no proof in any form, or an empty file.
    const auto damaged = prove_by_log(model.compiled, folder, [&](std::FILE* log) {
      if (seed % 8 == 0) std::fputs("nonsense", log);
      if (seed % 8 != 0) REQUIRE(std::freopen(nullptr, "wb", log) != nullptr);
    });
    REQUIRE(damaged);
    fresh += damaged->origin == runtime::ProofOrigin::kFreshSolve ? 1 : 0;
  }
  CHECK(searched > 80);
  CHECK(traces > 60);
  CHECK(fresh > 15);
}

constexpr const char* kPlan = R"(
(def-cram-function there ()
  (let ((?b (make-pose-stamped "map" 0.0 (make-3d-vector 1.5 0 0) (make-identity-rotation)))
        (?a (make-pose-stamped "map" 0.0 (make-3d-vector 0.5 0 0) (make-identity-rotation))))
    (perform (a motion (type going) (pose ?a)))
    (perform (a motion (type going) (pose ?b)))))
(there)
)";

TEST_CASE("traces of a plan are all traces, or all up to the horizon") {
  const Folder folder;
  for (const int horizon : {1, 2, 3}) {
    CAPTURE(horizon);
    PlannedModel model(kTwoRooms, kPlan, kGoing, "HoldsAt(At(b2),time)", horizon);
    REQUIRE(model.codes() == "");
    runtime::SolverSession session(model.compiled(), runtime::make_cadical_solver());
    runtime::PlanEnumerator enumerator(session);
    std::vector<runtime::Trace> traces;
    while (auto trace = enumerator.next()) traces.push_back(*std::move(trace));
    CHECK(traces.size() == (horizon == 1 ? 0 : 1));
    runtime::CompletenessClaim claim(model.compiled());
    CHECK((prove(claim, folder) == "ok") == false);  // a trace, or an execution, is left
    for (const auto& trace : traces) claim.add(trace);
    const bool all = enumerator.exploration() == runtime::Exploration::kAllTracesExplored;
    CHECK(all == (horizon > 1));
    CHECK(prove(claim, folder) == (all ? "ok" : "E7301"));
    claim.limit_to_horizon();
    CHECK(prove(claim, folder) == "ok");
  }
}

TEST_CASE("the log of a search for traces of a plan is a proof, with a bound and without") {
  const Folder folder;
  for (const int horizon : {1, 2, 3}) {
    CAPTURE(horizon);
    PlannedModel model(kTwoRooms, kPlan, kGoing, "HoldsAt(At(b2),time)", horizon);
    base::DiagnosticSink sink;
    auto files = runtime::ProofFiles::create(folder.file("p.drat"), sink);
    REQUIRE(files);
    runtime::CompletenessClaim claim(model.compiled());
    {
      runtime::SolverSession session(model.compiled(),
                                     runtime::make_logged_solver(files->proof(), claim),
                                     runtime::Loading::kWhole);
      runtime::PlanEnumerator enumerator(session);
      while (const auto trace = enumerator.next()) claim.add(*trace);
      if (enumerator.exploration() == runtime::Exploration::kCompleteUpToBound) {
        claim.limit_to_horizon();
      }
    }
    const auto certificate = runtime::prove(claim, *files, {}, sink, true);
    CHECK(certificate.verdict == ProofVerdict::kAccepted);
    CHECK(certificate.origin == runtime::ProofOrigin::kSearch);
  }
}

TEST_CASE("a proof that is stopped is neither accepted nor kept") {
  const TextModel model("range time 0 1\nfluent F()\nHoldsAt(F(),0).\n!HoldsAt(F(),0).\n");
  const Folder folder;
  {
    base::DiagnosticSink sink;
    auto files = runtime::ProofFiles::create(folder.file("p.drat"), sink);
    REQUIRE(files);
    const std::atomic<bool> stop = true;
    runtime::ProofLimits limits;
    limits.stop = &stop;
    const runtime::CompletenessClaim claim(model.compiled);
    CHECK(runtime::prove(claim, *files, limits, sink).verdict == ProofVerdict::kNotFinished);
    CHECK(base::info(sink.sorted().front().code).id == "E7302");
    CHECK(sink.exit_code() == 4);
  }
  CHECK(folder.names().empty());
}

TEST_CASE("files that cannot be written are refused before the work, and nothing stays behind") {
  const Folder folder;
  const auto code = [&](const fs::path& path) {
    base::DiagnosticSink sink;
    const auto files = runtime::ProofFiles::create(path, sink);
    CHECK_FALSE(files);
    CHECK(sink.exit_code() == 2);
    const auto entry = sink.sorted().front();
    CHECK(entry.subject.starts_with(path.string()));
    return std::string(base::info(entry.code).id);
  };
  CHECK(code(folder.file("no/p.drat")) == "E0005");
  CHECK(code("/dev/null") == "E0003");
  fs::create_directory(folder.file("p.drat.cnf"));
  CHECK(code(folder.file("p.drat")) == "E0003");
  fs::remove(folder.file("p.drat.cnf"));
  {
    base::DiagnosticSink sink;
    const auto files = runtime::ProofFiles::create(folder.file("p.drat"), sink);
    REQUIRE(files);
    CHECK(folder.names() == std::vector<std::string>{"p.drat.cnf.part", "p.drat.part"});
  }
  CHECK(folder.names().empty());
}

/// While it lives, files take no byte, as on a disk that is full; pipes and terminals do.
class FullDisk {
 public:
  FullDisk() : handler_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit none{0, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST_CASE("a disk that takes no more is noticed, whether the search was logged or not") {
  const TextModel model("range time 0 1\nfluent F()\nHoldsAt(F(),0).\n!HoldsAt(F(),0).\n");
  for (const bool logged : {false, true}) {
    CAPTURE(logged);
    const Folder folder;
    base::DiagnosticSink sink;
    auto files = runtime::ProofFiles::create(folder.file("p.drat"), sink);
    REQUIRE(files);
    const runtime::CompletenessClaim claim(model.compiled);
    std::optional<FullDisk> full(std::in_place);
    if (logged) {
      CHECK(runtime::SolverSession(model.compiled,
                                   runtime::make_logged_solver(files->proof(), claim),
                                   runtime::Loading::kWhole)
                .solve(1, {}) == runtime::SolveStatus::kUnsatisfiable);
    }
    const auto certificate = runtime::prove(claim, *files, {}, sink, logged);
    full.reset();
    CHECK(certificate.verdict == ProofVerdict::kNotFinished);
    REQUIRE(sink.error_count() == 1);
    CHECK(base::info(sink.sorted().front().code).id == "E0005");
  }
}

}  // namespace
}  // namespace parallax::test
