#pragma once

#include <optional>

#include "harness/import/xml_outline.h"

namespace parallax::harness {

/// Why the joints of a robot description form no tree: a joint without or with several parents or
/// children, a link that hangs on two joints, a circle of links. liburdfdom leaves some of these
/// unsaid, and then its links own each other in a circle.
std::optional<TextFault> tree_fault(const XmlOutline& outline);

}  // namespace parallax::harness
