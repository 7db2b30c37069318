#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "compiler/base/words.h"
#include "tools/repair/repair.h"
#include "tools/repair/trace_numbers.h"

namespace parallax::tools {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> printed(std::vector<std::string> lines) {
  for (auto& line : lines) line = base::printable(line);
  return lines;
}

/// The conflict at the start in words; `seen` is what the world has there.
std::string start_text(const RepairResult& result, const std::string& seen) {
  if (result.starts_shared == 0) {
    return fmt::format("  the start: at 0 the world has, and the model cannot have: {}\n", seen);
  }
  return fmt::format(
      "  the start: {} of {} starts of the model {} none of the world, which has at 0: {}\n",
      result.starts_excluded, result.starts_excluded + result.starts_shared,
      base::agreed(result.starts_excluded, "is", "are"), seen);
}

std::string parting_text(const RepairResult& result, const RunParting& parting) {
  std::vector<std::string> seen;
  for (const auto& [fluent, holds] : parting.seen) seen.push_back((holds ? "" : "not ") + fluent);
  constexpr std::size_t kMost = 6;
  const auto more = seen.size() > kMost ? fmt::format(" and {} more", seen.size() - kMost) : "";
  if (seen.size() > kMost) seen.resize(kMost);
  if (parting.ids.empty()) {
    return start_text(result, fmt::format("{}{}", fmt::join(seen, ", "), more));
  }
  const auto runs = parting.ids.size() == 1
                        ? "run " + parting.ids.front()
                        : fmt::format("{} runs, first {}", parting.ids.size(), parting.ids.front());
  return fmt::format("  {}: {} at {}{}, and at {} the model cannot have: {}{}\n", runs,
                     parting.step.event, parting.after - 1,
                     parting.step.failed ? " failed (" + parting.step.reason + ")" : "",
                     parting.after, fmt::join(seen, ", "), more);
}

std::string head(const RepairResult& result, const std::string& folder) {
  auto out = fmt::format("{}: {}, {} of them not as the model says\n", folder,
                         base::counted(result.runs, "run"), result.failed);
  if (result.experiments > 0) {
    out += fmt::format("  {} of them {} made to tell proposals apart\n", result.experiments,
                       base::agreed(result.experiments, "was", "were"));
  }
  // Where runs contradict each other no axiom is simply wrong.
  for (const auto& text : result.contradictions) {
    out +=
        fmt::format("  {}: chance, or the simulator, or something that the model has no word for\n",
                    base::printable(text));
  }
  for (const auto& cause : result.causes) out += "  " + base::printable(cause.words) + "\n";
  for (const auto& parting : result.partings) out += parting_text(result, parting);
  return out;
}

std::string tie_text(const std::vector<std::size_t>& tied) {
  return tied.empty() ? "" : fmt::format(" (tied with {})", fmt::join(tied, ", "));
}

/// Adds the effects of a change on the requested properties.
void add_properties(const Proposal& proposal, std::vector<std::string>& out) {
  for (const auto& [property, before, after] : proposal.properties) {
    const auto* what = "nothing is known of";
    if (after && !before) what = *after ? "there then holds" : "there then does not hold";
    if (after && before) {
      what = *after ? (*before ? "keeps" : "restores") : (*before ? "breaks" : "does not restore");
    }
    out.push_back(fmt::format("Property: {} `{}`.", what, property));
  }
}

/// The answer of random sequences of events to a proposal.
std::string validation_sentence(const Proposal& proposal, const RepairResult& result) {
  constexpr std::size_t kMost = 80;  // characters of a sequence
  const auto& verdict = proposal.verdict;
  const auto all = base::counted(result.sequences, "fresh random sequence") +
                   (result.sequences_of_plan ? " of the plan's events" : " of events");
  const bool is_right = !is_refuted_by_sequence(proposal, result);
  if (result.sequences == 0) {
    const auto runs = base::counted(result.choosing, "execution") + " that ordered the proposals";
    return is_right ? "Also right on " + runs + "."
                    : fmt::format("Right on {} of {}; refuted by {}.", verdict.validated, runs,
                                  verdict.refuted_by);
  }
  if (is_right) return "Also right on " + all + ".";
  const auto chosen = verdict.validated < result.choosing
                          ? fmt::format(", and on {} of the {} that ordered the proposals",
                                        verdict.validated, result.choosing)
                          : "";
  auto steps = verdict.refuted_by;
  if (steps.size() > kMost) steps = "..." + steps.substr(steps.size() - kMost);
  return fmt::format("Right on {} of {}{}; refuted by {}.", verdict.fresh_right, all, chosen,
                     steps.empty() ? "the first state of one" : steps);
}

std::string proposal_text(const Proposal& proposal, std::size_t rank, const RepairResult& result) {
  auto out = fmt::format("\n{}. {}{}.\n", rank, proposal.words, tie_text(proposal.tied));
  for (const auto& sentence : proposal_sentences(proposal, result)) {
    out += "   " + base::printable(sentence) + "\n";
  }
  const auto place = patch_place_words(proposal.files);
  if (!place.empty()) out += "   " + base::printable(place) + "\n";
  return out + "\n" + patch_from_here(proposal.files);
}

std::string tie_text(const RepairResult& result) {
  std::string out;
  const auto words = tie_words(result);
  for (const auto& sentence : words.refuted) out += "\n" + base::printable(sentence);
  if (!out.empty()) out += "\n";
  for (const auto& sentence : words.open) out += "\n" + base::printable(sentence) + "\n";
  return out;
}

}  // namespace

