#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/id.h"

namespace parallax::base {

struct FileTag {
  static constexpr bool kOrdered = true;  // order of loading
};
using FileId = Id<FileTag>;

/// Half-open byte range [begin, end) in one file.
struct SourceRange {
  FileId file;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  friend bool operator==(const SourceRange&, const SourceRange&) = default;
};

/// 1-based line and column; columns count Unicode code points, a tab is one column.
struct LineColumn {
  std::uint32_t line = 1;
  std::uint32_t column = 1;
  friend bool operator==(const LineColumn&, const LineColumn&) = default;
};

/// One text that was read: its name as the user wrote it, and its bytes.
class SourceFile {
 public:
  SourceFile(std::string name, std::string text);
  const std::string& name() const { return name_; }
  std::string_view text() const { return text_; }
  std::string_view text(const SourceRange& range) const;
  LineColumn position(std::uint32_t byte_offset) const;
  /// The text of a 1-based line, without its line end; empty beyond the last line.
  std::string_view line(std::uint32_t number) const;
  /// Byte offset at which a 1-based line starts (clamped to the end of the text).
  std::uint32_t line_begin(std::uint32_t number) const;

 private:
  std::uint32_t code_points_before(std::uint32_t byte_offset) const;

  std::string name_;
  std::string text_;
  std::vector<std::uint32_t> line_starts_;
  std::vector<std::uint32_t> code_points_before_;  // each block, so that long lines cost nothing
};

/// All texts of one run. Files stay where they are: a view into a text lives as long as the set.
class SourceFiles {
 public:
  FileId add(std::string name, std::string text);
  /// Remembers a file that was read, so that no output replaces it (check_output).
  void note_input(std::string path) { inputs_.push_back(std::move(path)); }
  const std::vector<std::string>& inputs() const { return inputs_; }
  const SourceFile& operator[](FileId id) const;
  std::size_t size() const { return files_.size(); }
  std::string_view text(const SourceRange& range) const { return (*this)[range.file].text(range); }
  /// "name:line" of the start of `range`, for messages that are not diagnostics.
  std::string place(const SourceRange& range) const;

 private:
  std::vector<std::vector<SourceFile>> files_;  // one inner element each: stable addresses
  std::vector<std::string> inputs_;             // paths
};

}  // namespace parallax::base
