#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "harness/import/description.h"
#include "harness/import/xml_outline.h"

namespace parallax::harness {

/// The attributes and children that a reader takes over for one tag. Words are separated by blanks.
struct TakenOf {
  std::string_view tag;
  std::string_view attributes;
  /// Elements in it that are read once; `TAG=VALUE` is read too, as long as it has this value,
  /// which changes nothing.
  std::string_view once = {};
  std::string_view often = {};  // elements in it of which each is read
  std::string_view told = {};   // elements that the reader itself lists, with all that is in them
};

/// Lists every element and attribute that no entry of `taken` says is read: unknown ones, rare
/// ones, and second ones where one is read. `place` is that of all of them, where the outline is
/// of another file than the one that is imported.
void list_rest(const XmlOutline& outline, std::span<const TakenOf> taken,
               std::optional<std::size_t> place, LeftOutList& left_out);

}  // namespace parallax::harness
