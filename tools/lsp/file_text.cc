// Lines and comments of the texts that an editor shows, found without parsing them.

#include "tools/lsp/file_text.h"

#include <vector>

namespace parallax::tools::lsp {

std::string_view without_comment(std::string_view line, bool yaml) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (!yaml && line[i] == ';') return line.substr(0, i);
    if (yaml && line[i] == '#' && (i == 0 || line[i - 1] == ' ')) return line.substr(0, i);
  }
  return line;
}

std::string comment_above(std::string_view text, std::size_t offset) {
  std::vector<std::string_view> lines;
  auto begin = text.rfind('\n', offset == 0 ? 0 : offset - 1);
  begin = begin == std::string_view::npos ? 0 : begin + 1;
  while (begin > 0) {
    const auto before = text.rfind('\n', begin - 2);
    const auto from = begin < 2 || before == std::string_view::npos ? 0 : before + 1;
    auto line = text.substr(from, begin - 1 - from);
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.front())) != 0)
      line.remove_prefix(1);
    if (!line.starts_with(';')) break;
    while (line.starts_with(';') || line.starts_with(' ')) line.remove_prefix(1);
    lines.push_back(line);
    begin = from;
  }
  std::string out;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line)
    out += std::string(out.empty() ? "" : "\n") + std::string(*line);
  return out;
}

}  // namespace parallax::tools::lsp
