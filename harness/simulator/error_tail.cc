#include "harness/simulator/error_tail.h"

#include <algorithm>

#include "compiler/base/shown_text.h"

namespace parallax::harness {

std::string error_tail_words(std::string_view tail) {
  while (tail.ends_with('\n')) tail.remove_suffix(1);
  if (tail.empty()) return {};
  std::string out = "; the end of its standard error:";
  for (std::size_t begin = 0; begin <= tail.size();) {
    const auto end = std::min(tail.find('\n', begin), tail.size());
    out += "\n| " + base::printable(tail.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

}  // namespace parallax::harness
