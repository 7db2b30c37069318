#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/repair/patch.h"
#include "tools/repair/repair_input.h"
#include "tools/repair/verification.h"

namespace parallax::tools {

/// Does a property of the plan hold up to the horizon? None: it is not known.
struct PropertyEffect {
  std::string property;
  std::optional<bool> before, after;  // in what was run; with the change
};

/// A change after which what was seen is no discrepancy any more, as far as it is needed.
struct Proposal {
  enum class Changes : std::uint8_t { kModel, kBinding, kPlan, kScenario };
  Changes changes =
      Changes::kModel;   // what it is about; a change of the plan may touch the model, too
  std::size_t size = 0;  // edits
  int oddity = 0;        // how far they are from what people write; less is better
  std::string words;     // a sentence without its period
  std::vector<std::string> evidence;  // what stands behind it, sentences; besides the verdict
  std::vector<ChangedFile> files;
  std::vector<std::string> read_by_world;  // of these: applied, the change is one of the world, too
  std::optional<std::string> text;  // of the edited model, flat; none: the model stays as it is
  /// For a change of the plan: the number of the proposal whose model of the world it assumes; 0:
  /// it rests on the runs alone.
  std::size_t under = 0;
  std::vector<PropertyEffect> properties;  // of those that were asked about, in their order
  bool precaution = false;                 // what may fail is taken to fail
  bool open = false;                       // it leaves open what happens
  bool of_start = false;                   // it settles RepairInput::start
  bool hides_failure = false;  // of a plan: the failure is taken, and nothing is done about it
  Verdict verdict;
  std::size_t unexplained = 0;  // runs that count against it in the ranking
  std::size_t unvalidated = 0;  // likewise, random sequences
  bool agrees_less = false;     // with fewer runs to their end than the unchanged model
  bool is_told_cause = false;   // a split of the start that the runs show to be the cause
  /// It explains the first difference, and no run follows it to its end.
  bool only_begins() const {
    const bool of_model = changes == Changes::kModel || changes == Changes::kBinding;
    return of_model && !precaution && !of_start && verdict.runs_whole == 0;
  }
  /// Is it held against random sequences? One that leaves an outcome open would admit either.
  bool meets_sequences() const {
    return (changes == Changes::kModel || changes == Changes::kBinding) && text && !open;
  }
  /// Effect on the traces. For a change of the model alone, computed by the ranking.
  std::optional<TraceEffects> effects;
  /// Numbers of the proposals that the ranking cannot tell from it by the observations, by size, by
  /// oddity or by the traces.
  std::vector<std::size_t> tied = {};
};

/// "model", "binding", "plan", "scenario": as `--json` says it.
const char* name_of(Proposal::Changes changes);

/// Proposals from one source.
struct FoundProposals {
  std::vector<Proposal> proposals;
  bool more = false;         // there are further ones that were not looked at
  std::size_t edits = 0;     // single edits that were considered
  std::string nearest_miss;  // where there is no proposal; may be empty
  std::vector<std::string> remarks;
  std::vector<std::string> hints;  // what the user may do to have more found; told in any case
};

/// A kind of proposals: looks for changes that explain the partings of `input`, of which there are
/// some. Stops where `context` was stopped.
using ProposalSource = FoundProposals (*)(const RepairInput& input, Context& context);

}  // namespace parallax::tools
