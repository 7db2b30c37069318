// Text that `confirm` and `threshold` print.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/shown_text.h"
#include "compiler/base/words.h"
#include "harness/confidence/rounding.h"
#include "tools/confirm/confirm.h"

namespace parallax::tools {
namespace {

using harness::BorderBracket;
using harness::ParameterRole;
using harness::Persistence;
using harness::StartVerdict;

/// With enough digits that values `apart` from each other differ in the last but one.
std::string rounded(double value, double apart, harness::Round round = harness::Round::kNearest) {
  if (!(apart > 0.0)) return fmt::format("{}", value);
  const auto digits = std::ceil(-std::log10(apart)) + 1.0;
  return harness::decimal_figure(value, static_cast<int>(std::clamp(digits, 0.0, 300.0)), round);
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + ' ' + unit;
}

std::string value_text(const StartParameter& parameter, double value, double apart) {
  return with_unit(rounded(value, apart), parameter.unit);
}

/// The outcome of starts that do not show the discrepancy.
std::string beyond_words(StartVerdict verdict) {
  return verdict == StartVerdict::kOtherwise ? "another thing goes wrong" : "it does not";
}

std::string share_words(const Persistence& seen, std::int64_t asked) {
  if (seen.runs == 0) {
    return fmt::format("none of {} runs tells: each was lost, or went wrong otherwise", asked);
  }
  const auto share = static_cast<double>(seen.failures) / static_cast<double>(seen.runs);
  auto out = fmt::format("it happens in {} of {} run{} ({})", seen.failures, seen.runs,
                         base::agreed(seen.runs, "", "s"), harness::percent_about(share));
  if (const auto others = asked - seen.runs; others > 0) {
    out += fmt::format("; {} more {} lost, or went wrong otherwise", others,
                       base::agreed(others, "was", "were"));
  }
  return out;
}

std::string again_words(const Confirmation& confirmation) {
  if (!confirmation.repeated) return "was not simulated";
  if (confirmation.repeated != StartVerdict::kFails) {
    return fmt::format("{} (determinism, as the simulator says: {})",
                       confirmation.repeated == StartVerdict::kClean ? "it does not happen"
                       : confirmation.repeated == StartVerdict::kOtherwise
                           ? "another thing goes wrong"
                           : "the simulator does not take the start, or was lost",
                       confirmation.determinism);
  }
  if (!confirmation.difference) return "bit for bit the same";
  const auto& difference = *confirmation.difference;
  return fmt::format(
      "it happens, not bit for bit the same: `{}` at {} was {} and is {} (determinism, as the "
      "simulator says: {})",
      difference.variable, difference.timepoint, difference.a, difference.b,
      confirmation.determinism);
}

struct SeedWords {
  const char* name;
  std::string words;
};

SeedWords seed_words(const Confirmation& confirmation) {
  const char* name = !confirmation.has_seeds       ? "once more"
                     : confirmation.world_is_model ? "other draws"
                                                   : "other seeds";
  if (confirmation.other_seeds) {
    auto words = share_words(*confirmation.other_seeds, confirmation.repeats);
    if (!confirmation.has_seeds) words += "; the simulator takes no seeds";
    return {name, std::move(words)};
  }
  if (confirmation.repeats == 0) return {name, "not asked for (--repeats 0)"};
  if (!confirmation.has_seeds) return {name, "the simulator takes no seeds and is deterministic"};
  return {name, "not simulated"};
}

std::string step_words(const Confirmation& confirmation) {
  if (confirmation.half_step) return share_words(*confirmation.half_step, confirmation.repeats);
  if (!confirmation.has_half_step) {
    return confirmation.world_is_model ? "the world is a model, which has no step"
                                       : "the simulator is a command, whose step is not ours";
  }
  return confirmation.repeats == 0 ? "not asked for (--repeats 0)" : "not simulated";
}

/// The kind of which every repetition was lost or went wrong otherwise; empty: neither.
std::string_view kind_that_does_not_tell(const Confirmation& confirmation) {
  const auto tells = [](const std::optional<Persistence>& seen) { return !seen || seen->runs > 0; };
  if (!tells(confirmation.other_seeds)) return "repetitions with other seeds";
  return tells(confirmation.half_step) ? "" : "repetitions with half the step";
}

std::string verdict_words(const Confirmation& confirmation) {
  switch (confirmation.verdict()) {
    case ConfirmVerdict::kOpen:
      return "Nothing is known: no simulation was made.";
    case ConfirmVerdict::kConfirmed:
      if (!confirmation.other_seeds && !confirmation.half_step) {
        return "It repeats; with other seeds or half the step nothing was simulated.";
      }
      return "It is confirmed.";
    case ConfirmVerdict::kPartly:
      if (const auto kind = kind_that_does_not_tell(confirmation); !kind.empty()) {
        return fmt::format("It repeats; of {} nothing is known.", kind);
      }
      return confirmation.may_move()
                 ? "It happens in most repetitions, and not in all: chance has a part in it."
                 : "It happens in most repetitions, and not in all: chance has a part in it, so "
                   "that "
                   "nothing was moved.";
    case ConfirmVerdict::kNotRepeated:
      return "It is not confirmed: one start and seed do not always show it, so that no border "
             "could be told.";
    case ConfirmVerdict::kSeed:
      return confirmation.world_is_model
                 ? "It is chance: the world's model leaves the outcome open."
                 : "It is in doubt: with most seeds it does not happen, so chance within the "
                   "simulator decides.";
    case ConfirmVerdict::kStep:
      return "It is in doubt: it goes with the simulator's step, so look at the simulator first.";
  }
  return {};
}

/// Do only some of the repetitions show it? Then the border depends on the seed, too.
bool is_partial(const Confirmation& confirmation) {
  const auto part = [](const std::optional<Persistence>& seen) {
    return seen && seen->failures < seen->runs;
  };
  return part(confirmation.other_seeds) || part(confirmation.half_step) || confirmation.difference;
}

std::string border_words(const StartParameter& parameter, const BorderBracket& border) {
  const auto apart = border.width();
  // Rounded away from each other, so that the shown values enclose the border as well.
  const auto outwards = [&](double value, double other) {
    const auto round = value < other ? harness::Round::kDown : harness::Round::kUp;
    return with_unit(rounded(value, apart, round), parameter.unit);
  };
  auto out = fmt::format("at {} it happens, at {} {}", outwards(border.fails, border.other),
                         outwards(border.other, border.fails), beyond_words(border.beyond));
  if (border.no_start) {
    out += fmt::format(
        "; between them, at {}, there is no valid start, so the border is known no "
        "better",
        value_text(parameter, *border.no_start, apart));
  } else if (!border.is_narrow()) {
    out += fmt::format(" (wider than the tolerance, {})",
                       with_unit(fmt::format("{:.3g}", border.tolerance), parameter.unit));
  }
  return out;
}

const BorderBracket* border_of(const harness::ShrunkStart& shrunk, std::size_t parameter) {
  const auto found =
      std::find_if(shrunk.borders.begin(), shrunk.borders.end(),
                   [&](const auto& border) { return border.parameter == parameter; });
  return found == shrunk.borders.end() ? nullptr : &*found;
}

std::string role_words(const Confirmation& confirmation, std::size_t p) {
  const auto& shrunk = *confirmation.shrunk;
  switch (shrunk.roles[p]) {
    case ParameterRole::kOpen:
      return "not asked";
    case ParameterRole::kIndifferent:
      return "in the middle it happens as well";
    case ParameterRole::kNoStart:
      return "not known: in the middle there is no valid start, or the simulator was lost";
    case ParameterRole::kDecides:
      break;
  }
  const auto* border = border_of(shrunk, p);
  if (border == nullptr) return "it decides; its border was not looked for any more";
  return border_words(confirmation.parameters[p], *border);
}

std::string list_of(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += fmt::format("{}`{}`", i == 0 ? "" : i + 1 == names.size() ? " and " : ", ", names[i]);
  }
  return out;
}

std::vector<std::string> names_of(const Confirmation& confirmation, ParameterRole role) {
  std::vector<std::string> out;
  for (std::size_t p = 0; p < confirmation.parameters.size(); ++p) {
    if (confirmation.shrunk->roles[p] == role) {
      out.push_back(base::printable(confirmation.parameters[p].range.name));
    }
  }
  return out;
}

/// Note for starts that are drawn by a law.
constexpr const char* kLawWords =
    "The scenario draws starts by a law: a moved one keeps to the ranges of its parameters, not to "
    "what the law ties together or rules out.";

/// The initial state that all starts lie in; empty where there is one.
std::string place_words(const StartPlace& place) {
  if (place.number == 0) return {};
  const auto all = place.all ? std::to_string(*place.all) : std::string("many");
  return fmt::format(
      "All starts lie in the initial state of this simulation, {} of {}: {}. Of the others nothing "
      "is said.",
      place.number, all, base::printable(place.holds));
}

std::string end_words(TriedStarts::End end, std::int64_t budget) {
  switch (end) {
    case TriedStarts::End::kNot:
    case TriedStarts::End::kFailed:
      break;
    case TriedStarts::End::kBudget:
      return fmt::format("It ended at {} starts (--runs): more of them, and it goes on from here.",
                         budget);
    case TriedStarts::End::kStopped:
      return "It was stopped: called again, it goes on from here.";
    case TriedStarts::End::kLost:
      return "It ended because the simulator was lost too often.";
  }
  return {};
}

/// The result of moving the start to the middle of the cell, in one or two sentences.
std::string shrunk_words(const Confirmation& confirmation) {
  if (!confirmation.may_move()) return {};
  if (confirmation.parameters.empty()) {
    return "No parameter of its start has a width: there is nothing to move.";
  }
  if (!confirmation.shrunk || !confirmation.shrunk->middle) return {};  // nothing was moved
  const auto& shrunk = *confirmation.shrunk;
  if (shrunk.middle == StartVerdict::kFails) {
    return "In the middle of the cell it happens as well, so nothing was moved from there: whether "
           "other starts avoid it was not looked at.";
  }
  const auto deciding = names_of(confirmation, ParameterRole::kDecides);
  const auto idle = names_of(confirmation, ParameterRole::kIndifferent);
  std::string out =
      shrunk.middle == StartVerdict::kNoStart
          ? "The middle of the cell is no valid start."
          : fmt::format("In the middle of the cell {}.", beyond_words(*shrunk.middle));
  const bool all_asked = names_of(confirmation, ParameterRole::kOpen).empty();
  if (!deciding.empty() && all_asked) {
    out += fmt::format(" It takes {}{}.", list_of(deciding),
                       idle.empty() ? ", each of them" : "; the rest can lie in the middle");
  }
  if (deciding.empty() && all_asked) {
    out += " No single parameter could be seen to decide.";
  }
  return out;
}

/// A row for each parameter that something is to be said of, then the names of the rest.
std::string parameter_rows(const Confirmation& confirmation) {
  const auto is_told = [&](std::size_t p) {
    return confirmation.shrunk->roles[p] != ParameterRole::kIndifferent;
  };
  std::size_t width = 0;
  for (std::size_t p = 0; p < confirmation.parameters.size(); ++p) {
    if (is_told(p))
      width = std::max(width, base::printable(confirmation.parameters[p].range.name).size());
  }
  std::string out;
  for (std::size_t p = 0; p < confirmation.parameters.size(); ++p) {
    if (!is_told(p)) continue;
    const auto& parameter = confirmation.parameters[p];
    const auto apart = 0.1 * parameter.range.width();
    out += fmt::format(
        "  {:<{}}  {} of {} to {}: {}\n", base::printable(parameter.range.name), width,
        rounded(parameter.failing, apart), rounded(parameter.range.lower, apart),
        value_text(parameter, parameter.range.upper, apart), role_words(confirmation, p));
  }
  const auto idle = names_of(confirmation, ParameterRole::kIndifferent);
  if (idle.empty() || confirmation.shrunk->middle == StartVerdict::kFails) return out;
  return out + fmt::format("  in the middle {}\n", fmt::join(idle, ", "));
}

}  // namespace

