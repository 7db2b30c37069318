// The order of proposals.
//
// First come proposals that follow most runs to their end; those that follow none come last, and
// behind them those that agree with fewer runs than the unchanged model does. Among
// them a split of the start comes first where the runs show that it is the cause, then models that
// leave no fluent open, then what most of the random sequences of events bear out. Then they are
// ordered by size, then precautions before splits of the start before other changes, then specific
// ones before those that let anything happen, and at last by oddity. Only the first few have their
// traces compared with the model's: among equals the change that permits the fewest new traces
// comes first, then the one that forbids the fewest. Neighbours that the order cannot distinguish
// are tied, which is told. Proposals as well founded as the first one that admit fewer runs to
// their end were refuted by experiments and are dropped.

#include "tools/repair/ranking.h"

#include <algorithm>
#include <optional>
#include <tuple>

namespace parallax::tools {
namespace {

constexpr std::size_t kMostCompared = 6;  // have their traces compared, where fewer are wanted

/// Order of equally small proposals: precautions in the model's own words (what may fail is taken
/// to fail), then a split that the starts show, then other consistent changes: where runs
/// contradict each other, these leave outcomes open.
int group_of(const Proposal& proposal) {
  if (proposal.changes == Proposal::Changes::kScenario) return 1;
  return proposal.precaution ? 0 : 2;
}

bool likelier(const Proposal& a, const Proposal& b) {
  const auto key = [](const Proposal& each) {
    return std::tuple(each.agrees_less, each.only_begins(), each.unexplained, !each.is_told_cause,
                      !each.verdict.leaves_open.empty(), each.unvalidated, each.size,
                      group_of(each), each.open, ~each.verdict.runs_whole, each.oddity);
  };
  return key(a) < key(b);
}

/// Counts the runs that each proposal does not follow to their end. Precautions and splits of the
/// start set runs aside on purpose. A proposal that lets anything happen explains every run: it
/// counts as no better than the best specific one.
void count_unexplained(std::size_t runs, std::vector<Proposal>& proposals) {
  auto least = runs;
  for (auto& each : proposals) {
    const bool sets_aside = each.precaution || each.changes == Proposal::Changes::kScenario;
    each.unexplained = sets_aside ? 0 : runs - std::min(runs, each.verdict.runs_whole);
    if (!each.open) least = std::min(least, each.unexplained);
  }
  for (auto& each : proposals) {
    const bool any_specific = least < runs;
    if (each.open && any_specific) each.unexplained = std::max(each.unexplained, least);
  }
}

/// The same for random sequences of events. A split of the start, which is not held against them,
/// counts as no better than the best that is, either.
void count_unvalidated(std::size_t sequences, std::vector<Proposal>& proposals) {
  auto least = sequences;
  for (auto& each : proposals) {
    each.unvalidated =
        sequences - std::min(sequences, each.verdict.validated) + each.verdict.runs_undemanded;
    if (each.meets_sequences()) least = std::min(least, each.unvalidated);
  }
  for (auto& each : proposals) {
    if (each.changes == Proposal::Changes::kScenario) {
      each.unvalidated = least;
    } else if (each.open) {
      each.unvalidated = std::max(each.unvalidated, least);
    }
  }
}

/// Among equals, the change that permits the fewest new traces, then the one that forbids the
/// fewest.
bool changes_less(const Proposal& a, const Proposal& b) {
  if (likelier(a, b) || likelier(b, a)) return likelier(a, b);
  if (!a.effects || !b.effects || !a.effects->gained || !b.effects->gained) return false;
  const auto gained = cmp(a.effects->gained->value, b.effects->gained->value);
  if (gained != 0 || !a.effects->lost || !b.effects->lost) return gained < 0;
  return a.effects->lost->value < b.effects->lost->value;
}

/// Ties between neighbours that the order cannot distinguish. Of these, long ones come last.
void find_ties(std::vector<Proposal>& proposals) {
  constexpr std::size_t kLong = 100;  // characters
  for (std::size_t begin = 0; begin < proposals.size();) {
    auto end = begin + 1;
    while (end < proposals.size() && !changes_less(proposals[begin], proposals[end])) ++end;
    const auto place = [&](std::size_t i) {
      return proposals.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::stable_partition(place(begin), place(end),
                          [](const Proposal& each) { return each.words.size() <= kLong; });
    for (auto i = begin; i < end; ++i) {
      for (auto j = begin; j < end; ++j) {
        if (i != j) proposals[i].tied.push_back(j + 1);
      }
    }
    begin = end;
  }
}

/// Drops proposals that experiments decided against: those as well founded as the first one that
/// admit fewer runs to their end.
void drop_refuted(std::vector<Proposal>& proposals) {
  if (proposals.empty()) return;
  const auto& first = proposals.front();
  const auto from = std::find_if(proposals.begin(), proposals.end(), [&](const Proposal& other) {
    return other.verdict.runs_whole < first.verdict.runs_whole;
  });
  proposals.erase(std::remove_if(from, proposals.end(),
                                 [&](const Proposal& other) {
                                   return other.changes == first.changes &&
                                          other.size == first.size &&
                                          other.precaution == first.precaution &&
                                          other.verdict.runs_whole < first.verdict.runs_whole;
                                 }),
                  proposals.end());
}

void compare_traces_of(const RepairInput& input, const std::vector<Proposal*>& proposals,
                       Context& context) {
  std::optional<TraceComparer> comparer;
  for (auto* proposal : proposals) {
    if (proposal->effects || !proposal->text) continue;
    auto& known = input.memo->effects;
    if (const auto found = known.find(*proposal->text); found != known.end()) {
      proposal->effects = found->second;
      continue;
    }
    if (!comparer) comparer.emplace(input.loaded, input.text, context);
    proposal->effects = comparer->compare(*proposal->text);
    if (!context.stopped()) known.emplace(*proposal->text, *proposal->effects);
  }
}

/// Do random sequences bear out less than half of what they do for the other? Such a proposal is
/// worth no experiment.
bool clearly_behind(const Proposal& proposal, const Proposal& other) {
  return 2 * proposal.verdict.validated < other.verdict.validated;
}

}  // namespace

void compare_traces(const RepairInput& input, std::vector<Proposal>& proposals, Context& context) {
  std::vector<Proposal*> all;
  for (auto& proposal : proposals) all.push_back(&proposal);
  compare_traces_of(input, all, context);
}

Unranked rank_proposals(const RepairInput& input, std::size_t limit,
                        std::vector<Proposal>& proposals, Context& context) {
  count_unexplained(input.runs, proposals);
  count_unvalidated(input.sequences.choosing.size(), proposals);
  for (auto& each : proposals) {
    each.agrees_less = each.verdict.runs_whole < input.runs - std::min(input.runs, input.failed);
  }
  std::stable_sort(proposals.begin(), proposals.end(), likelier);
  Unranked out;
  if (!proposals.empty() && proposals.front().agrees_less) {
    out.agree_less = proposals.size();
    proposals.clear();
  }
  if (input.experiments > 0) drop_refuted(proposals);
  const auto wanted = limit == 0 ? proposals.size() : limit;
  if (proposals.size() > std::max(wanted, kMostCompared)) {
    const auto kept = std::max(wanted, kMostCompared);
    out.more = true;
    out.not_compared = static_cast<std::size_t>(
        std::count_if(proposals.begin() + static_cast<std::ptrdiff_t>(kept), proposals.end(),
                      [&](const Proposal& each) { return !likelier(proposals.front(), each); }));
    proposals.resize(kept);
  }
  // Traces decide among equals alone, and comparing them takes longer than all that goes before.
  std::vector<Proposal*> equals;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    const bool above = i > 0 && !likelier(proposals[i - 1], proposals[i]);
    const bool below = i + 1 < proposals.size() && !likelier(proposals[i], proposals[i + 1]);
    if (above || below) equals.push_back(&proposals[i]);
  }
  compare_traces_of(input, equals, context);
  std::stable_sort(proposals.begin(), proposals.end(), changes_less);
  if (proposals.size() > wanted) {
    proposals.resize(wanted);
    out.more = true;
  }
  find_ties(proposals);
  return out;
}

std::size_t of_first_rank(const std::vector<Proposal>& proposals) {
  return static_cast<std::size_t>(std::find_if(proposals.begin(), proposals.end(),
                                               [&](const Proposal& other) {
                                                 return changes_less(proposals.front(), other) ||
                                                        proposals.front().changes != other.changes;
                                               }) -
                                  proposals.begin());
}

std::vector<std::size_t> as_well_founded(const std::vector<Proposal>& proposals) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    const auto& a = proposals.front();
    const auto& b = proposals[i];
    if (a.changes == b.changes && a.size == b.size && a.precaution == b.precaution &&
        a.verdict.runs_whole == b.verdict.runs_whole && !clearly_behind(b, a)) {
      out.push_back(i);
    }
  }
  return out;
}

}  // namespace parallax::tools
