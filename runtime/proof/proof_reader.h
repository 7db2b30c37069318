#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

namespace parallax::runtime {

/// Reads the clauses of a DIMACS file one after the other; comments may stand anywhere between
/// them. Memory is one line.
class DimacsReader {
 public:
  /// `in` outlives the reader.
  explicit DimacsReader(std::istream& in) : in_(in) {}

  /// Reads up to the `p cnf` line. False: `problem()` describes the error.
  bool read_header();
  std::int64_t variables() const { return variables_; }

  enum class Outcome : std::uint8_t { kClause, kEnd, kMalformed };
  /// kEnd after as many clauses as the header promised, and nothing else.
  Outcome next(std::vector<std::int64_t>& clause);
  /// "line 7: `x` is no literal"
  std::string problem() const;

 private:
  bool next_line();
  std::optional<std::int64_t> plain_literal();
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

/// Format of a DRAT file. The file does not state it; its writer knows.
enum class DratFormat : std::uint8_t {
  kBinary,  // `a` or `d`, literals as 2v or 2v + 1 in groups of 7 bits, low group first; 0 ends
  kText     // a clause a line, `d` before what is deleted; 0 ends
};

struct DratStep {
  bool deletes = false;
  std::vector<std::int64_t> clause;  // DIMACS literals
};

/// Reads the steps of a proof one after the other; memory is one step.
class DratReader {
 public:
  /// `in` outlives the reader. Literals of variables beyond `max_variable` are refused, and clauses
  /// with more literals than there are.
  DratReader(std::istream& in, DratFormat format, std::int64_t max_variable);

  enum class Outcome : std::uint8_t { kStep, kEnd, kMalformed };
  Outcome next(DratStep& step);
  /// Description of the error, after kMalformed.
  const std::string& problem() const { return problem_; }
  /// Bytes that were read, and steps.
  std::int64_t offset() const { return offset_; }
  std::int64_t steps() const { return steps_; }

 private:
  int get();
  Outcome fail(std::string problem);
  Outcome next_binary(DratStep& step);
  Outcome next_text(DratStep& step);
  bool read_number(std::int64_t& value);
  bool read_word(std::string& word);
  bool take(std::int64_t literal, DratStep& step);

  std::istream& in_;
  DratFormat format_;
  std::int64_t max_variable_;
  std::vector<char> buffer_;
  std::size_t next_ = 0, filled_ = 0;
  std::int64_t offset_ = 0, steps_ = 0;
  std::string problem_;
};

}  // namespace parallax::runtime