std::vector<std::string> confirm_sentences(const Confirmation& confirmation) {
  std::vector<std::string> out;
  const auto add = [&](std::string text) {
    if (!text.empty()) out.push_back(std::move(text));
  };
  add(verdict_words(confirmation));
  add(fmt::format("The same start and seed once more: {}.", again_words(confirmation)));
  if (confirmation.repeated) {
    const auto seeds = seed_words(confirmation);
    add(fmt::format("From the same start, {}: {}.",
                    confirmation.has_seeds ? fmt::format("with {}", seeds.name) : seeds.name,
                    seeds.words));
    add(fmt::format("With half the step: {}.", step_words(confirmation)));
  }
  add(shrunk_words(confirmation));
  if (confirmation.shrunk) {
    for (std::size_t p = 0; p < confirmation.parameters.size(); ++p) {
      if (confirmation.shrunk->roles[p] != ParameterRole::kDecides) continue;
      const auto& parameter = confirmation.parameters[p];
      add(fmt::format("`{}`: {}.", base::printable(parameter.range.name),
                      role_words(confirmation, p)));
    }
    if (!confirmation.shrunk->borders.empty()) {
      add(is_partial(confirmation)
              ? "Not every repetition shows it, so the borders are those of one seed and step."
              : "Each pair of values holds a border; where the verdict goes to and fro it holds "
                "more than one.");
    }
  }
  add(place_words(confirmation.place));
  if (confirmation.has_law && confirmation.shrunk) add(kLawWords);
  add(end_words(confirmation.end, confirmation.budget));
  return out;
}

