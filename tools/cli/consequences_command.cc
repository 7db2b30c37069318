#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/base/codes/files.h"
#include "compiler/base/json.h"
#include "compiler/base/word_table.h"
#include "compiler/base/words.h"
#include "tools/app/consequences.h"
#include "tools/app/plan_reservations.h"
#include "tools/app/scenario_model.h"
#include "tools/cli/command.h"
#include "tools/cli/explain_text.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

using nlohmann::ordered_json;
using runtime::Extent;

struct ConsequencesOptions {
  ModelOptions model;
  ConsequencesQuery query;
  bool always = false, sometimes = false, both = false;
  AbductionQuery abduction;
  std::string observed;
};

constexpr auto kExtentWords =
    base::word_table<Extent>("never", "sometimes", "always", "undecided", "absent", "undecided");

std::string because(const compiler::CompiledModel& model, const ConsequenceFact& fact) {
  std::string out;
  for (const auto origin : *fact.axioms) {
    const auto& said = model.origins[origin];
    const auto place = origin_place(said);
    out += fmt::format("      {}{}{}\n", place, place.empty() ? "" : "  ", axiom_text(said));
  }
  return out;
}

/// The facts of one extent, a line for each timepoint's fluents and events; with reasons a line for
/// each fact.
std::string facts_text(const compiler::CompiledModel& model, const ModelConsequences& found,
                       Extent extent, bool why) {
  std::string out;
  const ConsequenceFact* last = nullptr;
  for (const auto& fact : found.facts) {
    if (fact.extent != extent) continue;
    const bool goes_on =
        !why && last != nullptr && last->time == fact.time && last->happens == fact.happens;
    if (goes_on) {
      out += ", " + fact.name;
    } else {
      if (last != nullptr && !why) out += '\n';
      out += fmt::format("  {} {}  {}", fact.time, fact.happens ? "happens" : "holds  ", fact.name);
    }
    if (why) out += '\n';
    if (why && fact.axioms) out += because(model, fact);
    last = &fact;
  }
  if (last == nullptr) return "  nothing\n";
  if (!why) out += '\n';
  return out;
}

/// ` (not of every order)` where the plan has executions that were not explored.
std::string words_of(const PlanReservations& reservations) {
  return reservations.any() ? fmt::format(" ({})", reservations.words()) : "";
}

std::string text_of(const ConsequencesOptions& options, const compiler::CompiledModel& model,
                    const ModelConsequences& found, const PlanReservations& reservations) {
  std::string out;
  const bool why = options.query.why;
  auto limits = words_of(reservations);
  // Who gives `--until` knows it.
  if (model.has_constraints && options.model.until.empty()) {
    limits.insert(0, " that meet the scenario's constraints");
  }
  if (!options.sometimes) {
    out += fmt::format("in all traces{}\n", limits) + facts_text(model, found, Extent::kAll, why);
  }
  if (!options.always) {
    out += fmt::format("in some traces, not in all{}\n", limits) +
           facts_text(model, found, Extent::kSome, false);
  }
  const auto undecided = facts_text(model, found, Extent::kUndecided, false);
  if ((!found.complete || found.cut) && undecided != "  nothing\n")
    out += "not decided\n" + undecided;
  return out;
}

ordered_json json_of(const compiler::CompiledModel& model, const ModelConsequences& found,
                     const PlanReservations& reservations) {
  auto facts = ordered_json::array();
  ordered_json counts = {
      {"always", 0}, {"sometimes", 0}, {"never", 0}, {"absent", 0}, {"undecided", 0}};
  for (const auto& fact : found.facts) {
    auto& count = counts[kExtentWords.of(fact.extent)];
    count = count.get<std::int64_t>() + 1;
    ordered_json entry = {{"time", fact.time},
                          {"atom", fact.happens ? "Happens" : "HoldsAt"},
                          {"name", fact.name},
                          {"in", kExtentWords.of(fact.extent)}};
    if (fact.axioms) {
      auto axioms = ordered_json::array();
      for (const auto origin : *fact.axioms) {
        const auto& said = model.origins[origin];
        axioms.push_back({{"place", origin_place(said)}, {"text", axiom_text(said)}});
      }
      entry["because"] = std::move(axioms);
    }
    facts.push_back(std::move(entry));
  }
  ordered_json out = {{"status", "ok"},
                      {"has_traces", found.any ? ordered_json(*found.any) : ordered_json()},
                      {"complete", found.complete && !reservations.any()}};
  for (const auto& [name, value] : reservations.fields()) out[name] = value;
  out["horizon"] = model.horizon;
  out["facts"] = std::move(facts);
  out["counts"] = std::move(counts);
  return out;
}

int tell_consequences(const ConsequencesOptions& options, const compiler::Compilation& compilation,
                      Invocation& invocation) {
  const auto& model = compilation.model;
  const auto found = find_model_consequences(model, options.query, invocation);
  if (!found) return 0;
  auto reservations = reservations_of(compilation.plan);
  reservations.cut = found->cut.has_value();
  if (found->complete) invocation.answered();
  if (invocation.options().json) {
    invocation.document(base::json_text(json_of(model, *found, reservations)) + '\n');
  } else if (found->any == false) {
    invocation.result(
        fmt::format("there is no trace{}: everything would follow\n", words_of(reservations)));
    invocation.remark("`parallax explain` says which axioms exclude each other");
  } else if (found->any) {
    invocation.result(text_of(options, model, *found, reservations));
  }
  if (!found->complete) {
    invocation.remark("stopped before everything was decided");
    return 4;
  }
  const bool is_open =
      std::any_of(found->facts.begin(), found->facts.end(),
                  [](const ConsequenceFact& fact) { return fact.extent == Extent::kUndecided; });
  if (is_open) {
    invocation.remark(fmt::format(
        "from timepoint {} on the plan may be where its unrolling was cut: what follows is not "
        "decided",
        *found->cut));
    return 4;
  }
  return found->any == true ? 0 : 1;
}

