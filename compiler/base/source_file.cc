#include "compiler/base/source_file.h"

#include <fmt/core.h>

#include <algorithm>

#include "compiler/base/contract.h"
#include "compiler/base/shown_text.h"
#include "compiler/base/utf8.h"

namespace parallax::base {
namespace {

constexpr std::size_t kBlock = 4096;  // bytes; as many are looked through for one position

}  // namespace

SourceFile::SourceFile(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)) {
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') line_starts_.push_back(static_cast<std::uint32_t>(i + 1));
  }
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < text_.size(); i += kBlock) {
    code_points_before_.push_back(count);
    count +=
        static_cast<std::uint32_t>(count_code_points(std::string_view(text_).substr(i, kBlock)));
  }
  code_points_before_.push_back(count);
}

std::uint32_t SourceFile::code_points_before(std::uint32_t byte_offset) const {
  const auto block = byte_offset / kBlock;
  const auto rest = std::string_view(text_).substr(block * kBlock, byte_offset - block * kBlock);
  return code_points_before_[block] + static_cast<std::uint32_t>(count_code_points(rest));
}

std::string_view SourceFile::text(const SourceRange& range) const {
  PARALLAX_REQUIRE(range.begin <= range.end && range.end <= text_.size(),
                   "a range lies inside its file");
  return std::string_view(text_).substr(range.begin, range.end - range.begin);
}

LineColumn SourceFile::position(std::uint32_t byte_offset) const {
  const auto offset = std::min(byte_offset, static_cast<std::uint32_t>(text_.size()));
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const auto line = static_cast<std::uint32_t>(after - line_starts_.begin());
  const auto begin = line_starts_[line - 1];
  // Lines are short as a rule: then only the line is looked through, not the blocks around it.
  const auto before = std::string_view(text_).substr(begin, offset - begin);
  const auto column = before.size() <= kBlock
                          ? static_cast<std::uint32_t>(count_code_points(before))
                          : code_points_before(offset) - code_points_before(begin);
  return {line, 1 + column};
}

std::uint32_t SourceFile::line_begin(std::uint32_t number) const {
  if (number == 0) return 0;
  if (number > line_starts_.size()) return static_cast<std::uint32_t>(text_.size());
  return line_starts_[number - 1];
}

std::string_view SourceFile::line(std::uint32_t number) const {
  if (number == 0 || number > line_starts_.size()) return {};
  const auto begin = line_starts_[number - 1];
  auto end = number < line_starts_.size() ? line_starts_[number] - 1
                                          : static_cast<std::uint32_t>(text_.size());
  if (end > begin && text_[end - 1] == '\r') --end;
  return std::string_view(text_).substr(begin, end - begin);
}

FileId SourceFiles::add(std::string name, std::string text) {
  files_.emplace_back();
  files_.back().emplace_back(std::move(name), std::move(text));
  return FileId(static_cast<std::uint32_t>(files_.size() - 1));
}

const SourceFile& SourceFiles::operator[](FileId id) const {
  PARALLAX_REQUIRE(id.index() < files_.size(), "a FileId comes from this set");
  return files_[id.index()].front();
}

std::string SourceFiles::place(const SourceRange& range) const {
  const auto& file = (*this)[range.file];
  return fmt::format("{}:{}", printable(file.name()), file.position(range.begin).line);
}

}  // namespace parallax::base
