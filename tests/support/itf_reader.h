#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace parallax::test {

/// A reader of the Informal Trace Format, after its published description (Apalache ADR-015) and
/// nothing else: any reader of the format accepts the files that it accepts.
class ItfFile {
 public:
  using Json = nlohmann::json;

  explicit ItfFile(const std::string& text) {
    const auto top = Json::parse(text);
    require(top.is_object(), "the top is an object");
    for (const auto& [name, value] : top.items()) {
      const bool known = name == "#meta" || name == "params" || name == "vars" ||
                         name == "states" || name == "loop";
      require(known, "no other field at the top than " + name);
    }
    if (top.contains("#meta")) {
      meta = top["#meta"];
      require(meta.is_object(), "#meta is an object");
    }
    for (const auto& name : top.at("vars")) {
      require(name.is_string(), "variables are named by strings");
      require(vars.insert(name.get<std::string>()).second, "a variable is named once");
    }
    require(!vars.empty(), "there are variables");
    require(top.at("states").is_array(), "states are a list");
    for (const auto& state : top.at("states")) read_state(state);
    require(!states.empty(), "there are states");
  }

  std::set<std::string> vars;
  std::vector<std::map<std::string, Json>> states;
  std::vector<Json> state_meta;
  Json meta;

  /// A map from tuples, as pairs; the tuple's elements printed.
  static std::map<std::vector<std::string>, Json> map_of(const Json& value) {
    std::map<std::vector<std::string>, Json> out;
    for (const auto& pair : value.at("#map")) {
      std::vector<std::string> key;
      for (const auto& element : pair.at(0).at("#tup")) key.push_back(printed(element));
      require(out.emplace(key, pair.at(1)).second, "a key of a map stands once");
    }
    return out;
  }
  /// A string or integer as text.
  static std::string printed(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
    return value.at("#bigint").get<std::string>();
  }

 private:
  static void require(bool fine, const std::string& what) {
    if (!fine) throw std::runtime_error("ITF: " + what);
  }

  void read_state(const Json& state) {
    require(state.is_object(), "a state is an object");
    auto& values = states.emplace_back();
    state_meta.push_back(state.value("#meta", Json::object()));
    for (const auto& [name, value] : state.items()) {
      if (name == "#meta") continue;
      require(vars.contains(name), "a state has no other variables: " + name);
      check_value(value);
      values[name] = value;
    }
    require(values.size() == vars.size(), "a state gives every variable a value");
  }

  static void check_value(const Json& value) {
    if (value.is_string() || value.is_boolean()) return;
    if (value.is_number()) {
      require(value.is_number_integer(), "numbers are integers");
      const auto number = value.get<std::int64_t>();
      const auto largest = (std::int64_t{1} << 53U) - 1;
      require(number >= -largest && number <= largest, "integers are below 2^53");
      return;
    }
    if (value.is_array()) {
      for (const auto& item : value) check_value(item);
      return;
    }
    require(value.is_object(), "no other values, such as null");
    if (value.size() == 1 && value.contains("#bigint")) {
      require(value["#bigint"].is_string(), "a big integer is a string");
    } else if (value.size() == 1 && (value.contains("#tup") || value.contains("#set"))) {
      const auto& items = value.begin().value();
      require(items.is_array(), "tuples and sets are lists");
      check_value(items);
    } else if (value.size() == 1 && value.contains("#map")) {
      for (const auto& pair : value["#map"]) {
        require(pair.is_array() && pair.size() == 2, "a map is a list of pairs");
        check_value(pair);
      }
    } else {
      for (const auto& [name, field] : value.items()) {
        require(!name.starts_with("#"), "fields of records do not begin with #");
        check_value(field);
      }
    }
  }
};

}  // namespace parallax::test
