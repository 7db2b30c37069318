#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/search/strategy.h"

namespace parallax::harness {

/// The result of a search before the certification.
struct SearchResult {
  SearchSpec spec;
  std::int64_t runs = 0;     // simulated, lost ones included
  std::int64_t invalid = 0;  // points that were no valid starts
  std::int64_t lost = 0;
  /// The sample that came nearest to a discrepancy, and its margin in units of the usual value of
  /// the deciding part. None: no margin changed.
  std::optional<std::int64_t> nearest;
  double margin = 0.0;
  std::string part;  // "BoxIn(r1)"
  /// Parts of margins below zero where everything went as predicted; they were left out.
  std::vector<std::string> contradicting;
  bool found = false;
};

/// "40 simulations by portfolio, nothing found; the nearest was 1.17 (BoxIn(r1))"
std::string search_text(const SearchResult& result, std::int64_t trace);

}  // namespace parallax::harness
