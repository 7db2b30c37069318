#pragma once

#include <span>
#include <string_view>

namespace parallax::tools {

/// A file of tools/scaffold/templates, as it was when the program was built.
struct TemplateFile {
  std::string_view path;  // "room/scenario.yaml"
  std::string_view text;
};

std::span<const TemplateFile> template_files();

}  // namespace parallax::tools
