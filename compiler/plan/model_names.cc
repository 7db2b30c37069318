#include "compiler/plan/model_names.h"

#include <algorithm>

#include "compiler/base/ascii.h"
#include "compiler/base/suggest.h"

namespace parallax::compiler {
namespace {

std::string folded(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (c == '-' || c == '_') continue;
    out += base::to_lower(c);
  }
  return out;
}

}  // namespace

ModelNames::ModelNames(std::span<const std::string> names) : names_(names.begin(), names.end()) {
  for (const auto& name : names_) by_folded_.emplace(folded(name), name);
}

std::optional<std::string> ModelNames::find(std::string_view name) const {
  if (names_.empty()) return std::string(name);
  if (std::find(names_.begin(), names_.end(), name) != names_.end()) return std::string(name);
  const auto found = by_folded_.find(folded(name));
  if (found == by_folded_.end()) return std::nullopt;
  return found->second;
}

bool ModelNames::has(std::string_view name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

std::optional<std::string> ModelNames::nearest(std::string_view name) const {
  return base::nearest_name(name, names_, 3);
}

}  // namespace parallax::compiler
