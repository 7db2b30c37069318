// Proposals that split the start region where one or two parameters tell failures from clean
// runs.
//
// For each step at which runs left the model, the runs that came to it in the same way are
// compared with those that went on well; the cause of the difference is told by tell_cause
// (harness/cause), helped by borders that `confirm` found. If it is a part of the region, each
// border becomes a fluent of the start, and inside the part the event gets the effects that were
// observed. The new text is verified against all runs, each with the half that it began in.
// Clean runs inside the part are set aside as a precaution, failures outside of it remain, and
// both numbers are told. The effect on traces is compared with a model that has the new fluents
// but not the new effects.

#include "tools/repair/region_split.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <limits>
#include <map>

#include "compiler/base/ground_name.h"
#include "compiler/base/words.h"
#include "compiler/repair/condition_literal.h"
#include "compiler/repair/edit_grammar.h"
#include "compiler/repair/start_split.h"
#include "harness/cause/cause_kind.h"
#include "tools/app/kept_borders.h"
#include "tools/repair/mapping_line.h"

namespace parallax::tools {
namespace {

using compiler::StartFluent;
using harness::Border;

std::optional<double> drawn(const harness::State& start, const std::string& parameter) {
  const auto found = start.find(parameter);
  if (found == start.end()) return std::nullopt;
  if (const auto* real = std::get_if<double>(&found->second)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*whole);
  }
  return std::nullopt;
}

/// "Far" for a variable above a border, "Near" at or below it.
std::string side_word(const std::string& item, bool above) {
  static const std::map<std::string, std::pair<const char*, const char*>> kWords = {
      {"x", {"FarX", "NearX"}},    {"y", {"FarY", "NearY"}},     {"z", {"HighZ", "LowZ"}},
      {"bottom", {"High", "Low"}}, {"mass", {"Heavy", "Light"}}, {"yaw", {"Left", "Right"}}};
  const auto found = kWords.find(item);
  if (found != kWords.end()) return above ? found->second.first : found->second.second;
  auto name = item;
  name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
  return (above ? "More" : "Less") + name;
}

class SplitSearch {
 public:
  SplitSearch(const RepairInput& input, Context& context) : input_(input), context_(context) {
    for (const auto& path : input.paths) {
      const auto id =
          fmt::format("{}{}.{}", path.experiment ? "e" : "", path.id.trace, path.id.sample);
      starts_.emplace(id, &path.start);
      paths_.emplace(id, &path);
    }
  }

  FoundProposals run() {
    std::vector<std::pair<std::string, std::size_t>> looked_at;
    for (const auto& parting : input_.partings) {
      if (context_.stopped()) break;
      const std::pair step(parting.step.event, parting.after);
      if (std::find(looked_at.begin(), looked_at.end(), step) != looked_at.end()) continue;
      looked_at.push_back(step);
      look_at(parting);
    }
    return std::move(out_);
  }

 private:
  /// The runs that came to the step in the same way, as evidence, and the rule that their starts
  /// show.
  struct Cause {
    std::vector<const Evidence*> failed, clean;
    std::vector<std::string> parameters;
    harness::CauseFinding finding;
    std::vector<std::string> gaps;  // sentences about how well the borders are known
    bool is_in(const harness::State& start) const {
      const auto& borders = finding.rule->borders;
      return std::all_of(borders.begin(), borders.end(), [&](const Border& border) {
        const auto value = drawn(start, parameters[border.parameter]);
        return value && (*value > border.value) == border.above;
      });
    }
  };

  void look_at(const RunParting& parting) {
    const auto cause = cause_at(parting);
    if (cause.clean.empty()) return;  // then it is no matter of the start
    const auto& finding = cause.finding;
    if (finding.kind == harness::CauseKind::kUnknown) {
      out_.hints.push_back(fmt::format(
          "Whether `{1}` fails in a part of the start region cannot be told from {2} runs; "
          "`parallax explain {0} --runs {3}` makes more, `parallax confirm {0}` moves one that "
          "failed",
          input_.options.folder.folder, parting.step.event, finding.runs,
          std::max<std::int64_t>(120, 2 * finding.runs)));
    }
    if (finding.kind != harness::CauseKind::kRegion || !finding.rule) return;
    propose(parting, cause);
  }

