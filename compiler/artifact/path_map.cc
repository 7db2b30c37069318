#include "compiler/artifact/path_map.h"

namespace parallax::compiler {
namespace {

std::string without_final_slashes(std::string_view path) {
  while (path.size() > 1 && path.ends_with('/')) path.remove_suffix(1);
  return std::string(path);
}

/// Does the name lie below the folder, or is it the folder itself?
bool begins_with(std::string_view name, std::string_view folder) {
  if (!name.starts_with(folder)) return false;
  return name.size() == folder.size() || folder.ends_with('/') || name[folder.size()] == '/';
}

}  // namespace

bool PathMap::add(std::string_view rule) {
  const auto equals = rule.find('=');
  if (equals == std::string_view::npos || equals == 0) return false;
  rules_.emplace_back(without_final_slashes(rule.substr(0, equals)),
                      without_final_slashes(rule.substr(equals + 1)));
  return true;
}

std::string PathMap::mapped(const std::string& name) const {
  const std::pair<std::string, std::string>* best = nullptr;
  for (const auto& rule : rules_) {
    if (!begins_with(name, rule.first)) continue;
    if (best == nullptr || rule.first.size() > best->first.size()) best = &rule;
  }
  if (best != nullptr) {
    auto rest = name.substr(best->first.size());
    if (best->second.empty() && rest.starts_with('/')) rest.erase(0, 1);
    return best->second + rest;
  }
  const auto folder = folder_.generic_string();
  if (!name.starts_with('/') || folder.empty() || !begins_with(name, folder)) return name;
  return std::filesystem::path(name).lexically_relative(folder_).generic_string();
}

void map_paths(CompiledModel& model, const PathMap& map) {
  const auto apply = [&](std::string& name) {
    if (!name.empty()) name = map.mapped(name);
  };
  for (auto& source : model.sources) apply(source.name);
  for (auto& origin : model.origins) apply(origin.place.file);
  for (auto& step : model.plan) apply(step.place.file);
  for (auto& cut : model.plan_cuts) apply(cut.place.file);
}

}  // namespace parallax::compiler
