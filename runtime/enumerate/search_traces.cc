#include "runtime/enumerate/search_traces.h"

#include <algorithm>

#include "runtime/enumerate/projection.h"

namespace parallax::runtime {
namespace {

/// The flag is looked at after so many conflicts.
constexpr std::int64_t kSlice = 1000;

std::vector<Literal> joined(const std::vector<std::vector<Literal>>& blocks) {
  std::vector<Literal> out;
  for (const auto& block : blocks) out.insert(out.end(), block.begin(), block.end());
  return out;
}

}  // namespace

SearchTraces::SearchTraces(const CompiledModel& model, Distinct distinct,
                           const std::atomic<bool>* stop, std::int64_t conflicts)
    : model_(model),
      stop_(stop),
      conflicts_(conflicts),
      search_(model.variable_count(), joined(projection_blocks(model, distinct))) {
  for (std::size_t c = 0; c < model.clauses.size(); ++c) search_.add_clause(model.clauses[c]);
  search_.begin({});
}

std::optional<Trace> SearchTraces::next() {
  using Status = ClauseSearch::Status;
  if (exhausted_ || gave_up_) return std::nullopt;
  auto left = conflicts_;
  auto status = Status::kGaveUp;
  while (status == Status::kGaveUp && left > 0) {
    if (stop_ != nullptr && stop_->load()) return std::nullopt;
    status = search_.next(std::min(left, kSlice));
    left -= kSlice;
  }
  exhausted_ = status == Status::kNoMore;
  gave_up_ = status == Status::kGaveUp;
  if (status != Status::kFound) return std::nullopt;
  const auto value = [&](Literal literal) { return search_.value(literal); };
  for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
    const auto clause = model_.clauses[c];
    PARALLAX_REQUIRE(std::any_of(clause.begin(), clause.end(), value),
                     "what the search finds satisfies every clause");
  }
  auto trace = decode_trace(model_, model_.horizon, value);
  trace.number = ++found_;
  return trace;
}

SourceStats SearchTraces::stats() const {
  SourceStats stats;
  stats.strategy = "search";
  return stats;
}

}  // namespace parallax::runtime
