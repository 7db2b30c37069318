#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/known.h"
#include "harness/config/ledger.h"
#include "runtime/trace/trace.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// A known discrepancy that executions of a model go through: the model's state after its event is
/// not the one that the world showed there.
struct RestsOn {
  const harness::LedgerEntry* entry = nullptr;
  base::Known goes_through = base::Known::kYes;  // or kUndecided: the solver was stopped
};

/// The open and accepted entries of a scenario (its name in the ledger) that some execution within
/// the horizon goes through: the entry's events one by one from the start, or where it names no
/// trace its event at any time. What objects performs found and how they failed is not asked for,
/// so an entry may be named in vain, but none is missed. One solver call for an entry with a trace.
std::vector<RestsOn> rests_on(const compiler::CompiledModel& model, const harness::Ledger& ledger,
                              std::string_view scenario, Context& context);

/// The entries that this one trace goes through.
std::vector<RestsOn> rests_on(const runtime::Trace& trace, const harness::Ledger& ledger,
                              std::string_view scenario);

/// "edge.place-r1 (open): Place(r1) after Go(r2)": a line for people.
std::string rests_on_words(const RestsOn& one);

/// Does the scenario's model keep a property at all times, and what does that rest on?
struct PropertyAnswer {
  enum class Verdict : std::uint8_t { kHolds, kViolated, kStopped };
  Verdict verdict = Verdict::kStopped;
  compiler::Timepoint horizon = 0;  // kViolated: the length of a shortest trace
  std::vector<RestsOn> rests_on;
};
/// No proof is made. Reports what compiling reports.
base::Result<PropertyAnswer> ask_property(const std::string& scenario_file,
                                          const std::string& property,
                                          const harness::Ledger& ledger, std::string_view scenario,
                                          Context& context);

}  // namespace parallax::tools
