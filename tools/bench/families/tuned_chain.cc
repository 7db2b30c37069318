#include <fmt/core.h>

#include "tools/bench/families/tuned.h"

namespace parallax::tools {

std::string tuned_chain(int stages) {
  constexpr const char* kText = R"(fluent(lit(1..{0})).
happens(tick,T) :- step(T).
initiates(tick,lit(S+1),T) :- happens(tick,T), holds(lit(S),T), S < {0}.
:- not holds(lit(1),0).
:- holds(lit({0}),horizon).
)";
  return tuned_calculus(stages - 1) + fmt::format(kText, stages);
}

}  // namespace parallax::tools
