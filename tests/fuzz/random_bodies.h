#pragma once

#include "tests/support/random_model.h"

namespace parallax::test {

/// A small world of bodies that go from place to place: with preconditions of many forms, which
/// tell where a body is when it goes, exclusions and collisions, doors, starts that are stated or
/// open, releases, triggered events, effects that other axioms mention, completions. The same seed
/// gives the same model.
RandomModel random_bodies(std::uint64_t seed);

}  // namespace parallax::test
