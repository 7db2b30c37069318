#include <fmt/format.h>

#include <optional>
#include <set>

#include "compiler/base/json.h"
#include "compiler/base/word_table.h"
#include "runtime/explain/clause_text.h"
#include "tools/cli/explain_text.h"

namespace parallax::tools {
namespace {

using compiler::AtomKind;
using compiler::Literal;
using nlohmann::ordered_json;
using runtime::WhyKind;
using runtime::WhyStep;

/// Tells a chain of facts in words, earliest first, each with the axiom that it rests on.
class WhyText {
 public:
  /// `model` outlives the object.
  explicit WhyText(const compiler::CompiledModel& model)
      : model_(model), index_(model), clauses_(model) {}

  std::string text(const FactExplanation& explanation) const;
  std::string json(const FactExplanation& explanation) const;

 private:
  std::string state(Literal literal) const;
  std::string when(Literal literal, std::optional<compiler::Timepoint> now) const;
  std::string reason(const WhyStep& step) const;
  std::string inertia(const WhyStep& step) const;
  std::string premises(const WhyStep& step) const;
  std::string line(const WhyStep& step) const;

  const compiler::CompiledModel& model_;
  compiler::AtomIndex index_;
  runtime::ClauseText clauses_;
};

constexpr std::size_t kShownEvents = 4;

constexpr auto kWhyKindWords = base::word_table<WhyKind>(
    "stated", "effect", "inertia", "axiom", "completion", "forced", "chosen", "undecided");

/// `Filled(cup) holds`, `Pour(cup) does not happen`.
std::string WhyText::state(Literal literal) const {
  const auto atom = model_.atom(literal.var());
  const bool is = literal.is_positive();
  switch (atom.kind) {
    case AtomKind::kHoldsAt:
      return atom.name + (is ? " holds" : " does not hold");
    case AtomKind::kHappens:
      return atom.name + (is ? " happens" : " does not happen");
    case AtomKind::kReleasedAt:
      return atom.name + (is ? " is released from inertia" : " is subject to inertia");
    case AtomKind::kLocation:
      return (is ? "the plan is at " : "the plan is not at ") + printed(atom);
    case AtomKind::kHit:
      return is ? "the state constraints hold" : "the state constraints do not hold";
    case AtomKind::kRunning:
      return is ? "the plan goes on" : "the plan has ended";
    case AtomKind::kSucceeded:
      return "the perform at " + printed(atom) + (is ? " succeeded" : " did not succeed");
    case AtomKind::kResult:
      return "the perform before " + std::string(is ? "returned " : "did not return ") +
             printed(atom);
    case AtomKind::kRegister:
      return std::string(is ? "the plan knows " : "the plan does not know ") + printed(atom);
    case AtomKind::kPredicate:
    case AtomKind::kAuxiliary:
    case AtomKind::kUnused:
      break;
  }
  return atom.name + (is ? " is true" : " is false");
}

std::string WhyText::when(Literal literal, std::optional<compiler::Timepoint> now) const {
  const auto time = model_.atom(literal.var()).time;
  if (!time || time == now) return state(literal);
  return fmt::format("{} at {}", state(literal), *time);
}

std::string WhyText::premises(const WhyStep& step) const {
  std::string out;
  for (std::size_t i = 0; i < step.premises.size(); ++i) {
    if (i > 0) out += i + 1 == step.premises.size() ? " and " : ", ";
    out += when(step.premises[i], std::nullopt);
  }
  return out;
}

std::string WhyText::inertia(const WhyStep& step) const {
  const auto fluent = index_.fluent(step.fact.var());
  const bool holds = step.fact.is_positive();
  auto out = fmt::format("as it {} since {}", holds ? "has" : "has not", step.since);
  std::string others;
  for (const auto premise : step.premises) {
    const auto other = model_.atom(premise.var());
    if (other.kind == AtomKind::kHoldsAt && index_.fluent(premise.var()) == fluent) continue;
    others += (others.empty() ? "" : ", ") + when(premise, std::nullopt);
  }
  if (!others.empty()) out += ", because " + others;
  std::set<std::string> absent;
  for (const auto literal : step.absent) absent.insert(model_.atom(literal.var()).name);
  if (absent.empty()) {
    if (others.empty()) out += holds ? ": no event can end it" : ": no event can begin it";
    return out;
  }
  std::string names;
  for (const auto& name : absent) names += (names.empty() ? "" : " nor ") + name;
  if (absent.size() > kShownEvents) {
    return out + fmt::format(": none of the {} events that could {} it happened", absent.size(),
                             holds ? "end" : "begin");
  }
  return out + (absent.size() == 1 ? ": " + names + " did not happen"
                                   : ": neither " + names + " happened");
}

std::string WhyText::reason(const WhyStep& step) const {
  switch (step.kind) {
    case WhyKind::kStated:
      return "stated";
    case WhyKind::kEffect:
    case WhyKind::kAxiom:
      return "because " + premises(step);
    case WhyKind::kInertia:
      return inertia(step);
    case WhyKind::kCompletion:
      return step.premises.empty() ? "nothing could bring it about"
                                   : "nothing else could be the reason, as " + premises(step);
    case WhyKind::kForced:
      return "open so far, but what comes later admits nothing else";
    case WhyKind::kChosen:
      return (step.premises.empty() ? "" : "as " + premises(step) + ", ") +
             std::string("the model leaves it open; this trace has it so");
    case WhyKind::kUndecided:
      return "open so far; stopped before it was known whether what comes later admits anything "
             "else";
  }
  return {};
}

std::string WhyText::line(const WhyStep& step) const {
  const auto time = model_.atom(step.fact.var()).time;
  const auto head = time ? fmt::format("{:>4}  ", *time) : std::string("      ");
  auto out = fmt::format("{}{}: {}\n", head, state(step.fact), reason(step));
  const auto note = [&](const compiler::Origin& origin, const char* word) {
    const auto place = origin_place(origin);
    out += fmt::format("          {}{}{}\n", word, place.empty() ? "" : place + "  ",
                       axiom_text(origin));
  };
  if (step.origin) note(model_.origins[*step.origin], "");
  for (const auto clause : step.also) {
    out += "          also: " + clauses_.clause(clause) + '\n';
    note(model_.origins[model_.clause_origins[clause]], "  ");
  }
  return out;
}

std::string WhyText::text(const FactExplanation& explanation) const {
  if (!explanation.asked) {
    return fmt::format("{} is false in trace {} and in every other: nothing can make it true.\n",
                       explanation.fact.name, explanation.trace);
  }
  auto out =
      fmt::format("{} in trace {}:\n", when(*explanation.asked, std::nullopt), explanation.trace);
  for (const auto& step : explanation.steps) out += line(step);
  return out;
}

std::string WhyText::json(const FactExplanation& explanation) const {
  const auto place = [](const compiler::Origin& origin) {
    return ordered_json{{"file", origin.place.file},
                        {"line", origin.place.begin.line},
                        {"what", to_string(origin.kind)},
                        {"text", origin.text}};
  };
  const auto names = [&](const std::vector<Literal>& literals) {
    auto list = ordered_json::array();
    for (const auto literal : literals) list.push_back(clauses_.literal(literal));
    return list;
  };
  auto list = ordered_json::array();
  for (const auto& step : explanation.steps) {
    ordered_json entry = {{"fact", clauses_.literal(step.fact)},
                          {"why", kWhyKindWords.of(step.kind)}};
    if (step.kind == WhyKind::kInertia) entry["since"] = step.since;
    if (step.origin) entry["axiom"] = place(model_.origins[*step.origin]);
    entry["premises"] = names(step.premises);
    if (!step.absent.empty()) entry["absent"] = names(step.absent);
    auto also = ordered_json::array();
    for (const auto clause : step.also) {
      auto other = place(model_.origins[model_.clause_origins[clause]]);
      other["instance"] = clauses_.clause(clause);
      also.push_back(std::move(other));
    }
    if (!also.empty()) entry["also"] = std::move(also);
    list.push_back(std::move(entry));
  }
  const auto& asked = explanation.asked;
  ordered_json document = {{"status", "ok"}, {"trace", explanation.trace}};
  document["fact"] = asked ? clauses_.literal(*asked) : "!" + explanation.fact.name;
  document["steps"] = std::move(list);
  return base::json_text(document) + '\n';
}

}  // namespace

std::string why_text(const compiler::CompiledModel& model, const FactExplanation& explanation) {
  return WhyText(model).text(explanation);
}

std::string why_json(const compiler::CompiledModel& model, const FactExplanation& explanation) {
  return WhyText(model).json(explanation);
}

}  // namespace parallax::tools
