#pragma once

#include <cstdint>
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

/// What one simulation says of how near it was to a discrepancy, part by part: distances of bodies
/// and joints from the borders of the cells that are expected ("BoxIn(r1)", in widths of the cell),
/// and what the simulator's controllers report besides ("Place(r1): goal", in their units). Of a
/// part that is looked at several times the least value.
using MarginParts = std::map<std::string, double>;

MarginParts margin_parts(const StateMapping& mapping, const ModelFluents& fluents,
                         const CampaignTrace& trace, Comparison comparison,
                         const SampleRecord& record);

/// Makes one margin of many parts: the least of them, each in units of what was usual at first. A
/// part that was below zero in a simulation that went as predicted says nothing of discrepancies
/// and is left out from then on, and so is one that never changes.
class MarginScale {
 public:
  /// Of a simulation that was judged.
  void add(MarginParts parts, bool discrepancy);
  std::size_t size() const { return runs_.size(); }

  /// The margin of run number `run`, from 0, as it is taken now: below zero for a discrepancy,
  /// above for others. None: no part of it counts.
  std::optional<double> margin(std::size_t run) const;
  /// The same of a simulation that was not added.
  std::optional<double> margin_of(const MarginParts& parts, bool discrepancy) const;
  /// The part that gave it.
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
