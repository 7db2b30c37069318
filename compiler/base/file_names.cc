#include "compiler/base/file_names.h"

#include <system_error>

namespace parallax::base {

namespace fs = std::filesystem;

std::string absolute_name(const std::string& name) {
  std::error_code error;
  return fs::absolute(name, error).lexically_normal().generic_string();
}

fs::path common_folder(const std::map<std::string, std::string>& texts_by_name) {
  fs::path out;
  for (const auto& [name, text] : texts_by_name) {
    const auto folder = fs::path(name).parent_path();
    if (out.empty()) out = folder;
    fs::path both;
    for (auto a = out.begin(), b = folder.begin(); a != out.end() && b != folder.end() && *a == *b;
         ++a, ++b) {
      both /= *a;
    }
    out = both;
  }
  return out;
}

}  // namespace parallax::base
