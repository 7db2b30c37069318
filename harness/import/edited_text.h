#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::harness {

/// A text under way that is put together of pieces of others, and knows where each came from.
class EditedText {
 public:
  /// `source` is the caller's number of the text that `piece` was cut from at `offset`.
  void copy(std::string_view piece, std::size_t source, std::size_t offset);
  /// Puts a piece in the place of the text at `offset`.
  void put(std::string_view piece, std::size_t source, std::size_t offset);

  const std::string& text() const { return text_; }

  struct Origin {
    std::size_t source = 0, offset = 0;
  };
  Origin origin_of(std::size_t offset) const;

 private:
  struct Piece {
    std::size_t begin = 0;  // in text_
    Origin origin;
    bool is_copy = true;
  };
  std::string text_;
  std::vector<Piece> pieces_;
};

}  // namespace parallax::harness
