#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/base/shown_text.h"
#include "runtime/explain/clause_text.h"
#include "tools/app/blame.h"

namespace parallax::tools {
namespace {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Literal;
using compiler::OriginKind;
using PartingKind = Parting::Kind;
using Role = Difference::Role;

std::string joined_with_and(const std::vector<std::string>& parts) {
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) out += i + 1 == parts.size() ? " and " : ", ";
    out += parts[i];
  }
  return out;
}

/// An axiom without its quantifiers in front.
std::string axiom_words(const compiler::Origin& origin) {
  auto text = origin.text;
  if (text.starts_with('[')) {
    const auto end = text.find(']');
    if (end != std::string::npos) text.erase(0, text.find_first_not_of(' ', end + 1));
  }
  return text.empty() ? std::string(compiler::to_string(origin.kind)) : '`' + text + '`';
}

/// "domain.e:9"; empty for an origin without a place in a text.
std::string place_of(const compiler::Origin& origin) {
  if (origin.place.file.empty()) return {};
  return fmt::format("{}:{}", base::printable(origin.place.file), origin.place.begin.line);
}

std::string in_brackets(const std::string& place) {
  return place.empty() ? place : " (" + place + ')';
}

class BlameWords {
 public:
  BlameWords(const CompiledModel& model, const ObservedPath& path, const Parting& parting)
      : model_(model), index_(model), path_(path), parting_(parting), texts_(model) {}

  std::string text(const std::vector<std::size_t>& clauses) const {
    switch (parting_.kind) {
      case PartingKind::kFluents:
        return of_fluent(clauses);
      case PartingKind::kTogether:
        return together(clauses);
      case PartingKind::kOutcome:
        return outcome(clauses);
      case PartingKind::kImpossible:
        return impossible(clauses);
      case PartingKind::kNoState:
        return no_state();
    }
    return {};
  }

 private:
  const ObservedStep& step() const { return path_.steps[parting_.after - 1]; }
  std::size_t at() const { return parting_.after - 1; }
  bool has_failed() const { return step().outcome.status != harness::SimStatus::kOk; }
  const compiler::Origin& origin(std::size_t clause) const {
    return model_.origins[model_.clause_origins[clause]];
  }
  bool is_effect(std::size_t clause) const {
    const auto kind = origin(clause).kind;
    return kind == OriginKind::kEffectAxiom || kind == OriginKind::kTrajectoryAxiom;
  }
  std::string reason() const { return reason_of(step().outcome); }

  /// "The simulation refused `Go(r2)` at 4 (no way): `RobotAt(r2)` does not hold at 5", "While
  /// `Go(r2)` happened at 4, `Holding(a)` ceased to hold".
  std::string seen_first(const Difference& first) const {
    const auto seen = seen_words(path_, parting_, first);
    if (path_.steps.empty() || parting_.after == 0) return "At the start " + seen;
    if (has_failed()) {
      return fmt::format("The simulation refused `{}` at {} ({}): {}", step().name, at(), reason(),
                         seen);
    }
    if (!step().succeeded) {
      return fmt::format("`{}` at {} failed for the plan: {}", step().name, at(), seen);
    }
    return fmt::format("`{}` at {} went well, {} {}", step().name, at(),
                       first.observed ? "and" : "but", seen);
  }

  /// The negation of a clause's literal, in words: the condition under which the clause applies.
  std::optional<std::string> condition(Literal literal) const {
    if (texts_.is_auxiliary(literal.var())) return std::nullopt;
    const auto atom = model_.atom(literal.var());
    const bool asked = !literal.is_positive();
    if (atom.kind == AtomKind::kHappens) {
      return fmt::format("`{}` {}", atom.name, asked ? "happens" : "does not happen");
    }
    const auto name = atom.kind == AtomKind::kHoldsAt || atom.kind == AtomKind::kPredicate
                          ? atom.name
                          : texts_.literal(Literal::positive(literal.var()));
    return (asked ? "`" : "not `") + name + '`';
  }

  bool is_seen(Literal literal) const {
    const auto atom = model_.atom(literal.var());
    if (atom.kind != AtomKind::kHoldsAt) return true;
    const auto fluent = index_.fluent(literal.var());
    const auto t = static_cast<std::size_t>(*atom.time);
    return t < path_.states.size() && path_.states[t].contains(*fluent);
  }

