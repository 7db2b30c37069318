#include "tools/bench/reference_work.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <unordered_map>
#include <vector>

namespace parallax::tools {
namespace {

using Random = std::mt19937_64;

/// Random access: three-literal clauses found by the variables that occur in them.
std::uint64_t visit_clauses(Random& random) {
  constexpr std::size_t kVariables = 60'000, kClauses = 250'000, kVisits = 150'000;
  std::vector<std::uint32_t> literals(3 * kClauses);
  std::vector<std::vector<std::uint32_t>> occurrences(kVariables);
  for (std::size_t i = 0; i < literals.size(); ++i) {
    literals[i] = static_cast<std::uint32_t>(random() % kVariables);
    occurrences[literals[i]].push_back(static_cast<std::uint32_t>(i / 3));
  }
  std::vector<std::uint8_t> values(kVariables);
  std::uint64_t satisfied = 0;
  for (std::size_t visit = 0; visit < kVisits; ++visit) {
    const auto variable = random() % kVariables;
    values[variable] ^= 1U;
    for (const auto clause : occurrences[variable]) {
      const auto* first = &literals[3 * std::size_t{clause}];
      satisfied += values[first[0]] | values[first[1]] | values[first[2]];
    }
  }
  return satisfied;
}

/// Short texts built, hashed and looked up.
std::uint64_t hash_texts(Random& random) {
  std::unordered_map<std::string, std::uint64_t> numbers;
  std::uint64_t sum = 0;
  for (int i = 0; i < 250'000; ++i) {
    auto text = "HoldsAt(Fluent(" + std::to_string(random() % 40'000) + "),time)";
    sum += ++numbers[std::move(text)];
  }
  return sum + numbers.size();
}

std::uint64_t sort_numbers(Random& random) {
  std::vector<std::uint64_t> numbers(500'000);
  for (auto& number : numbers) number = random();
  std::sort(numbers.begin(), numbers.end());
  return std::accumulate(numbers.begin(), numbers.end(), std::uint64_t{0},
                         [](auto sum, auto next) { return 3 * sum + next; });
}

/// Dense floating point, as in a solver of contacts.
std::uint64_t relax_rows() {
  constexpr std::size_t kRows = 120;
  std::vector<double> matrix(kRows * kRows), solution(kRows);
  for (std::size_t i = 0; i < matrix.size(); ++i) matrix[i] = 1.0 / static_cast<double>(i % 97 + 2);
  for (int round = 0; round < 1'500; ++round) {
    for (std::size_t row = 0; row < kRows; ++row) {
      const auto sum =
          std::inner_product(solution.begin(), solution.end(),
                             matrix.begin() + static_cast<std::ptrdiff_t>(row * kRows), 0.0);
      solution[row] = 0.5 * solution[row] + 0.5 * std::sin(sum);
    }
  }
  return static_cast<std::uint64_t>(1e6 * std::abs(solution[kRows / 2]));
}

}  // namespace

std::uint64_t reference_work() {
  Random random(20050101);
  return visit_clauses(random) ^ hash_texts(random) ^ sort_numbers(random) ^ relax_rows();
}

}  // namespace parallax::tools
