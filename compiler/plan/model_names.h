#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::compiler {

/// Finds the model's spelling of a plan's name: Lisp folds case and writes
/// hyphens, a model has neither, so `top-drawer` means `topDrawer`.
class ModelNames {
 public:
  explicit ModelNames(std::span<const std::string> names);
  /// The name as the model writes it; an exact match goes first, then the first
  /// one declared that is equal up to case, `-` and `_`. Without any names
  /// every name is taken as it is.
  std::optional<std::string> find(std::string_view name) const;
  /// Is this very name among them?
  bool has(std::string_view name) const;
  /// For a suggestion.
  std::optional<std::string> nearest(std::string_view name) const;

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::string, std::less<>> by_folded_;
};

}  // namespace parallax::compiler
