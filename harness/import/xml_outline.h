#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::harness {

inline constexpr std::size_t kMaxImportBytes = std::size_t{8} << 20U;
inline constexpr std::size_t kMaxImportDepth = 64;
// The time that libraries take grows with the square of the number of named elements.
inline constexpr std::size_t kMaxImportElements = 30'000;
inline constexpr std::size_t kMaxImportParts = 1'000;

/// As written; the value without its quotes.
struct XmlAttribute {
  std::string_view name, value;
};

struct XmlElement {
  std::string_view tag;
  std::string_view name;              // its attribute of that name, as written
  std::string_view link;              // its attribute of that name, as written
  std::string_view text;              // what is between its tags, as written
  std::size_t offset = 0, end = 0;    // of its tag in the text, and past its end tag
  std::optional<std::size_t> parent;  // number of the element around it
  std::vector<XmlAttribute> attributes = {};

  /// Null where it has none of that name.
  const XmlAttribute* find(std::string_view attribute) const;
};

struct TextFault {
  std::size_t offset = 0;
  std::string message;
};

/// The elements of an XML text in their order, or why no other reader may see it: what is not well
/// formed in a way that readers take differently, document types and entities of its own (which
/// can grow without bound), CDATA, and what is too long, too deep or too many.
struct XmlOutline {
  std::vector<XmlElement> elements;
  std::optional<TextFault> fault;
};
XmlOutline outline_of(std::string_view text);

/// Models, links, joints and frames: at most kMaxImportParts of them are read.
bool is_part(const XmlElement& element);

}  // namespace parallax::harness
