#include <fmt/core.h>

#include "tools/bench/families/families.h"
#include "tools/bench/families/tuned.h"

namespace parallax::tools {

std::string chain_model(int stages) {
  constexpr const char* kText = R"(; A chain of {0} stages; each tick of a clock lights one more.

range time 0 {1}
sort stage: integer
range stage 1 {0}

fluent Lit(stage)
event Tick()

[stage1,stage2,time]
HoldsAt(Lit(stage1),time) & stage2=stage1+1 -> Initiates(Tick(),Lit(stage2),time).

HoldsAt(Lit(1),0).
[time] time<{1} -> Happens(Tick(),time).

; What is to be inferred, denied.
!HoldsAt(Lit({0}),{1}).
)";
  return fmt::format(kText, stages, stages - 1);
}

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
