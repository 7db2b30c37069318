#pragma once

#include <fmt/format.h>

#include <regex>
#include <string>

namespace parallax::test {

/// The text with four digits of each decimal number: the last ones depend on the machine.
inline std::string rounded(const std::string& text) {
  static const std::regex number("-?[0-9]+\\.[0-9]+");
  std::string out;
  auto from = text.begin();
  for (auto it = std::sregex_iterator(text.begin(), text.end(), number);
       it != std::sregex_iterator(); ++it) {
    out.append(from, text.begin() + it->position());
    out += fmt::format("{:.4g}", std::stod(it->str()));
    from = text.begin() + it->position() + it->length();
  }
  return out.append(from, text.end());
}

}  // namespace parallax::test
