#pragma once

#include <string>
#include <vector>

#include "harness/draw/projection.h"

namespace parallax::harness {

/// Finds places for the names in one view, so that none lies on another one.
class LabelLayout {
 public:
  explicit LabelLayout(const Rectangle& area) : area_(area) {}

  /// Names are kept off it as long as there is room elsewhere.
  void avoid(const Rectangle& what) { avoided_.push_back(what); }

  /// SVG of the text in or beside what it names, with a line to it where it stands apart. Empty:
  /// there is no room near it.
  std::string place(const std::string& text, const char* colour, const Rectangle& named);

 private:
  bool is_free(const Rectangle& box, bool strict) const;

  Rectangle area_;
  std::vector<Rectangle> texts_, avoided_;
};

}  // namespace parallax::harness
