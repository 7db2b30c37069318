#pragma once

#include <stdexcept>

namespace parallax::base {

/// The programmer broke a promise. Nobody catches this except `main`, which exits with 5.
class ContractViolation : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void contract_violated(const char* condition, const char* owed, const char* file,
                                    int line);

}  // namespace parallax::base

/// Always on, at public boundaries; `owed` names the caller's obligation.
#define PARALLAX_REQUIRE(condition, owed) \
  ((condition) ? void(0)                  \
               : ::parallax::base::contract_violated(#condition, owed, __FILE__, __LINE__))

/// Debug builds only, for use inside loops.
#ifdef NDEBUG
#define PARALLAX_ASSERT(condition) void(0)
#else
#define PARALLAX_ASSERT(condition) PARALLAX_REQUIRE(condition, "an internal invariant")
#endif
