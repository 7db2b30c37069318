#pragma once

#include <optional>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::base {

/// Proof that a diagnostic was reported. Only DiagnosticSink can make one, so a function that
/// returns Result cannot fail without having said why.
class Reported {
 private:
  friend class DiagnosticSink;
  friend class DiagnosticBuilder;
  Reported() = default;
};

/// A value, or the knowledge that an error has been reported. Mirrors std::expected<T, Reported>,
/// which GCC 12 offers from C++23 on only.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}  // NOLINT: implicit as in std::expected
  Result(Reported) {}                            // NOLINT

  bool has_value() const { return value_.has_value(); }
  explicit operator bool() const { return has_value(); }

  T& value() & {
    PARALLAX_REQUIRE(value_.has_value(), "a Result is checked before its value is taken");
    return *value_;
  }
  const T& value() const& {
    PARALLAX_REQUIRE(value_.has_value(), "a Result is checked before its value is taken");
    return *value_;
  }
  T&& value() && {
    PARALLAX_REQUIRE(value_.has_value(), "a Result is checked before its value is taken");
    return std::move(*value_);
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

 private:
  std::optional<T> value_;
};

/// For functions that only succeed or report.
struct Unit {};
using Status = Result<Unit>;

}  // namespace parallax::base
