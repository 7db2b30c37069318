#pragma once

#include <string>
#include <variant>

#include "harness/confidence/criterion_spec.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// The criterion as one JSON object; journal and report say it in the same words.
std::string criterion_json(const CriterionSpec& criterion);

/// A state as a JSON object, in order of the names. A template, so that no header of ours needs the
/// JSON library.
template <typename Json>
Json state_json(const State& state) {
  Json out = Json::object();
  for (const auto& [name, value] : state) {
    std::visit([&, &key = name](const auto& v) { out[key] = v; }, value);
  }
  return out;
}

}  // namespace parallax::harness
