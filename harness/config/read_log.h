#pragma once

// Only harness/config/*.cc include this header.

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::harness {

struct YamlNode;

/// Notes that the readers of a tree make about its fields, by the ids of its nodes: the default of
/// a key that is not given, which scalars are texts, which stand for a map. The readers alone know
/// the defaults; a comparison of scenarios finds them here.
class ReadLog {
 public:
  struct Notes {
    std::map<std::string, std::string, std::less<>> fallbacks;  // of keys that may be left out
    std::vector<std::string> required;                          // keys without such a value
    std::vector<std::string> known;                             // all keys that the reader admits
    std::string stands_for;    // a scalar: the key of the map that it abbreviates
    bool is_text = false;      // a scalar that is read as a text, whatever it looks like
    bool is_optional = false;  // a map: leaving it out is the same as leaving it empty
  };

  /// Gives the maps and scalars of the tree ids, and this log, which has to outlive it.
  void attach(YamlNode& root);

  /// Each does nothing for a node without a log.
  static void fallback(const YamlNode& map, std::string_view key, double value);
  static void fallback(const YamlNode& map, std::string_view key, std::string value);
  static void fallback(const YamlNode& map, std::string_view key, std::span<const double> values);
  static void fallback(const YamlNode& map, std::string_view key,
                       const std::vector<std::string>& values);
  static void required(const YamlNode& map, std::string_view key);
  static void known(const YamlNode& map, std::span<const std::string_view> keys);
  static void stands_for(const YamlNode& scalar, std::string_view key);
  static void text(const YamlNode& scalar);
  static void optional(const YamlNode& map);

  const Notes& notes(const YamlNode& node) const;

 private:
  static Notes* of(const YamlNode& node);
  std::vector<Notes> notes_ = {Notes()};  // 0: nodes without an id
};

/// One writing for all that mean this number: "0.3", "1000000".
std::string number_text(double value);
/// "[a, b]"
std::string list_text(std::span<const std::string> items);

}  // namespace parallax::harness
