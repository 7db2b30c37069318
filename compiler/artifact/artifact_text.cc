#include "compiler/artifact/artifact_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>

#include "compiler/base/codes/artifacts.h"
#include "compiler/base/whole_number.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kQuoteInMessages = 40;  // bytes of a bad word that a message repeats

bool is_plain(char c) { return c > 0x20 && c < 0x7F && c != '"' && c != '\\'; }

std::optional<char> hex_byte(std::string_view digits) {
  const auto value = base::whole_number<unsigned char>(digits, 16);
  if (digits.size() != 2 || !value) return std::nullopt;
  return static_cast<char>(*value);
}

/// The text between the quotes, or none if an escape is unknown or the closing quote is missing.
std::optional<std::string> unquoted(std::string_view word) {
  std::string out;
  std::size_t i = 1;
  for (; i < word.size() && word[i] != '"'; ++i) {
    if (word[i] != '\\') {
      out += word[i];
    } else if (i + 1 < word.size() && (word[i + 1] == '"' || word[i + 1] == '\\')) {
      out += word[++i];
    } else if (i + 3 < word.size() && word[i + 1] == 'x') {
      const auto byte = hex_byte(word.substr(i + 2, 2));
      if (!byte) return std::nullopt;
      out += *byte;
      i += 3;
    } else {
      return std::nullopt;
    }
  }
  if (i + 1 != word.size()) return std::nullopt;
  return out;
}

constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void LineHash::add(std::string_view line) {
  const bool comment = line.empty() || line == "c" || line.starts_with("c ");
  if ((comment && !line.starts_with("c dec ")) || line.starts_with(kHashEntry)) return;
  value_ = base::fnv1a64(line, value_);
  value_ = base::fnv1a64("\n", value_);
}

void append_word(std::string& out, std::string_view word) {
  out += ' ';
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) {
    out += word;
    return;
  }
  out += '"';
  for (const char c : word) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == ' ' || is_plain(c)) {
      out += c;
    } else {
      fmt::format_to(std::back_inserter(out), "\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  out += '"';
}

ArtifactCursor::ArtifactCursor(const base::SourceFiles& files, base::FileId file,
                               base::DiagnosticSink& sink)
    : text_(files[file].text()), file_(file), sink_(&sink), last_{file, 0, 0} {}

base::SourceRange ArtifactCursor::range(std::size_t begin, std::size_t end) const {
  return {file_, static_cast<std::uint32_t>(line_begin_ + begin),
          static_cast<std::uint32_t>(line_begin_ + end)};
}

base::SourceRange ArtifactCursor::line_range() const { return range(0, line_.size()); }

bool ArtifactCursor::next_line() {
  line_begin_ = next_;
  position_ = 0;
  line_ = {};
  last_ = range(0, 0);
  if (next_ >= text_.size()) return false;
  auto end = text_.find('\n', next_);
  if (end == std::string_view::npos) end = text_.size();
  line_ = text_.substr(next_, end - next_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  next_ = end + 1;
  hash_.add(line_);
  return true;
}

void ArtifactCursor::skip_blanks() {
  while (position_ < line_.size() && line_[position_] == ' ') ++position_;
}

bool ArtifactCursor::at_line_end() {
  skip_blanks();
  return position_ == line_.size();
}

std::string_view ArtifactCursor::raw_word() {
  skip_blanks();
  const auto begin = position_;
  if (begin < line_.size() && line_[begin] == '"') {
    ++position_;
    while (position_ < line_.size() && line_[position_] != '"') {
      position_ += line_[position_] == '\\' ? 2U : 1U;
    }
    position_ = std::min(position_ + 1, line_.size());
  }
  while (position_ < line_.size() && line_[position_] != ' ') ++position_;
  last_ = range(begin, position_);
  return line_.substr(begin, position_ - begin);
}

bool ArtifactCursor::word(std::string_view what, std::string& out) {
  const auto raw = raw_word();
  if (raw.starts_with('"')) {
    auto text = unquoted(raw);
    if (!text) return expected(what);
    out = *std::move(text);
    return true;
  }
  if (raw.empty() || !std::all_of(raw.begin(), raw.end(), is_plain)) return expected(what);
  out = raw;
  return true;
}

bool ArtifactCursor::number(std::string_view what, std::int64_t lower, std::int64_t upper,
                            std::int64_t& out) {
  return parse_number(raw_word(), what, lower, upper, out);
}

bool ArtifactCursor::parse_number(std::string_view text, std::string_view what, std::int64_t lower,
                                  std::int64_t upper, std::int64_t& out) {
  const auto* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, out);
  const bool too_long = error == std::errc::result_out_of_range && stop == end;
  if (!too_long && (error != std::errc() || stop != end)) return expected(what);
  if (too_long || out < lower || out > upper) {
    return fail(codes::kArtifactRange, what, text.substr(0, kQuoteInMessages), lower, upper);
  }
  return true;
}

bool ArtifactCursor::end_of_line() {
  if (at_line_end()) return true;
  raw_word();
  return expected("the end of the line");
}

bool ArtifactCursor::expected(std::string_view what) {
  const auto begin = static_cast<std::size_t>(last_.begin) - line_begin_;
  const auto size = static_cast<std::size_t>(last_.end - last_.begin);
  const auto text = line_.substr(begin, std::min(size, kQuoteInMessages));
  if (text.empty()) {
    const bool at_end = next_ >= text_.size();
    return fail(codes::kArtifactSyntax, what,
                at_end ? "the end of the file" : "the end of the line");
  }
  return fail(codes::kArtifactSyntax, what,
              fmt::format("`{}{}`", text, size > kQuoteInMessages ? "..." : ""));
}

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
    return cursor.fail(codes::kArtifactMissing, "c dec in FILE");
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
