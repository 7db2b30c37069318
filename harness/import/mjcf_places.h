#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "harness/import/mjcf_text.h"

namespace parallax::harness {

/// Where in a vetted text the elements are that became the parts of a model, by their numbers: a
/// model has bodies in the order of the text, and joints and geoms by body.
class MjcfPlaces {
 public:
  explicit MjcfPlaces(const MjcfText& text);

  /// Offsets in ImportInput::text; 0 where it is not known. `part` counts those of the body.
  std::size_t body(std::uint32_t body) const;
  std::size_t joint(std::uint32_t body, std::size_t part) const;
  std::size_t geom(std::uint32_t body, std::size_t part) const;
  /// The first element of this name, or the first in one of this name.
  std::size_t first(const std::string& tag) const;
  /// The first element that begins on a line of the text that the reader saw; with `tag`, the first
  /// such element there, if there is one.
  MjcfText::Place line(std::uint64_t line, const std::string& tag) const;

 private:
  struct Parts {
    std::size_t offset = 0;
    std::vector<std::size_t> joints, geoms;
  };
  std::size_t place(const std::vector<std::size_t>& offsets, std::size_t part) const;

  const MjcfText& text_;
  XmlOutline outline_;
  std::vector<Parts> bodies_;
  std::map<std::string, std::size_t, std::less<>> first_;
};

}  // namespace parallax::harness
