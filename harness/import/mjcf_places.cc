#include "harness/import/mjcf_places.h"

#include <algorithm>
#include <optional>

namespace parallax::harness {

MjcfPlaces::MjcfPlaces(const MjcfText& text)
    : text_(text), outline_(outline_of(text.files.front().bytes)), bodies_(1) {
  std::vector<std::optional<std::size_t>> body_of;  // by element: the body that it is
  std::size_t default_end = 0;                      // end of the elements that only set defaults
  for (const XmlElement& element : outline_.elements) {
    auto& own = body_of.emplace_back();
    if (element.tag == "default") default_end = std::max(default_end, element.end);
    if (element.offset < default_end) continue;
    first_.emplace(element.tag, element.offset);
    if (!element.parent) continue;
    const XmlElement& around = outline_.elements[*element.parent];
    first_.emplace(std::string(around.tag) + "/", element.offset);
    if (element.tag == "worldbody" && !around.parent) own = 0;
    const auto body = body_of[*element.parent];
    if (!body) continue;
    if (element.tag == "body") {
      own = bodies_.size();
      bodies_.push_back({element.offset, {}, {}});
    } else if (element.tag == "joint" || element.tag == "freejoint") {
      bodies_[*body].joints.push_back(element.offset);
    } else if (element.tag == "geom") {
      bodies_[*body].geoms.push_back(element.offset);
    }
  }
}

std::size_t MjcfPlaces::body(std::uint32_t body) const {
  return body < bodies_.size() ? text_.place_of(bodies_[body].offset).offset : 0;
}
std::size_t MjcfPlaces::joint(std::uint32_t body, std::size_t part) const {
  return body < bodies_.size() ? place(bodies_[body].joints, part) : 0;
}
std::size_t MjcfPlaces::geom(std::uint32_t body, std::size_t part) const {
  return body < bodies_.size() ? place(bodies_[body].geoms, part) : 0;
}
std::size_t MjcfPlaces::place(const std::vector<std::size_t>& offsets, std::size_t part) const {
  return part < offsets.size() ? text_.place_of(offsets[part]).offset : 0;
}

std::size_t MjcfPlaces::first(const std::string& tag) const {
  auto found = first_.find(tag + "/");
  if (found == first_.end() || tag == "body") found = first_.find(tag);
  return found == first_.end() ? 0 : text_.place_of(found->second).offset;
}

MjcfText::Place MjcfPlaces::line(std::uint64_t line, const std::string& tag) const {
  if (line == 0) return {};
  const std::string& text = text_.files.front().bytes;
  std::size_t begin = 0;
  for (std::uint64_t i = 1; i < line && begin < text.size(); ++i) {
    begin = std::min(text.find('\n', begin), text.size() - 1) + 1;
  }
  const auto end = std::min(text.find('\n', begin), text.size());
  std::optional<std::size_t> found;
  for (const XmlElement& element : outline_.elements) {
    if (element.offset < begin || element.offset >= end) continue;
    if (element.tag == tag) return text_.place_of(element.offset);
    if (!found) found = element.offset;
  }
  return text_.place_of(found.value_or(begin));
}

}  // namespace parallax::harness
