#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/config/scenario.h"

namespace parallax::harness {

/// The changes that a newer revision must not make to an older one. Without a section nothing is
/// said of such revisions; a change that a section does not forbid is allowed.
struct GateRules {
  /// A rule about the settings of a scenario besides model and plan. The ordered demands admit a
  /// change in one direction: a longer horizon, narrower regions, a criterion that asks for more.
  enum class Demand : std::uint8_t { kForbidden, kNotShorter, kNotWider, kNotWeaker };
  struct SettingRule {
    std::string name;  // "settings" (all but words), an effect ("physics") or a section ("world")
    Demand demand = Demand::kForbidden;
  };
  /// Rates that are worse.
  struct Worse {
    double confidence = 0.95;
    double margin = 0.05;  // by less than this is no worse
  };
  /// Runs of both revisions of a scenario whose physics changed; their rates must not be worse.
  struct Rerun {
    std::int64_t runs = 100;  // of each trace, old and new
    double seconds = 300.0;   // of the clock, for all scenarios of a gate together
    std::int64_t seed = 1;
    Worse worse;
  };
  struct Models {
    bool lost_traces = false, gained_traces = false;  // forbidden
    bool declarations = false, axioms = false;        // forbidden to change
    std::vector<LocatedText> properties;              // that must not be lost
    std::vector<SettingRule> settings;
    std::optional<Rerun> rerun;  // where the physics changed
  };
  struct Plans {
    bool forms = false, order = false;
  };
  struct Traces {
    bool lost = false, gained = false;
  };
  struct Runs {
    bool lost_traces = false, gained_discrepancies = false, worse_verdict = false;
    bool settings = false;
    std::optional<Rerun> rerun;  // where the physics of what both runs kept changed
  };
  struct Rates {
    std::optional<Worse> worse;
    bool gained_causes = false;
  };
  std::optional<Models> models;
  std::optional<Plans> plans;
  std::optional<Traces> traces;
  std::optional<Runs> runs;
  std::optional<Rates> rates;
  bool undecided_passes = false;  // what cannot be decided
  base::SourceRange source;       // of the file's first key
};

/// Reads rules (docs/reference/diff.md). Unknown keys are refused with the near name, and a section
/// that forbids nothing, as a gate that cannot fail.
base::Result<GateRules> load_gate_rules(const std::filesystem::path& path, base::SourceFiles& files,
                                        base::DiagnosticSink& sink);

}  // namespace parallax::harness
