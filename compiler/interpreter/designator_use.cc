#include "compiler/interpreter/designator_use.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

namespace parallax::compiler {

std::set<std::string, std::less<>> note_designator_use(const LispText& text, PlanCode& code) {
  static constexpr std::string_view kEquate[] = {"equate", "desig-equal"};
  static constexpr std::string_view kDescribe[] = {
      "desig-prop-value", "desig-prop-values", "properties",     "description",
      "copy-designator",  "property",          "def-fact-group", "extend-designator-properties"};
  const auto is_one = [](const auto& names, std::string_view name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
  };
  std::set<std::string, std::less<>> out;
  std::vector<DatumId> open(text.forms.begin(), text.forms.end());
  while (!open.empty()) {
    const auto datum = open.back();
    open.pop_back();
    const auto items = text.data.children(datum);
    if (text.data.head(datum) == "define-condition") continue;
    open.insert(open.end(), items.begin(), items.end());
    if (!text.data.is_symbol(datum)) continue;
    const auto& name = text.data.name(datum);
    out.insert(name);
    code.identities = code.identities || is_one(kEquate, name);
    code.describes = code.describes || code.identities || is_one(kDescribe, name);
  }
  return out;
}

}  // namespace parallax::compiler
