#include "harness/import/edited_text.h"

#include <algorithm>

namespace parallax::harness {

void EditedText::copy(std::string_view piece, std::size_t source, std::size_t offset) {
  if (piece.empty()) return;
  pieces_.push_back({text_.size(), {source, offset}, true});
  text_ += piece;
}

void EditedText::put(std::string_view piece, std::size_t source, std::size_t offset) {
  if (piece.empty()) return;
  pieces_.push_back({text_.size(), {source, offset}, false});
  text_ += piece;
}

EditedText::Origin EditedText::origin_of(std::size_t offset) const {
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), offset,
                                      [](std::size_t at, const Piece& p) { return at < p.begin; });
  if (after == pieces_.begin()) return {};
  const Piece& piece = *std::prev(after);
  Origin origin = piece.origin;
  if (piece.is_copy) origin.offset += offset - piece.begin;
  return origin;
}

}  // namespace parallax::harness