  /// " if `A` and not `B`, which was so at 4", " without a condition".
  std::string conditions(std::size_t clause, Literal concluded) const {
    std::vector<std::string> asked, unseen;
    for (const auto literal : model_.clauses[clause]) {
      if (literal == concluded || literal == ~happens()) continue;
      const auto text = condition(literal);
      if (!text) return " under a condition that was met: " + axiom_words(origin(clause));
      asked.push_back(*text);
      if (!is_seen(literal)) unseen.push_back(*text);
    }
    if (asked.empty()) return " without a condition";
    auto out = fmt::format(" if {}, which was so at {}", joined_with_and(asked), at());
    if (!unseen.empty()) {
      out +=
          unseen.size() == asked.size()
              ? " as the model has it (nobody saw it)"
              : fmt::format(" ({} as the model has it: nobody saw that)", joined_with_and(unseen));
    }
    return out;
  }

  Literal happens() const {
    const auto slot = model_.events[step().event.index()].slot;
    return Literal::positive(
        model_.variable(slot.value_or(0), static_cast<compiler::Timepoint>(at())));
  }

  /// The instance that concludes the opposite of a difference: of an effect axiom, else of inertia,
  /// else of another axiom.
  struct Conclusion {
    std::size_t clause;
    const Difference* difference;
    Literal predicted;
  };
  std::optional<Conclusion> conclusion(const std::vector<std::size_t>& clauses) const {
    const auto rank = [&](std::size_t clause) {
      return is_effect(clause) ? 0 : origin(clause).kind == OriginKind::kFrameAxiom ? 1 : 2;
    };
    std::optional<Conclusion> best;
    for (const auto& difference : parting_.differences) {
      const auto atom = model_.holds_at(difference.fluent, parting_.observed.length);
      if (!atom) continue;
      const auto predicted = difference.observed ? ~*atom : *atom;
      for (const auto clause : clauses) {
        const auto literals = model_.clauses[clause];
        if (std::find(literals.begin(), literals.end(), predicted) == literals.end()) continue;
        if (!best || rank(clause) < rank(best->clause)) {
          best = Conclusion{clause, &difference, predicted};
        }
      }
      if (best) break;
    }
    return best;
  }

  std::string of_fluent(const std::vector<std::size_t>& clauses) const {
    const auto found = conclusion(clauses);
    if (!found) {
      return fmt::format("{}, which the axioms below exclude together.",
                         seen_first(parting_.differences.front()));
    }
    const auto seen = seen_first(*found->difference);
    if (is_effect(found->clause)) return seen + ", " + effect(*found);
    if (origin(found->clause).kind == OriginKind::kFrameAxiom) return seen + ", " + inertia(*found);
    return seen + ", " + axiom(found->clause) + '.';
  }

  std::string effect(const Conclusion& found) const {
    const auto literals = model_.clauses[found.clause];
    const bool of_event = std::find(literals.begin(), literals.end(), ~happens()) != literals.end();
    const auto place = in_brackets(place_of(origin(found.clause)));
    if (!of_event) {
      return fmt::format("though the model says otherwise{}: {}.", place,
                         axiom_words(origin(found.clause)));
    }
    auto out = fmt::format("though the model says that `{}` {} it{}{}.", step().name,
                           found.difference->observed ? "terminates" : "initiates",
                           conditions(found.clause, found.predicted), place);
    if (has_failed()) {
      out += fmt::format(" The model predicts success: no axiom knows why `{}` should fail.",
                         step().name);
    }
    return out;
  }

  std::string inertia(const Conclusion& found) const {
    const bool observed = found.difference->observed;
    const auto fluent = found.difference->fluent;
    std::size_t since = at();
    while (since > 0) {
      const auto& before = path_.states[since - 1];
      const auto value = before.find(fluent);
      if (value == before.end() || value->second == observed) break;
      --since;
    }
    auto out = fmt::format(
        "though in the model it {} at {} by inertia from {}: no axiom {} it while `{}` happens{}.",
        observed ? "still does not hold" : "still holds", parting_.after, since,
        observed ? "begins" : "ends", step().name, in_brackets(place_of(origin(found.clause))));
    for (const auto& near : near_misses(found)) out += ' ' + near;
    return out;
  }

