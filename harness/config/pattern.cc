#include <algorithm>

#include "compiler/base/ascii.h"
#include "compiler/base/diagnostic_codes.h"
#include "harness/config/sections.h"

namespace parallax::harness {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<SymbolPattern> parse_pattern(std::string_view text) {
  SymbolPattern pattern;
  const auto open = text.find('(');
  const auto symbol = trimmed(text.substr(0, open));
  if (!base::is_identifier(symbol)) return std::nullopt;
  pattern.symbol = std::string(symbol);
  if (open == std::string_view::npos) return pattern;
  text = trimmed(text.substr(open));
  if (text.size() < 2 || text.back() != ')') return std::nullopt;
  auto rest = trimmed(text.substr(1, text.size() - 2));
  while (!rest.empty()) {
    const auto comma = rest.find(',');
    const auto word = trimmed(rest.substr(0, comma));
    if (!base::is_identifier(word)) return std::nullopt;
    const auto& known = pattern.parameters;
    if (std::find(known.begin(), known.end(), word) != known.end()) return std::nullopt;
    pattern.parameters.emplace_back(word);
    if (comma == std::string_view::npos) return pattern;
    rest = trimmed(rest.substr(comma + 1));
    if (rest.empty()) return std::nullopt;  // a comma at the end
  }
  return pattern;
}

std::string with_positions(const std::string& text, const SymbolPattern& pattern,
                           base::SourceRange range, base::DiagnosticSink& sink) {
  std::string out;
  std::size_t at = 0;
  for (;;) {
    const auto open = text.find('{', at);
    const auto close = open == std::string::npos ? open : text.find('}', open);
    if (close == std::string::npos) return out + text.substr(at);
    const auto name = text.substr(open + 1, close - open - 1);
    const auto& names = pattern.parameters;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      auto error =
          sink.error(base::DiagnosticCode::kUnknownPatternParameter, range, name, pattern.symbol);
      add_suggestion(error, name, names, "parameters");
    }
    out += text.substr(at, open - at) + '{' + std::to_string(found - names.begin()) + '}';
    at = close + 1;
  }
}

}  // namespace parallax::harness