std::vector<std::string> proposal_sentences(const Proposal& proposal, const RepairResult& result) {
  const auto runs = result.runs;
  std::vector<std::string> out;
  const auto effects = proposal.effects.value_or(TraceEffects{});
  if (proposal.changes == Proposal::Changes::kPlan) {
    out = proposal.evidence;
    out.push_back(fmt::format("Of the plan's traces there {} lost, {} gained.",
                              number_text(effects.lost), number_text(effects.gained)));
    add_properties(proposal, out);
    return out;
  }
  const auto& verdict = proposal.verdict;
  if (proposal.of_start) {
    out.emplace_back("With it the starts of the model are starts of the world.");
  }
  auto first =
      fmt::format("Consistent with {} of {}", verdict.runs_consistent, base::counted(runs, "run"));
  if (verdict.runs_whole < verdict.runs_consistent) {
    first += fmt::format(", with {} of them to the end", verdict.runs_whole);
  }
  out.push_back(first + fmt::format("; traces lost: {}, gained: {}.", number_text(effects.lost),
                                    number_text(effects.gained)));
  if (result.sequences + result.choosing > 0 && proposal.meets_sequences())
    out.push_back(validation_sentence(proposal, result));
  for (const auto& plan : verdict.plans) {
    const auto name = "`" + plan.scenario + "`";
    if (plan.runs == 0) {
      out.push_back(fmt::format("{} could not be run with it.", name));
    } else if (plan.right == plan.runs) {
      out.push_back(fmt::format("Also right on {} of {}.", base::counted(plan.runs, "run"), name));
    } else {
      out.push_back(fmt::format("Right on {} of {} of {}; refuted by {}.", plan.right,
                                base::counted(plan.runs, "run"), name, plan.refuted_by));
    }
  }
  if (!verdict.leaves_open.empty()) {
    out.push_back(
        fmt::format("It leaves open when `{}` holds: no run can refute what it says of that.",
                    verdict.leaves_open));
  }
  if (verdict.runs_undemanded > 0) {
    out.push_back(fmt::format(
        "It follows {} only if events happen that nothing demands, and comes later for that.",
        base::counted(verdict.runs_undemanded, "run")));
  }
  if (proposal.agrees_less) {
    out.push_back(fmt::format("The unchanged model agrees with more runs: {}, this one with {}.",
                              runs - result.failed, verdict.runs_whole));
  }
  if (proposal.only_begins()) {
    out.emplace_back(
        "It explains the first difference only: no run follows the changed model to its end.");
  }
  out.insert(out.end(), proposal.evidence.begin(), proposal.evidence.end());
  if (proposal.precaution) {
    out.emplace_back(
        "A precaution: what may fail is taken to fail; in the other runs it went well.");
  }
  if (verdict.refuses) {
    out.emplace_back("What failed is then impossible: no plan of the model may try it.");
  }
  if (effects.reaches == false) {
    out.emplace_back(
        "No trace reaches the constraints any more: if this is how the world is, the plan is at "
        "fault.");
  }
  for (const auto& name : proposal.read_by_world) {
    out.push_back(fmt::format(
        "The world reads {}, too: applied, this changes the world with the model.", name));
  }
  add_properties(proposal, out);
  return out;
}

