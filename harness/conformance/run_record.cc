#include "harness/conformance/run_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

constexpr std::string_view kDigestName = "digest";

std::optional<double> number_in(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

RunDifference value_difference(const std::string& name, const Value& a, const Value& b,
                               const std::string& when) {
  RunDifference difference;
  const auto x = number_in(a), y = number_in(b);
  if (x && y ? *x == *y : a == b) return difference;
  difference.kind = (x && y) || name == kDigestName ? RunDifference::Kind::kNumbers
                                                    : RunDifference::Kind::kDiscrete;
  if (x && y) difference.largest = std::abs(*x - *y);
  difference.where = fmt::format("`{}` {}: {} and {}", name, when, text_of(a), text_of(b));
  return difference;
}

RunDifference discrete(std::string where) {
  return {RunDifference::Kind::kDiscrete, 0.0, std::move(where)};
}

}  // namespace

std::string text_of(const Value& value) {
  auto text = encode_state({{"", value}});  // {"":VALUE}
  return text.substr(4, text.size() - 5);
}

void RunDifference::add(const RunDifference& other) {
  const bool is_worse = other.kind > kind || (other.kind == kind && other.largest > largest);
  if (is_worse) where = other.where;
  kind = std::max(kind, other.kind);
  largest = std::max(largest, other.largest);
}

RunDifference difference_of(const State& a, const State& b, const std::string& when) {
  RunDifference difference;
  for (const auto& [name, value] : a) {
    const auto other = b.find(name);
    difference.add(other == b.end()
                       ? discrete(fmt::format("`{}` {} is there and is not", name, when))
                       : value_difference(name, value, other->second, when));
  }
  for (const auto& [name, value] : b) {
    if (!a.contains(name)) {
      difference.add(discrete(fmt::format("`{}` {} is not there and is", name, when)));
    }
  }
  return difference;
}

RunDifference difference_of(const RunRecord& a, const RunRecord& b,
                            const std::vector<TriedAction>& actions, double time_slack_s,
                            bool with_digest) {
  RunDifference difference;
  const auto count = std::min(a.states.size(), b.states.size());
  if (a.states.size() != b.states.size()) {
    difference.add(discrete(fmt::format("{} and {} states", a.states.size(), b.states.size())));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto when = i == 0 ? std::string("after `reset`")
                             : fmt::format("after `{}`", actions[i - 1].controller);
    const auto &x = a.outcomes[i], &y = b.outcomes[i];
    if (x.status != y.status) {
      difference.add(discrete(
          fmt::format("the status {}: {} and {}", when, to_string(x.status), to_string(y.status))));
    }
    auto took = value_difference("sim_time", x.sim_time_s, y.sim_time_s, when);
    if (took.largest <= time_slack_s) took.largest = 0.0;
    difference.add(took);
    auto before = a.states[i], after = b.states[i];
    if (!with_digest) {
      before.erase(std::string(kDigestName));
      after.erase(std::string(kDigestName));
    }
    difference.add(difference_of(before, after, when));
  }
  return difference;
}

}  // namespace parallax::harness
