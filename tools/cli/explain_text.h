#pragma once

#include <string>
#include <vector>

#include "tools/app/discrepancy.h"
#include "tools/app/evidence.h"
#include "tools/app/explain.h"

namespace parallax::tools {

// Explanations as the text and the JSON document of `parallax explain`: each function for JSON
// gives one object and a newline.

/// `domain.e:14`; empty for an origin without a place in a text.
std::string origin_place(const compiler::Origin& origin);
/// The text of an axiom; for a frame axiom, the meaning of the declaration behind it.
std::string axiom_text(const compiler::Origin& origin);

/// The lines before the sets: how many there are, and what is known of others. `run` may be null;
/// `verbose`: all of its lines.
std::string contradiction_head(const runtime::MinimalSets& found, const SetOptions& options,
                               const ObservedRun* run, bool verbose = true);
/// Set `number`, from 1; for runs with the instances only if asked for, and then each on a line.
enum class Instances : std::uint8_t { kAll, kNone, kShort };
std::string contradiction_text(const compiler::CompiledModel& model, std::size_t number,
                               const Contradiction& set, Instances instances = Instances::kAll,
                               const std::string& words = {});
/// The words that a run is explained with first: the paragraph of a set, and what follows from the
/// first difference.
std::string run_words_text(const RecordedDiscrepancy& found, const std::string& words);
std::string contradictions_json(const compiler::CompiledModel& model,
                                const runtime::MinimalSets& found, const SetOptions& options,
                                const ObservedRun* run, const std::vector<Contradiction>& sets);
/// The same for a run, with `words` for each set, and the differences.
std::string run_contradictions_json(const RecordedDiscrepancy& found,
                                    const runtime::MinimalSets& sets_found,
                                    const SetOptions& options, const ObservedRun& run,
                                    const std::vector<Contradiction>& sets,
                                    const std::vector<std::string>& words,
                                    const CauseEvidence& cause);
/// The kind of cause, with the runs behind it.
std::string cause_text(const CauseEvidence& cause);
/// The initial states that it fails in; empty where the runs do not tell.
std::string where_text(const CauseEvidence& cause);

/// The message that there is no contradiction.
std::string no_contradiction_text(const compiler::CompiledModel& model, const ObservedRun* run);
std::string no_contradiction_json();

/// The chain behind a fact in words, earliest first, each with the axiom that it rests on.
std::string why_text(const compiler::CompiledModel& model, const FactExplanation& explanation);
std::string why_json(const compiler::CompiledModel& model, const FactExplanation& explanation);

}  // namespace parallax::tools
