#pragma once

#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace parallax::test {

inline bool holds_text(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The rows of a body in an export: time, x, y, z.
inline std::vector<std::array<double, 4>> rows_of(const std::string& csv, const std::string& body) {
  std::vector<std::array<double, 4>> out;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string time, name, x, y, z;
    std::getline(fields, time, ',');
    std::getline(fields, name, ',');
    std::getline(fields, x, ',');
    std::getline(fields, y, ',');
    std::getline(fields, z, ',');
    if (name == body) out.push_back({std::stod(time), std::stod(x), std::stod(y), std::stod(z)});
  }
  return out;
}

}  // namespace parallax::test
