#include "compiler/base/contract.h"

#include <fmt/core.h>

#include <string_view>

namespace parallax::base {

void contract_violated(const char* condition, const char* owed, const char* file, int line) {
  // Only the file's base name: a message must not depend on where the tree was built.
  std::string_view path(file);
  const auto slash = path.rfind('/');
  if (slash != std::string_view::npos) path.remove_prefix(slash + 1);
  throw ContractViolation(fmt::format("{}:{}: {} ({})", path, line, owed, condition));
}

}  // namespace parallax::base
