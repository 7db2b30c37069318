#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

/// The expected traces of a model. At least one field is set.
struct TraceExpectation {
  std::optional<std::int64_t> traces;
  /// False: `traces` are looked for and there must be more; then `traces` is at least 1.
  bool complete = true;
  /// The text that `parallax traces` must print; the file need not exist.
  std::optional<LocatedText> golden;
  std::vector<LocatedText> holds, violated;  // properties (docs/reference/model_language.md)

  bool lists_traces() const { return traces || golden; }
};

/// One case: models compiled together and what is known of their traces. Paths are resolved against
/// the manifest's folder.
struct ManifestCase {
  std::string id;  // distinct within the manifest; a safe file name
  base::SourceRange source;
  std::vector<LocatedText> models;       // not empty; the files exist
  std::optional<std::int64_t> horizon;   // replaces the range of `time`
  std::vector<LocatedText> constraints;  // traces end where these hold for the first time
  double time_limit_s = 60.0;            // wall clock
  std::optional<std::int64_t> memory_limit_mb;
  TraceExpectation expect;
};

/// A suite manifest as checked data (docs/reference/suites.md), cases in the order of the file.
struct SuiteManifest {
  std::filesystem::path file;
  std::vector<ManifestCase> cases;
};

/// The role of a YAML file in a suite.
enum class SuiteFileKind : std::uint8_t {
  kOther,     // neither of these
  kManifest,  // has a key `cases` at its outermost level, or cases below another key
  kScenario,  // expects something there, or names a model
  kBroken,    // cannot be read, or something that it includes cannot: it may be either
};
/// Reads the file with all that it includes, so that it does not matter how a key is written.
/// Nothing is reported.
SuiteFileKind suite_file_kind(const std::filesystem::path& path, bool allow_outside);
/// The same; `files`, which is new, has what was read.
SuiteFileKind suite_file_kind(const std::filesystem::path& path, bool allow_outside,
                              base::SourceFiles& files);

/// Reads and checks a manifest; several errors per run, each at its key. `defaults` are laid under
/// every case. Unknown keys, unsafe and repeated ids, missing models (kFileNotFound) and cases that
/// expect nothing are refused, and so are paths that lead out of the manifest's folder (PathGate),
/// unless `allow_outside`.
base::Result<SuiteManifest> load_manifest(const std::filesystem::path& path,
                                          base::SourceFiles& files, base::DiagnosticSink& sink,
                                          bool allow_outside = false);

}  // namespace parallax::harness
