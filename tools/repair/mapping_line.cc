#include "tools/repair/mapping_line.h"

namespace parallax::tools {
namespace {

struct Line {
  std::size_t begin = 0, end = 0;  // without its line feed
  std::size_t indent = 0;
  bool is_blank = false;
};

Line line_at(std::string_view text, std::size_t at) {
  Line out;
  out.begin = at == 0 ? 0 : text.rfind('\n', at - 1);
  out.begin = at == 0 || out.begin == std::string_view::npos ? 0 : out.begin + 1;
  out.end = std::min(text.find('\n', at), text.size());
  while (out.begin + out.indent < out.end && text[out.begin + out.indent] == ' ') ++out.indent;
  const auto rest = text.substr(out.begin + out.indent, out.end - out.begin - out.indent);
  out.is_blank = rest.empty() || rest == "\r" || rest.front() == '#';
  return out;
}

}  // namespace

std::optional<compiler::TextChange> mapping_line(const harness::FluentBinding& beside,
                                                 const std::string& entry,
                                                 const base::SourceFiles& files) {
  const auto& key = beside.source;
  if (key.end == key.begin) return std::nullopt;
  const auto text = files[key.file].text();
  const auto own = line_at(text, key.begin);
  auto first = own.begin + own.indent;
  if (first < key.begin && (text[first] == '"' || text[first] == '\'')) ++first;
  if (first != key.begin) {
    // Inside braces, in front of the entry.
    auto at = key.begin;
    if (at > 0 && (text[at - 1] == '"' || text[at - 1] == '\'')) --at;
    return compiler::TextChange{key.file, at, at, entry + ", "};
  }
  // Lines that are indented more belong to the entry; blank lines and comments after it do not.
  auto end = own.end;
  for (auto at = own.end; at < text.size();) {
    const auto line = line_at(text, at + 1);
    if (at + 1 >= text.size() || (!line.is_blank && line.indent <= own.indent)) break;
    if (!line.is_blank) end = line.end;
    at = line.end;
  }
  const auto at = static_cast<std::uint32_t>(end);
  const bool returns = end > 0 && text[end - 1] == '\r';
  const auto before = returns ? at - 1 : at;
  return compiler::TextChange{key.file, before, before,
                              (returns ? "\r\n" : "\n") + std::string(own.indent, ' ') + entry};
}

}  // namespace parallax::tools
