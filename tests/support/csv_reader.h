#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace parallax::test {

/// Records and fields after RFC 4180: records end with CRLF, quoted fields may hold anything, a
/// quote in them is doubled, quotes stand nowhere else.
inline std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> records(1);
  std::size_t i = 0;
  while (i < text.size()) {
    std::string field;
    if (text[i] == '"') {
      for (++i;; ++i) {
        if (i >= text.size()) throw std::runtime_error("CSV: a quoted field does not end");
        if (text[i] != '"') {
          field += text[i];
        } else if (text.compare(i, 2, "\"\"") == 0) {
          field += text[i++];
        } else {
          break;
        }
      }
      ++i;
    } else {
      while (i < text.size() && text[i] != ',' && text[i] != '\r') {
        if (text[i] == '"' || text[i] == '\n') throw std::runtime_error("CSV: quotes are missing");
        field += text[i++];
      }
    }
    records.back().push_back(field);
    if (text.compare(i, 2, "\r\n") == 0) {
      i += 2;
      if (i < text.size()) records.emplace_back();
    } else if (i < text.size() && text[i] == ',') {
      // A comma at the end of the text would leave a field out.
      if (++i == text.size()) throw std::runtime_error("CSV: the last record does not end");
    } else {
      throw std::runtime_error("CSV: a field ends with a comma or CRLF");
    }
  }
  for (const auto& record : records) {
    if (record.size() != records.front().size()) {
      throw std::runtime_error("CSV: records have equally many fields");
    }
  }
  return records;
}

}  // namespace parallax::test
