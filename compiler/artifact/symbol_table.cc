#include "compiler/artifact/symbol_table.h"

namespace parallax::compiler {

SymbolTable::SymbolTable(const CompiledModel& model) {
  for (const auto& fluent : model.fluents) add_fluent(fluent.name);
  for (const auto& event : model.events) add_event(event.name);
  PARALLAX_REQUIRE(fluent_count() == model.fluents.size() && event_count() == model.events.size(),
                   "a model declares no name twice");
}

}  // namespace parallax::compiler
