#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/check.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/loader.h"

namespace parallax::compiler {

/// The names that `ignore` statements put out of force. A declaration or list entry is left out if
/// it comes after the statement; a formula wherever it stands.
class IgnoredNames {
 public:
  explicit IgnoredNames(const ModelAst& ast);
  bool contains(std::string_view name) const { return since_.contains(name); }
  /// Is `name` ignored by a statement before position `at` of ModelAst::order?
  bool contains(std::string_view name, std::size_t at) const;
  /// Does the formula mention an ignored name anywhere?
  bool concern(const Ast& ast, const Statement& formula) const;

 private:
  std::unordered_map<std::string_view, std::size_t> since_;
};

/// Fills the sorts, objects and symbols of `model` from all declarations, wherever in the model
/// they stand, and its options and completions. Reports and leaves out what is wrong.
void declare(const ModelAst& ast, const IgnoredNames& ignored, const CheckOptions& options,
             TypedModel& model, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
