// Events that a model allows and a plan does not perform.
//
// Runs of a plan do not refute a model that permits too much. So each state that a run came to is
// paired with each event that the model allows there and that no run performed there. The events
// before it are performed once more, and then the event itself. A world that refuses it shows that
// the model lacks a precondition, and one in which it ends otherwise that an effect is wrong. What
// is asked of the model afterwards is about the states that were seen, so that an execution that
// went another way blames nobody.
//
// Cost: a solver call for each pair, and a simulation for each that is chosen.

#include "tools/repair/provocation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "compiler/base/codes/files.h"
#include "compiler/base/ground_name.h"
#include "compiler/base/words.h"
#include "compiler/repair/closed_triggers.h"
#include "harness/campaign/journal.h"
#include "tools/app/version.h"
#include "tools/repair/domain_model.h"
#include "tools/repair/plan_runs.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostPairsAsked = 20'000;
constexpr std::size_t kMostLines = 10;  // of events, in the text

/// A state that a run came to: the run up to there, and the events that were performed there.
struct RunState {
  Evidence before;
  std::set<std::string> performed;
};

std::vector<RunState> run_states(std::vector<Evidence> runs) {
  std::map<Evidence::State, RunState> states;
  for (auto& seen : runs) {
    end_at_refusal(seen);
    for (std::size_t t = 0; t < seen.states.size(); ++t) {
      const bool refused = t > 0 && seen.steps[t - 1].failed;
      if (refused) break;
      auto& state = states[seen.states[t]];
      if (t < seen.steps.size()) state.performed.insert(seen.steps[t].event);
      if (!state.before.states.empty() && state.before.steps.size() <= t) continue;
      state.before = seen;
      state.before.steps.resize(t);
      state.before.states.resize(t + 1);
    }
  }
  std::vector<RunState> out;
  for (auto& [key, state] : states) out.push_back(std::move(state));
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return a.before.steps.size() < b.before.steps.size();
  });
  return out;
}

/// The model without its plan, asked whether events can happen.
class PermissiveModel {
 public:
  static std::unique_ptr<PermissiveModel> make(const ScenarioModel& loaded, std::size_t horizon,
                                               Context& context) {
    const auto domain = load_domain(loaded.scenario, context);
    if (domain == nullptr) return nullptr;
    auto out = std::make_unique<PermissiveModel>();
    std::string why;
    out->model_ = compile_text(compiler::flat_text(domain->ast, domain->files, {}),
                               static_cast<std::int64_t>(horizon), context, why);
    if (!out->model_) return nullptr;
    const auto demanded =
        compiler::closed_triggers(domain->ast, domain->files, *domain->typed).symbols;
    out->demanded_.insert(demanded.begin(), demanded.end());
    out->admission_ = std::make_unique<EvidenceAdmission>(*out->model_, context.stop());
    return out;
  }

  /// Events that axioms demand are nobody's to perform.
  bool is_demanded(const std::string& event) const {
    return demanded_.contains(base::symbol_of(event));
  }
  /// Can the event happen behind these events, through these states?
  bool allows(Evidence before, const std::string& event) {
    before.steps.push_back({event, false, ""});
    before.states.emplace_back();
    return admission_->ask(before).whole;
  }
  bool admits(const Evidence& seen) { return admission_->ask(seen).whole; }

 private:
  std::optional<compiler::CompiledModel> model_;
  std::set<std::string> demanded_;
  std::unique_ptr<EvidenceAdmission> admission_;
};

/// An event that is to be performed, and where.
struct ChosenEvent {
  const RunState* at;
  std::string event;
};