  Cause cause_at(const RunParting& parting) const {
    Cause out;
    const auto t = parting.after;
    for (const auto& seen : input_.evidence) {
      if (seen.divergence == t && seen.steps[t - 1].event == parting.step.event) {
        out.failed.push_back(&seen);
      }
    }
    for (const auto& seen : input_.evidence) {
      if (seen.divergence && *seen.divergence <= t) continue;
      const bool same = std::any_of(out.failed.begin(), out.failed.end(),
                                    [&](const Evidence* a) { return goes_like(*a, seen, t); });
      if (same) out.clean.push_back(&seen);
    }
    std::vector<const harness::State*> starts;
    std::vector<harness::CauseRun> runs;
    for (const auto* list : {&out.failed, &out.clean}) {
      for (const auto* seen : *list) {
        for (const auto& id : seen->ids) {
          starts.push_back(starts_.at(id));
          runs.push_back({{}, list == &out.failed});
        }
      }
    }
    if (starts.empty()) return out;
    for (const auto& [name, value] : *starts.front()) {
      const auto first = drawn(*starts.front(), name);
      if (!first || name.find('.') == std::string::npos) continue;
      const bool known = std::all_of(starts.begin(), starts.end(), [&](const auto* start) {
        return drawn(*start, name).has_value();
      });
      const bool varies = std::any_of(starts.begin(), starts.end(), [&](const auto* start) {
        return drawn(*start, name) != first;
      });
      if (known && varies) out.parameters.push_back(name);
    }
    for (std::size_t i = 0; i < runs.size(); ++i) {
      for (const auto& name : out.parameters) runs[i].start.push_back(*drawn(*starts[i], name));
    }
    out.finding = harness::tell_cause(runs, input_.loaded.world != nullptr);
    const auto borders = borders_of(out);
    harness::weigh_borders(borders, runs, out.parameters, out.finding);
    if (!out.finding.rule) return out;
    if (out.finding.rule->by_moving) {
      for (const auto& border : borders) {
        out.gaps.push_back(fmt::format(
            "The border of `{}` is that of a failing start that `parallax confirm` moved: from "
            "{:.4g} to {:.4g}.",
            border.parameter, std::min(border.fails, border.other),
            std::max(border.fails, border.other)));
      }
      return out;
    }
    for (const auto& border : out.finding.rule->borders) {
      out.gaps.push_back(gap(runs, border, out.parameters[border.parameter]));
    }
    return out;
  }

  /// The borders that `confirm` has found for one of the failed runs.
  std::vector<harness::CauseBorder> borders_of(const Cause& cause) const {
    for (const auto* seen : cause.failed) {
      for (const auto& id : seen->ids) {
        const auto& path = *paths_.at(id);
        if (path.experiment) continue;
        auto borders = kept_borders(input_.options.folder.folder, path.id, path.start);
        if (!borders.empty()) return borders;
      }
    }
    return {};
  }

  /// Between the runs next to the border it may be anywhere.
  static std::string gap(const std::vector<harness::CauseRun>& runs, const Border& border,
                         const std::string& parameter) {
    double below = -std::numeric_limits<double>::infinity(), above = -below;
    for (const auto& run : runs) {
      const double value = run.start[border.parameter];
      if (value <= border.value) below = std::max(below, value);
      if (value > border.value) above = std::min(above, value);
    }
    return fmt::format(
        "No run began with `{}` from {:.4g} to {:.4g}: the border is somewhere there.", parameter,
        below, above);
  }

  /// A fluent, and the side of a variable that it stands for.
  struct Half {
    StartFluent fluent;
    std::string parameter, body, item, region;  // the region is where the body begins; may be empty
    const harness::FluentBinding* beside = nullptr;
    double value = 0.0;
    bool above = true;
    std::string side() const { return fmt::format("{} {}", above ? ">" : "<=", value); }
  };

  std::vector<Half> halves(const Cause& cause) const {
    std::vector<Half> out;
    for (const auto& border : cause.finding.rule->borders) {
      Half half;
      half.parameter = cause.parameters[border.parameter];
      const auto dot = half.parameter.rfind('.');
      half.body = half.parameter.substr(0, dot);
      half.item = half.parameter.substr(dot + 1);
      half.value = border.value;
      half.above = border.above;
      place(half, *cause.failed.front());
      name(half);
      while (std::any_of(out.begin(), out.end(), [&](const auto& other) {
        return other.fluent.name == half.fluent.name;
      })) {
        half.fluent.name += "2";
      }
      out.push_back(std::move(half));
    }
    return out;
  }

