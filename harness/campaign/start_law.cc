#include "harness/campaign/start_law.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/confidence/rounding.h"
#include "harness/sampling/law_draw.h"

namespace parallax::harness {

double LawResult::refused_share() const {
  const auto candidates = static_cast<double>(drawn + refused);
  return candidates > 0.0 ? static_cast<double>(refused) / candidates : 0.0;
}

std::string LawResult::text() const {
  // With executions, each initial state may have entries of its own.
  constexpr std::size_t kMost = 12;
  if (words.size() <= kMost) return fmt::format("{}", fmt::join(words, "; "));
  const auto end = words.begin() + kMost;
  return fmt::format("{}; and {} more", fmt::join(words.begin(), end, "; "), words.size() - kMost);
}

std::string LawResult::refused_text() const {
  if (conditions.empty()) return {};
  std::vector<std::string> parts;
  for (const auto& [text, count] : conditions) {
    if (count > 0) parts.push_back(fmt::format("`{}` {}", text, count));
  }
  return fmt::format("{} of {} candidates ({}){}{}", refused, drawn + refused,
                     percent_about(refused_share()), parts.empty() ? "" : ": ",
                     fmt::join(parts, ", "));
}

std::string left_out_text(const Sampler& sampler) {
  constexpr double kShown = 1e-3;
  const double share = sampler.rim_share();
  const bool is_given = sampler.inset() != Sampler::kDefaultInset;
  if (share <= 0.0 || (!is_given && share <= kShown)) return {};
  return fmt::format("its rim (`inset_m`: {})", sampler.inset());
}

void LawCounter::name(const Sampler& sampler) {
  if (auto text = left_out_text(sampler); !text.empty()) left_out_ = std::move(text);
  const auto* law = sampler.law();
  if (law == nullptr) return;
  if (!result_) result_.emplace();
  auto& words = result_->words;
  for (const auto& word : law->words()) {
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  }
}

void LawCounter::add(const Sampler& sampler, std::uint64_t campaign_seed, std::uint64_t trace_key,
                     const SampleRecord& record) {
  if (record.searched) return;
  name(sampler);
  const auto* law = sampler.law();
  if (law == nullptr) return;
  const auto texts = law->conditions();
  std::vector<std::int64_t> refusals(texts.size());
  for (std::int64_t attempt = 0; attempt <= record.attempt; ++attempt) {
    const auto drawn = sampler.draw_counting(
        {campaign_seed, trace_key, DrawPhase::kCertify, static_cast<std::uint64_t>(record.sample),
         static_cast<std::uint64_t>(attempt)},
        &refusals);
    ++result_->drawn;
    result_->refused += drawn.refused;
  }
  auto& conditions = result_->conditions;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    auto known = std::find_if(conditions.begin(), conditions.end(),
                              [&](const auto& one) { return one.text == texts[i]; });
    if (known == conditions.end()) known = conditions.insert(known, {texts[i], 0});
    known->refused += refusals[i];
  }
}

}  // namespace parallax::harness
