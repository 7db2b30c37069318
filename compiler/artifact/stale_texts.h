#pragma once

#include <filesystem>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/diagnostic.h"

namespace parallax::compiler {

/// Warns (kArtifactStale) of the texts that a compiled model was made from and that are others by
/// now, or gone while one beside them is still there. They are looked for by the names in the
/// header, from the current folder and from that of the artifact; where none is found nothing is
/// said. Only files that the artifact may name (PathGate) are read; all are inputs of `files`.
void tell_stale_texts(const CompiledModel& model, base::FileId artifact, base::SourceFiles& files,
                      base::DiagnosticSink& sink);

}  // namespace parallax::compiler
