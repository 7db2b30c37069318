#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "tests/support/checked_traces.h"

namespace parallax::test {

/// A robot is in one of two rooms and goes to either.
inline const std::string kTwoRooms = R"(
sort room
room a1, b2
fluent At(room)
event Go(room)
[time] {room} HoldsAt(At(room),time).
[room1,room2,time] HoldsAt(At(room1),time) & HoldsAt(At(room2),time) -> room1=room2.
[room,time] Initiates(Go(room),At(room),time).
[room1,room2,time] room1!=room2 -> Terminates(Go(room1),At(room2),time).
)";

/// Going there, by a pose, in a binding table.
inline const std::string kGoing =
    "motion going (:target ?p) -> Go(region(?p))  ok: At(region(?p)) @t+1 else "
    "navigation-pose-unreachable\n";

/// x below 1 is a1, the rest is b2.
class TwoRooms final : public compiler::PoseLocator {
 public:
  std::optional<std::string> region_of(std::string_view,
                                       const compiler::PlanPose& pose) const override {
    return pose.x_m < 1.0 ? "a1" : "b2";
  }
  std::optional<Nearest> nearest(std::string_view, const compiler::PlanPose&) const override {
    return std::nullopt;
  }
};

/// A model, a plan, a binding table and one state constraint, through the whole front end.
class PlannedModel {
 public:
  PlannedModel(const std::string& model, const std::string& plan, const std::string& binding,
               const std::string& constraint, std::optional<std::int64_t> horizon,
               bool interleave = false, bool failures_by_reason = false)
      : interleave_(interleave), failures_by_reason_(failures_by_reason) {
    std::string name = (std::filesystem::temp_directory_path() / "parallax_model_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) return;
    const auto path = std::filesystem::path(name) / "model.e";
    std::ofstream(path) << model;
    compile({path}, plan, binding, constraint, horizon, rooms_);
    std::filesystem::remove_all(name);
  }

  /// Compiles model files that already exist and are kept; `locator` outlives the call.
  PlannedModel(const std::vector<std::filesystem::path>& models, const std::string& plan,
               const std::string& binding, const std::string& constraint,
               std::optional<std::int64_t> horizon, const compiler::PoseLocator& locator) {
    compile(models, plan, binding, constraint, horizon, locator);
  }

  const compiler::CompiledModel& compiled() const { return compilation_->model; }
  const compiler::TypedModel& typed() const { return *compilation_->typed; }

  /// The codes that were reported, in order, blank-separated.
  std::string codes() const {
    std::string out;
    for (const auto& diagnostic : sink_.sorted()) {
      if (!out.empty()) out += ' ';
      out += base::info(diagnostic.code).id;
    }
    return out;
  }

  const compiler::PlanGraph& graph() const { return *compilation_->plan; }
  const compiler::PlanFormulas& formulas() const { return *compilation_->plan_formulas; }
  bool compiles() const { return compilation_.has_value(); }

  struct Found {
    std::vector<std::string> keys;
    runtime::Exploration exploration = runtime::Exploration::kStopped;
    runtime::OpenEnds open_ends;
  };
  /// Every trace is checked on the way.
  Found keys(const runtime::PlanEnumeratorOptions& options = {}) const {
    TraceChecker checker(*compilation_->typed);
    runtime::SolverSession session(compiled(), runtime::make_cadical_solver());
    runtime::PlanEnumerator enumerator(session, options);
    Found found;
    while (const auto trace = enumerator.next()) {
      checker.check(*trace);
      found.keys.push_back(runtime::event_key(*trace));
    }
    found.exploration = enumerator.exploration();
    found.open_ends = enumerator.open_ends();
    return found;
  }

 private:
  void compile(const std::vector<std::filesystem::path>& models, const std::string& plan,
               const std::string& binding, const std::string& constraint,
               std::optional<std::int64_t> horizon, const compiler::PoseLocator& locator) {
    compiler::CompileInput input;
    input.models = models;
    input.horizon = horizon;
    input.plan = compiler::PlanInput{
        {files_.add("plan.lisp", plan)}, files_.add("plan.bind", binding), std::nullopt, &locator};
    input.plan->interleave = interleave_;
    input.plan->failures_by_reason = failures_by_reason_;
    const auto text = files_.add("constraint", constraint);
    const base::SourceRange range{text, 0, static_cast<std::uint32_t>(constraint.size())};
    input.constraints = {{range, range}};
    auto result = compiler::compile_model(input, files_, sink_);
    if (result) compilation_ = *std::move(result);
  }

  bool interleave_ = false;
  bool failures_by_reason_ = false;
  base::SourceFiles files_;
  base::DiagnosticSink sink_;
  TwoRooms rooms_;
  std::optional<compiler::Compilation> compilation_;
};

}  // namespace parallax::test
