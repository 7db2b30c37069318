#include <algorithm>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "tools/app/explain.h"

namespace parallax::tools {
namespace {

/// What finding needed instances may cost, for all sets together: a fraction of the time there is.
runtime::Effort effort_of(double time_limit_s) {
  constexpr double kMost = 100'000, kEachSecond = 5'000;  // conflicts
  const auto most = time_limit_s > 0 ? std::min(kMost, kEachSecond * time_limit_s) : kMost;
  return runtime::Effort(static_cast<std::int64_t>(most));
}

}  // namespace

ContradictionSearch::ContradictionSearch(const compiler::CompiledModel& model,
                                         const std::optional<ObservedRun>& run, Context& context)
    : context_(context),
      formula_(model, run ? std::optional(run->observed) : std::nullopt),
      axioms_(runtime::group_axioms(model)),
      texts_(model),
      effort_(effort_of(context.form().time_limit_s)) {}

base::Result<runtime::MinimalSets> ContradictionSearch::sets(const SetOptions& options) {
  auto solver =
      runtime::load_axioms(formula_, axioms_, runtime::make_cadical_solver(&context_.stop()));
  auto found = options.all ? runtime::all_minimal_sets(
                                 solver, static_cast<std::size_t>(options.limit), &context_.stop())
                           : runtime::smallest_set(solver, &context_.stop());
  if (found.unknown) {
    return context_.sink().error_about(base::DiagnosticCode::kExplanationCutShort, "",
                                       "whether there is a contradiction is not known");
  }
  return found;
}

Contradiction ContradictionSearch::look_at(const runtime::IndexSet& set) {
  runtime::ProofLimits limits;
  limits.stop = &context_.stop();
  const auto ground = runtime::ground_contradiction(formula_, axioms_, set, limits, effort_);
  if (ground.proof.verdict == runtime::ProofVerdict::kRejected) {
    context_.sink().error_about(base::DiagnosticCode::kProofRejected, "", ground.proof.reason);
  }
  Contradiction out{{}, ground.minimal, ground.proof.verdict};
  for (const auto group : set) {
    out.axioms.push_back({axioms_.origins[group].front(), instances_of(group, ground.clauses)});
  }
  return out;
}

std::vector<std::string> ContradictionSearch::instances_of(
    std::uint32_t group, const std::vector<std::size_t>& clauses) const {
  std::vector<std::pair<compiler::Timepoint, std::string>> found;
  const auto& model = formula_.model();
  for (const auto clause : clauses) {
    if (axioms_.group_of[model.clause_origins[clause]] != group) continue;
    found.emplace_back(model.clause_timepoints[clause], texts_.clause(clause));
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> out;
  for (auto& [time, text] : found) out.push_back(std::move(text));
  return out;
}

}  // namespace parallax::tools
