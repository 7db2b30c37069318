#pragma once

#include <variant>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// A state as a JSON object, in order of the names; linear in their number, as assigning members of
/// an ordered object would not be. A template, so that no header of ours needs the JSON library.
template <typename Json>
Json state_json(const State& state) {
  typename Json::object_t members;
  members.reserve(state.size());
  for (const auto& [name, value] : state)
    members.push_back({name, std::visit([](const auto& plain) { return Json(plain); }, value)});
  return members;
}

}  // namespace parallax::harness
