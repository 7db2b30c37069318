#include "runtime/consequences/size_bound.h"

#include <algorithm>
#include <utility>

namespace parallax::runtime {

SizeBound::SizeBound(SolverSession& session, std::vector<Literal> literals, std::size_t largest)
    : session_(session), largest_(largest), outputs_(count(std::move(literals))) {}

/// The count in unary, cut at the largest bound.
std::vector<Literal> SizeBound::count(std::vector<Literal> literals) {
  if (literals.size() <= 1) return literals;
  const auto middle = literals.begin() + static_cast<std::ptrdiff_t>(literals.size() / 2);
  const auto left = count({literals.begin(), middle});
  const auto right = count({middle, literals.end()});
  std::vector<Literal> sum;
  for (std::size_t i = 0; i < std::min(left.size() + right.size(), largest_); ++i) {
    sum.push_back(session_.new_variable());
  }
  // More than i - 1 of the left and more than j - 1 of the right are more than i + j - 1.
  for (std::size_t i = 0; i <= left.size(); ++i) {
    for (std::size_t j = 0; j <= right.size(); ++j) {
      if (i + j == 0 || i + j > sum.size()) continue;
      std::vector<Literal> clause = {sum[i + j - 1]};
      if (i > 0) clause.push_back(~left[i - 1]);
      if (j > 0) clause.push_back(~right[j - 1]);
      session_.add_clause(clause);
    }
  }
  return sum;
}

}  // namespace parallax::runtime
