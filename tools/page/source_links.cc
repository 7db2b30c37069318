#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "compiler/base/ground_name.h"
#include "tools/page/markup.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

/// Is one of the names the end of the other one, from a folder on? A run may have been started in
/// another folder than the page is made in.
bool is_same_file(std::string_view a, std::string_view b) {
  if (a.size() < b.size()) std::swap(a, b);
  if (!a.ends_with(b)) return false;
  return a.size() == b.size() || a[a.size() - b.size() - 1] == '/';
}

}  // namespace

SourceLinks::SourceLinks(const PageData& page) : page_(page) {
  for (const auto& source : page.sources) {
    auto& lines = lines_.emplace_back();
    const std::string_view text = source.text;
    for (std::size_t begin = 0; begin < text.size();) {
      const auto end = std::min(text.find('\n', begin), text.size());
      lines.push_back(text.substr(begin, end - begin));
      if (!lines.back().empty() && lines.back().back() == '\r') lines.back().remove_suffix(1);
      begin = end + 1;
    }
  }
  for (const auto& [symbol, axioms] : page.axioms) axioms_[symbol] = axioms;
}

bool SourceLinks::find(const std::string& place, Line& line) const {
  const auto colon = place.rfind(':');
  if (colon == std::string::npos) return false;
  const auto* end = place.data() + place.size();
  if (std::from_chars(place.data() + colon + 1, end, line.number).ptr != end) return false;
  for (line.file = 0; line.file < lines_.size(); ++line.file) {
    if (!is_same_file(page_.sources[line.file].name, std::string_view(place).substr(0, colon))) {
      continue;
    }
    return line.number >= 1 && line.number <= lines_[line.file].size();
  }
  return false;
}

std::string SourceLinks::link(const std::string& place) const {
  Line line;
  if (!find(place, line)) return html_short(place);
  const auto slash = place.rfind('/');
  const auto shown = slash == std::string::npos ? place : place.substr(slash + 1);
  return fmt::format("<a href=\"#s{}-{}\" title=\"{}\">{}</a>", line.file, line.number,
                     html_short(place), html_short(shown));
}

std::string SourceLinks::line_html(const Line& line, bool with_id) const {
  const auto id = with_id ? fmt::format(" id=\"s{}-{}\"", line.file, line.number) : std::string();
  return fmt::format("<span class=\"l\"{}><i>{:>4}</i> {}</span>\n", id, line.number,
                     coloured(lines_[line.file][line.number - 1], page_.sources[line.file].name));
}

std::string SourceLinks::excerpt(const std::string& place, std::size_t around) const {
  Line at;
  if (!find(place, at)) return {};
  const auto first = at.number > around ? at.number - around : 1;
  const auto last = std::min(at.number + around, lines_[at.file].size());
  std::string out =
      fmt::format("<figure class=\"excerpt\"><figcaption>{}</figcaption><pre>", link(place));
  for (auto number = first; number <= last; ++number) {
    const auto text = line_html({at.file, number}, false);
    out += number == at.number ? "<mark>" + text + "</mark>" : text;
  }
  return out + "</pre></figure>\n";
}

const std::vector<PagePlace>& SourceLinks::axioms_of(const std::string& event) const {
  static const std::vector<PagePlace> kNone;
  const auto found = axioms_.find(base::symbol_of(event));
  return found == axioms_.end() ? kNone : found->second;
}

std::string SourceLinks::section() const {
  std::string out;
  for (std::size_t file = 0; file < lines_.size(); ++file) {
    out += fmt::format("<details class=\"source\"><summary>{}</summary><pre tabindex=\"0\">",
                       html_short(page_.sources[file].name));
    for (std::size_t i = 1; i <= lines_[file].size(); ++i) out += line_html({file, i}, true);
    out += "</pre></details>\n";
  }
  return out.empty() ? out : section_of("sources", "Sources", out);
}

}  // namespace parallax::tools
