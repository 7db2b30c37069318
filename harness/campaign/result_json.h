#pragma once

#include <string>

#include "harness/confidence/criterion_spec.h"

namespace parallax::harness {

/// The criterion as one JSON object; journal and report say it in the same words.
std::string criterion_json(const CriterionSpec& criterion);

}  // namespace parallax::harness
