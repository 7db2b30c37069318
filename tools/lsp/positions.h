#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools::lsp {

/// A place as editors count it: from 0, columns in UTF-16 units or, where both sides agreed on it,
/// in bytes.
struct EditorPlace {
  std::int64_t line = 0, column = 0;
  friend bool operator==(const EditorPlace&, const EditorPlace&) = default;
};

enum class ColumnUnit : std::uint8_t { kUtf16, kByte };

/// Places in one text, which outlives it.
class Positions {
 public:
  Positions(std::string_view text, ColumnUnit unit);
  /// A place beyond the end of its line is the line's end, one beyond the last line the end of the
  /// text.
  std::size_t offset(const EditorPlace& place) const;
  EditorPlace place(std::size_t offset) const;
  std::size_t lines() const { return starts_.size(); }

 private:
  std::string_view line(std::size_t number) const;

  std::string_view text_;
  ColumnUnit unit_;
  std::vector<std::size_t> starts_;
};

/// The path of a `file:` address; empty for any other. Escapes (%20), `.` and `..` are
/// resolved.
std::string path_of_uri(std::string_view uri);
std::string uri_of_path(std::string_view path);

}  // namespace parallax::tools::lsp