TieWords tie_words(const RepairResult& result) {
  TieWords out;
  for (const auto& words : result.refuted) {
    out.refuted.push_back(fmt::format("Refuted by a run: {}.", words));
  }
  for (const auto& words : result.crowded_out) {
    out.refuted.push_back(
        fmt::format("No run refutes it, but others are shown in its place: {}.", words));
  }
  if (result.not_compared > 0) {
    out.open.push_back(
        fmt::format("{} as likely as the first {} not compared with it; --limit 0 compares all.",
                    base::counted(result.not_compared, "further proposal"),
                    base::agreed(result.not_compared, "was", "were")));
  }
  if (result.founded.size() < 2 && result.tied < 2) return out;
  std::string tie;
  if (result.tied > 1) {
    tie = fmt::format("A tie: proposals 1 to {} are of one rank", result.tied);
    if (result.tied_hidden > 0) {
      tie += fmt::format(", of which the last {} {} not shown (--limit)", result.tied_hidden,
                         base::agreed(result.tied_hidden, "is", "are"));
    }
  } else {
    std::vector<std::size_t> ranks;
    for (const auto i : result.founded) ranks.push_back(i + 1);
    tie = fmt::format("The runs speak for proposals {} alike, of which the first is the usual one",
                      fmt::join(ranks, ", "));
  }
  out.open.push_back(tie + (result.why_tied.empty() ? "" : "; " + result.why_tied) + ".");
  return out;
}

std::string repair_text(const RepairResult& result, const RepairOptions& options) {
  const auto folder = base::printable(options.folder.folder);
  if (result.runs == 0 && result.partings.empty())
    return folder + ": no simulation in it came to its end\n";
  if (result.partings.empty() && !result.remarks.empty()) {
    return fmt::format("{}: {}, and nothing that an edit of the model could mend:\n  {}\n", folder,
                       base::counted(result.runs, "run"),
                       fmt::join(printed(result.remarks), "\n  "));
  }
  if (result.partings.empty() && !result.finished) {
    return fmt::format(
        "{}: {}, and the model admits all of them, but the run came to no verdict: `parallax run` "
        "with "
        "--resume goes on with it.\n",
        folder, base::counted(result.runs, "run"));
  }
  if (result.partings.empty()) {
    return fmt::format(
        "{}: {}, and the model admits all of them: there is nothing to repair.\nMore runs may find "
        "something: `parallax run` with a smaller --epsilon, or other starts, or another plan.\n",
        folder, base::counted(result.runs, "run"));
  }
  auto out = head(result, folder);
  if (result.proposals.empty()) {
    out += fmt::format("No edit of the grammar explains all runs ({} were considered).\n",
                       result.edits);
    if (!result.nearest_miss.empty())
      out += "Nearest miss: " + base::printable(result.nearest_miss) + ".\n";
    for (const auto& hint : result.hints) out += base::printable(hint) + ".\n";
    if (result.runs > 0) {
      out +=
          fmt::format("`parallax explain {}` names the axioms that a run contradicts.\n", folder);
    }
    return out;
  }
  const auto is_plan = [](const Proposal& proposal) {
    return proposal.changes == Proposal::Changes::kPlan;
  };
  for (std::size_t i = 0; i < result.proposals.size(); ++i) {
    const bool first =
        is_plan(result.proposals[i]) && (i == 0 || !is_plan(result.proposals[i - 1]));
    if (first && i == 0) {
      out += "\nNo edit of the model explains all runs. Changes of the plan:\n";
    } else if (first) {
      out += result.plan_at_fault
                 ? "\nIf the world is as proposal 1 says, the plan is at fault: no trace of it "
                   "reaches the constraints any more. Changes of the plan:\n"
                 : "\nOr the plan is changed:\n";
    } else if (i > 0 && !is_plan(result.proposals[i]) && is_plan(result.proposals[i - 1])) {
      out += "\nFurther changes of the model:\n";
    }
    out += proposal_text(result.proposals[i], i + 1, result);
  }
  out += tie_text(result);
  if (result.more) out += "\nThere are further ones; --limit shows more.\n";
  for (const auto& hint : result.hints) out += "\n" + base::printable(hint) + ".\n";
  return out;
}

