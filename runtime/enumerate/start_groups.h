#pragma once

#include <span>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// The fluents in groups: two are in one if a chain of clauses connects them at timepoint 0, each
/// clause being about the state there alone (with auxiliary variables). A fluent that is false in
/// every trace is in no group.
std::vector<std::vector<compiler::FluentId>> connected_at_start(
    const compiler::CompiledModel& model, std::span<const compiler::FluentId> fluents);

}  // namespace parallax::runtime
