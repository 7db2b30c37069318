#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/repair/axiom_form.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Sentences that let an event happen only where one of its triggers demands it, or where a fluent
/// says that it is performed.
struct ClosedTriggers {
  std::string text;                  // with the declarations; empty: there are none
  std::vector<std::string> symbols;  // of the events
};
/// The fluent that says that an event of this symbol is performed. It has no arguments: where one
/// instance is performed, the others may happen at the same time.
std::string performed_fluent(std::string_view symbol);

/// The sentences for events that plain triggers alone demand. An event that another axiom can
/// demand, such as one of two in one head, has none.
ClosedTriggers closed_triggers(const ModelAst& model, const base::SourceFiles& files,
                               const TypedModel& typed);

}  // namespace parallax::compiler
