#include "compiler/syntax/foundations.h"

#include <array>

namespace parallax::compiler {
namespace {

// The axioms DEC1 to DEC12 are no text: grounding applies them as rules. What a model may name is
// declared here, so that a redeclaration can point at it.
constexpr std::array<Foundation, 5> kFoundations = {{
    {"foundations/Root.e", R"(; What every model needs.
sort boolean
sort integer
reified sort predicate
reified sort function
)"},
    {"foundations/EC.e", R"(; The event calculus: timepoints, fluents, events and their predicates.
load foundations/Root.e
sort time: integer
sort offset: integer
reified sort fluent
reified sort event
predicate Happens(event,time)
predicate HoldsAt(fluent,time)
predicate ReleasedAt(fluent,time)
predicate Initiates(event,fluent,time)
predicate Terminates(event,fluent,time)
predicate Releases(event,fluent,time)
predicate Trajectory(fluent,time,fluent,offset)
predicate AntiTrajectory(fluent,time,fluent,offset)
)"},
    {"foundations/DEC.e", R"(; The same, with the interval predicates of encoding 3.
load foundations/EC.e
predicate Clipped(time,fluent,time)
predicate Declipped(time,fluent,time)

[time1,fluent,time2]
Clipped(time1,fluent,time2) <->
{event,time} time1<=time & time<time2 & Happens(event,time) & Terminates(event,fluent,time).

[time1,fluent,time2]
Declipped(time1,fluent,time2) <->
{event,time} time1<=time & time<time2 & Happens(event,time) & Initiates(event,fluent,time).
)"},
    {"foundations/ECTraj.e",
     R"(; Trajectories and antitrajectories (DEC3, DEC4) need no text of their own.
load foundations/EC.e
)"},
    {"foundations/ECCausal.e",
     R"(; Causal constraints: what a fluent is made to be at a timepoint by the events there.
load foundations/EC.e
predicate Started(fluent,time)
predicate Stopped(fluent,time)
predicate Initiated(fluent,time)
predicate Terminated(fluent,time)

[fluent,time]
Started(fluent,time) <->
HoldsAt(fluent,time) | ({event} Happens(event,time) & Initiates(event,fluent,time)).

[fluent,time]
Stopped(fluent,time) <->
!HoldsAt(fluent,time) | ({event} Happens(event,time) & Terminates(event,fluent,time)).

[fluent,time]
Initiated(fluent,time) <->
Started(fluent,time) & !({event} Happens(event,time) & Terminates(event,fluent,time)).

[fluent,time]
Terminated(fluent,time) <->
Stopped(fluent,time) & !({event} Happens(event,time) & Initiates(event,fluent,time)).
)"},
}};

}  // namespace

std::span<const Foundation> foundations() { return kFoundations; }

std::optional<Foundation> find_foundation(std::string_view path) {
  for (const auto& foundation : kFoundations) {
    if (foundation.path == path) return foundation;
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