std::string repair_json(const RepairResult& result) {
  Json out;
  out["status"] = "ok";
  out["runs"] = result.runs;
  out["failed"] = result.failed;
  out["experiments"] = result.experiments;
  out["sequences"] = result.sequences;
  out["sequences_choosing"] = result.choosing;
  out["sequences_of_plan"] = result.sequences_of_plan;
  out["finished"] = result.finished;
  auto& partings = out["partings"] = Json::array();
  for (const auto& parting : result.partings) {
    Json seen = Json::array();
    for (const auto& [fluent, holds] : parting.seen) {
      seen.push_back({{"fluent", fluent}, {"observed", holds}});
    }
    partings.push_back({{"runs", parting.ids},
                        {"event", parting.step.event},
                        {"failed", parting.step.failed},
                        {"reason", parting.step.reason},
                        {"timepoint", parting.after},
                        {"fluents", std::move(seen)}});
  }
  out["contradictions"] = result.contradictions;
  auto& causes = out["causes"] = Json::array();
  for (const auto& cause : result.causes) {
    causes.push_back({{"cause", cause.kind}, {"words", cause.words}});
  }
  auto& proposals = out["proposals"] = Json::array();
  for (std::size_t i = 0; i < result.proposals.size(); ++i) {
    const auto& proposal = result.proposals[i];
    const auto effects = proposal.effects.value_or(TraceEffects{});
    Json reaches = nullptr;
    if (effects.reaches) reaches = *effects.reaches;
    Json properties = Json::array();
    const auto known = [](std::optional<bool> value) {
      return value ? Json(*value) : Json(nullptr);
    };
    for (const auto& [property, before, after] : proposal.properties) {
      properties.push_back(
          {{"property", property}, {"before", known(before)}, {"after", known(after)}});
    }
    proposals.push_back({{"rank", i + 1},
                         {"tied", proposal.tied},
                         {"words", proposal.words},
                         {"changes", name_of(proposal.changes)},
                         {"evidence", proposal.evidence},
                         {"edits", proposal.size},
                         {"patch", patch_from_here(proposal.files)},
                         {"patch_folder", patch_folder(proposal.files)},
                         {"read_by_world", proposal.read_by_world},
                         {"precaution", proposal.precaution},
                         {"hides_failure", proposal.hides_failure},
                         {"only_begins", proposal.only_begins()},
                         {"leaves_open", proposal.verdict.leaves_open},
                         {"runs_consistent", proposal.verdict.runs_consistent},
                         {"runs_to_the_end", proposal.verdict.runs_whole},
                         {"runs", result.runs},
                         {"runs_undemanded", proposal.verdict.runs_undemanded},
                         {"agrees_less", proposal.agrees_less},
                         {"traces_lost", number_json(effects.lost)},
                         {"traces_gained", number_json(effects.gained)},
                         {"reaches_constraints", std::move(reaches)},
                         {"properties", std::move(properties)}});
    if (result.sequences + result.choosing > 0 && proposal.meets_sequences()) {
      proposals.back()["sequences_right"] = proposal.verdict.fresh_right;
      proposals.back()["choosing_right"] = proposal.verdict.validated;
      proposals.back()["refuted_by"] = proposal.verdict.refuted_by;
    }
    if (!proposal.verdict.plans.empty()) {
      auto& plans = proposals.back()["other_plans"] = Json::array();
      for (const auto& plan : proposal.verdict.plans) {
        plans.push_back({{"scenario", plan.scenario},
                         {"runs", plan.runs},
                         {"right", plan.right},
                         {"refuted_by", plan.refuted_by}});
      }
    }
    if (proposal.under > 0) proposals.back()["under"] = proposal.under;
  }
  out["tied"] = result.tied;
  auto& founded = out["founded"] = Json::array();
  for (const auto i : result.founded) founded.push_back(i + 1);
  if (!result.why_tied.empty()) out["why_tied"] = result.why_tied;
  out["tied_hidden"] = result.tied_hidden;
  out["not_compared"] = result.not_compared;
  out["refuted"] = result.refuted;
  out["crowded_out"] = result.crowded_out;
  out["plan_at_fault"] = result.plan_at_fault;
  out["more"] = result.more;
  if (!result.hints.empty()) out["hints"] = result.hints;
  if (!result.nearest_miss.empty()) out["nearest_miss"] = result.nearest_miss;
  return base::json_text(out);
}

}  // namespace parallax::tools
