#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/repair/causes.h"
#include "tools/repair/proposal.h"
#include "tools/repair/repair_input.h"

namespace parallax::tools {

struct RepairResult {
  std::size_t runs = 0, failed = 0;  // read from the folder; those that the model cannot follow
  std::vector<RunParting> partings;
  /// RepairInput::start: starts of the model that the world excludes, and those that both have.
  std::size_t starts_excluded = 0, starts_shared = 0;
  std::vector<std::string> contradictions;
  std::vector<RepairCause> causes;  // of the contradictions
  std::vector<Proposal> proposals;  // best first
  /// In the model of the first proposal, no trace of the plan reaches the constraints.
  bool plan_at_fault = false;
  bool more = false;         // there are further ones that were not looked at
  std::size_t edits = 0;     // single edits that were considered
  std::string nearest_miss;  // where there is no proposal; may be empty
  std::vector<std::string> remarks, hints;
  bool finished = true;              // the run came to a verdict of its own
  std::size_t sequences = 0;         // fresh random ones that the proposals were held against
  std::size_t choosing = 0;          // others, by which they were chosen
  bool sequences_of_plan = false;    // all of them are of the plan's events alone
  std::size_t experiments = 0;       // of the runs were made to tell proposals apart
  std::vector<std::string> refuted;  // proposals, in words, that these have refuted
  /// Proposals that no run refutes but that others outranked: the number of proposals is limited.
  std::vector<std::string> crowded_out;
  /// Indices of the proposals that the runs support as much as the first one, which is included.
  /// The first `tied` of them also share its rank.
  std::vector<std::size_t> founded;
  std::size_t tied = 0;
  std::size_t tied_hidden = 0;  // of these are not shown, as --limit says
  /// Number of further ones that are as likely as the first, but had no comparison of traces.
  std::size_t not_compared = 0;
  std::string why_tied;  // "no run of this plan tells them apart"; empty: nothing was tried
};

/// Proposes changes that explain the runs of a folder, so that they show no discrepancy: the
/// proposals of all sources, in order. Reports what load_repair_input reports.
base::Result<RepairResult> propose_repairs(const RepairOptions& options, Context& context);
/// The same for loaded input, with as many proposals as its options say.
base::Result<RepairResult> propose_repairs(const RepairInput& input, Context& context);

/// Adds changes of the plan to the proposals for `input`, behind the first repairs of the model,
/// from which they start, so that the number of a proposal does not depend on how many are shown.
/// Then checks all against the requested properties. Reports a text that is not a property.
base::Status add_plan_proposals(const RepairInput& input, RepairResult& result, Context& context);

/// Holds the proposals against the fresh random sequences.
void hold_against_sequences(const RepairInput& input, RepairResult& result, const Context& context);
/// Does one of the random sequences refute it?
bool is_refuted_by_sequence(const Proposal& proposal, const RepairResult& result);
/// Does such a sequence, or a run of another plan, refute it? Says which: "second.yaml: Go(r2)";
/// none: neither.
std::optional<std::string> refutation(const Proposal& proposal, const RepairResult& result);

/// Evidence of the runs for a proposal, and its cost, as sentences.
std::vector<std::string> proposal_sentences(const Proposal& proposal, const RepairResult& result);
/// Proposals that the runs refuted or that others crowded out, and those still open; sentences.
struct TieWords {
  std::vector<std::string> refuted, open;
};
TieWords tie_words(const RepairResult& result);

std::string repair_text(const RepairResult& result, const RepairOptions& options);
std::string repair_json(const RepairResult& result);

}  // namespace parallax::tools
