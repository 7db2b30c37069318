// Which kind of cause fits the runs of one discrepancy.
//
// The first that applies: the initial state of the model alone decides (state_rule.cc: a condition
// is missing); all runs fail, at least five of them (an axiom is wrong); a rule of
// one or two borders tells failing starts (failure_rule.cc: the region is too coarse); one and
// the same start both fails and passes (the outcome is open, or the simulator is in doubt). Else
// the runs tell nothing by themselves, and what was tried since decides: the borders of a start
// that was moved (start_line.cc), or whether the failure vanishes with other seeds or half the
// step. Linear in the runs but for the rule.

#include "harness/cause/cause_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compiler/base/shown_text.h"
#include "compiler/base/words.h"

namespace parallax::harness {
namespace {

/// So many runs of one kind and none of the other are taken for all.
constexpr std::int64_t kEnoughRuns = 5;

std::int64_t contradictory_starts(const std::vector<CauseRun>& runs) {
  struct Ends {
    bool failed = false, clean = false;
  };
  std::map<std::vector<double>, Ends> by_start;
  for (const auto& run : runs) {
    auto& ends = by_start[run.start];
    (run.failed ? ends.failed : ends.clean) = true;
  }
  return std::count_if(by_start.begin(), by_start.end(),
                       [](const auto& entry) { return entry.second.failed && entry.second.clean; });
}

std::string share(std::int64_t part, std::int64_t whole) {
  const double percent =
      whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  return fmt::format("{} % of the", std::lround(percent));
}

std::string runs_text(std::int64_t count) { return base::counted(count, "run"); }

/// "Again from the failing start: with 5 other seeds of the simulator in 5, with half ...".
std::string persistence_words(const CauseFinding& finding) {
  std::string out;
  const auto add = [&](const std::optional<Persistence>& seen, const char* with) {
    if (!seen || seen->runs == 0) return;
    out += fmt::format("{} {} it happens in {} of {}", out.empty() ? "" : ",", with, seen->failures,
                       runs_text(seen->runs));
  };
  add(finding.other_seeds, "with other seeds of the simulator");
  add(finding.half_step, "with half its step");
  return out.empty() ? out : " From the failing start once more:" + out + ".";
}

}  // namespace

void weigh_persistence(std::optional<Persistence> other_seeds, std::optional<Persistence> half_step,
                       CauseFinding& finding) {
  finding.other_seeds = other_seeds;
  finding.half_step = half_step;
  const auto vanishes = [](const std::optional<Persistence>& seen) {
    return seen && seen->runs > 0 && !seen->in_most();
  };
  if (finding.kind == CauseKind::kUnknown && (vanishes(other_seeds) || vanishes(half_step))) {
    finding.kind = CauseKind::kSimulator;
  }
}

void weigh_states(const std::vector<StateRun>& runs, CauseFinding& finding) {
  finding.where = state_rule(runs);
  if (finding.where && finding.where->is_exact()) finding.kind = CauseKind::kState;
}

namespace {

/// The part of the start region that borders of a failing start say, with the runs in it.
std::optional<FailureRule> rule_of_borders(const std::vector<CauseBorder>& borders,
                                           const std::vector<CauseRun>& runs,
                                           const std::vector<std::string>& parameters) {
  constexpr std::size_t kMost = 2;  // as of rules that runs show
  if (borders.size() > kMost) return std::nullopt;
  FailureRule out;
  out.by_moving = true;
  for (const auto& border : borders) {
    const auto found = std::find(parameters.begin(), parameters.end(), border.parameter);
    if (found == parameters.end()) return std::nullopt;
    out.borders.push_back(
        {static_cast<std::size_t>(found - parameters.begin()),
         round_between(std::min(border.fails, border.other), std::max(border.fails, border.other)),
         border.fails > border.other});
  }
  for (const auto& run : runs) {
    const bool inside = std::all_of(out.borders.begin(), out.borders.end(),
                                    [&](const auto& border) { return border.holds(run); });
    ++(run.failed ? out.failures : out.clean);
    if (inside) ++(run.failed ? out.failures_inside : out.clean_inside);
  }
  return out;
}

/// "Moved towards the middle of its cell, ...": what moving a failing start has shown.
std::string border_sentence(const CauseFinding& finding) {
  std::string out;
  for (const auto& border : finding.borders) {
    const auto apart = std::abs(border.fails - border.other);
    const auto digits = apart > 0.0 ? std::ceil(-std::log10(apart)) + 1.0 : 16.0;
    const auto value = [&](double number) {
      return digits > 15.0
                 ? fmt::format("{}", number)
                 : fmt::format("{:.{}f}", number, static_cast<int>(std::max(0.0, digits)));
    };
    out += fmt::format("{}`{}`, with which it happens at {} and not at {}",
                       out.empty() ? " From a failing start it takes " : "; ", border.parameter,
                       value(border.fails), value(border.other));
  }
  return out.empty() ? out : out + ".";
}

}  // namespace

void weigh_borders(const std::vector<CauseBorder>& borders, const std::vector<CauseRun>& runs,
                   const std::vector<std::string>& parameters, CauseFinding& finding) {
  finding.borders = borders;
  if (borders.empty() || finding.kind != CauseKind::kUnknown) return;
  finding.kind = CauseKind::kRegion;
  finding.rule = rule_of_borders(borders, runs, parameters);
}

CauseFinding tell_cause(const std::vector<CauseRun>& runs, bool is_model) {
  CauseFinding out;
  out.runs = static_cast<std::int64_t>(runs.size());
  out.failures =
      std::count_if(runs.begin(), runs.end(), [](const auto& run) { return run.failed; });
  out.contradictory_starts = contradictory_starts(runs);
  out.rule = failure_rule(runs);
  const auto clean = out.runs - out.failures;
  if (clean == 0 && out.failures >= kEnoughRuns) {
    out.kind = CauseKind::kAlways;
  } else if (out.rule) {
    out.kind = CauseKind::kRegion;
  } else if (out.contradictory_starts > 0) {
    out.kind = is_model ? CauseKind::kRandom : CauseKind::kSimulator;
  }
  return out;
}

std::string rule_text(const std::vector<Border>& borders,
                      const std::vector<std::string>& parameters) {
  std::string out;
  for (const auto& border : borders) {
    out += fmt::format("{}`{}` {} {}", out.empty() ? "" : " and ",
                       base::printable(parameters[border.parameter]),
                       border.above ? ">" : "<=", border.value);
  }
  return out;
}

namespace {

std::string kind_words(const CauseFinding& finding, const std::vector<std::string>& parameters) {
  std::string out;
  if (finding.contradictory_starts > 0) {
    out = fmt::format(
        "From one and the same start some runs go wrong as told below and others do not: "
        "it is {}. ",
        finding.kind == CauseKind::kSimulator ? "the simulator or chance" : "chance");
  }
  switch (finding.kind) {
    case CauseKind::kAlways:
      return out + fmt::format("It happens always, in each of {} of this trace: an axiom is wrong.",
                               runs_text(finding.runs));
    case CauseKind::kRegion: {
      if (!finding.rule) return out + "It depends on the start, and the region is too coarse.";
      const auto& rule = *finding.rule;
      if (rule.by_moving) {
        return out +
               fmt::format(
                   "It depends on the start, and the region is too coarse: {} failures ({} of {}) "
                   "have {}, and {} clean runs ({} of {}).",
                   share(rule.failures_inside, rule.failures), rule.failures_inside, rule.failures,
                   rule_text(rule.borders, parameters), share(rule.clean_inside, rule.clean),
                   rule.clean_inside, rule.clean);
      }
      return out + fmt::format(
                       "It depends on the start, and the region is too coarse: {} failures "
                       "({} of {}) have {}, and {} clean runs ({} of {}); cross-validated "
                       "accuracy {:.2f}.",
                       share(rule.failures_inside, rule.failures), rule.failures_inside,
                       rule.failures, rule_text(rule.borders, parameters),
                       share(rule.clean_inside, rule.clean), rule.clean_inside, rule.clean,
                       rule.accuracy);
    }
    case CauseKind::kRandom:
      return out + fmt::format("It happened in {} of {}: the outcome is open.", finding.failures,
                               runs_text(finding.runs));
    case CauseKind::kSimulator:
      if (finding.contradictory_starts == 0) {
        return fmt::format("It happened in {} of {}, and the simulator is in doubt.",
                           finding.failures, runs_text(finding.runs));
      }
      return out + fmt::format(
                       "It happens in {} of {}, with some seeds of the simulator and not "
                       "with others.",
                       finding.failures, runs_text(finding.runs));
    case CauseKind::kState:
      return "It depends on the initial state: a condition is missing or wrong.";
    case CauseKind::kUnknown:
      break;
  }
  const auto clean = finding.runs - finding.failures;
  if (finding.failures >= kEnoughRuns && clean >= kEnoughRuns) {
    return out + fmt::format(
                     "It happened in {} of {} of this trace, and no border of one or two "
                     "start parameters tells in which: it takes more of them, or more runs, "
                     "or it is chance.",
                     finding.failures, runs_text(finding.runs));
  }
  return out + fmt::format(
                   "It happened in {} of {} of this trace, too few to tell whether always, "
                   "in a part of the start region or at random.",
                   finding.failures, runs_text(finding.runs));
}

}  // namespace

std::string cause_words(const CauseFinding& finding, const std::vector<std::string>& parameters) {
  return kind_words(finding, parameters) + border_sentence(finding) + persistence_words(finding);
}

}  // namespace parallax::harness
