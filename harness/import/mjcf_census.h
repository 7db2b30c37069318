#pragma once

#include <cstddef>
#include <functional>

#include "harness/import/description.h"
#include "harness/import/xml_outline.h"

namespace parallax::harness {

/// Lists every element and attribute of a world in MJCF that is neither taken over nor told from
/// what MuJoCo's compiler makes of the file (mjcf_reader.cc, mjcf_import.cc). `outline` is that of
/// the file with its includes; `place_of` maps an offset there to one in the file itself.
void list_unread_mjcf(const XmlOutline& outline,
                      const std::function<std::size_t(std::size_t offset)>& place_of,
                      LeftOutList& left_out);

}  // namespace parallax::harness
