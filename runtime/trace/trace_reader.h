#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "runtime/trace/claim_reader.h"
#include "runtime/trace/trace_claims.h"

namespace parallax::runtime {

/// Where a trace stands in a file, and what is known before it is read.
struct TracePlace {
  base::SourceRange source;
  bool whole_file = false;  // one ITF document over several lines
};

/// What a trace file says of itself.
struct TraceFileHead {
  std::vector<TracePlace> traces;  // in order
  /// The model that the traces were made from (`model_hash`), and where the file says so.
  std::optional<std::string> model;
  base::SourceRange model_source;
  bool closed = false;    // there is a line that says how the list ended, or none is needed
  bool complete = false;  // and that these are all traces
};

/// Finds the traces of a file: lines of `--format jsonl`, or ITF, as one document or as lines. The
/// closing line, where there is one, must count the traces that are there. E6101 for what is no
/// JSON, E6102 for another shape; nothing is read of the traces yet but the hash of the model.
base::Result<TraceFileHead> open_trace_file(base::FileId file, const base::SourceFiles& files,
                                            base::DiagnosticSink& sink);

/// Reads one trace and holds its names against the vocabulary of the model: E6103 for names that it
/// does not have. The first thing wrong is reported, and nothing else. Traces without a number get
/// `default_number`.
base::Result<ClaimedTrace> read_trace(const TracePlace& place, std::int64_t default_number,
                                      const base::SourceFiles& files, ClaimReader& reader);

}  // namespace parallax::runtime
