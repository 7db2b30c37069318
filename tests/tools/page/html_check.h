#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::test {

/// A page as an HTML reader sees it, found out by a separate scanner.
struct HtmlPage {
  std::vector<std::string> faults;  // badly nested, doubtful attributes, links to nowhere
  std::map<std::string, std::size_t> elements;
  std::set<std::string> ids;
  std::string style, script, policy, data, motion;
  std::string text;  // what is shown, a line for each block
};

/// Takes a page apart. Faults are elements that do not nest, unknown ones, attributes `style` and
/// `on...`, `src` and links that are not to an id of the page, and ids that stand twice.
HtmlPage check_html(std::string_view page);

}  // namespace parallax::test
