#pragma once

// Sequences of events by which two models are compared: each is performed in both, and both must
// allow the same states. Of other events only those happen that an axiom demands.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/bench/mistakes/mistake.h"

namespace parallax::tools {

/// Events by their text (`Drive(dock,yard)`), one for each timepoint from 0 on.
using EventSequence = std::vector<std::string>;

/// A model that has a trace for each sequence and each way that it can go in the model of `files`.
std::string sequences_model(const std::vector<std::string>& files,
                            const std::vector<EventSequence>& sequences);

/// Timepoints after the longest sequence.
int horizon_of(const std::vector<EventSequence>& sequences);

/// For each sequence: can it be performed to its end?
using AreExecutable = std::function<std::vector<bool>(const std::vector<EventSequence>&)>;

/// Random sequences of the events that no axiom demands: `walks` that the model can perform, of
/// `length` events each, and up to as many that begin like one of them and end with an event that
/// the model refuses. Depends on the model and the seed alone.
std::vector<EventSequence> random_sequences(const ModelText& model, std::size_t walks,
                                            std::size_t length, std::uint64_t seed,
                                            const AreExecutable& are_executable);

}  // namespace parallax::tools
