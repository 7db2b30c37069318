#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {

/// Names of files as an artifact has them, so that two checkouts give equal bytes. An absolute name
/// below `folder` becomes relative to it; any other stays unless a rule maps it.
class PathMap {
 public:
  explicit PathMap(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// `FROM=TO`: FROM at the beginning of a name, up to a slash or its end, becomes TO. The longest
  /// FROM that fits counts. False if the text is no such rule.
  bool add(std::string_view rule);
  std::string mapped(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::vector<std::pair<std::string, std::string>> rules_;
};

/// Maps the names of all texts and places.
void map_paths(CompiledModel& model, const PathMap& map);

}  // namespace parallax::compiler
