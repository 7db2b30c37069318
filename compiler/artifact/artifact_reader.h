#pragma once

#include <cstddef>
#include <filesystem>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/diagnostic.h"

namespace parallax::compiler {

/// The largest file that is read; a larger model is compiled where it is used.
inline constexpr std::size_t kMaxArtifactBytes = std::size_t{1} << 30U;

/// Reads what `to_artifact` wrote, and checks every count, range, name and copy. The first thing
/// wrong is reported at its place (E6001 to E6013), and nothing else. Entries of a newer minor
/// version that this reader does not know are skipped with a warning. The sources of origins and
/// plan steps are lines of this file; what their `place` names need not exist.
///
/// Time and memory are linear in the size of the file, whatever numbers it holds.
base::Result<CompiledModel> read_artifact(base::FileId file, const base::SourceFiles& files,
                                          base::DiagnosticSink& sink);

/// Reads the file from disk and registers it under the name that the user wrote. Warns where the
/// texts that it was made from have changed since (tell_stale_texts).
base::Result<CompiledModel> load_artifact(const std::filesystem::path& path,
                                          base::SourceFiles& files, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
