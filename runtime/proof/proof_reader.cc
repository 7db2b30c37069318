#include "runtime/proof/proof_reader.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <utility>

#include "runtime/proof/proof_clauses.h"

namespace parallax::runtime {

bool DimacsReader::fail(std::string problem) {
  problem_ = std::move(problem);
  return false;
}

std::string DimacsReader::problem() const {
  return "line " + std::to_string(line_number_) + ": " + problem_;
}

bool DimacsReader::next_line() {
  while (std::getline(in_, line_)) {
    ++line_number_;
    position_ = 0;
    if (!line_.starts_with('c')) return true;
  }
  return false;
}

bool DimacsReader::next_word(std::string& word) {
  constexpr const char* kBlanks = " \t\r";
  const auto begin = line_.find_first_not_of(kBlanks, position_);
  if (begin == std::string::npos) return false;
  position_ = std::min(line_.find_first_of(kBlanks, begin), line_.size());
  word = line_.substr(begin, position_ - begin);
  return true;
}

/// The next word, if it is a literal and not the last word of its line; else nothing is read.
std::optional<std::int64_t> DimacsReader::plain_literal() {
  const auto* end = line_.data() + line_.size();
  const auto* begin = line_.data() + std::min(position_, line_.size());
  if (begin != end && *begin == ' ') ++begin;
  std::int64_t literal = 0;
  const auto [stop, error] = std::from_chars(begin, end, literal);
  if (error != std::errc() || stop == end || *stop != ' ' || literal == 0 ||
      literal < -variables_ || literal > variables_) {
    return std::nullopt;
  }
  position_ = static_cast<std::size_t>(stop - line_.data()) + 1;
  return literal;
}

bool DimacsReader::number(const std::string& word, std::int64_t lower, std::int64_t upper,
                          std::int64_t& value) {
  const auto* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  const bool fine = error == std::errc() && stop == end && value >= lower && value <= upper;
  return fine || fail("`" + word + "` is no whole number from " + std::to_string(lower) + " to " +
                      std::to_string(upper));
}

bool DimacsReader::read_header() {
  std::string word;
  do {
    if (!next_line()) return fail("the file has no line `p cnf`");
  } while (!next_word(word));
  std::string format;
  if (word != "p" || !next_word(format) || format != "cnf") return fail("expected `p cnf`");
  if (!next_word(word) || !number(word, 0, proof_literal::kMaxVariable, variables_)) return false;
  return next_word(word) && number(word, 0, INT64_MAX, promised_);
}

DimacsReader::Outcome DimacsReader::next(std::vector<std::int64_t>& clause) {
  clause.clear();
  std::string word;
  while (true) {
    // Nearly every word is a literal with a blank behind it.
    while (const auto literal = plain_literal()) clause.push_back(*literal);
    if (!next_word(word)) {
      if (next_line()) continue;
      if (clause.empty() && found_ == promised_) return Outcome::kEnd;
      fail("the file ends after " + std::to_string(found_) + " of " + std::to_string(promised_) +
           " clauses");
      return Outcome::kMalformed;
    }
    std::int64_t literal = 0;
    if (!number(word, -variables_, variables_, literal)) return Outcome::kMalformed;
    if (literal != 0) {
      clause.push_back(literal);
      continue;
    }
    if (found_++ < promised_) return Outcome::kClause;
    fail("there are more clauses than the header says");
    return Outcome::kMalformed;
  }
}

namespace {

constexpr int kEndOfFile = -1;
constexpr std::size_t kBufferBytes = std::size_t{1} << 16U;
constexpr std::size_t kMaxWord = 20;  // longer than any literal

bool is_blank(int c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

DratReader::DratReader(std::istream& in, DratFormat format, std::int64_t max_variable)
    : in_(in), format_(format), max_variable_(max_variable), buffer_(kBufferBytes) {}

int DratReader::get() {
  if (next_ == filled_) {
    in_.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    filled_ = static_cast<std::size_t>(in_.gcount());
    next_ = 0;
    if (filled_ == 0) return kEndOfFile;
  }
  ++offset_;
  return static_cast<unsigned char>(buffer_[next_++]);
}

DratReader::Outcome DratReader::fail(std::string problem) {
  problem_ = std::move(problem);
  return Outcome::kMalformed;
}

DratReader::Outcome DratReader::next(DratStep& step) {
  step.deletes = false;
  step.clause.clear();
  const auto outcome = format_ == DratFormat::kBinary ? next_binary(step) : next_text(step);
  if (outcome == Outcome::kStep) ++steps_;
  if (outcome == Outcome::kEnd && in_.bad()) return fail("the file cannot be read");
  return outcome;
}

bool DratReader::take(std::int64_t literal, DratStep& step) {
  if (std::abs(literal) > max_variable_) {
    problem_ = "the variable " + std::to_string(std::abs(literal)) + " is beyond " +
               std::to_string(max_variable_);
    return false;
  }
  if (static_cast<std::int64_t>(step.clause.size()) >= 2 * max_variable_) {
    problem_ = "a clause has more literals than there are";
    return false;
  }
  step.clause.push_back(literal);
  return true;
}

/// A number of at most 32 bits in groups of 7, without idle groups.
bool DratReader::read_number(std::int64_t& value) {
  constexpr int kMaxShift = 28;
  std::uint64_t number = 0;
  for (int shift = 0;; shift += 7) {
    const int byte = get();
    if (byte == kEndOfFile) {
      problem_ = "the file ends within a clause";
      return false;
    }
    number |= static_cast<std::uint64_t>(byte & 0x7F) << static_cast<unsigned>(shift);
    if ((byte & 0x80) == 0) {
      const bool idle = shift > 0 && byte == 0;
      if (idle) problem_ = "a number is longer than it need be";
      value = static_cast<std::int64_t>(number);
      return !idle;
    }
    if (shift == kMaxShift) {
      problem_ = "a number is too large";
      return false;
    }
  }
}

DratReader::Outcome DratReader::next_binary(DratStep& step) {
  const int first = get();
  if (first == kEndOfFile) return Outcome::kEnd;
  if (first != 'a' && first != 'd') return fail("a step begins with neither `a` nor `d`");
  step.deletes = first == 'd';
  while (true) {
    std::int64_t number = 0;
    if (!read_number(number)) return Outcome::kMalformed;
    if (number == 0) return Outcome::kStep;
    if (number == 1) return fail("1 is no literal");
    if (!take(number % 2 == 0 ? number / 2 : -(number / 2), step)) return Outcome::kMalformed;
  }
}

/// The next word, and the blank after it. False at the end of the file.
bool DratReader::read_word(std::string& word) {
  word.clear();
  int c = get();
  while (is_blank(c)) c = get();
  while (c != kEndOfFile && !is_blank(c) && word.size() < kMaxWord) {
    word += static_cast<char>(c);
    c = get();
  }
  return !word.empty();
}

DratReader::Outcome DratReader::next_text(DratStep& step) {
  std::string word;
  if (!read_word(word)) return Outcome::kEnd;
  step.deletes = word == "d";
  if (step.deletes && !read_word(word)) return fail("the file ends within a clause");
  while (true) {
    std::int64_t literal = 0;
    const auto* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, literal);
    if (error != std::errc() || stop != end) return fail("`" + word + "` is no literal");
    if (literal == 0) return Outcome::kStep;
    if (!take(literal, step)) return Outcome::kMalformed;
    if (!read_word(word)) return fail("the file ends within a clause");
  }
}

}  // namespace parallax::runtime
