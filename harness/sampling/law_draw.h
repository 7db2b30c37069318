#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/law/sampling_law.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// A sampling law bound to the start cuboid of one discrete state: takes a point of the unit cube
/// to a start, or says which conditions refuse it. Uniform points that are not refused give starts
/// of the law. It is never changed, so threads may share it.
class LawDraw {
 public:
  /// Reports kLawWithoutMass, kNoFormulaValue, and kStartsRefused where fewer than one in a
  /// thousand points (of up to 100,000, always the same) are let through, at the condition that
  /// refuses most.
  static base::Result<std::shared_ptr<const LawDraw>> make(const StartCuboid& start,
                                                           const SamplingLaw& law, double inset,
                                                           base::DiagnosticSink& sink);

  /// Numbers in [0, 1) that a start is made from, in the cuboid's order, then parameters.
  std::size_t coordinates() const { return coordinates_.size(); }
  /// Does the start depend on this one?
  bool is_free(std::size_t coordinate) const { return coordinates_[coordinate].is_free; }
  /// None: some condition refuses it, and each that does is counted in `refusals` (by conditions())
  /// unless that is null.
  std::optional<State> start_at(std::span<const double> point,
                                std::vector<std::int64_t>* refusals) const;

  /// The conditions on the values, for people: "`cup.x > 1`".
  std::vector<std::string> conditions() const;
  /// The law in words, one entry each: "box.mass normal with mean 1 and sd 0.05 in 0.8 to 1.2".
  const std::vector<std::string>& words() const { return words_; }

 private:
  friend class LawBinder;
  struct Coordinate {
    Interval range;
    std::optional<ConditionedLaw> law;  // none: uniform in the range, or fixed
    bool is_free = false;
    bool is_drawn = false;  // by itself; else an area or a formula gives the value
  };
  struct Value {
    std::string variable;
    bool is_start = false;  // part of the start, not a parameter or a constant
  };
  struct MappedArea {
    std::size_t x = 0, y = 0;  // values, and coordinates likewise
    std::shared_ptr<const Area> area;
    PlanePoint offset{};
    std::size_t condition = 0;  // that it overlaps itself, or leaves the cell
  };
  struct Formula {
    std::size_t value = 0;
    const Expression* expression = nullptr;
    std::vector<std::size_t> arguments;
    std::size_t condition = 0;  // that it has a value
  };
  struct Condition {
    enum class Kind : std::uint8_t { kGiven, kRange, kArea, kHalfPlane, kTruth };
    Kind kind = Kind::kGiven;
    std::string text;
    base::SourceRange source;
    std::vector<std::size_t> values;  // what it is about
    Interval range;                   // kRange; closed
    std::shared_ptr<const Area> area;
    PlanePoint offset{};  // of the area; of a half-plane its normal
    double distance_m = 0.0;
    const Expression* expression = nullptr;
  };

  bool holds(const Condition& condition, std::span<const double> values) const;

  std::shared_ptr<const SamplingLaw> law_;  // owns the expressions
  double inset_ = 0.0;
  std::vector<Coordinate> coordinates_;
  std::vector<Value> values_;      // coordinates first, then formulas, then constants
  std::vector<double> constants_;  // by value; those of drawn values are not used
  std::vector<MappedArea> areas_;
  std::vector<Formula> formulas_;
  std::vector<Condition> conditions_;
  std::vector<std::string> words_;
};

}  // namespace parallax::harness
