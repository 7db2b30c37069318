#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/base/word_table.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

inline constexpr auto kSymbolKindWords =
    base::word_table<SymbolKind>("predicate", "function", "fluent", "event", "term constructor");
constexpr std::string_view kind_word(SymbolKind kind) { return kSymbolKindWords.of(kind); }
/// "an event", "a fluent".
std::string with_article(std::string_view noun);
/// "Filled(cup)" as it was declared.
std::string signature(const TypedModel& model, const Symbol& symbol);
/// The sort of a term for messages: the first one of a constant, "integer" for numbers.
std::string sort_name(const TypedModel& model, TermId term);

/// Advice for a predicate of the event calculus that the model has not declared, or for an old one
/// with another number of arguments; empty for other names.
std::string_view calculus_advice(std::string_view name, std::size_t arguments);

/// Finds declared names near a misspelt one. Gives up on sets of names so large that searching them
/// for every error would take longer than checking the model.
class NameAdvice {
 public:
  NameAdvice(const TypedModel& model, const base::DiagnosticSink& sink)
      : model_(model), sink_(sink) {}

  std::optional<SymbolId> symbol(std::string_view name, std::span<const SymbolKind> kinds) const;
  std::optional<ObjectId> object(std::string_view name) const;
  std::optional<SortId> sort(std::string_view name) const;
  /// The constants of a sort and of those below it, in words; long lists are cut.
  std::string constants_of(SortId sort) const;

  static std::string replace(std::string_view wrong, std::string_view right);

 private:
  bool worthwhile(std::size_t names) const;
  const TypedModel& model_;
  const base::DiagnosticSink& sink_;
};

}  // namespace parallax::compiler