  /// The instances of axioms with exactly this effect of the event whose conditions were nearest to
  /// being met.
  std::vector<std::size_t> nearest_instances(const Conclusion& found) const {
    std::vector<std::size_t> out;
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (origin(c).kind != OriginKind::kEffectAxiom) continue;
      const auto literals = model_.clauses[c];
      const auto has = [&](Literal wanted) {
        return std::find(literals.begin(), literals.end(), wanted) != literals.end();
      };
      if (!has(~found.predicted) || !has(~happens())) continue;
      const auto same = std::find_if(out.begin(), out.end(), [&](std::size_t other) {
        return model_.clause_origins[other] == model_.clause_origins[c];
      });
      if (same == out.end()) {
        out.push_back(c);
      } else if (conditions_at(literals, Unmet::kSeen).size() <
                 conditions_at(model_.clauses[*same], Unmet::kSeen).size()) {
        *same = c;
      }
    }
    return out;
  }

  /// Axioms with that very effect of the event, whose conditions were not met.
  std::vector<std::string> near_misses(const Conclusion& found) const {
    constexpr std::size_t kMost = 2;
    const auto* would = found.difference->observed ? "begin" : "end";
    std::vector<std::string> out;
    for (const auto c : nearest_instances(found)) {
      if (out.size() == kMost) break;
      const auto literals = model_.clauses[c];
      const auto place = in_brackets(place_of(origin(c)));
      if (const auto unmet = conditions_at(literals, Unmet::kSeen); !unmet.empty()) {
        out.push_back(
            fmt::format("An axiom that would {} it asks for {}, which was not so at {}{}.", would,
                        joined_with_and(unmet), at(), place));
      } else if (const auto open = conditions_at(literals, Unmet::kUnseen); !open.empty()) {
        out.push_back(
            fmt::format("An axiom that would {} it asks for {}, which the model denies at {}{}.",
                        would, joined_with_and(open), at(), place));
      } else {
        out.push_back(
            fmt::format("An axiom that would {} it has a condition that was not met{}: {}.", would,
                        place, axiom_words(origin(c))));
      }
    }
    return out;
  }

  /// Conditions that were observed to be false, or else the unobserved ones, if they are plain.
  enum class Unmet : std::uint8_t { kSeen, kUnseen };
  std::vector<std::string> conditions_at(std::span<const Literal> literals, Unmet wanted) const {
    std::vector<std::string> out;
    for (const auto literal : literals) {
      if (texts_.is_auxiliary(literal.var())) {
        if (wanted == Unmet::kUnseen) return {};
        continue;
      }
      const auto atom = model_.atom(literal.var());
      if (atom.kind != AtomKind::kHoldsAt || static_cast<std::size_t>(*atom.time) != at()) continue;
      const auto& state = path_.states[at()];
      const auto value = state.find(*index_.fluent(literal.var()));
      const bool is_wanted = wanted == Unmet::kUnseen
                                 ? value == state.end()
                                 : value != state.end() && value->second == literal.is_positive();
      if (is_wanted) out.push_back(*condition(literal));
    }
    return out;
  }

  /// "which an axiom excludes (domain.e:3): `...`"
  std::string axiom(std::size_t clause) const {
    const auto& from = origin(clause);
    const auto place = in_brackets(place_of(from));
    const auto* what = from.kind == OriginKind::kPlanStep     ? "which the plan excludes"
                       : from.kind == OriginKind::kCompletion ? "of which nothing is the reason"
                                                              : "which an axiom excludes";
    return fmt::format("{}{}: {}", what, place, axiom_words(from));
  }

  /// The axiom that excludes the state: the first one that is not generated, if there is one.
  std::string exclusion(const std::vector<std::size_t>& clauses) const {
    const auto stated = std::find_if(clauses.begin(), clauses.end(), [&](std::size_t clause) {
      return origin(clause).kind == OriginKind::kAxiom;
    });
    if (stated != clauses.end()) return axiom(*stated);
    return clauses.empty() ? "which the model excludes" : axiom(clauses.front());
  }

  /// "`A` holds and `B` does not hold": the observed fluents that are needed for the contradiction.
  std::string needed() const {
    std::vector<std::string> out;
    for (const auto& [fluent, holds] : parting_.needed) {
      out.push_back(fmt::format("`{}` {}", model_.fluents[fluent.index()].name,
                                holds ? "holds" : "does not hold"));
    }
    return out.empty() ? "the state was seen" : joined_with_and(out);
  }

  std::string together(const std::vector<std::size_t>& clauses) const {
    const auto when = parting_.after == 0
                          ? std::string("At the start")
                          : fmt::format("`{}` at {} {}, and", step().name, at(),
                                        has_failed() ? "failed (" + reason() + ')' : "went well");
    return fmt::format("{} {} at {}: the model allows each by itself, but not together, {}.", when,
                       needed(), parting_.after, exclusion(clauses));
  }

  std::string outcome(const std::vector<std::size_t>& clauses) const {
    const auto& done = step();
    const auto how = !done.succeeded       ? "failed (" + reason() + ')'
                     : done.object.empty() ? std::string("succeeded")
                                           : "found `" + done.object + '`';
    const auto place = clauses.empty() ? std::string() : place_of(origin(clauses.front()));
    return fmt::format(
        "`{}` at {} {}, but {} at {}, which by the formula of success is {} of this perform{}.",
        done.name, at(), how, needed(), parting_.after,
        done.succeeded && done.object.empty() ? "a failure"
        : done.succeeded                      ? "another result"
                                              : "a success",
        in_brackets(place));
  }

  std::string impossible(const std::vector<std::size_t>& clauses) const {
    const auto against = std::find_if(clauses.begin(), clauses.end(), [&](std::size_t clause) {
      const auto literals = model_.clauses[clause];
      return std::find(literals.begin(), literals.end(), ~happens()) != literals.end();
    });
    if (against == clauses.end()) {
      return fmt::format("`{}` happened at {}, where it cannot in the model, {}.", step().name,
                         at(), exclusion(clauses));
    }
    std::vector<std::string> given;
    for (const auto literal : model_.clauses[*against]) {
      if (literal == ~happens()) continue;
      if (const auto text = condition(literal)) given.push_back(*text);
    }
    return fmt::format("`{}` happened at {}, where the model forbids it{}: {}{}.", step().name,
                       at(), given.empty() ? "" : " because of " + joined_with_and(given),
                       axiom_words(origin(*against)), in_brackets(place_of(origin(*against))));
  }

  std::string no_state() const {
    std::vector<std::string> what;
    for (const auto fluent : path_.points[parting_.after].neither) {
      what.push_back('`' + model_.fluents[fluent.index()].name + "` is neither so nor so");
    }
    for (const auto& text : path_.points[parting_.after].outside) {
      what.push_back('`' + text + '`');
    }
    const auto when = parting_.after == 0 ? std::string("At the start")
                                          : fmt::format("After `{}` at {}", step().name, at());
    return fmt::format(
        "{} {} was seen at {}, for which no state of a model stands: the regions and "
        "the mapping say so, no axiom does.",
        when, joined_with_and(what), parting_.after);
  }

  const CompiledModel& model_;
  compiler::AtomIndex index_;
  const ObservedPath& path_;
  const Parting& parting_;
  runtime::ClauseText texts_;
};

}  // namespace

