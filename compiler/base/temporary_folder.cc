#include "compiler/base/temporary_folder.h"

#include <cstdlib>
#include <system_error>

#include "compiler/base/path_gate.h"

namespace parallax::base {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& purpose) {
  std::error_code error;
  auto name = (fs::temp_directory_path(error) / ("parallax_" + purpose + "_XXXXXX")).string();
  if (!error && ::mkdtemp(name.data()) != nullptr) path_ = real_path(name);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  if (!path_.empty()) fs::remove_all(path_, error);
}

}  // namespace parallax::base
