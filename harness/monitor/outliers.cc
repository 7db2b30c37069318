#include "harness/monitor/outliers.h"

#include <charconv>

namespace parallax::harness {
namespace {

std::optional<std::int64_t> whole_number_in(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<OutlierRate> read_outlier_rate(std::string_view text) {
  constexpr std::int64_t kMostOf = 1'000'000;
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto at_most = whole_number_in(text.substr(0, slash));
  const auto of = whole_number_in(text.substr(slash + 1));
  // At half and more nothing would say which half is right.
  if (!at_most || !of || *at_most < 0 || *of < 1 || *of > kMostOf || *at_most > (*of - 1) / 2) {
    return std::nullopt;
  }
  return OutlierRate{*at_most, *of};
}

void OutlierCount::agreed() {
  ++seen_;
  ++stretch_agreed_;
}

bool OutlierCount::disagreed() {
  ++seen_;
  ++count_;
  ++stretch_outliers_;
  recent_.push_back(seen_);
  if (static_cast<std::int64_t>(recent_.size()) <= rate_.at_most) return true;
  // One more than is allowed, counted back from here.
  const auto first = recent_.front();
  recent_.pop_front();
  return seen_ - first >= rate_.of;
}

bool OutlierCount::end_stretch() {
  const bool holds = stretch_outliers_ == 0 || stretch_agreed_ > stretch_outliers_;
  stretch_agreed_ = stretch_outliers_ = 0;
  return holds;
}

}  // namespace parallax::harness
