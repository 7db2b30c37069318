#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/import/edited_text.h"
#include "harness/import/import.h"
#include "harness/import/mjcf_module.h"

namespace parallax::harness {

/// A world in MJCF as its reader may see it: one text with everything in it that it includes, which
/// names no file but meshes that were read here, under names of our own. Pictures, skins and height
/// fields are replaced by what does the same in a simulation, or taken out; their files are not
/// opened.
struct MjcfText {
  std::optional<TextFault> fault;   // then the rest says nothing
  std::vector<MjcfFile> files;      // the text, then the meshes
  std::vector<LeftOut> left_out;    // elements that were replaced or removed
  std::vector<std::string> read;    // paths of files that were opened
  std::vector<std::string> absent;  // paths where a file was sought and not found

  /// Where in ImportInput::text that is, or is included; then `inside` says where there, as "in
  /// `parts/arm.xml`, line 3: ".
  struct Place {
    std::size_t offset = 0;
    std::string inside;
  };
  Place place_of(std::size_t offset) const;
  /// The same of an offset in `included`, without `inside`.
  std::size_t place_of_included(std::size_t offset) const;
  /// The reader's message with mesh files named as in the description.
  std::string in_names_given(const std::string& said) const;

  struct Source {
    std::string name;  // as it was included; empty: the file itself
    std::string text;
    std::size_t offset = 0;  // of the including element, in ImportInput::text
  };
  std::deque<Source> sources;                     // which stay where they are
  EditedText included, edited;                    // of the sources, of that text
  std::map<std::string, std::string> mesh_names;  // as given, by those of our own
};

MjcfText vetted_mjcf(const ImportInput& input);

}  // namespace parallax::harness
