// Poses and objects of a plan's designators are laid over the arguments of the controllers, so a
// plan may change what is simulated although its events stay the same.
#include "compiler/compare/plan_calls.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace parallax::compiler {
namespace {

std::string value_text(const PlanValue& value) {
  return std::visit([](const auto& one) { return fmt::format("{}", one); }, value);
}

}  // namespace

std::vector<HandedCall> plan_calls(const CompiledModel& model) {
  std::vector<HandedCall> out;
  std::set<std::pair<std::string, std::map<std::string, std::string>>> seen;
  for (const auto& perform : model.plan) {
    HandedCall call{perform.event, {}, {perform.place.file, perform.place.begin.line}};
    for (const auto& [name, value] : perform.arguments) {
      call.arguments.emplace(name, value_text(value));
    }
    if (seen.emplace(call.event, call.arguments).second) out.push_back(std::move(call));
  }
  return out;
}

std::map<std::string, std::string> call_values(const std::vector<HandedCall>& calls,
                                               const std::string& event) {
  std::set<std::string> names;
  std::vector<const HandedCall*> of_event;
  for (const auto& call : calls) {
    if (call.event != event) continue;
    of_event.push_back(&call);
    for (const auto& [name, value] : call.arguments) names.insert(name);
  }
  std::map<std::string, std::string> out;
  for (const auto& name : names) {
    auto& text = out[name];
    for (const auto* call : of_event) {
      const auto found = call->arguments.find(name);
      text += (call == of_event.front() ? "" : ", ") +
              (found == call->arguments.end() ? "-" : found->second);
    }
  }
  return out;
}

}  // namespace parallax::compiler
