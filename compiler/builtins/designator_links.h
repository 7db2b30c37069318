#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/builtins/plan_value.h"

namespace parallax::compiler {

using DesignatorKeys = std::vector<std::pair<std::string, ValueId>>;

/// Everything that a plan can change beside its variables. Cells are fluents, tables, arrays and
/// structures; each is told apart by its identity, a number that no designator has either.
struct PlanHeap {
  std::vector<std::pair<std::uint32_t, ValueId>> cells;    // what each holds; ascending
  std::vector<std::pair<std::uint32_t, ValueId>> globals;  // those that were set; ascending
  std::uint32_t kept = 0;  // cells up to this one are known to the first values of globals

  std::optional<ValueId> content(const ValueStore& values, ValueId cell) const;
  void change(const ValueStore& values, ValueId cell, ValueId content);
  std::optional<ValueId> global(std::uint32_t number) const;
  void set_global(std::uint32_t number, ValueId value);
};

/// Which designators have been equated, so that they describe the same thing: chains from the first
/// description to the youngest. Designators are told apart by their identity, which they have only
/// in plans that equate at all; elsewhere two that are written alike are one.
struct DesignatorLinks {
  bool identities = false;
  std::uint32_t next = 1;   // an identity that nothing has yet
  std::uint32_t floor = 1;  // those below are taken by what is not in this state
  std::vector<std::vector<ValueId>> chains;
  PlanHeap heap;

  ValueId first(ValueId designator) const;
  ValueId current(ValueId designator) const;
  bool same(ValueId left, ValueId right) const { return first(left) == first(right); }
  /// `successor` describes what `parent` does, and is younger; false if that was known.
  bool equate(ValueId parent, ValueId successor);
  ValueId make(ValueStore& values, DesignatorKind kind, DesignatorKeys keys);
  /// A new cell; `what` begins with the word for it.
  ValueId make_cell(ValueStore& values, std::string what, ValueId content);

 private:
  std::optional<std::size_t> chain_of(ValueId designator) const;
};

/// Designators, and objects that the model returned, which keep the description they were sought
/// by.
bool is_designator(const Value& value);
/// `:object`, `location`, `'desig-props:action` ...
std::optional<DesignatorKind> designator_class(std::string_view name);
/// `object-designator` ...: does the value have this type? None: no such type.
std::optional<bool> has_designator_type(const Value& value, std::string_view type);

/// ((:key value) ...), in the order of the designator.
ValueId property_list(ValueStore& values, ValueId designator);
/// The keys that such a list gives; none if it is not one.
std::optional<DesignatorKeys> keys_of_list(const ValueStore& values, ValueId list);
/// The value of a key; for an object that the model returned, its own name.
std::optional<ValueId> property_value(const ValueStore& values, ValueId designator,
                                      std::string_view key);
/// The designator with the current one in the place of each that is in it.
ValueId resolve_links(const DesignatorLinks& links, ValueStore& values, ValueId designator);

}  // namespace parallax::compiler
