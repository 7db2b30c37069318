#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::test {

/// An element of an XML document, its text with entities resolved.
struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;
  std::string text;  // of the element itself, pieces joined

  /// This element and all below it that have the name, in document order.
  std::vector<const XmlElement*> all(std::string_view wanted) const;
  const std::string& at(const std::string& attribute) const;  // throws where there is none
};

/// The outermost element. Strict where XML 1.0 is, on the part of it that programs write: elements,
/// quoted attributes, the five entities and decimal references, a declaration; no comments, CDATA
/// or DTDs. Throws std::runtime_error with the offset.
XmlElement parse_xml(std::string_view text);

}  // namespace parallax::test
