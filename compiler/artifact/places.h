#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "compiler/artifact/artifact_text.h"
#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {

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
