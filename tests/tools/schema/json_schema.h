#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace parallax::test {

/// Holds documents against one schema, in the part of JSON Schema 2020-12 that the published
/// schemas use. Which keys documents had is remembered, so that keys that none had can be told.
class JsonSchema {
 public:
  explicit JsonSchema(nlohmann::json schema);

  /// Faults of the schema itself: unknown keywords, open objects, references to nothing.
  std::vector<std::string> faults() const;
  /// Errors of the document with their places. Where alternatives are refused,
  /// that of the one that fits best.
  std::vector<std::string> errors(const nlohmann::json& document);
  /// Keys of the schema that no valid document had so far.
  std::vector<std::string> unseen() const;
  const std::set<std::string>& seen() const { return seen_; }

 private:
  struct Judgement {
    std::vector<std::string> errors;
    std::set<std::string> seen;  // places of properties in the schema
  };
  const nlohmann::json& resolved(const nlohmann::json& schema, std::string& place) const;
  Judgement judge(const nlohmann::json& schema, std::string place, const nlohmann::json& value,
                  const std::string& where) const;
  void judge_object(const nlohmann::json& schema, const std::string& place,
                    const nlohmann::json& value, const std::string& where, Judgement& out) const;

  nlohmann::json schema_;
  std::set<std::string> seen_;
};

}  // namespace parallax::test
