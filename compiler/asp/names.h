#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Identifiers of a logic program for the names of a model: the first letter small, and `_` behind
/// a name that is taken. One pool for sorts, constants, symbols and the exporter's own predicates,
/// so that no two things share a name.
class AspNames {
 public:
  explicit AspNames(const TypedModel& model);

  const std::string& sort(SortId id) const { return sorts_[id.index()]; }
  const std::string& object(ObjectId id) const { return objects_[id.index()]; }
  /// The predicates of the event calculus are `holds_at`, `happens`, ...
  const std::string& symbol(SymbolId id) const { return symbols_[id.index()]; }

  /// `wanted`, changed where it is no identifier or is taken; never given again.
  std::string fresh(std::string_view wanted);

  /// A ground term or user's atom as clingo prints it, in the model's spelling without blanks:
  /// `on(red,3)` is `On(Red,3)`, `f` is `F()`.
  std::string original(std::string_view printed) const;

 private:
  std::vector<std::string> sorts_, objects_, symbols_;
  std::set<std::string, std::less<>> taken_;
  std::map<std::string, std::string, std::less<>> originals_;  // symbols with `()` appended
};

}  // namespace parallax::compiler
