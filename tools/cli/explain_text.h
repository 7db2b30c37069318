#pragma once

#include <string>
#include <vector>

#include "tools/app/explain.h"

namespace parallax::tools {

// Explanations as `parallax explain` tells them, and as its JSON document has them: each function
// for JSON gives one object and a newline.

/// What precedes the sets: how many there are, and what is known of others. `run` may be null.
std::string contradiction_head(const runtime::MinimalSets& found, const SetOptions& options,
                               const ObservedRun* run);
/// Set `number`, from 1.
std::string contradiction_text(const compiler::CompiledModel& model, std::size_t number,
                               const Contradiction& set);
std::string contradictions_json(const compiler::CompiledModel& model,
                                const runtime::MinimalSets& found, const SetOptions& options,
                                const ObservedRun* run, const std::vector<Contradiction>& sets);

/// That there is no contradiction.
std::string no_contradiction_text(const compiler::CompiledModel& model, const ObservedRun* run);
std::string no_contradiction_json();

/// The chain behind a fact in words, earliest first, each with the axiom that it rests on.
std::string why_text(const compiler::CompiledModel& model, const FactExplanation& explanation);
std::string why_json(const compiler::CompiledModel& model, const FactExplanation& explanation);

}  // namespace parallax::tools
