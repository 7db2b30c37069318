#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/campaign/judge.h"
#include "harness/campaign/sample_record.h"
#include "harness/campaign/trace_input.h"
#include "harness/confidence/comparison.h"
#include "harness/region/state_mapping.h"

namespace parallax::harness {

/// The margins of one simulation, part by part: distances of bodies and joints from the borders of
/// the expected cells ("BoxIn(r1)", in widths of the cell), and the margins that the simulator's
/// controllers report ("Place(r1): goal", in their units). A part that is read several times has
/// its least value.
using MarginParts = std::map<std::string, double>;

MarginParts margin_parts(const StateMapping& mapping, const ModelFluents& fluents,
                         const CampaignTrace& trace, Comparison comparison,
                         const SampleRecord& record);

/// Combines many parts into one margin: the least part, each in units of its usual value at first.
/// Parts that were below zero in a simulation that went as predicted tell nothing about
/// discrepancies and are left out from then on, and so are parts that never change.
class MarginScale {
 public:
  /// Adds a simulation that was judged.
  void add(MarginParts parts, bool discrepancy);
  std::size_t size() const { return runs_.size(); }

  /// The margin of run number `run`, from 0, as it is taken now: below zero for a discrepancy,
  /// above for others. None: no part of it counts.
  std::optional<double> margin(std::size_t run) const;
  /// The margin of a simulation that was not added.
  std::optional<double> margin_of(const MarginParts& parts, bool discrepancy) const;
  /// The part of least margin in that run.
  std::string part_of(std::size_t run) const;
  /// Parts that contradicted a verdict, by name.
  const std::set<std::string>& contradicting() const { return contradicting_; }

 private:
  struct Part {
    double unit = 0.0;
    double first = 0.0;
    bool varies = false;
    int seen = 0;
  };
  struct Run {
    MarginParts parts;
    bool discrepancy = false;
  };
  std::optional<std::pair<std::string, double>> least(const MarginParts& parts) const;

  std::map<std::string, Part> parts_;
  std::vector<Run> runs_;
  std::set<std::string> contradicting_;
};

}  // namespace parallax::harness
