#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace parallax::tools {

/// A JSON document with its own SHA-256 around it, so that manual changes and half-written files
/// are detected.
std::string sealed(const std::string& document);

/// The document, as `base::json_text` writes it; nothing if it is not what was sealed.
std::optional<std::string> unsealed(std::string_view text);

}  // namespace parallax::tools