std::string confirm_text(const Confirmation& confirmation, const std::string& run_dir) {
  std::string out =
      fmt::format("{}: simulation {}.{}, {}\n", base::printable(run_dir), confirmation.sample.trace,
                  confirmation.sample.sample, base::printable(confirmation.words));
  const auto row = [&](const std::string& name, const std::string& words) {
    out += fmt::format("  {:<12} {}\n", name, words);
  };
  row("same seed", again_words(confirmation));
  if (confirmation.repeated) {
    const auto seeds = seed_words(confirmation);
    row(seeds.name, seeds.words);
    row("half step", step_words(confirmation));
  }
  out += verdict_words(confirmation) + '\n';
  if (auto words = shrunk_words(confirmation); !words.empty()) out += '\n' + words + '\n';
  if (confirmation.shrunk && confirmation.shrunk->middle) {
    out += parameter_rows(confirmation);
    if (!confirmation.shrunk->borders.empty()) {
      out += is_partial(confirmation)
                 ? "Not every repetition shows it: the borders are those of one seed and step.\n"
                 : "Each border was bisected with all others as told here.\n";
    }
  }
  if (confirmation.place.number > 0) out += place_words(confirmation.place) + '\n';
  if (confirmation.has_law && confirmation.shrunk) out += std::string(kLawWords) + '\n';
  if (auto words = end_words(confirmation.end, confirmation.budget); !words.empty()) {
    out += words + '\n';
  }
  out += fmt::format("{} simulation{}, on record in {}/{}\n", confirmation.runs,
                     base::agreed(confirmation.runs, "", "s"), base::printable(run_dir),
                     TriedStarts::kFolder);
  return out;
}

