#pragma once

// Only harness/config/*.cc include this header.

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/config/keys.h"
#include "harness/config/read_log.h"
#include "harness/config/yaml_reader.h"
#include "harness/region/region.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// The bounds of a number; an open bound excludes its value.
struct NumberBounds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
  bool upper_open = false;
  bool admits(double value) const;
  std::string text() const;  // "above 0 and at most 1"
};
inline constexpr NumberBounds kAnyNumber{};
inline constexpr NumberBounds kPositive{0.0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr NumberBounds kNotNegative{0.0, std::numeric_limits<double>::infinity(), false,
                                           false};
inline constexpr NumberBounds kOpenUnit{0.0, 1.0, true, true};

/// Typed access to the fields of a map. A getter leaves `out` alone when the key is missing, and
/// reports at the value when it has the wrong kind or is out of bounds. Unless `out` is an
/// optional, what it holds before is the default, and is written into the tree's ReadLog: a key
/// whose absence means anything else needs an optional.
class YamlFields {
 public:
  /// `what` names the map in messages: "`criterion`", "the body `box`". Reports when `node` is not
  /// a map; then every getter finds nothing.
  YamlFields(const YamlNode& node, std::string what, base::DiagnosticSink& sink);

  /// Rejects every other key, with the near name as a fix and a note that lists the known ones.
  YamlFields& only(std::span<const std::string_view> known);
  YamlFields& only(std::initializer_list<std::string_view> known) {
    return only(std::span<const std::string_view>(known.begin(), known.size()));
  }

  /// Keys that `only` refuses with the word that they belong below `section`.
  void belongs(std::string_view section, std::span<const std::string_view> keys) {
    section_ = section;
    elsewhere_ = keys;
  }

  const YamlNode* find(std::string_view key) const;
  /// Reports kMissingKey at the map.
  const YamlNode* require(std::string_view key) const;

  void number(std::string_view key, const NumberBounds& bounds, double& out) const;
  void number(std::string_view key, const NumberBounds& bounds, std::optional<double>& out) const;
  /// A number of radians; one in degrees is refused where it shows (angle_fault).
  void angle(std::string_view key, double& out) const;
  void integer(std::string_view key, std::int64_t lower, std::int64_t upper,
               std::int64_t& out) const;
  void integer(std::string_view key, std::int64_t lower, std::int64_t upper,
               std::optional<std::int64_t>& out) const;
  void boolean(std::string_view key, bool& out) const;
  void boolean(std::string_view key, std::optional<bool>& out) const;
  void text(std::string_view key, std::string& out) const;
  void text(std::string_view key, std::optional<std::string>& out) const;
  void texts(std::string_view key, std::vector<std::string>& out) const;
  /// One of `choices`, or kYamlUnknownChoice: "`x` is not a known `kind`".
  std::optional<std::size_t> choice(std::string_view key, std::string_view kind,
                                    std::span<const std::string_view> choices) const;
  /// The same with a default, which is written down and not returned.
  std::optional<std::size_t> choice(std::string_view key, std::string_view kind,
                                    std::span<const std::string_view> choices,
                                    std::size_t fallback) const;
  /// A word of an enum, which holds the default. False: it is not there, or was reported.
  template <typename Enum, std::size_t kCount>
  bool word(std::string_view key, const base::WordTable<Enum, kCount>& words, Enum& value) const {
    const auto given =
        choice(key, "value of `" + std::string(key) + '`', words, static_cast<std::size_t>(value));
    if (given) value = static_cast<Enum>(*given);
    return given.has_value();
  }
  /// Leaving the whole map out means the same as leaving it empty.
  void may_be_absent() const { ReadLog::optional(node_); }
  /// Exactly `count` numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count) const;

  const YamlNode& node() const { return node_; }
  const std::string& what() const { return what_; }
  base::DiagnosticSink& sink() const { return sink_; }

 private:
  std::string name_of(std::string_view key) const;
  const YamlNode& node_;
  std::string what_;
  base::DiagnosticSink& sink_;
  std::string_view section_;
  std::span<const std::string_view> elsewhere_;
};

/// The map that a scalar abbreviates (`search: 40` for `search: {runs: 40}`); any other node as it
/// is.
YamlNode with_key(const YamlNode& node, std::string_view key);

/// The value of a scalar, or a report that says what `name` is instead.
std::optional<double> read_number(const YamlNode& node, std::string_view name,
                                  const NumberBounds& bounds, base::DiagnosticSink& sink);
std::optional<std::string> read_text(const YamlNode& node, std::string_view name,
                                     base::DiagnosticSink& sink);
/// Reports an interval of angles, or one angle, that is in degrees; true if it is not.
bool check_radians(const Interval& angles_rad, const YamlNode& node, std::string_view name,
                   base::DiagnosticSink& sink);
/// A number, or a list of two in either order: the order is the caller's to check.
std::optional<Interval> read_interval(const YamlNode& node, std::string_view name,
                                      base::DiagnosticSink& sink);
/// true, false, an integer, a number, or text, by YAML's core rules; quoted is always text.
std::optional<Value> read_value(const YamlNode& node, std::string_view name,
                                base::DiagnosticSink& sink);

/// A choice among `known` as diagnostics do it: note with the list, fix with the near name.
void add_suggestion(base::DiagnosticBuilder& builder, std::string_view name,
                    std::span<const std::string> known, std::string_view list_title);

}  // namespace parallax::harness