/// Chooses at most `most` pairs of state and event: one for each event first, then their second
/// ones.
std::vector<ChosenEvent> choose(const std::vector<RunState>& states,
                                const std::vector<std::string>& events, std::int64_t most,
                                PermissiveModel& model, const Context& context, Provocation& told) {
  std::vector<std::pair<std::size_t, ChosenEvent>> all;  // by how many of the event come before
  std::map<std::string, std::size_t> count;
  std::size_t asked = 0;
  for (const auto& state : states) {
    for (const auto& event : events) {
      if (context.stopped() || asked == kMostPairsAsked) break;
      if (model.is_demanded(event) || state.performed.contains(event)) continue;
      ++asked;
      if (model.allows(state.before, event)) all.push_back({count[event]++, {&state, event}});
    }
  }
  if (asked == kMostPairsAsked) {
    told.skipped.push_back(fmt::format("what comes after the first {} states and events", asked));
  }
  told.allowed = std::ssize(all);
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ChosenEvent> out;
  for (auto& [place, chosen] : all) {
    if (std::ssize(out) < most) out.push_back(std::move(chosen));
  }
  return out;
}

std::vector<std::string> names_of_steps(const std::vector<Evidence::Step>& steps) {
  std::vector<std::string> out;
  for (const auto& step : steps) out.push_back(step.event);
  return out;
}

/// Notes how the world answered to an event.
void judge(const ChosenEvent& chosen, const Evidence& seen, PermissiveModel& model,
           Provocation& out) {
  const auto last = chosen.at->before.steps.size();
  auto before = seen;
  const bool arrived = seen.steps.size() == last + 1 && seen.states.size() > last &&
                       std::none_of(seen.steps.begin(), seen.steps.end() - 1,
                                    [](const auto& step) { return step.failed; });
  if (arrived) {
    before.steps.resize(last);
    before.states.resize(last + 1);
  }
  if (!arrived || !model.allows(before, chosen.event)) {
    ++out.unreached;
    return;
  }
  ProvokedEvent provoked{chosen.event, names_of_steps(before.steps), seen.steps.back().reason};
  const bool as_told = seen.states.size() == last + 2 && model.admits(seen);
  provoked.changes_nothing = as_told && seen.steps.back().failed;
  if (seen.steps.back().failed) {
    out.refused.push_back(std::move(provoked));
  } else if (!as_told) {
    out.otherwise.push_back(std::move(provoked));
  }
}

std::string lines_about(const std::vector<ProvokedEvent>& events) {
  std::string out;
  std::set<std::string> told;
  for (const auto& each : events) {
    const auto symbol = base::symbol_of(each.event);
    const auto kind = symbol + (each.changes_nothing ? " idle" : "");
    if (told.size() == kMostLines || !told.insert(kind).second) continue;
    const auto more = std::count_if(events.begin(), events.end(), [&](const auto& other) {
      return base::symbol_of(other.event) == symbol &&
             other.changes_nothing == each.changes_nothing;
    });
    constexpr std::size_t kMostShown = 4;  // events before it
    const auto shown = std::min(each.after.size(), kMostShown);
    out += fmt::format(
        "    {}{}{}{}{}{}{}\n", each.event, shown > 0 ? " after " : " at the start",
        each.after.size() > shown ? "..., " : "",
        fmt::join(each.after.end() - static_cast<std::ptrdiff_t>(shown), each.after.end(), ", "),
        each.reason.empty() ? "" : ": " + each.reason,
        each.changes_nothing ? "; in the model, too, nothing changes" : "",
        more > 1 ? fmt::format(" (and {} more of `{}`)", more - 1, symbol) : "");
  }
  return out;
}

nlohmann::ordered_json json_of_events(const std::vector<ProvokedEvent>& events) {
  auto out = nlohmann::ordered_json::array();
  for (const auto& each : events) {
    out.push_back({{"event", each.event},
                   {"after", each.after},
                   {"reason", each.reason},
                   {"changes_nothing", each.changes_nothing}});
  }
  return out;
}

}  // namespace

