#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/diagnostic.h"
#include "compiler/base/hash.h"
#include "compiler/base/source_file.h"

namespace parallax::compiler {

inline constexpr std::int64_t kFormatMajor = 1;
inline constexpr std::int64_t kFormatMinor = 1;

/// Appends a blank and the word. A word of visible ASCII characters other than `"` and `\` is
/// written as it is; any other is quoted, with `\"`, `\\` and `\xHH` for bytes that are not visible
/// ASCII.
void append_word(std::string& out, std::string_view word);

/// Hash of an artifact's lines: entries, header and clauses, in order; other comments, the
/// projection, and the line that holds the hash do not count.
class LineHash {
 public:
  void add(std::string_view line);
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = base::kFnvStart;
};
inline constexpr std::string_view kHashEntry = "c dec hash ";

/// Reads the lines of an artifact and their words, and reports errors at their place. Lines end
/// with a newline (a carriage return before it is dropped), words are separated by blanks.
/// Functions that return bool report and return false.
class ArtifactCursor {
 public:
  /// `files` and `sink` outlive the cursor.
  ArtifactCursor(const base::SourceFiles& files, base::FileId file, base::DiagnosticSink& sink);

  /// False at the end of the file; nothing is reported.
  bool next_line();
  std::string_view line() const { return line_; }
  /// Bytes of the whole file.
  std::size_t file_size() const { return text_.size(); }
  /// Hash of the lines up to the current one.
  std::uint64_t hash() const { return hash_.value(); }

  /// The next word as it stands, without unquoting; empty at the end of the line.
  std::string_view raw_word();
  bool at_line_end();
  /// A word, unquoted. `what` names the expected word in the error: "a name".
  bool word(std::string_view what, std::string& out);
  /// A decimal number with an optional minus. E6003 if it is not a number, E6006 beyond the bounds.
  bool number(std::string_view what, std::int64_t lower, std::int64_t upper, std::int64_t& out);
  bool parse_number(std::string_view text, std::string_view what, std::int64_t lower,
                    std::int64_t upper, std::int64_t& out);
  bool end_of_line();

  /// Reports E6003 at the word read last; always false.
  bool expected(std::string_view what);
  template <typename... Args>
  bool fail(base::DiagnosticCode code, const Args&... args) {
    sink_->error(code, last_, args...);
    return false;
  }
  template <typename... Args>
  void warn(base::DiagnosticCode code, const Args&... args) {
    sink_->warning(code, last_, args...);
  }
  /// The range of the word read last, or of the line's end.
  base::SourceRange last() const { return last_; }
  base::SourceRange line_range() const;
  base::DiagnosticSink& sink() { return *sink_; }

 private:
  void skip_blanks();
  base::SourceRange range(std::size_t begin, std::size_t end) const;

  std::string_view text_;
  base::FileId file_;
  base::DiagnosticSink* sink_;
  std::size_t next_ = 0;        // where the next line begins
  std::size_t line_begin_ = 0;  // of the current line
  std::string_view line_;
  LineHash hash_;
  std::size_t position_ = 0;  // in the line
  base::SourceRange last_;
};

/// Places are written relative to the place written before in the same file, so that a line which
/// is inserted into a text changes one place: `+3:1-0:40` begins three lines further down in column
/// 1 and ends in the same line before column 40. The file stands in a line of its own, `c dec in
/// FILE`, that counts until the next one.
class PlaceWriter {
 public:
  /// Writes a line if the place is in another file than the last one.
  void write_file(const TextPlace& place, std::string& out);
  void write_place(const TextPlace& place, std::string& out);

 private:
  bool any_ = false;
  std::string file_;
  std::map<std::string, std::uint32_t, std::less<>> last_lines_;  // by file; none: 0
};

class PlaceReader {
 public:
  /// The rest of a line `c dec in`.
  bool read_file(ArtifactCursor& cursor);
  bool read_place(ArtifactCursor& cursor, TextPlace& place);

 private:
  bool any_ = false;
  std::string file_;
  std::map<std::string, std::uint32_t, std::less<>> last_lines_;
};

}  // namespace parallax::compiler
