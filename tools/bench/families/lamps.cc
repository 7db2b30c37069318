#include <fmt/core.h>

#include "tools/bench/families/families.h"
#include "tools/bench/families/object_names.h"

namespace parallax::tools {

std::string lamps_model(int lamps, int horizon) {
  constexpr const char* kText = R"(; {0} lamps with a switch each, {1} steps.

range time 0 {1}
sort lamp
lamp {2}

fluent Lit(lamp)
event Flip(lamp)

[lamp,time] !HoldsAt(Lit(lamp),time) -> Initiates(Flip(lamp),Lit(lamp),time).
[lamp,time] HoldsAt(Lit(lamp),time) -> Terminates(Flip(lamp),Lit(lamp),time).

[lamp] !HoldsAt(Lit(lamp),0).
[lamp] HoldsAt(Lit(lamp),{1}).
)";
  return fmt::format(kText, lamps, horizon, numbered_names("Lamp", lamps));
}

std::string distant_model(int lamps, int horizon) {
  return lamps_model(lamps, horizon) +
         fmt::format("\n[lamp] Happens(Flip(lamp),0) -> !Happens(Flip(lamp),{}).\n", horizon - 1);
}

}  // namespace parallax::tools
