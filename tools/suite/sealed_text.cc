#include "tools/suite/sealed_text.h"

#include "compiler/base/json.h"
#include "compiler/base/sha256.h"

namespace parallax::tools {

std::string sealed(const std::string& document) {
  const nlohmann::json json = {{"sha256", base::sha256_hex(document)},
                               {"entry", base::parse_json(document)}};
  return base::json_text(json) + '\n';
}

std::optional<std::string> unsealed(std::string_view text) {
  const auto json = base::parse_json(text);
  const auto* hash = base::json_member(json, "sha256");
  const auto* entry = base::json_member(json, "entry");
  if (hash == nullptr || entry == nullptr || !hash->is_string()) return std::nullopt;
  auto inner = base::json_text(*entry);
  if (hash->get<std::string>() != base::sha256_hex(inner)) return std::nullopt;
  return inner;
}

}  // namespace parallax::tools
