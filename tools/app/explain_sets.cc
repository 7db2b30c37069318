#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/json.h"
#include "runtime/explain/clause_text.h"
#include "runtime/explain/contradiction.h"
#include "tools/app/explain.h"
#include "tools/app/explain_place.h"

namespace parallax::tools {
namespace {

using nlohmann::ordered_json;
using runtime::IndexSet;
using runtime::ProofVerdict;

constexpr std::size_t kShownInstances = 6;  // of one axiom, in text

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// One minimal set, written down.
class SetWriter {
 public:
  SetWriter(runtime::ExecutionFormula& formula, const runtime::AxiomGroups& axioms)
      : formula_(formula), axioms_(axioms), texts_(formula.model()) {}

  const runtime::GroundContradiction& ground(const IndexSet& set,
                                             const runtime::ProofLimits& limits,
                                             runtime::Effort& effort) {
    groups_ = set;
    found_ = runtime::ground_contradiction(formula_, axioms_, set, limits, effort);
    return found_;
  }

  std::string text() const {
    std::string out;
    for (const auto group : groups_) {
      const auto& origin = first_origin(group);
      const auto place = place_text(origin);
      out += fmt::format("  {}{}\n", place.empty() ? "" : place + "  ", axiom_text(origin));
      const auto instances = instances_of(group);
      for (std::size_t i = 0; i < instances.size() && i < kShownInstances; ++i) {
        out += "      " + instances[i] + '\n';
      }
      if (instances.size() > kShownInstances) {
        out += fmt::format("      ... and {}\n",
                           counted(instances.size() - kShownInstances, "further instance"));
      }
    }
    return out;
  }

  ordered_json json() const {
    auto list = ordered_json::array();
    for (const auto group : groups_) {
      const auto& origin = first_origin(group);
      list.push_back({{"file", origin.place.file},
                      {"line", origin.place.begin.line},
                      {"column", origin.place.begin.column},
                      {"what", to_string(origin.kind)},
                      {"text", origin.text},
                      {"instances", instances_of(group)}});
    }
    return list;
  }

 private:
  const compiler::Origin& first_origin(std::uint32_t group) const {
    return formula_.model().origins[axioms_.origins[group].front()];
  }
  std::vector<std::string> instances_of(std::uint32_t group) const {
    std::vector<std::pair<compiler::Timepoint, std::string>> found;
    const auto& model = formula_.model();
    for (const auto clause : found_.clauses) {
      if (axioms_.group_of[model.clause_origins[clause]] != group) continue;
      found.emplace_back(model.clause_timepoints[clause], texts_.clause(clause));
    }
    std::sort(found.begin(), found.end());
    std::vector<std::string> out;
    for (auto& [time, text] : found) out.push_back(std::move(text));
    return out;
  }

