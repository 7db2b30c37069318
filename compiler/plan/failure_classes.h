#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::compiler {

/// Which common failures CRAM ships: those of its branch devel, or those of its release of 2020.
enum class FailureTable : std::uint8_t { kDevel, k2020 };

/// A Lisp error that leaves a task goes on as a failure of this class.
inline constexpr std::string_view kErrorEnvelope = "common-lisp-error-envelope";

/// The hierarchy of conditions: those of Common Lisp and of CRAM that plans name, extended and
/// overridden by `define-condition`.
class FailureClasses {
 public:
  explicit FailureClasses(FailureTable table = FailureTable::kDevel);
  bool knows(std::string_view name) const;
  /// The canonical name: `perception-object-unfound` is an alias. None for an unknown class.
  std::optional<std::string> canonical(std::string_view name) const;
  /// Adds a class below known parents, in place of CRAM's own class of that name; false if it was
  /// added before, or is above one of its parents.
  bool add(std::string_view name, std::vector<std::string> parents);
  /// True if `name` is `ancestor` or below it. Both known.
  bool is_a(std::string_view name, std::string_view ancestor) const;
  /// The longest way up to a class without parents: a class lies deeper than those above it.
  int depth(std::string_view name) const;
  /// Is neither of the two above the other, and some class below both?
  bool cross(std::string_view one, std::string_view other) const;
  /// An error of Lisp that is no plan failure.
  bool is_lisp_error(std::string_view name) const {
    return is_a(name, "error") && !is_a(name, "plan-failure");
  }
  /// All names, sorted.
  std::vector<std::string> names() const;

  /// Structures and classes of the plan are types, but no conditions.
  void add_structure(std::string_view name) { structures_.emplace(name); }
  bool has_structure(std::string_view name) const { return structures_.contains(name); }

 private:
  std::set<std::string, std::less<>> structures_;
  std::map<std::string, std::vector<std::string>, std::less<>> parents_;
  std::set<std::string, std::less<>> added_;
};

}  // namespace parallax::compiler
