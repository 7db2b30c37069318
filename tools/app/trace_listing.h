#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "compiler/pipeline/compile.h"
#include "compiler/sema/typed_model.h"
#include "runtime/trace/decreasoner_format.h"
#include "runtime/trace/trace_format.h"
#include "tools/app/model_options.h"

namespace parallax::tools {

/// How a list of traces is to be written.
struct ListingOptions {
  std::string format = "text";  // text, jsonl, itf, csv, decreasoner
  std::string output;           // itf: a folder of one file for each trace; else empty
};

/// Reports options that do not go together.
bool check_listing(const ModelOptions& model, const ListingOptions& options,
                   base::DiagnosticSink& sink);

/// The format as an object; none for text and jsonl, which have functions of their own.
/// `one_trace`: at most one is asked for. The compilation and the context outlive it.
std::unique_ptr<runtime::ListFormat> make_listing(const ModelOptions& model,
                                                  const ListingOptions& options, bool one_trace,
                                                  const compiler::Compilation& compilation,
                                                  Context& context);

/// Text for standard output if a limit ends the process in the middle of the list.
std::string stopped_text(const std::string& format);

/// Options of the old printed form, from the model's `option` lines and completions.
inline runtime::DecreasonerOptions decreasoner_options(const compiler::TypedModel& typed) {
  runtime::DecreasonerOptions options;
  options.time_diff = typed.options.time_diff;
  options.model_diff = typed.options.model_diff;
  options.show_predicates = typed.options.show_predicates;
  options.events_completed = std::any_of(
      typed.completions.begin(), typed.completions.end(),
      [&](const compiler::Completion& one) { return one.predicate == typed.core.happens; });
  return options;
}

}  // namespace parallax::tools
