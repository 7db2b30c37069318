#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A binding's formula in the syntax of models. A binding may write `exists i. TypeOf(i,cup)`; a
/// variable of a model begins with its sort: `{item9000} TypeOf(item9000,cup)`.
struct PlanFormulaText {
  std::string text;
  /// The new names of quantified variables that began with no sort.
  std::map<std::string, std::string, std::less<>> renamed;
};
/// The sort of a renamed variable is that of the first argument place it stands at; without one it
/// keeps its name, and the checker reports it. Linear in the text times its variables.
PlanFormulaText to_model_syntax(const TypedModel& model, std::string_view formula);

/// The sort of the first argument place that the name stands at.
std::optional<SortId> sort_by_use(const TypedModel& model, std::string_view text,
                                  std::string_view name);

/// The sort that a variable's name begins with: `item` of `item12`.
std::optional<SortId> sort_of_variable(const TypedModel& model, std::string_view variable);

/// A variable of that sort that does not occur in the text.
std::string fresh_variable(const TypedModel& model, SortId sort, std::string_view text);

/// The text with every whole word `name` replaced.
std::string replace_word(std::string_view text, std::string_view name, std::string_view by);

}  // namespace parallax::compiler
