#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/compare/trace_difference.h"
#include "tools/app/scenario_model.h"
#include "tools/repair/domain_model.h"
#include "tools/repair/evidence.h"

namespace parallax::tools {

/// The answer of runs of another plan about a model.
struct PlanAnswer {
  std::string scenario;
  std::size_t runs = 0, right = 0;  // those that the model follows to their end
  std::string refuted_by;           // the first other one
};

/// Comparison of an edited model with the observations, made from the edited text alone.
struct Verdict {
  bool admits = false;              // every run as far as it is needed
  std::string why;                  // it does not: "no right model: ...", "run 1.4 at 3"
  std::size_t runs_whole = 0;       // runs that it admits to their end
  std::size_t runs_consistent = 0;  // to their end, or to where they left the model
  bool refuses = false;             // of a failed run it says that the event cannot happen
  /// Runs that it admits to their end only if events with triggers may happen undemanded.
  std::size_t runs_undemanded = 0;
  std::size_t validated = 0;    // sequences, that chose it, that it follows to their end
  std::size_t fresh_right = 0;  // and fresh ones (hold_against)
  std::string refuted_by;       // the first other one: "Call(ground), Enter()"
  /// A fluent that it leaves open, so that no run refutes what it says of it; empty: none.
  std::string leaves_open;
  std::vector<PlanAnswer> plans;
};
/// Effect of an edit on the traces of the scenario: its model with its plan, up to its horizon.
struct TraceEffects {
  std::optional<runtime::TraceNumber> lost, gained;  // none: not known
  /// A trace reaches the state constraints; none: it is not known, or nothing asks for it.
  std::optional<bool> reaches;
};

/// The answers of runs, of random sequences and of the traces about models by their texts: none of
/// them changes while runs are added.
struct SequenceMemo {
  struct Said {
    std::size_t validated = 0;
    std::string refuted_by, leaves_open;
  };
  std::map<std::string, Said> by_text;
  std::map<std::string, TraceEffects> effects;
  /// How a model follows a run.
  struct RunAnswer {
    std::vector<Evidence::Step> steps;
    std::vector<Evidence::State> states;
    std::optional<std::size_t> refuse_at;
    EvidenceAdmission::Answer answer;
    bool strictly = true;
  };
  std::map<std::string, std::vector<RunAnswer>> of_runs;  // by text

  const Said* find(const std::string& text) const {
    const auto found = by_text.find(text);
    return found == by_text.end() ? nullptr : &found->second;
  }
};

/// Compiles `text`, the edited model, and asks a solver about each way that runs went, and about
/// further sequences, which it need not admit. What `memo` has of these is not asked again.
Verdict verify(const std::string& text, const std::vector<Evidence>& evidence,
               const std::vector<Evidence>& further, const Context& context,
               SequenceMemo* memo = nullptr);

/// Asks about fresh sequences, too.
void hold_against(const std::string& text, const std::vector<Evidence>& fresh,
                  const Context& context, Verdict& verdict);

/// Compares models with the one of the scenario.
class TraceComparer {
 public:
  /// `loaded`, of which the scenario is used, `context` and `text`, its model, outlive it.
  TraceComparer(const ScenarioModel& loaded, const std::string& text, Context& context);
  TraceEffects compare(const std::string& edited);

 private:
  std::optional<compiler::Compilation> compile(const std::string& text, bool constraints);

  const ScenarioModel& loaded_;
  Context& context_;
  std::optional<compiler::Compilation> original_;
  std::optional<runtime::ComparedModel> compared_;
};

}  // namespace parallax::tools
