#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runtime/enumerate/open_atom_finder.h"
#include "runtime/enumerate/plan_ends.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/enumerate/trace_source.h"
#include "runtime/trace/trace_format.h"
#include "tools/app/certify.h"
#include "tools/app/context.h"
#include "tools/app/trace_check.h"

namespace parallax::tools {

/// Prints traces as they are found and counts them; under --json they are kept for the document.
/// Traces that fail the check are printed, too.
class TraceWriter {
 public:
  struct Form {
    std::string format = "text";  // or "jsonl"
    bool count_only = false;
    std::int64_t limit = 0;  // 0: none
    /// In place of `format`, for what is neither text nor jsonl; outlives the writer.
    runtime::ListFormat* listing = nullptr;
    /// Finds what a trace leaves open, for forms that print such atoms; outlives the writer.
    /// None: traces are printed as they were found.
    runtime::OpenAtomFinder* open_atoms = nullptr;
    /// Where the finder gives up, prints the trace and claims nothing of atoms that may be open.
    bool prints_unsettled = false;
    /// The model whose plan's end the traces tell; null: none. It outlives the writer.
    const compiler::CompiledModel* plan = nullptr;
    bool all_hits = false;  // as in PlanEnumeratorOptions
    /// Symbols of predicates that the plan asks for: traces say how many settings of them there
    /// are.
    std::set<std::string> asked = {};
    /// Prints only traces whose plan may have ended like this: `done`, `failed`, `cut`; empty: all.
    std::string ended = {};
  };
  /// `check` may be null; else it outlives the writer, as the others do.
  TraceWriter(Form form, TraceCheck* check, TraceCertifier& certifier, Context& context);

  bool full() const { return !form_.count_only && form_.limit > 0 && count_ == form_.limit; }
  /// Prints the trace and counts it.
  void write(const runtime::Trace& trace);
  /// Everything that the source has, up to the limit.
  void write_all(runtime::TraceSource& source);

  std::int64_t count() const { return count_; }
  /// A stop was raised before it was known what to print of a trace: it is left out.
  bool cut_short() const { return cut_short_; }
  const std::string& list() const { return list_; }
  bool agreed() const { return check_ == nullptr || check_->agreed(); }
  /// `"checked":N,` where traces are checked.
  std::string checked_field() const;
  /// `, N checked` where traces are checked.
  std::string checked_remark() const;

 private:
  const runtime::TraceFormat& format() const;
  bool is_wanted(const std::string& ended) const;
  bool print(const runtime::Trace& trace);
  std::int64_t count_starts(const runtime::Trace& trace);
  bool needs_traces();

  Form form_;
  TraceCheck* check_;
  TraceCertifier& certifier_;
  Context& context_;
  std::optional<runtime::PlanEnds> ends_;
  std::int64_t count_ = 0;
  bool cut_short_ = false;
  std::string list_;
};

/// The open ends of the exploration, one sentence each: "bound reached: `loop` at plan.lisp:3:5",
/// "the plan goes on beyond timepoint 20 with Go(r1) at plan.lisp:9:3".
std::vector<std::string> open_end_texts(const compiler::CompiledModel& model,
                                        const runtime::OpenEnds& ends);

/// "a prefix that cannot go on violates the property at timepoint 1: no trace of horizon 4 begins
/// like that"; `does`: "violates the property".
std::string dead_end_text(const compiler::CompiledModel& model, std::string_view does,
                          compiler::Timepoint length);

/// `"bounds":["..."],`, empty without any.
std::string bounds_field(const std::vector<std::string>& bounds);

}  // namespace parallax::tools
