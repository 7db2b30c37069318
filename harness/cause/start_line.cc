// The least change of a failing start that makes it pass, one parameter after the other.
//
// A start is shrunk towards the middle of its cell: each parameter is moved there alone and
// stays there if the start still fails as before. A move that ends the failure may not end it
// behind a later one, so each is tried again until nothing has moved since the last attempt.
// What is left decides: moving it, and nothing else, ends the failure. Between the start and the
// middle the border of each such parameter is then bisected, all in step so that simulations run
// in parallel. A scan instead simulates a row of points along one parameter and bisects every
// change of verdict between neighbours.
//
// Cost: parameters * (late moves + 1) simulations, and log2(width / tolerance) for each border.

#include "harness/cause/start_line.h"

#include <algorithm>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

double between(double a, double b) { return a + 0.5 * (b - a); }

StartPoint with(StartPoint start, std::size_t parameter, double value) {
  start[parameter] = value;
  return start;
}

bool tells(StartVerdict verdict) { return verdict != StartVerdict::kNoStart; }

}  // namespace

bool BorderBracket::is_narrow() const {
  if (width() <= tolerance) return true;
  const double half = between(fails, other);
  return half == fails || half == other;
}

bool narrow(std::vector<BorderBracket>& brackets, const StartPoint& base, const StartProbe& probe) {
  while (true) {
    std::vector<BorderBracket*> open;
    std::vector<StartPoint> starts;
    for (auto& bracket : brackets) {
      if (bracket.is_narrow() || bracket.no_start) continue;
      open.push_back(&bracket);
      starts.push_back(with(base, bracket.parameter, between(bracket.fails, bracket.other)));
    }
    if (open.empty()) return true;
    const auto verdicts = probe(starts);
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      auto& bracket = *open[i];
      const double value = starts[i][bracket.parameter];
      if (!tells(verdicts[i])) {
        bracket.no_start = value;
      } else if (verdicts[i] == StartVerdict::kFails) {
        bracket.fails = value;
      } else {
        bracket.other = value;
        bracket.beyond = verdicts[i];
      }
    }
    if (verdicts.size() < starts.size()) return false;
  }
}

namespace {

class Shrinker {
 public:
  Shrinker(const std::vector<CellParameter>& cell, StartPoint failing, const StartProbe& probe)
      : cell_(cell), probe_(probe), beyond_(cell.size(), StartVerdict::kNoStart) {
    out_.start = std::move(failing);
    out_.roles.assign(cell.size(), ParameterRole::kOpen);
  }

  ShrunkStart run(const std::vector<double>& tolerances) {
    if (!try_middle() || !move_each()) return std::move(out_);
    for (std::size_t p = 0; p < cell_.size(); ++p) {
      if (out_.roles[p] != ParameterRole::kDecides) continue;
      out_.borders.push_back({p, out_.start[p], cell_[p].middle(), beyond_[p], tolerances[p], {}});
    }
    out_.finished = narrow(out_.borders, out_.start, probe_);
    return std::move(out_);
  }

 private:
  std::optional<StartVerdict> ask(const StartPoint& start) {
    const auto verdicts = probe_({start});
    return verdicts.empty() ? std::nullopt : std::optional(verdicts.front());
  }

  bool try_middle() {
    auto middle = out_.start;
    for (std::size_t p = 0; p < cell_.size(); ++p) middle[p] = cell_[p].middle();
    out_.middle = ask(middle);
    if (out_.middle != StartVerdict::kFails) return out_.middle.has_value();
    out_.start = std::move(middle);
    out_.roles.assign(cell_.size(), ParameterRole::kIndifferent);
    return true;
  }

  /// A move that ended it may not end it behind a later one: each is tried again until nothing has
  /// moved since.
  bool move_each() {
    std::int64_t moves = 0;
    std::vector<std::int64_t> tried_behind(cell_.size(), -1);  // `moves` at the last attempt
    for (bool any = true; any;) {
      any = false;
      for (std::size_t p = 0; p < cell_.size(); ++p) {
        if (out_.roles[p] == ParameterRole::kIndifferent || tried_behind[p] == moves) continue;
        const auto verdict = ask(with(out_.start, p, cell_[p].middle()));
        if (!verdict) return false;
        any = true;
        tried_behind[p] = moves;
        beyond_[p] = *verdict;
        if (*verdict == StartVerdict::kFails) {
          out_.start[p] = cell_[p].middle();
          out_.roles[p] = ParameterRole::kIndifferent;
          ++moves;
        } else {
          out_.roles[p] = tells(*verdict) ? ParameterRole::kDecides : ParameterRole::kNoStart;
        }
      }
    }
    return true;
  }

  const std::vector<CellParameter>& cell_;
  const StartProbe& probe_;
  std::vector<StartVerdict> beyond_;  // by parameter: with it in the middle
  ShrunkStart out_;
};

}  // namespace

ShrunkStart shrink_start(const std::vector<CellParameter>& cell, StartPoint failing,
                         const std::vector<double>& tolerances, const StartProbe& probe) {
  PARALLAX_REQUIRE(failing.size() == cell.size() && tolerances.size() == cell.size(),
                   "one value and one tolerance for each parameter");
  return Shrinker(cell, std::move(failing), probe).run(tolerances);
}

LineScan scan_line(const CellParameter& range, std::size_t parameter, const StartPoint& failing,
                   std::int64_t points, double tolerance, const StartProbe& probe) {
  PARALLAX_REQUIRE(points >= 2, "both ends of the range");
  LineScan out;
  std::vector<StartPoint> starts;
  for (std::int64_t i = 0; i < points; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(points - 1);
    const double value =
        i + 1 == points ? range.upper : range.lower + share * (range.upper - range.lower);
    if (value != failing[parameter]) starts.push_back(with(failing, parameter, value));
  }
  const auto verdicts = probe(starts);
  out.points.push_back({failing[parameter], StartVerdict::kFails});
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    out.points.push_back({starts[i][parameter], verdicts[i]});
  }
  std::sort(out.points.begin(), out.points.end(),
            [](const auto& a, const auto& b) { return a.value < b.value; });
  if (verdicts.size() < starts.size()) return out;
  const LineScan::Point* before = nullptr;
  for (const auto& point : out.points) {
    if (!tells(point.verdict)) continue;
    const bool fails = point.verdict == StartVerdict::kFails;
    if (before != nullptr && fails != (before->verdict == StartVerdict::kFails)) {
      const auto& inside = fails ? point : *before;
      const auto& beyond = fails ? *before : point;
      out.borders.push_back({parameter, inside.value, beyond.value, beyond.verdict, tolerance, {}});
    }
    before = &point;
  }
  out.finished = narrow(out.borders, failing, probe);
  return out;
}

}  // namespace parallax::harness
