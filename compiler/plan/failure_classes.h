#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::compiler {

/// The hierarchy of plan failures: the classes of cram_common_failures, as every CRAM plan knows
/// them, extensible by `define-condition`.
class FailureClasses {
 public:
  FailureClasses();
  bool knows(std::string_view name) const;
  /// The canonical name: `perception-object-unfound` is an alias. None for an unknown class.
  std::optional<std::string> canonical(std::string_view name) const;
  /// Adds a class below known parents; false if the name exists.
  bool add(std::string_view name, std::vector<std::string> parents);
  /// True if `name` is `ancestor` or below it. Both known.
  bool is_a(std::string_view name, std::string_view ancestor) const;
  /// All names, sorted.
  std::vector<std::string> names() const;

 private:
  std::map<std::string, std::vector<std::string>, std::less<>> parents_;
};

}  // namespace parallax::compiler
