#include <fmt/core.h>

#include "tools/bench/families/families.h"
#include "tools/bench/families/object_names.h"

namespace parallax::tools {

std::string pigeon_model(int pigeons, int holes) {
  constexpr const char* kText = R"(; {0} pigeons come home to {1} holes.

range time 0 1
sort pigeon
pigeon {2}
sort hole
hole {3}

fluent Home(pigeon)
fluent SitsIn(pigeon,hole)
event ComeHome(pigeon)

; Where a pigeon sits is open once it has come home.
[pigeon,time] Initiates(ComeHome(pigeon),Home(pigeon),time).
[pigeon,hole,time] Releases(ComeHome(pigeon),SitsIn(pigeon,hole),time).

[pigeon,time] HoldsAt(Home(pigeon),time) -> ({{hole}} HoldsAt(SitsIn(pigeon,hole),time)).
[pigeon,hole1,hole2,time]
HoldsAt(SitsIn(pigeon,hole1),time) & HoldsAt(SitsIn(pigeon,hole2),time) -> hole1=hole2.
[pigeon1,pigeon2,hole,time]
HoldsAt(SitsIn(pigeon1,hole),time) & HoldsAt(SitsIn(pigeon2,hole),time) -> pigeon1=pigeon2.

[pigeon] !HoldsAt(Home(pigeon),0).
[pigeon,hole] !HoldsAt(SitsIn(pigeon,hole),0).
[pigeon] Happens(ComeHome(pigeon),0).
)";
  return fmt::format(kText, pigeons, holes, numbered_names("Pigeon", pigeons),
                     numbered_names("Hole", holes));
}

}  // namespace parallax::tools
