#pragma once

#include <variant>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

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