ordered_json json_of(const Abduction& found, const PlanReservations& reservations) {
  auto explanations = ordered_json::array();
  for (const auto& set : found.explanations) {
    auto occurrences = ordered_json::array();
    for (const auto& one : set) occurrences.push_back({{"event", one.name}, {"time", one.time}});
    explanations.push_back(std::move(occurrences));
  }
  ordered_json out = {{"status", "ok"},
                      {"explanations", std::move(explanations)},
                      {"complete", found.complete && !reservations.any()}};
  for (const auto& [name, value] : reservations.fields()) out[name] = value;
  out["possible_only"] = found.possible_only;
  return out;
}

std::string text_of(const Abduction& found, const PlanReservations& reservations) {
  std::string out;
  std::size_t number = 0;
  for (const auto& set : found.explanations) {
    out += fmt::format("explanation {}: ", ++number);
    if (set.empty()) out += "it holds anyway";
    for (std::size_t i = 0; i < set.size(); ++i) {
      out += fmt::format("{}{} at {}", i == 0 ? "" : ", ", set[i].name, set[i].time);
    }
    out += '\n';
  }
  out += fmt::format("{}{}\n", base::counted(number, "explanation"),
                     reservations.any() ? ", " + reservations.words()
                     : found.complete   ? ", complete"
                                        : "");
  if (found.possible_only > 0) {
    out += fmt::format("{} of events may be followed by it, but need not: something else is open\n",
                       base::counted(found.possible_only, "further set"));
  }
  return out;
}

int tell_abduction(const ConsequencesOptions& options, const compiler::Compilation& compilation,
                   Invocation& invocation) {
  const auto found = abduce(compilation.model, options.abduction, invocation);
  if (!found) return 0;
  const auto reservations = reservations_of(compilation);
  if (invocation.options().json) {
    invocation.document(base::json_text(json_of(*found, reservations)) + '\n');
  } else {
    invocation.result(text_of(*found, reservations));
  }
  if (found->complete) invocation.answered();
  if (!found->complete && invocation.stopped()) {
    invocation.remark("stopped before the end: there may be more explanations");
    return 4;
  }
  return found->explanations.empty() ? 1 : 0;
}

int run_consequences(ConsequencesOptions options, Invocation& invocation) {
  const bool abduces = !options.abduction.events.empty();
  if (abduces != !options.observed.empty()) {
    invocation.sink().error_about(
        codes::kUsage, abduces ? "--abduce" : "--observe",
        "--abduce names the events that may explain what --observe says: give both");
    return 0;
  }
  if (abduces && !options.model.until.empty()) {
    invocation.sink().error_about(codes::kUsage, "--until",
                                  "does not go with --abduce: an observation is of the horizon");
    return 0;
  }
  if (static_cast<int>(options.always) + static_cast<int>(options.sometimes) +
          static_cast<int>(options.both) >
      1) {
    invocation.sink().error_about(codes::kUsage, "",
                                  "give one of --always, --sometimes and --both");
    return 0;
  }
  if (abduces) options.model.until = {options.observed};
  options.query.only_always = options.always;
  const auto compilation = compile_models(options.model, invocation);
  if (!compilation) return 0;
  tell_reservations(*compilation, invocation);
  return abduces ? tell_abduction(options, *compilation, invocation)
                 : tell_consequences(options, *compilation, invocation);
}

}  // namespace

Command consequences_command() {
  auto options = std::make_shared<ConsequencesOptions>();
  OptionTable command("consequences",
                      "What holds and happens in all traces of a model, and what in some; which "
                      "events would explain an observation");
  command.footer(
      "Examples:\n"
      "  parallax consequences domain.e start.e --horizon 4\n"
      "  parallax consequences domain.e --always --at 3 --why\n"
      "  parallax consequences maze.e --until \"HoldsAt(At(Exit),time)\" --horizon 20\n"
      "  parallax consequences scenario.yaml --always\n"
      "  parallax consequences yale.e --abduce Load --abduce Shoot \\\n"
      "      --observe \"!HoldsAt(Alive(),time)\" --horizon 3");
  add_model_options(command, options->model);
  add_plan_options(command, options->model);
  command.heading("What is asked");
  command.flag("--always", options->always, "Only what is in all traces");
  command.flag("--sometimes", options->sometimes, "Only what is in some traces and not in all");
  command.flag("--both", options->both, "The default");
  command.option("--at", options->query.at, "Only what is at this timepoint").check(NonNegative{});
  command.flag("--why", options->query.why,
               "Behind every fact that is in all traces a minimal set of axioms that it follows "
               "from");
  command.heading("Explanations of an observation");
  command
      .option("--abduce", options->abduction.events,
              "Events whose smallest sets of occurrences explain what --observe says")
      .details("An event, or a name for all events that have it.");
  command.option("--observe", options->observed,
                 "Formula over `time`, which is the horizon, and earlier timepoints");
  command.option("--limit", options->abduction.limit, "Of --abduce: so many explanations; 0: all")
      .check(NonNegative{})
      .show_default();
  return command_of(std::move(command), options, run_consequences);
}

}  // namespace parallax::tools
