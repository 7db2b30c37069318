#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compiler/base/json.h"
#include "tools/learn/learn.h"
#include "tools/learn/learned_model.h"

namespace parallax::tools {

std::string refuted_text(const RefutedFormula& formula) {
  return fmt::format("formula contradicted by {}: {}: {} Instead: {}", named_runs(formula.runs),
                     formula.place, formula.text,
                     formula.instead.empty() ? "nothing." : formula.instead);
}

std::string learn_log(const LearnResult& result) {
  std::string out;
  for (const auto& round : result.rounds) {
    out += fmt::format("round {}, {}: {} axioms about events, {} simulations, {}; {} axioms {}\n",
                       round.number, to_string(round.kind), round.axioms, round.simulations,
                       round.outcome, round.changed, "changed after it");
  }
  out += fmt::format("\n{} axioms about events, from {} simulations; {} of {} runs admitted\n",
                     result.axioms, result.simulations, result.admitted, result.runs);
  if (result.sequences > 0) {
    out += fmt::format("{} random sequences; the last {} of them taught nothing\n",
                       result.sequences, result.sequences_clean);
  }
  out += result.clean ? "clean\n" : "not clean: " + result.why + "\n";
  if (result.judged_in_closed_loop) out += std::string(kJudgedInClosedLoop) + "\n";
  for (const auto& claim : result.claims) out += "  " + claim + "\n";
  for (const auto& formula : result.refuted) out += refuted_text(formula) + "\n";
  for (const auto& each : result.contradictions) out += "left open: " + each + "\n";
  for (const auto& each : result.not_learnable) out += "not learned: " + each + "\n";
  for (const auto& each : result.remarks) out += "remark: " + each + "\n";
  return out;
}

std::string learn_json(const LearnResult& result, const LearnOptions& options) {
  nlohmann::ordered_json out;
  out["status"] = "ok";
  out["scenario"] = options.scenario;
  out["seed"] = options.seed;
  out["clean"] = result.clean;
  out["why"] = result.why;
  out["model"] = result.model;
  out["axioms"] = result.axioms;
  out["dropped"] = result.dropped;
  out["simulations"] = result.simulations;
  out["sequences"] = result.sequences;
  out["sequences_clean"] = result.sequences_clean;
  out["runs"] = result.runs;
  out["runs_admitted"] = result.admitted;
  out["claims"] = result.claims;
  out["judged_in_closed_loop"] = result.judged_in_closed_loop;
  out["contradicted_formulas"] = nlohmann::ordered_json::array();
  for (const auto& formula : result.refuted) {
    nlohmann::ordered_json told;
    told["formula"] = formula.text;
    told["place"] = formula.place;
    told["runs"] = formula.runs;
    told["instead"] = formula.instead;
    out["contradicted_formulas"].push_back(std::move(told));
  }
  out["contradictions"] = result.contradictions;
  out["not_learned"] = result.not_learnable;
  out["remarks"] = result.remarks;
  out["folder"] = options.out.string();
  out["rounds"] = nlohmann::ordered_json::array();
  for (const auto& round : result.rounds) {
    nlohmann::ordered_json told;
    told["round"] = round.number;
    told["kind"] = std::string(to_string(round.kind));
    told["simulations"] = round.simulations;
    told["outcome"] = round.outcome;
    told["axioms"] = round.axioms;
    told["changed"] = round.changed;
    out["rounds"].push_back(std::move(told));
  }
  return base::json_text(out, 2) + "\n";
}

}  // namespace parallax::tools
