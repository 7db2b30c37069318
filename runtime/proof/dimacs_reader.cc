#include "runtime/proof/dimacs_reader.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "runtime/proof/proof_literal.h"

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
    while (!next_word(word)) {
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

}  // namespace parallax::runtime
