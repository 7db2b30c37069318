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
  std::vector<std::string> contradictions;
  std::vector<RepairCause> causes;  // of the contradictions
  std::vector<Proposal> proposals;  // best first
  /// In the model that the first proposal makes no trace of the plan reaches the constraints.
  bool plan_at_fault = false;
  bool more = false;         // there are further ones that were not looked at
  std::size_t edits = 0;     // single edits that were considered
  std::string nearest_miss;  // where there is no proposal; may be empty
  std::vector<std::string> remarks, hints;
  bool finished = true;              // the run came to a verdict of its own
  std::size_t experiments = 0;       // of the runs were made to tell proposals apart
  std::vector<std::string> refuted;  // proposals, in words, that these have refuted
  /// Such that no run refutes, but others came before them: no more than some are looked at.
  std::vector<std::string> crowded_out;
  /// Proposals that the runs speak for as much as for the first, with it: indices. Those in front
  /// that `tied` counts are of one rank with it, too.
  std::vector<std::size_t> founded;
  std::size_t tied = 0;
  std::size_t tied_hidden = 0;  // of these are not shown, as --limit says
  /// Further ones that are as likely as the first, of which the traces were not compared.
  std::size_t not_compared = 0;
  std::string why_tied;  // "no run of this plan tells them apart"; empty: nothing was tried
};

/// What is to be changed so that what was seen in the runs of a folder is no discrepancy: what all
/// sources of proposals find, in order. Reports what load_repair_input reports.
base::Result<RepairResult> propose_repairs(const RepairOptions& options, Context& context);
/// The same of what was loaded, for as many proposals as its options say.
base::Result<RepairResult> propose_repairs(const RepairInput& input, Context& context);

/// Adds changes of the plan to what was proposed for `input`, behind the first repairs of the
/// model, from which they start, so that the number of a proposal does not depend on how many are
/// shown; then holds all against the properties that were asked about. Reports a property that is
/// none.
base::Status add_plan_proposals(const RepairInput& input, RepairResult& result, Context& context);

/// What stands behind a proposal of `runs` recorded runs, and what it costs, as sentences.
std::vector<std::string> proposal_sentences(const Proposal& proposal, std::size_t runs);
/// What the runs refuted or others crowded out, and what they leave open; sentences.
struct TieWords {
  std::vector<std::string> refuted, open;
};
TieWords tie_words(const RepairResult& result);

std::string repair_text(const RepairResult& result, const RepairOptions& options);
std::string repair_json(const RepairResult& result);

}  // namespace parallax::tools
