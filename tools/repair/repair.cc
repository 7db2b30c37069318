#include "tools/repair/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "compiler/base/words.h"
#include "tools/repair/model_proposals.h"
#include "tools/repair/plan_proposals.h"
#include "tools/repair/properties.h"
#include "tools/repair/ranking.h"
#include "tools/repair/region_split.h"
#include "tools/repair/start_proposals.h"

namespace parallax::tools {
namespace {

/// All sources are asked; their proposals are ranked together.
constexpr ProposalSource kSources[] = {
    model_proposals,
    region_splits,
};
constexpr ProposalSource kStartSources[] = {start_proposals};

std::span<const ProposalSource> sources_for(const RepairInput& input) {
  return input.start ? std::span<const ProposalSource>(kStartSources) : kSources;
}

template <typename T>
void append(std::vector<T>& to, std::vector<T> more) {
  to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

base::Status add_plan_proposals(const RepairInput& input, RepairResult& result, Context& context) {
  const auto limit = static_cast<std::size_t>(input.options.limit);
  auto& all = result.proposals;
  const auto place = std::min(all.size(), std::max(kMostModels, result.tied));
  const bool has_step = !input.partings.empty() && !input.start;
  if (has_step && !context.stopped() && (limit == 0 || limit > place)) {
    auto found = plan_proposals(input, all, context);
    append(result.remarks, std::move(found.remarks));
    result.edits += found.edits;
    const auto& first = all.empty() ? std::nullopt : all.front().effects;
    result.plan_at_fault = first && first->reaches == false;
    result.more = result.more || found.more;
    const auto added = found.proposals.size();
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(place),
               std::make_move_iterator(found.proposals.begin()),
               std::make_move_iterator(found.proposals.end()));
    if (limit != 0 && all.size() > limit) {
      all.resize(limit);
      result.more = true;
    }
    for (auto& proposal : all) {
      for (auto& tied : proposal.tied) tied += tied > place ? added : 0;
      std::erase_if(proposal.tied, [&](std::size_t tied) { return tied > all.size(); });
    }
    for (auto& index : result.founded) index += index >= place ? added : 0;
    std::erase_if(result.founded, [&](std::size_t index) { return index >= all.size(); });
  }
  return hold_against_properties(input, all, context);
}

const char* name_of(Proposal::Changes changes) {
  switch (changes) {
    case Proposal::Changes::kModel:
      return "model";
    case Proposal::Changes::kBinding:
      return "binding";
    case Proposal::Changes::kPlan:
      return "plan";
    case Proposal::Changes::kScenario:
      return "scenario";
  }
  return "";
}

void hold_against_sequences(const RepairInput& input, RepairResult& result,
                            const Context& context) {
  for (auto& proposal : result.proposals) {
    if (!proposal.meets_sequences() || input.sequences.fresh.empty()) continue;
    hold_against(*proposal.text, input.sequences.fresh, context, proposal.verdict);
  }
  result.sequences = context.stopped() ? 0 : input.sequences.fresh.size();
  if (context.stopped()) result.choosing = 0;
}

bool is_refuted_by_sequence(const Proposal& proposal, const RepairResult& result) {
  return proposal.meets_sequences() && (proposal.verdict.validated < result.choosing ||
                                        proposal.verdict.fresh_right < result.sequences);
}

std::optional<std::string> refutation(const Proposal& proposal, const RepairResult& result) {
  for (const auto& plan : proposal.verdict.plans) {
    if (plan.right < plan.runs) return plan.scenario + ": " + plan.refuted_by;
  }
  if (!is_refuted_by_sequence(proposal, result)) return std::nullopt;
  const auto& by = proposal.verdict.refuted_by;
  return "a random sequence of events" + (by.empty() ? "" : ": " + by);
}

base::Result<RepairResult> propose_repairs(const RepairOptions& options, Context& context) {
  const auto input = load_repair_input(options, context);
  if (!input) return context.sink().already_reported();
  auto result = propose_repairs(*input, context);
  if (result) compare_traces(*input, result->proposals, context);
  return result;
}

base::Result<RepairResult> propose_repairs(const RepairInput& input, Context& context) {
  RepairResult result;
  result.runs = input.runs;
  result.failed = input.failed;
  result.experiments = input.experiments;
  result.partings = input.partings;
  result.contradictions = input.contradictions;
  result.remarks = input.remarks;
  result.finished = input.finished;
  if (input.start) {
    result.starts_excluded = input.start->refused.size();
    result.starts_shared = input.start->is_shared ? input.start->wanted.size() : 0;
  }
  if (input.partings.empty()) return result;
  result.causes = causes_of(input);
  for (const auto source : sources_for(input)) {
    if (context.stopped()) break;
    auto found = source(input, context);
    append(result.proposals, std::move(found.proposals));
    append(result.remarks, std::move(found.remarks));
    append(result.hints, std::move(found.hints));
    result.more = result.more || found.more;
    result.edits += found.edits;
    if (result.nearest_miss.empty()) result.nearest_miss = std::move(found.nearest_miss);
  }
  const bool of_region = std::any_of(result.causes.begin(), result.causes.end(),
                                     [](const auto& cause) { return cause.kind == "region"; });
  for (auto& proposal : result.proposals) {
    proposal.is_told_cause = of_region && proposal.changes == Proposal::Changes::kScenario;
  }
  // Causes that the model has no words for are told with proposals that leave the outcome open or
  // take it to happen.
  for (auto& proposal : result.proposals) {
    if (!proposal.open && !proposal.precaution) continue;
    if (proposal.changes == Proposal::Changes::kScenario) continue;  // it says so itself
    for (const auto& cause : result.causes) proposal.evidence.push_back(cause.words);
  }
  result.choosing = input.sequences.choosing.size();
  result.sequences_of_plan = input.sequences.of_plan;
  const auto left_out = rank_proposals(input, static_cast<std::size_t>(input.options.limit),
                                       result.proposals, context);
  result.more = result.more || left_out.more;
  result.not_compared = left_out.not_compared;
  if (left_out.agree_less > 0) {
    result.hints.push_back(
        fmt::format("{} {} with fewer runs than the unchanged model, and {} not proposed",
                    base::counted(left_out.agree_less, "change"),
                    base::agreed(left_out.agree_less, "agrees", "agree"),
                    base::agreed(left_out.agree_less, "is", "are")));
  }
  if (result.proposals.empty()) return result;
  result.tied = of_first_rank(result.proposals);
  result.founded = as_well_founded(result.proposals);
  return result;
}

}  // namespace parallax::tools