base::Result<Provocation> provoke(const ScenarioModel& loaded, const std::filesystem::path& run_dir,
                                  const ProvokeOptions& options, Context& context) {
  auto& sink = context.sink();
  const auto journal = harness::read_journal(run_dir, context.files(), sink);
  if (!journal) return sink.already_reported();
  const auto paths = observed_paths(loaded, *journal, context);
  if (!paths) return sink.already_reported();
  const auto states = run_states(evidence_of(*paths, loaded.compilation.model));
  const auto executed =
      load_scenario_model(loaded.scenario.file, context,
                          {.as_run = true, .execution = harness::Execution::kClosedLoop});
  if (!executed) return sink.already_reported();
  Provocation out;
  ExploreOptions explored;
  explored.seed = options.seed;
  explored.jobs = options.jobs;
  explored.all_events = true;
  explored.run_dir = run_dir / kProvoked;
  explored.tool_version = kVersion;
  explored.progress = options.progress;
  const auto events = sequence_events(*executed, explored, context);
  if (!events) return sink.already_reported();
  std::size_t horizon = 1;
  for (const auto& state : states) horizon = std::max(horizon, state.before.steps.size() + 1);
  const auto model = PermissiveModel::make(loaded, horizon, context);
  if (model == nullptr || states.empty()) return out;
  const auto chosen = choose(states, *events, options.most, *model, context, out);
  if (chosen.empty()) return out;
  explored.count = std::ssize(chosen);
  explored.given = [&](std::int64_t number) {
    const auto& each = chosen[static_cast<std::size_t>(number - 1)];
    ExploreOptions::Sequence sequence{each.at->before.states.front(),
                                      names_of_steps(each.at->before.steps)};
    sequence.events.push_back(each.event);
    return sequence;
  };
  // An earlier part of a resumed run made it; a folder of somebody's own stays.
  std::error_code error;
  const bool is_ours = std::filesystem::exists(explored.run_dir / harness::kJournalName, error);
  if (!is_ours && std::filesystem::exists(explored.run_dir, error)) {
    return sink.error_about(codes::kUsage, "--provoke",
                            fmt::format("the simulations belong into {}, which an earlier call did "
                                        "not make; move it away",
                                        explored.run_dir.string()));
  }
  std::filesystem::remove_all(explored.run_dir, error);
  const auto simulator = options.simulator(*executed);
  if (!simulator) return sink.already_reported();
  auto made = explore(*executed, {}, *simulator, explored, context);
  if (!made) return sink.already_reported();
  out.made = made->made;
  out.skipped.insert(out.skipped.end(), made->skipped.begin(), made->skipped.end());
  for (const auto& seen : made->runs) {
    judge(chosen[static_cast<std::size_t>(std::stoll(seen.ids.front()) - 1)], seen, *model, out);
  }
  return out;
}

bool Provocation::is_clean() const {
  return otherwise.empty() &&
         std::all_of(refused.begin(), refused.end(),
                     [](const ProvokedEvent& each) { return each.changes_nothing; });
}

std::string provocation_text(const Provocation& provocation) {
  auto out = fmt::format(
      "provoked: {} that the model allows and no run performed, of {} in the states that runs came "
      "to\n",
      base::counted(provocation.made, "event"), provocation.allowed);
  if (!provocation.refused.empty()) {
    out += fmt::format("  the world refuses {}:\n{}", provocation.refused.size(),
                       lines_about(provocation.refused));
  }
  if (!provocation.otherwise.empty()) {
    out += fmt::format("  after {} the world is not as the model says:\n{}",
                       provocation.otherwise.size(), lines_about(provocation.otherwise));
  }
  if (provocation.is_clean()) out += "  the world is as the model says after all of them\n";
  if (provocation.unreached > 0) {
    out += fmt::format("  {} did not come to the state\n", provocation.unreached);
  }
  for (const auto& what : provocation.skipped) out += fmt::format("  not tried: {}\n", what);
  return out;
}

nlohmann::ordered_json provocation_json(const Provocation& provocation) {
  return {{"allowed", provocation.allowed},
          {"made", provocation.made},
          {"unreached", provocation.unreached},
          {"refused", json_of_events(provocation.refused)},
          {"otherwise", json_of_events(provocation.otherwise)},
          {"skipped", provocation.skipped}};
}

}  // namespace parallax::tools