std::vector<std::string> threshold_sentences(const Threshold& threshold) {
  std::vector<std::string> out;
  const auto& parameter = threshold.parameter;
  const auto& scan = threshold.scan;
  if (threshold.repeated && threshold.repeated != StartVerdict::kFails) {
    out.push_back(
        "The same start and seed do not show it again, so that there is no border to look for.");
  } else if (threshold.repeated && !scan.points.empty()) {
    const auto count = [&](StartVerdict verdict) {
      return std::count_if(scan.points.begin(), scan.points.end(),
                           [&](const auto& point) { return point.verdict == verdict; });
    };
    const auto apart = 0.1 * parameter.range.width();
    auto line = fmt::format(
        "`{}` from {} to {}, all else as in simulation {}.{}: it happens at {} of {} values",
        base::printable(parameter.range.name), rounded(parameter.range.lower, apart),
        value_text(parameter, parameter.range.upper, apart), threshold.sample.trace,
        threshold.sample.sample, count(StartVerdict::kFails), scan.points.size());
    if (const auto others = count(StartVerdict::kOtherwise); others > 0) {
      line += fmt::format(", at {} another thing goes wrong", others);
    }
    if (const auto gaps = count(StartVerdict::kNoStart); gaps > 0) {
      line += fmt::format(", {} {} no valid start, or lost", gaps, base::agreed(gaps, "is", "are"));
    }
    out.push_back(line + '.');
    for (const auto& border : scan.borders) {
      out.push_back(fmt::format("Border: {}.", border_words(parameter, border)));
    }
    if (scan.borders.empty() && scan.finished) {
      out.push_back("No border was seen.");
    } else if (!scan.borders.empty()) {
      out.push_back(
          "Both values of a pair were simulated: it holds one border, or an odd number of them; "
          "elsewhere there may be others, which --points finds if they are wide enough.");
    }
    if (!threshold.repeats) {
      out.push_back(
          "The simulator does not promise to repeat itself: each verdict is that of one "
          "simulation, and the border is as sure as these.");
    }
  }
  if (auto words = place_words(threshold.place); !words.empty()) out.push_back(std::move(words));
  if (threshold.has_law && !threshold.scan.points.empty()) out.emplace_back(kLawWords);
  if (auto words = end_words(threshold.end, threshold.budget); !words.empty()) {
    out.push_back(std::move(words));
  }
  return out;
}

std::string threshold_text(const Threshold& threshold, const std::string& run_dir) {
  std::string out =
      fmt::format("{}: simulation {}.{}, {}\n", base::printable(run_dir), threshold.sample.trace,
                  threshold.sample.sample, base::printable(threshold.words));
  for (const auto& point : threshold.scan.points) {
    const char* words = point.verdict == StartVerdict::kFails       ? "it happens"
                        : point.verdict == StartVerdict::kClean     ? "it does not"
                        : point.verdict == StartVerdict::kOtherwise ? "another thing goes wrong"
                                                                    : "no valid start, or lost";
    const bool own = point.value == threshold.parameter.failing;
    out += fmt::format(
        "  {:>12}  {}{}\n",
        value_text(threshold.parameter, point.value, 0.01 * threshold.parameter.range.width()),
        words, own ? ", as recorded" : "");
  }
  for (const auto& sentence : threshold_sentences(threshold)) out += sentence + '\n';
  out += fmt::format("{} simulation{}, on record in {}/{}\n", threshold.runs,
                     base::agreed(threshold.runs, "", "s"), base::printable(run_dir),
                     TriedStarts::kFolder);
  return out;
}

}  // namespace parallax::tools
