#pragma once

#include <algorithm>
#include <cstdint>

namespace parallax::runtime {

/// What the solver may spend on making sets smaller, in conflicts, so that the same is reached on
/// every machine. One question gets at most a tenth of it.
class Effort {
 public:
  explicit Effort(std::int64_t conflicts)
      : left_(conflicts), share_(std::max<std::int64_t>(conflicts / 10, 1)) {}

  bool is_spent() const { return left_ <= 0; }
  /// Of the next question.
  std::int64_t share() const { return std::min(left_, share_); }
  /// Every question counts, however easy it was.
  void spend(std::int64_t conflicts) { left_ -= conflicts + 1; }

 private:
  std::int64_t left_, share_;
};

}  // namespace parallax::runtime
