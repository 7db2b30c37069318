#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/source_file.h"

namespace parallax::tools {

/// A world, and the robot that is made for it.
struct ScaffoldKind {
  std::string_view world, robot;
};
const std::vector<ScaffoldKind>& scaffold_kinds();

struct ScaffoldFile {
  std::string name, text;
};

/// Describes what is wrong with the name of a scenario; empty: nothing.
std::string wrong_scenario_name(std::string_view name);

/// The files of a scenario that runs as it is, sorted by name.
std::vector<ScaffoldFile> scaffold_files(std::string_view name, const ScaffoldKind& kind);

/// The text with a value in the place of each "@MARK@".
std::string with_mark(std::string text, std::string_view mark, std::string_view value);

/// Writes one file below `folder`, with the folders on its way.
base::Status write_scaffold_file(const std::filesystem::path& folder, const ScaffoldFile& file,
                                 const base::SourceFiles& read, base::DiagnosticSink& sink);

/// Makes `folder` and writes the files into it. Reports kUsage where something is there already and
/// kFileNotWritable where it cannot be written; then nothing is left behind.
base::Status write_scaffold(const std::string& folder, const std::vector<ScaffoldFile>& files,
                            const base::SourceFiles& read, base::DiagnosticSink& sink);

}  // namespace parallax::tools
