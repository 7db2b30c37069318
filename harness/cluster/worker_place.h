#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/source_file.h"

namespace parallax::harness {

/// A place where workers can be started: the prefix of their command.
struct WorkerPlace {
  std::vector<std::string> prefix;  // "ssh", "lab3"
  std::string text;                 // as it was written, for people
  std::int64_t slots = 1;           // workers at the same time
};

inline constexpr std::int64_t kMostSlots = 1024;  // of all places together

/// The place of `--launcher`. Reports kBadLauncher.
base::Result<WorkerPlace> launcher_place(const std::string& text, std::int64_t slots,
                                         base::DiagnosticSink& sink);

/// A file of places, one a line: how many slots, then the prefix, as a shell would take it apart.
///
///     # the lab
///     4 ssh lab3
///     2 docker exec -i sim
///
/// Reports kBadHostLine at its place, for a file without any at its begin.
base::Result<std::vector<WorkerPlace>> read_hosts(const std::filesystem::path& path,
                                                  base::SourceFiles& files,
                                                  base::DiagnosticSink& sink);

}  // namespace parallax::harness
