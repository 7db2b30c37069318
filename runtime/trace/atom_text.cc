#include "runtime/trace/atom_text.h"

namespace parallax::runtime {

std::optional<AtomText> split_atom(std::string_view atom) {
  const auto open = atom.find('(');
  if (open == std::string_view::npos || open == 0 || !atom.ends_with(')')) return std::nullopt;
  AtomText parts;
  parts.symbol = atom.substr(0, open);
  const auto inside = atom.substr(open + 1, atom.size() - open - 2);
  if (inside.empty()) return parts;
  std::size_t depth = 0, begin = 0;
  for (std::size_t i = 0; i <= inside.size(); ++i) {
    const char c = i < inside.size() ? inside[i] : ',';
    if (c == '(') ++depth;
    if (c == ')' && depth-- == 0) return std::nullopt;
    if (c != ',' || (depth > 0 && i < inside.size())) continue;
    if (depth > 0 || i == begin) return std::nullopt;
    parts.arguments.emplace_back(inside.substr(begin, i - begin));
    begin = i + 1;
  }
  return parts;
}

std::string join_atom(const AtomText& parts) {
  std::string out = parts.symbol + '(';
  for (std::size_t i = 0; i < parts.arguments.size(); ++i) {
    if (i > 0) out += ',';
    out += parts.arguments[i];
  }
  return out + ')';
}

}  // namespace parallax::runtime
