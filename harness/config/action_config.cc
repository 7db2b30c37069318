#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/world/arguments.h"

namespace parallax::harness {
namespace {

constexpr double kMaxTimeLimitS = 86400.0;

void unknown_argument(const ControllerSpec& controller, const std::string& name,
                      base::SourceRange range, base::DiagnosticSink& sink) {
  std::vector<std::string> known;
  for (const auto& argument : controller.arguments) known.emplace_back(argument.name);
  known.emplace_back(Key::kTimeLimitS);  // of the action, not of the controller
  auto error = sink.error(codes::kUnknownArgument, range, controller.name, name);
  add_suggestion(error, name, known, "arguments");
}

/// Reads the arguments of one action; maps nest, so that `target: {x: 0.5}` is target.x.
class ArgumentReader {
 public:
  ArgumentReader(const SymbolPattern& pattern, const ControllerSpec* controller,
                 base::DiagnosticSink& sink)
      : pattern_(pattern), controller_(controller), sink_(sink) {}

  State take() { return std::move(arguments_); }
  std::map<std::string, base::SourceRange> take_sources() { return std::move(sources_); }

  void read(const std::string& name, const YamlEntry& entry) {
    if (entry.value.is_map()) {
      for (const auto& inner : entry.value.entries) read(name + "." + inner.key, inner);
      return;
    }
    auto value = read_value(entry.value, fmt::format("`{}`", name), sink_);
    if (!value) return;
    if (auto* text = std::get_if<std::string>(&*value)) {
      *text = with_positions(*text, pattern_, entry.value.range, sink_);
    }
    if (controller_ != nullptr && !fits(name, entry, *value)) return;
    arguments_.insert_or_assign(name, std::move(*value));
    sources_.insert_or_assign(name, entry.value.range);
  }

 private:
  bool fits(const std::string& name, const YamlEntry& entry, Value& value) {
    const auto* argument = find_argument(*controller_, name);
    if (argument == nullptr) {
      unknown_argument(*controller_, name, entry.key_range, sink_);
      return false;
    }
    const bool wants_name = is_name(*argument);
    if (const auto* whole = std::get_if<std::int64_t>(&value); whole != nullptr && !wants_name) {
      value = static_cast<double>(*whole);  // `1` is as good a length as `1.0`
    }
    const bool right = wants_name ? std::holds_alternative<std::string>(value)
                                  : std::holds_alternative<double>(value);
    if (!right) {
      sink_.error(codes::kWrongYamlKind, entry.value.range, fmt::format("`{}`", name),
                  describe(entry.value),
                  wants_name ? fmt::format("the name of a `{}`", argument->unit)
                             : fmt::format("a number [{}]", argument->unit));
      return false;
    }
    if (wants_name) return true;  // which names there are is known once the world is
    const auto fault = wrong_number(*argument, std::get<double>(value));
    if (fault.empty()) return true;
    sink_.error(codes::kBadWorld, entry.value.range,
                fmt::format("actions/{}/{}", pattern_.symbol, name), fault);
    return false;
  }

  const SymbolPattern& pattern_;
  const ControllerSpec* controller_;  // null: another simulator's, unknown here
  base::DiagnosticSink& sink_;
  State arguments_;
  std::map<std::string, base::SourceRange> sources_;
};

const ControllerSpec* known_controller(const std::string& name, base::SourceRange range,
                                       base::DiagnosticSink& sink) {
  if (const auto* found = find_controller(name)) return found;
  std::vector<std::string> known;
  for (const auto& controller : controllers()) known.emplace_back(controller.name);
  auto error = sink.error(codes::kUnknownController, range, name);
  add_suggestion(error, name, known, "controllers");
  return nullptr;
}

/// `from_plan`: names of the plan's arguments and what the controller calls them.
void read_from_plan(const YamlNode& node, const ControllerSpec* controller, ActionBinding& action,
                    base::DiagnosticSink& sink) {
  const YamlFields all(node, fmt::format("`{}` of `{}`", Key::kFromPlan, action.event), sink);
  action.from_plan.emplace();
  for (const auto& entry : node.entries) {
    const auto to = read_text(entry.value, fmt::format("`{}`", entry.key), sink);
    if (!to) continue;
    const bool known =
        controller == nullptr ||
        std::any_of(controller->arguments.begin(), controller->arguments.end(),
                    [&](const ArgumentSpec& argument) {
                      return argument.name == *to || argument.name.starts_with(*to + ".");
                    });
    if (!known) unknown_argument(*controller, *to, entry.value.range, sink);
    action.from_plan->emplace(entry.key, *to);
  }
}

std::optional<ActionBinding> read_action(const YamlEntry& entry, bool built_in,
                                         base::DiagnosticSink& sink) {
  const auto pattern = read_pattern(entry, sink);
  if (!pattern) return std::nullopt;
  ActionBinding action;
  action.event = pattern->symbol;
  action.arity = pattern->parameters.size();
  action.source = entry.key_range;
  const YamlFields fields(entry.value, fmt::format("the action of `{}`", pattern->symbol), sink);
  if (!entry.value.is_map()) return std::nullopt;
  const auto* controller = fields.find(Key::kController);
  if (controller == nullptr) {
    sink.error(codes::kActionWithoutController, entry.key_range, entry.key);
    return std::nullopt;
  }
  fields.text(Key::kController, action.controller);
  fields.number(Key::kTimeLimitS, NumberBounds{0.0, kMaxTimeLimitS, true, false},
                action.time_limit_s);
  if (!built_in) {
    action.controller = with_positions(action.controller, *pattern, controller->range, sink);
  }
  const ControllerSpec* table = nullptr;
  if (built_in && !action.controller.empty()) {
    table = known_controller(action.controller, controller->range, sink);
    if (table == nullptr) return std::nullopt;
  }
  ArgumentReader reader(*pattern, table, sink);
  for (const auto& argument : entry.value.entries) {
    if (argument.key == Key::kController || argument.key == Key::kTimeLimitS) continue;
    if (argument.key == Key::kFromPlan) {
      read_from_plan(argument.value, table, action, sink);
      continue;
    }
    reader.read(argument.key, argument);
  }
  action.arguments = reader.take();
  action.argument_sources = reader.take_sources();
  const auto fault = table == nullptr ? std::nullopt : wrong_together(*table, action.arguments);
  if (fault) {
    sink.error(codes::kBadWorld, action.argument_sources.at(fault->name),
               fmt::format("actions/{}/{}", action.event, fault->name), fault->text);
  }
  return action;
}

}  // namespace

std::vector<ActionBinding> read_actions(const YamlNode& node, bool built_in,
                                        base::DiagnosticSink& sink) {
  std::vector<ActionBinding> actions;
  const YamlFields all(node, key_text(Key::kActions), sink);
  std::map<std::string, base::SourceRange> seen;
  for (const auto& entry : node.entries) {
    auto action = read_action(entry, built_in, sink);
    if (!action) continue;
    const auto [earlier, fresh] = seen.emplace(action->event, action->source);
    if (!fresh) {
      sink.error(codes::kDuplicateKey, action->source, action->event)
          .note(earlier->second, "first given here");
    }
    actions.push_back(std::move(*action));
  }
  std::sort(actions.begin(), actions.end(),
            [](const auto& a, const auto& b) { return a.event < b.event; });
  return actions;
}

}  // namespace parallax::harness
