#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/source_file.h"

namespace parallax::compiler {

/// Copies from the source files the data that a model needs to report without them: the hashes of
/// all texts, and for every origin and plan step its place, text and id. Origins are put in the
/// order of their places, so that they do not move when another stage looks at them earlier.
void describe_sources(CompiledModel& model, const base::SourceFiles& files);

/// Gives every origin the id that `what` and `text` ask for: 8 hexadecimal digits, and `.2`, `.3`
/// for the later ones of equal origins. Blanks do not count.
void assign_ids(std::vector<Origin>& origins);

/// The text on one line: comments (`;` to the end of the line) go, blanks are single; at most
/// 2000 bytes, then `...`.
std::string one_line(std::string_view text);

/// Puts the clauses into an order that does not depend on how they were made: within each section
/// by origin, timepoint, definitions last, then by literals. The copies of a section follow its
/// first block. O(n log n) in the clauses of first blocks.
void sort_clauses(CompiledModel& model);

}  // namespace parallax::compiler
