#pragma once

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/two_models.h"

namespace parallax::test {

inline bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A turkey that is alive and may be shot at, once, with a gun that is loaded or not: four traces.
inline constexpr const char* kTurkey =
    "range time 0 1\n"
    "fluent Alive()\n"
    "fluent Loaded()\n"
    "event Shoot()\n"
    "[time] HoldsAt(Loaded(),time) -> Terminates(Shoot(),Alive(),time).\n"
    "HoldsAt(Alive(),0).\n";

inline constexpr const char* kAll =
    "models: {lost_traces: forbidden, gained_traces: forbidden, declarations: forbidden, "
    "axioms: forbidden}\n";

class Gate : public TwoModels {
 public:
  /// Outcomes of the rules, by name; the gate's exit code must follow from them.
  nlohmann::json hold(const std::string& rules, const std::string& before, const std::string& after,
                      const std::vector<std::string>& more = {}) const {
    write("rules.yaml", rules);
    std::vector<std::string> arguments = {"diff", "--gate", "rules.yaml", before, after, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = parallax(arguments);
    CAPTURE(result.err);
    CAPTURE(result.out);
    const auto document = nlohmann::json::parse(result.out);
    REQUIRE(document["status"] == "ok");
    const bool passed = document["gate"]["passed"];
    CHECK(result.code == (passed ? 0 : 1));
    nlohmann::json out = {{"passed", passed}};
    for (const auto& rule : document["gate"]["rules"]) {
      out[rule["rule"].get<std::string>()] = rule["outcome"];
      out[rule["rule"].get<std::string>() + " witness"] = rule["witness"];
      out[rule["rule"].get<std::string>() + " words"] = rule["words"];
    }
    return out;
  }
  nlohmann::json models(const std::string& rules, const std::string& before,
                        const std::string& after) const {
    write("old.e", before);
    write("new.e", after);
    return hold(rules, "old.e", "new.e");
  }
  void refused(const std::string& rules, const std::string& why) const {
    write("rules.yaml", rules);
    write("old.e", kTurkey);
    const auto result = parallax({"diff", "--gate", "rules.yaml", "old.e", "old.e"});
    CAPTURE(rules);
    CHECK(result.code == 3);
    CHECK_MESSAGE(holds(result.err, why), result.err);
    CHECK(holds(result.err, "rules.yaml:"));
  }
};

}  // namespace parallax::test
