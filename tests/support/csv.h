#pragma once

#include <string>
#include <vector>

namespace parallax::test {

/// Fields by line, after RFC 4180; lines end in LF or CRLF.
inline std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  std::vector<std::string> line;
  std::string field;
  bool quoted = false, began = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"') {
        field += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        field += text[++i];
      } else {
        quoted = false;
      }
    } else if (c == '"' && field.empty()) {
      quoted = began = true;
    } else if (c == ',') {
      line.push_back(std::move(field));
      field.clear();
      began = true;
    } else if (c == '\n') {
      line.push_back(std::move(field));
      field.clear();
      lines.push_back(std::move(line));
      line.clear();
      began = false;
    } else if (c != '\r') {
      field += c;
      began = true;
    }
  }
  if (began) {
    line.push_back(std::move(field));
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace parallax::test
