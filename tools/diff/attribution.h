#pragma once

#include <optional>
#include <vector>

#include "compiler/compare/fact.h"
#include "runtime/compare/trace_difference.h"
#include "tools/app/model_options.h"

namespace parallax::tools {

/// A fact that one revision has and another has not, or one that stands for another.
struct Edit {
  std::optional<std::size_t> kept;     // of the revision that has the trace
  std::optional<std::size_t> refused;  // of the revision that has it not
};

/// Of all edits the most that are tried out; each costs a compilation.
inline constexpr std::size_t kMaxTriedEdits = 24;

/// A minimal set of edits such that the revision without the trace has it when these are undone and
/// all others stay ("sufficient" in the sense of Maoz and Ringert 2018: and no smaller part of the
/// set is). Found by undoing all and making them again one by one; a variant that is no right
/// model counts as one without the trace. None if there are more than kMaxTriedEdits.
std::optional<std::vector<Edit>> responsible_edits(const std::vector<compiler::Fact>& kept,
                                                   const std::vector<compiler::Fact>& refused,
                                                   const std::vector<Edit>& edits,
                                                   const runtime::Trace& trace,
                                                   const runtime::SharedVocabulary& vocabulary,
                                                   const ModelOptions& options, Context& context);

}  // namespace parallax::tools