  runtime::ExecutionFormula& formula_;
  const runtime::AxiomGroups& axioms_;
  runtime::ClauseText texts_;
  IndexSet groups_;
  runtime::GroundContradiction found_;
};

/// What finding needed instances may cost, for all sets together: a fraction of the time there is.
runtime::Effort effort_of(double time_limit_s) {
  constexpr double kMost = 100'000, kEachSecond = 5'000;  // conflicts
  const auto most = time_limit_s > 0 ? std::min(kMost, kEachSecond * time_limit_s) : kMost;
  return runtime::Effort(static_cast<std::int64_t>(most));
}

/// What is known of the sets that are not shown.
std::string claim(const runtime::MinimalSets& found, const SetOptions& options) {
  if (options.all) {
    return found.proven ? "these are all minimal sets" : "stopped: there may be further sets";
  }
  if (found.proven) return "no fewer axioms do";
  return fmt::format("stopped: fewer may do, but at least {}",
                     std::max<std::size_t>(found.lower_bound, 1));
}

const char* proof_word(ProofVerdict verdict) {
  switch (verdict) {
    case ProofVerdict::kAccepted:
      return "checked";
    case ProofVerdict::kRejected:
      return "not accepted";
    case ProofVerdict::kNotFinished:
      return "not checked";
  }
  return "";
}

/// What the sets are held against.
std::string observed_text(const std::optional<ObservedRun>& run) {
  std::string out;
  if (!run) return out;
  for (const auto& line : run->lines) out += "  observed: " + line + '\n';
  return out;
}

void print_none(const compiler::CompiledModel& model, const std::optional<ObservedRun>& run,
                Context& context) {
  if (context.form().json) {
    context.document("{\"status\":\"ok\",\"satisfiable\":true,\"sets\":[]}\n");
  } else if (run) {
    context.result("The model admits what was observed.\n" + observed_text(run));
  } else {
    context.result(fmt::format(
        "The model has a trace up to timepoint {}: its axioms do not contradict each other.\n",
        model.horizon));
  }
}

void print(const runtime::MinimalSets& found, const SetOptions& options,
           const std::optional<ObservedRun>& run, const runtime::ProofLimits& limits,
           SetWriter& writer, Context& context) {
  const bool as_json = context.form().json;
  ordered_json document = {{"status", "ok"},
                           {"satisfiable", false},
                           {"smallest", !options.all && found.proven},
                           {"complete", options.all && found.proven}};
  if (run) document["observed"] = run->lines;
  auto sets = ordered_json::array();
  auto effort = effort_of(context.form().time_limit_s);
  if (!as_json) {
    context.result(
        fmt::format("The model has no trace{}; {} of axioms that contradict {} ({}):\n{}",
                    run ? " in which this happens" : "", counted(found.sets.size(), "minimal set"),
                    run ? "it" : "each other", claim(found, options), observed_text(run)));
  }
  for (std::size_t i = 0; i < found.sets.size(); ++i) {
    const auto& ground = writer.ground(found.sets[i], limits, effort);
    if (ground.proof.verdict == ProofVerdict::kRejected) {
      context.sink().error_about(base::DiagnosticCode::kProofRejected, "", ground.proof.reason);
    }
    const auto* proof = proof_word(ground.proof.verdict);
    if (as_json) {
      sets.push_back({{"size", found.sets[i].size()},
                      {"proof", proof},
                      {"instances_minimal", ground.minimal},
                      {"axioms", writer.json()}});
    } else {
      context.result(fmt::format(
          "set {}: {} (proof {}{})\n{}", i + 1, counted(found.sets[i].size(), "axiom"), proof,
          ground.minimal ? "" : "; instances not minimal: stopped", writer.text()));
    }
  }
  if (!as_json) return;
  document["sets"] = std::move(sets);
  context.document(base::json_text(document) + '\n');
}

}  // namespace

int explain_sets(const compiler::CompiledModel& model, const SetOptions& options,
                 const std::optional<ObservedRun>& run, Context& context) {
  runtime::ExecutionFormula formula(model, run ? std::optional(run->observed) : std::nullopt);
  const auto axioms = runtime::group_axioms(model);
  auto solver =
      runtime::load_axioms(formula, axioms, runtime::make_cadical_solver(&context.stop()));
  const auto found = options.all
                         ? runtime::all_minimal_sets(
                               solver, static_cast<std::size_t>(options.limit), &context.stop())
                         : runtime::smallest_set(solver, &context.stop());
  if (found.unknown) {
    context.sink().error_about(base::DiagnosticCode::kExplanationCutShort, "",
                               "whether there is a contradiction is not known");
    return 0;
  }
  if (found.sets.empty()) {
    print_none(model, run, context);
    return 0;
  }
  runtime::ProofLimits limits;
  limits.stop = &context.stop();
  SetWriter writer(formula, axioms);
  print(found, options, run, limits, writer, context);
  if (context.stopped()) {
    context.sink().error_about(base::DiagnosticCode::kExplanationCutShort, "",
                               found.proven ? "not every instance shown is needed"
                                            : "the sets may not be what was asked for");
    return 0;
  }
  return 1;
}

}  // namespace parallax::tools
