#include "compiler/artifact/places.h"

#include <fmt/format.h>

#include <iterator>
#include <limits>

#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {
namespace {

constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void PlaceWriter::write_file(const TextPlace& place, std::string& out) {
  if (any_ && file_ == place.file) return;
  any_ = true;
  file_ = place.file;
  out += "c dec in";
  append_word(out, file_);
  out += '\n';
}

void PlaceWriter::write_place(const TextPlace& place, std::string& out) {
  PARALLAX_REQUIRE(any_ && file_ == place.file, "the file is written before its places");
  PARALLAX_REQUIRE(place.begin.line <= place.end.line, "a place begins before it ends");
  auto& last = last_lines_[file_];
  fmt::format_to(std::back_inserter(out), " {:+}:{}-{}:{}",
                 std::int64_t{place.begin.line} - std::int64_t{last}, place.begin.column,
                 place.end.line - place.begin.line, place.end.column);
  last = place.begin.line;
}

bool PlaceReader::read_file(ArtifactCursor& cursor) {
  any_ = cursor.word("the name of a file", file_);
  return any_ && cursor.end_of_line();
}

bool PlaceReader::read_place(ArtifactCursor& cursor, TextPlace& place) {
  const auto text = cursor.raw_word();
  if (!any_) {
    return cursor.fail(base::DiagnosticCode::kArtifactMissing, "c dec in FILE");
  }
  const auto colon = text.find(':');
  const auto dash = text.find('-', colon == std::string_view::npos ? 0 : colon);
  const auto second = text.find(':', dash == std::string_view::npos ? text.size() : dash);
  const bool is_signed = text.starts_with('+') || text.starts_with('-');
  if (!is_signed || second == std::string_view::npos) return cursor.expected("a place");
  // from_chars knows no plus sign.
  const std::size_t digits = text.starts_with('+') ? 1 : 0;
  auto& last = last_lines_[file_];
  std::int64_t down = 0, begin = 0, lines = 0, end = 0;
  if (!cursor.parse_number(text.substr(digits, colon - digits), "a distance of lines",
                           1 - std::int64_t{last}, kMost - last, down) ||
      !cursor.parse_number(text.substr(colon + 1, dash - colon - 1), "a column", 1, kMost, begin)) {
    return false;
  }
  const auto line = std::int64_t{last} + down;
  if (!cursor.parse_number(text.substr(dash + 1, second - dash - 1), "a number of lines", 0,
                           kMost - line, lines) ||
      !cursor.parse_number(text.substr(second + 1), "a column", 1, kMost, end)) {
    return false;
  }
  last = static_cast<std::uint32_t>(line);
  place.file = file_;
  place.begin = {last, static_cast<std::uint32_t>(begin)};
  place.end = {static_cast<std::uint32_t>(line + lines), static_cast<std::uint32_t>(end)};
  return true;
}

}  // namespace parallax::compiler
