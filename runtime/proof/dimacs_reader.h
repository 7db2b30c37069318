#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <vector>

namespace parallax::runtime {

/// Reads the clauses of a DIMACS file one after the other; comments may stand anywhere between
/// them. Memory is one line.
class DimacsReader {
 public:
  /// `in` outlives the reader.
  explicit DimacsReader(std::istream& in) : in_(in) {}

  /// Reads up to the `p cnf` line. False: `problem()` says what is wrong.
  bool read_header();
  std::int64_t variables() const { return variables_; }

  enum class Outcome : std::uint8_t { kClause, kEnd, kMalformed };
  /// kEnd after as many clauses as the header promised, and nothing else.
  Outcome next(std::vector<std::int64_t>& clause);
  /// "line 7: `x` is no literal"
  std::string problem() const;

 private:
  bool next_line();
  bool next_word(std::string& word);
  bool number(const std::string& word, std::int64_t lower, std::int64_t upper, std::int64_t& value);
  bool fail(std::string problem);

  std::istream& in_;
  std::string line_;
  std::size_t position_ = 0;
  std::int64_t line_number_ = 0;
  std::int64_t variables_ = 0, promised_ = 0, found_ = 0;
  std::string problem_;
};

}  // namespace parallax::runtime
