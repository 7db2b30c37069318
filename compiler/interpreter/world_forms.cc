#include "compiler/interpreter/world_forms.h"

#include <fmt/core.h>

#include <algorithm>

#include "compiler/interpreter/form_compiler.h"

namespace parallax::compiler {
namespace {

constexpr std::string_view kIgnoredForms[] = {
    "declare",
    "in-package",
    "ros-debug",
    "ros-info",
    "ros-warn",
    "ros-error",
    "ros-fatal",
    "set-debug-level",
    "set-debug-levels",
    "log-event",
    "warn",
    "on-event",
    "publish-event",
    "clear-belief",
    "visualize-marker",
    "visualize-gripper",
};

constexpr std::string_view kIgnoredPackages[] = {"btr-belief",
                                                 "cram-bullet-reasoning-belief-state"};

constexpr std::string_view kIgnoredFunctions[] = {
    "btr:add-objects-to-mesh-list",
    "btr:add-vis-axis-object",
    "btr:attach-object",
    "btr:clear-costmap-vis-object",
    "btr:detach-all-objects",
    "btr:detach-object",
    "btr:remove-vis-axis-object",
    "btr:simulate",
    "btr-utils:kill-all-objects",
    "btr-utils:kill-object",
    "btr-utils:move-object",
    "btr-utils:spawn-object",
};

constexpr std::string_view kTransparentForms[] = {
    "with-projected-task-tree",
    "with-projection-environment",
    "with-process-modules-running",
    "with-ros-node",
};

/// Accepted, not evaluated.
void form_ignored(FormCompiler& c, DatumId form, FormItems /*items*/) {
  c.check_no_perform(form);
  c.nil(form);
}

void form_transparent(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.refuse(form, "expected an argument before the body");
  c.compile_body(items.subspan(2));
}

}  // namespace

std::span<const std::string_view> ignored_forms() { return kIgnoredForms; }
std::span<const std::string_view> ignored_packages() { return kIgnoredPackages; }
std::span<const std::string_view> ignored_functions() { return kIgnoredFunctions; }
std::span<const std::string_view> transparent_forms() { return kTransparentForms; }

bool is_ignored_call(std::string_view package, std::string_view name) {
  if (package.empty()) return false;
  const auto packages = ignored_packages();
  if (std::find(packages.begin(), packages.end(), package) != packages.end()) return true;
  const auto functions = ignored_functions();
  const auto full = fmt::format("{}:{}", package, name);
  return std::find(functions.begin(), functions.end(), full) != functions.end();
}

std::span<const FormEntry> world_forms() {
  static const auto entries = [] {
    std::vector<FormEntry> out;
    for (const auto name : kIgnoredForms) out.push_back({name, form_ignored});
    for (const auto name : kTransparentForms) out.push_back({name, form_transparent});
    return out;
  }();
  return entries;
}

}  // namespace parallax::compiler
