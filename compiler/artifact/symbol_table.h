#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/contract.h"
#include "compiler/base/id.h"

namespace parallax::compiler {

/// The names of ground fluents and events behind their ids, for what outlives a model or comes from
/// elsewhere: a trace and whatever it is compared with share one. Ids are given in the order in
/// which names are added; those of a model come first, so that its atoms have the same ids.
class SymbolTable {
 public:
  SymbolTable() = default;
  explicit SymbolTable(const CompiledModel& model) {
    for (const auto& fluent : model.fluents) add_fluent(fluent.name);
    for (const auto& event : model.events) add_event(event.name);
    PARALLAX_REQUIRE(fluent_count() == model.fluents.size() && event_count() == model.events.size(),
                     "a model declares no name twice");
  }

  /// The id that the name has, or a new one.
  FluentId add_fluent(std::string_view name) { return fluents_.add(name); }
  EventId add_event(std::string_view name) { return events_.add(name); }
  std::optional<FluentId> fluent(std::string_view name) const { return fluents_.find(name); }
  std::optional<EventId> event(std::string_view name) const { return events_.find(name); }
  /// Printed without blanks; valid until the next name is added.
  const std::string& name(FluentId id) const { return fluents_.names[id]; }
  const std::string& name(EventId id) const { return events_.names[id]; }
  std::size_t fluent_count() const { return fluents_.names.size(); }
  std::size_t event_count() const { return events_.names.size(); }

 private:
  template <typename IdType>
  struct Names {
    base::Store<IdType, std::string> names;
    std::map<std::string, IdType, std::less<>> ids;

    IdType add(std::string_view name) {
      if (const auto known = find(name)) return *known;
      const auto id = names.add(std::string(name));
      ids.emplace(name, id);
      return id;
    }
    std::optional<IdType> find(std::string_view name) const {
      const auto found = ids.find(name);
      if (found == ids.end()) return std::nullopt;
      return found->second;
    }
  };

  Names<FluentId> fluents_;
  Names<EventId> events_;
};

}  // namespace parallax::compiler
