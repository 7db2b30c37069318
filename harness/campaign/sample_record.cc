#include "harness/campaign/sample_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

#include "compiler/base/ascii.h"
#include "compiler/base/shown_text.h"
#include "compiler/base/utf8.h"
#include "harness/campaign/sample_row.h"

namespace parallax::harness {
namespace {

std::optional<RecordDifference> differing_outcome(const ActionOutcome& a, const ActionOutcome& b,
                                                  std::int64_t timepoint) {
  if (a.status != b.status) {
    return RecordDifference{timepoint, "act: status", std::string(to_string(a.status)),
                            std::string(to_string(b.status))};
  }
  if (a.reason != b.reason) return RecordDifference{timepoint, "act: reason", a.reason, b.reason};
  if (a.object != b.object) return RecordDifference{timepoint, "act: object", a.object, b.object};
  if (!bit_equal(a.sim_time_s, b.sim_time_s)) {
    return RecordDifference{timepoint, "act: sim_time_s", exact_text(a.sim_time_s),
                            exact_text(b.sim_time_s)};
  }
  return std::nullopt;
}

std::optional<RecordDifference> differing_state(const State& a, const State& b,
                                                std::int64_t timepoint) {
  auto left = a.begin();
  auto right = b.begin();
  while (left != a.end() || right != b.end()) {
    const bool only_left = right == b.end() || (left != a.end() && left->first < right->first);
    const bool only_right = left == a.end() || (right != b.end() && right->first < left->first);
    if (only_left)
      return RecordDifference{timepoint, left->first, exact_text(left->second), "absent"};
    if (only_right) {
      return RecordDifference{timepoint, right->first, "absent", exact_text(right->second)};
    }
    if (!bit_equal(left->second, right->second)) {
      return RecordDifference{timepoint, left->first, exact_text(left->second),
                              exact_text(right->second)};
    }
    ++left;
    ++right;
  }
  return std::nullopt;
}

}  // namespace

std::string recorded_words(std::string_view words) {
  auto line = base::with_invalid_utf8_replaced(words);  // the journal holds text
  std::replace_if(line.begin(), line.end(), base::is_space, ' ');
  return base::printable(line);
}

std::string reason_word(const ActionOutcome& outcome) {
  if (outcome.status == SimStatus::kOk) return "failed";
  if (outcome.reason.empty() || outcome.status == SimStatus::kTruncated) {
    return std::string(to_string(outcome.status));
  }
  return outcome.reason.substr(0, outcome.reason.find(':'));
}

std::vector<KindCount> count_kinds(std::span<const SampleRecord> records) {
  std::map<std::string, std::int64_t> counts;
  for (const auto& record : records) {
    if (!record.kind.empty()) ++counts[record.kind];
  }
  std::vector<KindCount> out;
  for (const auto& [kind, count] : counts) out.push_back({kind, count});
  return out;
}

double simulated_s(std::span<const SampleRecord> records) {
  double sum = 0.0;
  for (const auto& record : records) {
    for (const auto& outcome : record.outcomes) sum += outcome.sim_time_s;
  }
  return sum;
}

bool is_drawn(const SampleRecord& record) {
  return !record.searched && !record.visit && (!record.path || record.path->target.empty());
}

bool is_of_the_solver(const SampleRecord& record) {
  return record.reason.starts_with(kOfTheSolver);
}

std::string loss_kind(std::string_view reason) {
  constexpr std::size_t kLongest = 80;
  auto end = std::min({reason.find(": "), reason.find(" ("), reason.size()});
  if (end == 0) return "no reason given";
  if (end <= kLongest) return std::string(reason.substr(0, end));
  for (end = kLongest; end > 0 && base::continues_code_point(reason[end]);) --end;
  return std::string(reason.substr(0, end)) + "...";
}

std::string digest_of(const SampleRecord& record) {
  if (record.observations.empty()) return {};
  const auto found = record.observations.back().find("digest");
  if (found == record.observations.back().end()) return {};
  const auto* text = std::get_if<std::string>(&found->second);
  return text != nullptr ? *text : std::string();
}

bool bit_equal(const Value& a, const Value& b) {
  const auto* x = std::get_if<double>(&a);
  const auto* y = std::get_if<double>(&b);
  if (x != nullptr && y != nullptr) {
    return std::bit_cast<std::uint64_t>(*x) == std::bit_cast<std::uint64_t>(*y);
  }
  return a == b;
}

std::string exact_text(const Value& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const double number = std::get<double>(value);
  return fmt::format("{} ({:a})", number, number);
}

std::optional<RecordDifference> first_difference(const SampleRecord& a, const SampleRecord& b) {
  if (a.status != b.status) {
    return RecordDifference{0, "status", std::string(to_string(a.status)),
                            std::string(to_string(b.status))};
  }
  const auto timepoints = std::max(a.observations.size(), b.observations.size());
  for (std::size_t t = 0; t < timepoints; ++t) {
    const auto time = static_cast<std::int64_t>(t);
    if (t > 0 && t <= a.outcomes.size() && t <= b.outcomes.size()) {
      if (auto found = differing_outcome(a.outcomes[t - 1], b.outcomes[t - 1], time)) return found;
    }
    if (t >= a.observations.size() || t >= b.observations.size()) {
      const bool has_a = t < a.observations.size();
      return RecordDifference{time, "observation", has_a ? "present" : "absent",
                              has_a ? "absent" : "present"};
    }
    if (auto found = differing_state(a.observations[t], b.observations[t], time)) return found;
  }
  if (a.digest != b.digest) {
    return RecordDifference{static_cast<std::int64_t>(timepoints), "digest", a.digest, b.digest};
  }
  return std::nullopt;
}

SampleRow sample_row(const SampleRecord& record, const char* outcome) {
  SampleRow row;
  row.trace = record.trace;
  row.sample = record.sample;
  row.seed = record.seed;
  row.rejected = record.rejected;
  row.retries = record.retries;
  row.start_state = record.start_state;
  row.drawn = is_drawn(record);
  row.outcome = outcome;
  row.reason = record.reason;
  row.start = record.initial;
  row.kind = record.kind;
  for (const auto& one : record.outcomes) {
    row.sim_time_s += one.sim_time_s;
    row.margins.push_back(one.margins);
  }
  return row;
}

}  // namespace parallax::harness
