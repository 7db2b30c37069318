#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/plan_machine.h"

namespace parallax::compiler {

/// Bounds of what all macros of a plan do together.
inline constexpr std::size_t kMaxMacroExpansions = 50000;
inline constexpr std::size_t kMaxMacroData = 500000;
inline constexpr std::int64_t kMaxMacroSteps = 2000000;

/// Reads the head of (defmacro name parameters form...) and gives it units, still empty.
PlanMacro declare_macro(FormCompiler& c, DatumId form, std::string_view name, DatumId parameters);
void compile_macro(FormCompiler& c, const PlanMacro& macro, FormItems body);

/// Expands the calls of macros. A macro is a unit like any function; it runs on the unroller's own
/// machine, on data as values, and may neither perform nor ask the model. Data of the call that it
/// passes on stay the data of the call; data that it makes are new and have their place in the
/// macro's text.
class MacroExpander {
 public:
  explicit MacroExpander(FormCompiler& c);
  std::optional<DatumId> expand(const PlanMacro& macro, DatumId call);
  /// Notes that a bound was reached: nothing more is expanded. True if it was not known: report it.
  bool stop() { return !std::exchange(full_, true); }
  /// A datum as a value that remembers where it stands; `made`: in a macro's own text.
  ValueId value_of(DatumId datum, bool made);

 private:
  bool run(const PlanMacro& macro, DatumId call, PlanState& state);
  std::optional<DatumId> datum_of(ValueId value, const base::SourceRange& place, std::size_t depth);
  std::optional<DatumId> list_of(ValueId value, const base::SourceRange& place, std::size_t depth);
  DatumId copy_of(DatumId atom, const base::SourceRange& place);
  std::nullopt_t wrong(const PlanMacro& macro, DatumId call, std::string_view text);

  FormCompiler& c_;
  PlanMachine machine_;
  std::map<std::pair<std::uint32_t, bool>, ValueId> values_;  // by datum
  std::set<std::uint32_t> refused_;  // units with errors, which were reported
  std::size_t expansions_ = 0;
  std::size_t data_made_ = 0;
  bool full_ = false;  // reported
  std::string trouble_;
};

}  // namespace parallax::compiler