  /// Which region does the body begin in, and what says so?
  void place(Half& half, const Evidence& seen) const {
    const auto& mapping = *input_.loaded.scenario.mapping;
    for (const auto& [text, holds] : seen.states.front()) {
      const auto fluent = harness::ground_fluent(text);
      const auto* binding = mapping.find(fluent.symbol);
      if (binding == nullptr || binding->source.begin == binding->source.end) continue;
      const auto* inside = binding->inside();
      if (inside == nullptr) {
        if (half.beside == nullptr) half.beside = binding;
        continue;
      }
      if (!holds || harness::with_arguments(inside->body, fluent) != half.body) continue;
      half.beside = binding;
      const auto* region = inside->region_of(fluent, mapping.regions());
      const auto axis = harness::kRegionAxisWords.find(half.item);
      if (region != nullptr && axis && region->on(*axis)) half.region = region->name;
      return;
    }
  }

  void name(Half& half) const {
    const auto& typed = *input_.domain->typed;
    auto word = side_word(half.item, half.above);
    const auto object = std::find_if(typed.objects.begin(), typed.objects.end(),
                                     [&](const auto& each) { return each.name == half.body; });
    if (object != typed.objects.end()) {
      half.fluent.sort = typed.sorts[object->sorts.front()].name;
      half.fluent.constant = half.body;
    } else {
      word = half.body + word;
      word.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(word.front())));
    }
    half.fluent.name = compiler::unused_symbol(typed, word);
    half.fluent.means = fmt::format("At the start {} {}.", half.parameter, half.side());
  }

  std::string entry(const Half& half) const {
    const auto side = fmt::format("{}: {}", half.above ? "above" : "up_to", half.value);
    const auto& fluent = half.fluent;
    if (fluent.sort.empty()) {
      return fmt::format("{}(): {{start: {}, {}}}", fluent.name, half.parameter, side);
    }
    return fmt::format("{0}({1}): {{start: \"{{{1}}}.{2}\", {3}, only: [{4}]}}", fluent.name,
                       fluent.sort, half.item, side, fluent.constant);
  }

  void propose(const RunParting& parting, const Cause& cause) {
    const auto& domain = *input_.domain;
    const auto split = halves(cause);
    std::vector<compiler::TextChange> declared, mapped;
    std::vector<StartFluent> fluents;
    for (const auto& half : split) {
      const auto line = half.beside == nullptr
                            ? std::nullopt
                            : mapping_line(*half.beside, entry(half), context_.files());
      if (!line) return;
      mapped.push_back(*line);
      declared.push_back(compiler::declare(half.fluent, domain.ast, *domain.typed, domain.files));
      fluents.push_back(half.fluent);
    }
    compiler::PartStep step{parting.step.event, {}};
    for (const auto& other : input_.partings) {
      if (other.after != parting.after || other.step.event != parting.step.event) continue;
      for (const auto& id : other.ids) {
        const bool counts =
            cause.is_in(*starts_.at(id)) && !paths_.at(id)->in_no_state(parting.after);
        if (counts) step.differing.push_back(other.seen);
      }
    }
    if (step.differing.empty()) return;
    const auto effects = compiler::effects_in_part(domain.ast, *domain.typed, domain.files,
                                                   domain.forms, fluents, step);
    auto changes = declared;
    changes.insert(changes.end(), effects.changes.begin(), effects.changes.end());

    Proposal proposal;
    proposal.changes = Proposal::Changes::kScenario;
    proposal.size = 1;
    proposal.text = compiler::flat_text(domain.ast, domain.files, changes);
    const auto held = held_against(parting, cause, split);
    proposal.verdict = verify(*proposal.text, held.evidence, {}, context_);
    proposal.words = words(parting, split, effects);
    if (!proposal.verdict.admits) {
      out_.remarks.push_back(fmt::format("not proposed, as the check of its text says no: {} ({})",
                                         proposal.words, proposal.verdict.why));
      return;
    }
    proposal.precaution = held.set_aside > 0;
    proposal.evidence = sentences(cause, held);
    proposal.files = changed_files(domain.files, changes);
    auto scenario = changed_files(context_.files(), mapped);
    proposal.files.insert(proposal.files.end(), std::make_move_iterator(scenario.begin()),
                          std::make_move_iterator(scenario.end()));
    // Compared with the model that only declares the halves: the original one lacks their fluents.
    TraceComparer comparer(input_.loaded, compiler::flat_text(domain.ast, domain.files, declared),
                           context_);
    proposal.effects = comparer.compare(*proposal.text);
    out_.proposals.push_back(std::move(proposal));
    ++out_.edits;
  }

  /// Each run with the half that it began in, which the split model has to admit.
  struct Held {
    std::vector<Evidence> evidence;
    std::size_t set_aside = 0;  // runs of the part that went well
    std::size_t left = 0;       // runs outside that did not
    std::size_t nowhere = 0;    // runs of the part that ended in no state of a model
  };
  Held held_against(const RunParting& parting, const Cause& cause,
                    const std::vector<Half>& split) const {
    Held out;
    const auto t = parting.after;
    for (const auto& seen : input_.evidence) {
      const bool went_well =
          std::find(cause.clean.begin(), cause.clean.end(), &seen) != cause.clean.end();
      const bool is_failure =
          std::find(cause.failed.begin(), cause.failed.end(), &seen) != cause.failed.end();
      std::map<std::vector<bool>, Evidence> by_half;
      for (const auto& id : seen.ids) {
        if (is_failure && cause.is_in(*starts_.at(id)) && paths_.at(id)->in_no_state(t)) {
          ++out.nowhere;
          continue;
        }
        std::vector<bool> sides;
        for (const auto& half : split) {
          const auto value = drawn(*starts_.at(id), half.parameter);
          sides.push_back(value && (*value > half.value) == half.above);
        }
        const auto [at, fresh] = by_half.emplace(sides, seen);
        if (fresh) at->second.ids.clear();
        at->second.ids.push_back(id);
      }
      for (auto& [sides, each] : by_half) {
        const bool inside = std::find(sides.begin(), sides.end(), false) == sides.end();
        if (is_failure != inside && is_failure) {
          out.left += each.runs();
          continue;
        }
        if (seen.divergence && !is_failure) {
          out.left += each.runs();
          continue;
        }
        if (went_well && inside) {
          each.until = t - 1;
          out.set_aside += each.runs();
        }
        for (std::size_t i = 0; i < split.size(); ++i) {
          add_half(split[i], sides[i], each.states.front());
        }
        out.evidence.push_back(std::move(each));
      }
    }
    return out;
  }

  void add_half(const Half& half, bool holds, Evidence::State& state) const {
    const auto& typed = *input_.domain->typed;
    const auto sort = typed.find_sort(half.fluent.sort);
    if (sort) {
      for (const auto& constant : compiler::constants_of(typed, *sort)) {
        state.emplace(fmt::format("{}({})", half.fluent.name, constant),
                      constant == half.fluent.constant && holds);
      }
      return;
    }
    state.emplace(half.fluent.ground(), holds);
  }

  static std::string words(const RunParting& parting, const std::vector<Half>& split,
                           const compiler::PartEffects& effects) {
    std::string borders, part;
    for (const auto& half : split) {
      borders +=
          fmt::format("{}{} at `{}` = {}", borders.empty() ? "" : " and ",
                      half.region.empty() ? "the start is split"
                                          : fmt::format("the region `{}`, where `{}` begins, "
                                                        "is split",
                                                        half.region, half.body),
                      half.parameter, half.value);
      part += fmt::format("{}`{}` ({})", part.empty() ? "" : " and ", half.fluent.ground(),
                          half.side());
    }
    std::vector<std::string> what;
    const auto quoted = [](const std::vector<std::string>& list) {
      return "`" + fmt::format("{}", fmt::join(list, "`, `")) + "`";
    };
    if (!effects.not_there.empty()) what.push_back("does not: " + quoted(effects.not_there));
    if (!effects.added.empty()) what.push_back("does: " + quoted(effects.added));
    if (!effects.open.empty()) what.push_back("leaves open: " + quoted(effects.open));
    return fmt::format("{}; with {}, `{}` {}", borders, part, base::symbol_of(parting.step.event),
                       fmt::join(what, "; and "));
  }

  static std::vector<std::string> sentences(const Cause& cause, const Held& held) {
    const auto& rule = *cause.finding.rule;
    std::vector<std::string> out;
    out.push_back(fmt::format("{} of {} failures and {} of {} clean runs have {}.",
                              rule.failures_inside, rule.failures, rule.clean_inside, rule.clean,
                              harness::rule_text(rule.borders, cause.parameters)));
    for (const auto& gap : cause.gaps) out.push_back(gap);
    if (held.nowhere > 0) {
      out.push_back(fmt::format("{} ended in no state that the model has, and no edit admits it.",
                                base::counted(held.nowhere, "run")));
    }
    const auto left = held.left;
    if (left > 0) {
      out.push_back(
          fmt::format("{} that failed otherwise {} what is left: run again, and repair again.",
                      base::counted(left, "run"), base::agreed(left, "is", "are")));
    }
    return out;
  }

  const RepairInput& input_;
  Context& context_;
  std::map<std::string, const harness::State*> starts_;  // by run
  std::map<std::string, const ObservedPath*> paths_;     // likewise
  FoundProposals out_;
};

}  // namespace

FoundProposals region_splits(const RepairInput& input, Context& context) {
  return SplitSearch(input, context).run();
}

}  // namespace parallax::tools
