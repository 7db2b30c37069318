#include "tools/bench/families/tuned.h"

#include <fmt/core.h>

namespace parallax::tools {

std::string numbered_names(std::string_view prefix, int count) {
  std::string names;
  for (int i = 1; i <= count; ++i) {
    names += fmt::format("{}{}{}", i == 1 ? "" : ", ", prefix, i);
  }
  return names;
}

std::string tuned_calculus(int horizon) {
  constexpr const char* kText = R"(% The calculus.
#const horizon = {}.
time(0..horizon).
step(0..horizon-1).
#defined terminates/3.
#defined releases/3.

on(F,T) :- initiates(E,F,T).
off(F,T) :- terminates(E,F,T).
free(F,T) :- releases(E,F,T).
:- on(F,T), off(F,T).
:- on(F,T), free(F,T).
:- off(F,T), free(F,T).

released(F,T+1) :- free(F,T).
released(F,T+1) :- released(F,T), step(T), not on(F,T), not off(F,T).
{{ holds(F,0) }} :- fluent(F).
{{ holds(F,T) }} :- released(F,T).
holds(F,T+1) :- on(F,T).
holds(F,T+1) :- holds(F,T), step(T), not off(F,T), not released(F,T+1).
#show holds/2.
#show happens/2.

% The model.
)";
  return fmt::format(kText, horizon);
}

}  // namespace parallax::tools
