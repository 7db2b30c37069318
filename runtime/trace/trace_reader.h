#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "runtime/trace/claim_reader.h"
#include "runtime/trace/trace_claims.h"

namespace parallax::runtime {

/// Description of a trace file before its traces are read.
struct TraceFileHead {
  std::vector<base::SourceRange> traces;  // in order
  /// The model that the traces were made from (`model_hash`), and the place in the file that says
  /// so.
  std::optional<std::string> model;
  base::SourceRange model_source;
  bool closed = false;    // there is a line that says how the list ended, or none is needed
  bool complete = false;  // that line says that these are all traces
};

/// Finds the traces of a file: lines of `--format jsonl`, or ITF, as one document or as lines. The
/// closing line, where there is one, must count the traces that are there. E6101 for invalid JSON,
/// E6102 for another shape; of the traces themselves only the hash of the model is read.
base::Result<TraceFileHead> open_trace_file(base::FileId file, const base::SourceFiles& files,
                                            base::DiagnosticSink& sink);

/// Reads one trace and checks its names against the vocabulary of the model: E6103 for unknown
/// names. Only the first error is reported. Traces without a number get `default_number`.
base::Result<ClaimedTrace> read_trace(const base::SourceRange& place, std::int64_t default_number,
                                      const base::SourceFiles& files, ClaimReader& reader);

}  // namespace parallax::runtime