std::string reason_of(const harness::ActionOutcome& outcome) {
  if (outcome.reason.empty()) return std::string(harness::to_string(outcome.status));
  return outcome.reason;
}

std::string seen_words(const ObservedPath& path, const Parting& parting,
                       const Difference& difference) {
  const auto t = parting.after;
  if (difference.neither) {
    return fmt::format("`{}` neither holds nor does not at {}", difference.name, t);
  }
  std::optional<bool> before;
  if (t > 0) {
    const auto& state = path.states[t - 1];
    const auto found = state.find(difference.fluent);
    if (found != state.end()) before = found->second;
  }
  const auto* how = difference.observed ? (before == true ? "still holds" : "holds")
                    : before == true    ? "no longer holds"
                                        : "does not hold";
  return fmt::format("`{}` {} at {}", difference.name, how, t);
}

std::string blame_words(const CompiledModel& model, const ObservedPath& path,
                        const Parting& parting, const std::vector<std::size_t>& clauses) {
  return BlameWords(model, path, parting).text(clauses);
}

std::string consequence_words(const ObservedPath& path, const Parting& parting) {
  const auto list = [&](Role role) {
    std::vector<std::string> out;
    for (const auto& difference : parting.differences) {
      if (difference.role == role) out.push_back(seen_words(path, parting, difference));
    }
    return joined_with_and(out);
  };
  std::vector<std::string> out;
  if (const auto found = list(Role::kFollows); !found.empty()) {
    out.push_back("It follows that " + found + '.');
  }
  if (const auto found = list(Role::kSameAction); !found.empty()) {
    out.push_back(fmt::format("Other effects of `{}` that are missing: {}.",
                              path.steps[parting.after - 1].name, found));
  }
  if (const auto found = list(Role::kFurther); !found.empty()) {
    out.push_back("Besides, " + found + '.');
  }
  return fmt::format("{}", fmt::join(out, " "));
}

}  // namespace parallax::tools
