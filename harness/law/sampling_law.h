#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/source_file.h"
#include "harness/law/distribution.h"
#include "harness/law/expression.h"
#include "harness/region/area.h"
#include "harness/region/state_mapping.h"

namespace parallax::harness {

/// The law of starts as a scenario gives it (`sampling`), where that is more than uniform ranges:
/// all values are drawn independently and then conditioned on everything that is asked for, so the
/// order of the entries does not matter. What a discrete state asks for conditions it besides.
struct SamplingLaw {
  struct Marginal {
    std::string variable;
    Distribution law;
    base::SourceRange source;
  };
  struct Formula {
    std::string variable;
    Expression value;
    std::optional<Interval> within;  // asked of the value
    bool is_parameter = false;       // as `parameters`
    base::SourceRange source;
  };
  struct BodyArea {
    std::string body;
    std::shared_ptr<const Area> area;
    base::SourceRange source;
  };
  /// The body is at least so far in front of another one, in the direction (x, y) of its frame.
  struct HalfPlane {
    std::string body, of;
    PlanePoint normal{};  // of length 1
    double distance_m = 0.0;
    base::SourceRange source;
  };
  struct Requirement {
    Expression condition;
    base::SourceRange source;
  };

  std::vector<Marginal> marginals;           // of variables and parameters
  std::vector<SampledDimension> parameters;  // drawn for formulas alone; no simulator sees them
  std::vector<Formula> formulas;             // each after those that it needs
  std::vector<BodyArea> areas;
  std::vector<HalfPlane> half_planes;
  std::vector<Requirement> requirements;
  /// Reset values of variables that nothing draws: "table.x".
  std::map<std::string, double> constants;

  /// Does it say anything that uniform ranges do not?
  bool is_plain() const {
    return marginals.empty() && parameters.empty() && formulas.empty() && areas.empty() &&
           half_planes.empty() && requirements.empty();
  }
};

}  // namespace parallax::harness
