#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/app/trace_feed.h"

namespace parallax::tools {

/// Gives traces until a number of simulations is used up. Its constructor arguments outlive it.
class BoundedTraces final : public harness::TraceFeed {
 public:
  BoundedTraces(EnumeratedTraces& traces, const std::int64_t& made, std::int64_t most)
      : traces_(traces), made_(made), most_(most) {}
  base::Result<std::optional<harness::CampaignTrace>> next() override {
    if (made_ < most_) return traces_.next();
    ended_ = true;
    return std::optional<harness::CampaignTrace>();
  }
  bool ended() const { return ended_; }
  std::string exploration() const override { return ended_ ? "stopped" : traces_.exploration(); }
  std::vector<std::string> bounds() const override { return traces_.bounds(); }
  std::string reservation() const override { return traces_.reservation(); }
  runtime::Symbols symbols() const override { return traces_.symbols(); }
  base::Known admits(const harness::CampaignTrace& trace,
                     const std::vector<std::map<compiler::FluentId, bool>>& observed) override {
    return traces_.admits(trace, observed);
  }
  base::Result<std::optional<harness::TraceStarts>> starts(
      const harness::CampaignTrace& trace, std::span<const compiler::FluentId> fluents) override {
    return traces_.starts(trace, fluents);
  }
  base::Result<std::pair<base::Known, std::optional<harness::CampaignTrace>>> from(
      const harness::CampaignTrace& trace, std::span<const compiler::FluentId> fluents,
      const std::vector<compiler::FluentId>& state) override {
    return traces_.from(trace, fluents, state);
  }

 private:
  EnumeratedTraces& traces_;
  const std::int64_t& made_;
  std::int64_t most_;
  bool ended_ = false;
};

}  // namespace parallax::tools
