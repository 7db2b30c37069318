#pragma once

#include <map>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/compare/fact.h"

namespace parallax::compiler {

/// The arguments that the plan hands to the controller of an event, as text.
struct HandedCall {
  std::string event;
  std::map<std::string, std::string> arguments;  // "target.x" -> "0.985"
  FactPlace place = {};                          // of the first perform that calls so
  friend bool operator==(const HandedCall& a, const HandedCall& b) {
    return a.event == b.event && a.arguments == b.arguments;
  }
};

/// The calls of a plan in the order of its text, each once.
std::vector<HandedCall> plan_calls(const CompiledModel& model);

/// The calls of one event, argument by argument: "0.985", or the values of several calls in order,
/// "0.5, -, 0.7", where the second has none. No values where no call has an argument.
std::map<std::string, std::string> call_values(const std::vector<HandedCall>& calls,
                                               const std::string& event);

}  // namespace parallax::compiler
