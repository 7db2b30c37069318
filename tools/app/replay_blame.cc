#include "tools/app/replay_blame.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

namespace parallax::tools {
namespace {

constexpr std::size_t kMaxNotes = 5;            // for one trace
constexpr std::size_t kMaxLookedThrough = 500;  // looked through for the first one

std::set<std::string> truths(const runtime::AtomClaims& claims) {
  std::set<std::string> names;
  for (const auto& [name, claim] : claims.listed) {
    if (claim.value) names.insert(name);
  }
  return names;
}

compiler::Valuation claimed_valuation(const runtime::ClaimedTrace& trace) {
  compiler::Valuation valuation;
  for (const auto& point : trace.points) {
    valuation.holds.push_back(truths(point.holds));
    valuation.happens.push_back(truths(point.happens));
    valuation.released.push_back(truths(point.released));
  }
  valuation.predicates = truths(trace.predicates);
  return valuation;
}

base::DiagnosticNote note_at(const base::SourceRange& source, std::string text) {
  const bool placed = source.end > source.begin;
  return {placed ? std::optional(source) : std::nullopt, std::move(text)};
}

}  // namespace

std::optional<Blame> evaluated_blame(const runtime::ClaimedTrace& trace,
                                     const compiler::ReferenceEvaluator& evaluator) {
  auto found = evaluator.violations(claimed_valuation(trace), kMaxLookedThrough).violations;
  if (found.empty()) return std::nullopt;
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.timepoint < b.timepoint; });
  Blame blame{found.front().timepoint, note_at(found.front().source, found.front().text), {}};
  for (std::size_t i = 1; i < found.size() && i <= kMaxNotes; ++i) {
    blame.others.push_back(note_at(found[i].source, found[i].text));
  }
  return blame;
}

std::optional<Blame> core_blame(const compiler::Compilation& compilation,
                                const runtime::TraceReplay& replay,
                                const runtime::ClaimedTrace& trace,
                                const runtime::ReplayVerdict& verdict) {
  const auto core = replay.blame(trace, verdict.timepoint);
  if (core.status != runtime::SolveStatus::kUnsatisfiable) return std::nullopt;
  Blame blame{verdict.timepoint, {}, {}};
  for (const auto index : core.origins) {
    const auto& origin = compilation.model.origins[index];
    auto note = note_at(origin.source, std::string(to_string(origin.kind)));
    // In a compiled model the source is a line of that file.
    if (compilation.typed == nullptr) {
      note.text += fmt::format(" of {}:{}", origin.place.file, origin.place.begin.line);
    }
    if (blame.first.text.empty()) {
      note.text += ": it cannot hold with what the trace says";
      const auto others = core.origins.size() - 1;
      if (others > 0) note.text += fmt::format(" and {} others", others);
      if (verdict.hidden > 0) note.text += ", whatever it does not mention";
      blame.first = std::move(note);
    } else if (blame.others.size() < kMaxNotes) {
      blame.others.push_back(std::move(note));
    }
  }
  return blame;
}

}  // namespace parallax::tools
