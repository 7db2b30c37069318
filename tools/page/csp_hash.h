#pragma once

#include <string>
#include <string_view>

namespace parallax::tools {

/// As a Content-Security-Policy names an inline script or style: "sha256-47DEQpj8...=".
std::string csp_hash(std::string_view text);

}  // namespace parallax::tools
