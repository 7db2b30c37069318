#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/pipeline/compile.h"
#include "runtime/optimize/minimal_choice.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// `--prefer`: the traces in which no fewer of the named atoms are true in any other.
class PreferredTraces {
 public:
  /// `levels`: `Ab`, `Ab(Tweety)`, or several separated by commas; the first level counts most.
  /// Reports kUsage, or kLimitReached where there are too many minimal sets.
  static std::optional<PreferredTraces> of(const std::vector<std::string>& levels,
                                           const compiler::Compilation& compilation,
                                           Context& context);

  /// The model whose traces are the preferred ones.
  compiler::CompiledModel model(const compiler::CompiledModel& all) const {
    return runtime::with_choices(all, levels_, choices_.choices);
  }
  /// `minimal: Ab(Tweety)`, a line for each set, at most ten.
  std::string text() const;
  /// `"minimal_sets":[["Ab(Tweety)"]],`
  std::string fields() const;

 private:
  PreferredTraces() = default;
  runtime::Levels levels_;
  runtime::MinimalChoices choices_;
  std::vector<std::vector<std::string>> sets_;  // by choice: its atoms as they are printed
};

}  // namespace parallax::tools
