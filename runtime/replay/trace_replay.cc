// Is a trace that somebody claims one of a model? One solver call, and more only if not.
//
// The claims become assumptions, one literal for each atom that the trace gives a value; atoms
// that it does not mention stay open and are completed by the solver. The state constraints have
// to hold at the end and not before. A trace has to be the beginning of a valuation of the whole
// horizon, so a second call asks for that. If one of them fails, prefixes are tried from the
// shortest on: the first timepoint up to which no trace agrees is where the claims go wrong. If
// no prefix fails, the constraints hold too early, or not at the end. An atom that has no
// variable is false in every trace, so a claim that it is true fails at its timepoint unless
// something fails earlier. For an explanation the claims are added as clauses that are always
// kept, and a core of the axioms is taken.
//
// Cost: two calls for a trace that agrees, up to two for each timepoint of the horizon for
// others.

#include "runtime/replay/trace_replay.h"

namespace parallax::runtime {

using compiler::AtomKind;
using Kind = ReplayVerdict::Kind;

namespace {

/// None for atoms of a plan's control and the like, which traces do not mention.
const AtomClaims* claims_of(const ClaimedTrace& trace, AtomKind kind,
                            std::optional<Timepoint> time) {
  if (kind == AtomKind::kPredicate) return &trace.predicates;
  if (!time) return nullptr;
  const auto& point = trace.points[static_cast<std::size_t>(*time)];
  if (kind == AtomKind::kHoldsAt) return &point.holds;
  if (kind == AtomKind::kHappens) return &point.happens;
  return kind == AtomKind::kReleasedAt ? &point.released : nullptr;
}

}  // namespace

TraceReplay::TraceReplay(const CompiledModel& model, MakeSolver make_solver)
    : model_(&model),
      make_solver_(std::move(make_solver)),
      session_(model, make_solver_()),
      index_(model),
      symbols_(symbols_of(model)) {
  for (std::size_t f = 0; f < model.fluents.size(); ++f) {
    if (!model.fluents[f].slot) never_holds_.insert(model.fluents[f].name);
    if (!model.release_slots[f]) never_released_.insert(model.fluents[f].name);
  }
  for (const auto& event : model.events) {
    if (!event.slot) never_happens_.insert(event.name);
  }
}

/// With state constraints a trace ends where they hold first: at 0 only if the model asks there.
std::pair<Timepoint, Timepoint> TraceReplay::lengths() const {
  if (!model_->has_constraints) return {model_->horizon, model_->horizon};
  return {index_.hit(0) ? 0 : 1, model_->horizon};
}

TraceReplay::Units TraceReplay::units_of(const ClaimedTrace& trace) const {
  Units units;
  model_->for_each_atom([&](const compiler::AtomRef& atom) {
    const auto needed = atom.needed_horizon(model_->horizon);
    if (needed > trace.length()) return;
    const auto* claims = claims_of(trace, atom.kind, atom.time);
    if (claims == nullptr) return;
    const auto value = claims->value(atom.name);
    if (!value) {
      ++units.hidden;
      return;
    }
    units.said.push_back({*value ? atom.literal() : ~atom.literal(), needed});
  });
  return units;
}

/// Atoms without a variable are false in every trace.
std::optional<ReplayVerdict> TraceReplay::impossible_claim(const ClaimedTrace& trace) const {
  ReplayVerdict verdict;
  verdict.kind = Kind::kFails;
  const auto look = [&](const char* predicate, const AtomClaims& claims,
                        const std::unordered_set<std::string>& never) {
    for (const auto& [name, claim] : claims.listed) {
      if (!claim.value || !never.contains(name)) continue;
      verdict.impossible = claim;
      verdict.impossible_atom =
          std::string(predicate) + '(' + name + ',' + std::to_string(verdict.timepoint) + ')';
      return true;
    }
    return false;
  };
  for (const auto& point : trace.points) {
    if (look("HoldsAt", point.holds, never_holds_) ||
        look("Happens", point.happens, never_happens_) ||
        look("ReleasedAt", point.released, never_released_)) {
      return verdict;
    }
    ++verdict.timepoint;
  }
  return std::nullopt;
}

SolveStatus TraceReplay::solve(const Units& units, Timepoint n, std::span<const Literal> more) {
  std::vector<Literal> assumptions(more.begin(), more.end());
  for (const auto& unit : units.said) {
    if (unit.needed <= n) assumptions.push_back(unit.literal);
  }
  return session_.solve(n, assumptions);
}

ReplayVerdict TraceReplay::replay(const ClaimedTrace& trace) {
  const auto length = trace.length();
  PARALLAX_REQUIRE(length >= lengths().first && length <= lengths().second,
                   "a length that traces of the model can have");
  const auto units = units_of(trace);
  if (auto impossible = impossible_claim(trace)) {
    // Something before it may fail as well.
    auto earlier = find_failure(units, 0, impossible->timepoint);
    if (earlier.kind == Kind::kFails && earlier.timepoint < impossible->timepoint) {
      impossible = std::move(earlier);
    }
    impossible->hidden = units.hidden;
    return *std::move(impossible);
  }
  std::vector<Literal> hits;
  if (model_->has_constraints) {
    for (Timepoint t = lengths().first; t <= length; ++t) {
      const auto hit = index_.hit(t);
      PARALLAX_REQUIRE(hit.has_value(), "every timepoint from the first has its hit atom");
      hits.push_back(t < length ? ~*hit : *hit);
    }
  }
  ReplayVerdict verdict;
  auto status = solve(units, length, hits);
  const bool goes_this_far = status == SolveStatus::kSatisfiable;
  if (goes_this_far) {
    auto assumptions = hits;
    for (const auto& unit : units.said) assumptions.push_back(unit.literal);
    status = session_.solve_whole(length, assumptions);
  }
  if (status == SolveStatus::kSatisfiable) {
    verdict.kind = Kind::kAgrees;
    verdict.completion = decode_trace(*model_, symbols_, length,
                                      [&](Literal literal) { return session_.value(literal); });
    verdict.completion.number = trace.number;
  } else if (status == SolveStatus::kUnsatisfiable && goes_this_far) {
    verdict = find_failure(units, length + 1, model_->horizon);
    if (verdict.kind == Kind::kAgrees) verdict = find_end(units, length);
  } else if (status == SolveStatus::kUnsatisfiable) {
    verdict = find_failure(units, 0, length);
    if (verdict.kind == Kind::kAgrees) verdict = find_end(units, length);
  }
  verdict.hidden = units.hidden;
  return verdict;
}

/// The first timepoint from `first` to `last` up to which no trace of the model agrees with the
/// claims; kAgrees if there is none.
ReplayVerdict TraceReplay::find_failure(const Units& units, Timepoint first, Timepoint last) {
  ReplayVerdict verdict;
  for (Timepoint n = first; n <= last; ++n) {
    const auto status = solve(units, n, {});
    if (status == SolveStatus::kSatisfiable) continue;
    verdict.kind = status == SolveStatus::kUnsatisfiable ? Kind::kFails : Kind::kUnknown;
    verdict.timepoint = n;
    return verdict;
  }
  verdict.kind = Kind::kAgrees;
  return verdict;
}

/// Where the state constraints hold too early, or else the end, where they do not.
ReplayVerdict TraceReplay::find_end(const Units& units, Timepoint length) {
  ReplayVerdict verdict;
  std::vector<Literal> no_hits;
  for (Timepoint t = lengths().first; t < length; ++t) {
    no_hits.push_back(~*index_.hit(t));
    const auto status = solve(units, length, no_hits);
    if (status == SolveStatus::kSatisfiable) continue;
    verdict.kind = status == SolveStatus::kUnsatisfiable ? Kind::kNoFirstHit : Kind::kUnknown;
    verdict.timepoint = t;
    return verdict;
  }
  verdict.kind = Kind::kNoFirstHit;
  verdict.timepoint = length;
  return verdict;
}

UnsatCore TraceReplay::blame(const ClaimedTrace& trace, Timepoint timepoint) const {
  // The claims join as definitions: those are never left out of a core.
  auto model = *model_;
  const auto origin = static_cast<std::uint32_t>(model.origins.size());
  model.origins.push_back({{}, compiler::OriginKind::kTrace});
  for (const auto& unit : units_of(trace).said) {
    if (unit.needed > timepoint) continue;
    model.clauses.add(std::span(&unit.literal, 1));
    model.clause_timepoints.push_back(unit.needed);
    model.clause_origins.push_back(origin);
    model.clause_is_definition.push_back(true);
  }
  return find_unsat_core(model, timepoint, make_solver_());
}

}  // namespace parallax::runtime
