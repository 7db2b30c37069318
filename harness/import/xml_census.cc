#include "harness/import/xml_census.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace parallax::harness {
namespace {

/// Calls `visit` with each word, until it says true.
template <typename Visit>
bool any_word(std::string_view words, const Visit& visit) {
  while (!words.empty()) {
    const auto end = std::min(words.find(' '), words.size());
    if (end > 0 && visit(words.substr(0, end))) return true;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return false;
}

bool has_word(std::string_view words, std::string_view word) {
  return any_word(words, [&](std::string_view one) { return one == word; });
}

std::string_view without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// The same text, number or truth value.
bool is_value(std::string_view text, std::string_view value) {
  text = without_blanks(text);
  if (text == value) return true;
  if (value == "true" || value == "false") return text == (value == "true" ? "1" : "0");
  double a = 0.0, b = 0.0;
  const auto all = [](std::string_view word, double& number) {
    const auto read = std::from_chars(word.data(), word.data() + word.size(), number);
    return read.ec == std::errc() && read.ptr == word.data() + word.size();
  };
  return all(text, a) && all(value, b) && a == b;
}

/// Is `name`, or `name=value`, among the words?
bool has_pair(std::string_view words, std::string_view name, std::string_view value) {
  return any_word(words, [&](std::string_view word) {
    const auto equals = word.find('=');
    if (word.substr(0, equals) != name) return false;
    return equals == word.npos || is_value(value, word.substr(equals + 1));
  });
}

enum class Fate : std::uint8_t { kRead, kTold, kLeft };

class Census {
 public:
  Census(const XmlOutline& outline, std::span<const TakenOf> taken,
         const std::function<std::size_t(std::size_t)>& place_of, LeftOutList& left_out)
      : outline_(outline), taken_(taken), place_of_(place_of), left_out_(left_out) {}

  void run() {
    const auto& all = outline_.elements;
    std::size_t past = 0;  // the end of the last element that counts as a whole
    for (std::size_t i = 0; i < all.size(); ++i) {
      const XmlElement& element = all[i];
      if (element.offset < past) continue;
      if (fate_of(i) != Fate::kRead) {
        past = element.end;
        continue;
      }
      const TakenOf* taken = entry_of(element.tag);
      for (const XmlAttribute& attribute : element.attributes) {
        if (attribute.name.starts_with("xmlns")) continue;
        if (taken != nullptr && has_pair(taken->attributes, attribute.name, attribute.value)) {
          continue;
        }
        add(fmt::format("attributes `{}` of <{}>", attribute.name.substr(0, 40),
                        element.tag.substr(0, 40)),
            element);
      }
    }
  }

 private:
  const TakenOf* entry_of(std::string_view tag) const {
    const auto found = std::find_if(taken_.begin(), taken_.end(),
                                    [&](const TakenOf& one) { return one.tag == tag; });
    return found == taken_.end() ? nullptr : &*found;
  }

  Fate fate_of(std::size_t i) {
    const XmlElement& element = outline_.elements[i];
    if (!element.parent) return Fate::kRead;
    const XmlElement& around = outline_.elements[*element.parent];
    if (const TakenOf* taken = entry_of(around.tag)) {
      if (has_word(taken->told, element.tag)) return Fate::kTold;
      if (has_word(taken->often, element.tag)) return Fate::kRead;
      if (has_pair(taken->once, element.tag, element.text) &&
          once_.emplace(*element.parent, element.tag).second) {
        return Fate::kRead;
      }
    }
    add(fmt::format("elements <{}> of <{}>", element.tag.substr(0, 40), around.tag.substr(0, 40)),
        element);
    return Fate::kLeft;
  }

  /// Under the name of the element, or of the nearest one around it that has a name.
  void add(const std::string& what, const XmlElement& element) {
    const XmlElement* named = &element;
    while (named->name.empty() && named->parent) named = &outline_.elements[*named->parent];
    const auto name = named->name.empty() ? named->tag : named->name;
    left_out_.add(what, std::string(name.substr(0, 120)),
                  place_of_ ? place_of_(element.offset) : element.offset);
  }

  const XmlOutline& outline_;
  std::span<const TakenOf> taken_;
  const std::function<std::size_t(std::size_t)>& place_of_;
  LeftOutList& left_out_;
  std::set<std::pair<std::size_t, std::string_view>> once_;
};

}  // namespace

void list_rest(const XmlOutline& outline, std::span<const TakenOf> taken,
               const std::function<std::size_t(std::size_t offset)>& place_of,
               LeftOutList& left_out) {
  Census(outline, taken, place_of, left_out).run();
}

}  // namespace parallax::harness
