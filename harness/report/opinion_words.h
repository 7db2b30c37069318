#pragma once

#include <string>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/campaign/second_opinion.h"

namespace parallax::harness {

/// The answers of two simulators on the discrepancies of one cause.
struct CauseOpinion {
  enum class Doubt : std::uint8_t {
    kModel,      // both disagree with it, wherever the other one answered
    kSimulator,  // only the first does, wherever the other one answered
    kEither,     // sometimes one, sometimes the other
    kNoAnswer
  };
  std::string cause;
  std::int64_t both = 0, only = 0, unanswered = 0;
  std::vector<std::string> others;     // what the other one's discrepancies come of, each once
  std::string why_unanswered;          // of the first
  std::int64_t trace = 0, sample = 0;  // the first
  Doubt doubt() const;
};
inline constexpr auto kDoubtWords =
    base::word_table<CauseOpinion::Doubt>("model", "simulator", "either", "no-answer");
constexpr std::string_view to_string(CauseOpinion::Doubt doubt) { return kDoubtWords.of(doubt); }

/// The opinions in the order in which the causes came.
std::vector<CauseOpinion> opinions_by_cause(const SecondOpinion& opinion);

/// A sentence for each cause, and one about the clean simulations.
std::vector<std::string> opinion_sentences(const SecondOpinion& opinion);

/// The member `second_opinion` of the report, as the text of a JSON object.
std::string opinion_json(const SecondOpinion& opinion);

}  // namespace parallax::harness
