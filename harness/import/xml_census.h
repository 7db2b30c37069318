#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

#include "harness/import/description.h"
#include "harness/import/xml_outline.h"

namespace parallax::harness {

/// The attributes and children that a reader takes over for one tag. Words are separated by blanks.
struct TakenOf {
  std::string_view tag;
  /// `NAME=VALUE` is read too, as long as it has this value, which changes nothing; so for `once`.
  std::string_view attributes;
  /// Elements in it that are read once.
  std::string_view once = {};
  std::string_view often = {};  // elements in it of which each is read
  std::string_view told = {};   // elements that the reader itself lists, with all that is in them
};

/// Lists every element and attribute that no entry of `taken` says is read: unknown ones, rare
/// ones, and second ones where one is read. `place_of` maps an offset in the outline's text to one
/// in the file that is imported; without it they are the same.
void list_rest(const XmlOutline& outline, std::span<const TakenOf> taken,
               const std::function<std::size_t(std::size_t offset)>& place_of,
               LeftOutList& left_out);

}  // namespace parallax::harness
