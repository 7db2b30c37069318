#include <fmt/format.h>

#include <map>

#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/json.h"
#include "tools/mutate/mutation_score.h"

namespace parallax::tools {
namespace {

using OrderedJson = nlohmann::ordered_json;

struct Numbers {
  std::size_t noticed = 0, unnoticed = 0, equivalent = 0, invalid = 0, unknown = 0, open = 0;
  void add(MutantOutcome outcome) {
    switch (outcome) {
      case MutantOutcome::kOpen:
        ++open;
        break;
      case MutantOutcome::kNoticed:
        ++noticed;
        break;
      case MutantOutcome::kUnnoticed:
        ++unnoticed;
        break;
      case MutantOutcome::kEquivalent:
        ++equivalent;
        break;
      case MutantOutcome::kInvalid:
        ++invalid;
        break;
      case MutantOutcome::kUnknown:
        ++unknown;
        break;
    }
  }
  std::size_t observable() const { return noticed + unnoticed; }
};

/// Rounded down, so that 100 % means all of them.
std::string share(std::size_t part, std::size_t whole) {
  if (whole == 0) return "-";
  const auto tenths = part * 1000 / whole;
  return fmt::format("{}.{} %", tenths / 10, tenths % 10);
}

Numbers all_of(const MutationScore& score) {
  Numbers out;
  for (const auto& judgement : score.judgements) out.add(judgement.outcome);
  return out;
}

std::string witness(const MutantJudgement& judgement) {
  const auto* whose = judgement.gained ? "of the mutant, which the original has not"
                                       : "of the original, which the mutant has not";
  return fmt::format("  {} has a trace {} (ruled out by timepoint {}):\n{}",
                     base::printable(judgement.told_in), whose, judgement.excluded_by,
                     judgement.trace);
}

std::string readers(const MutationScore& score) {
  std::string out =
      fmt::format("{:<28} {:>8} {:>9} {:>10} {:>10} {:>7} {:>7}\n", "mistake", "noticed",
                  "unnoticed", "share", "equivalent", "invalid", "unknown");
  std::map<std::string, Numbers> kinds;
  for (std::size_t i = 0; i < score.mutants.size(); ++i) {
    kinds[score.mutants[i].kind].add(score.judgements[i].outcome);
  }
  for (const auto& [kind, of] : kinds) {
    out += fmt::format("{:<28} {:>8} {:>9} {:>10} {:>10} {:>7} {:>7}\n", kind, of.noticed,
                       of.unnoticed, share(of.noticed, of.observable()), of.equivalent, of.invalid,
                       of.unknown);
  }
  return out;
}

OrderedJson json_of(const Mutant& mutant, const MutantJudgement& judgement) {
  OrderedJson out = {{"file", mutant.file},
                     {"line", mutant.line},
                     {"kind", mutant.kind},
                     {"words", mutant.words},
                     {"outcome", to_string(judgement.outcome)}};
  if (!judgement.by.empty()) out["noticed_by"] = judgement.by;
  if (!judgement.why.empty()) out["why"] = judgement.why;
  if (judgement.outcome != MutantOutcome::kUnnoticed) return out;
  out["witness"] = base::parse_ordered_json(judgement.trace_json);
  if (!out["witness"].is_object()) out["witness"] = OrderedJson::object();
  out["witness"].erase("trace");
  out["witness"]["case"] = judgement.told_in;
  out["witness"]["of"] = judgement.gained ? "mutant" : "original";
  out["witness"]["excluded_by"] = judgement.excluded_by;
  return out;
}

}  // namespace

std::string mutation_text(const MutationScore& score) {
  std::string out;
  if (!score.red.empty()) {
    for (const auto& line : score.red) out += line + '\n';
    return out + fmt::format(
                     "{} of {} cases do not pass: a suite can be scored when all of its cases do\n",
                     score.red.size(), score.cases);
  }
  for (std::size_t i = 0; i < score.mutants.size(); ++i) {
    const auto& mutant = score.mutants[i];
    const auto& judgement = score.judgements[i];
    const auto outcome = judgement.outcome;
    if (outcome != MutantOutcome::kUnnoticed && outcome != MutantOutcome::kUnknown) continue;
    out += fmt::format("{}:{}: {}, {}: {}\n", base::printable(mutant.file), mutant.line,
                       to_string(outcome), mutant.kind, base::printable(mutant.words));
    out += outcome == MutantOutcome::kUnnoticed ? witness(judgement)
                                                : "  " + base::printable(judgement.why) + '\n';
  }
  const auto all = all_of(score);
  if (!out.empty()) out += '\n';
  out += readers(score);
  for (const auto& text : score.passed_over) out += base::printable(text) + '\n';
  if (score.mutants.size() < score.made) {
    out += fmt::format("of {} mutants {} were looked at, evenly spread\n", score.made,
                       score.mutants.size());
  }
  if (all.open > 0)
    out += fmt::format("{} mutants were not looked at: go on with --resume\n", all.open);
  out += fmt::format("score {}: {} of {} observable mutants are noticed\n",
                     share(all.noticed, all.observable()), all.noticed, all.observable());
  return out;
}

std::string mutation_document(const MutationScore& score) {
  const auto all = all_of(score);
  OrderedJson out = {{"status", "ok"}, {"cases", score.cases}, {"suite_passes", score.red.empty()}};
  if (!score.red.empty()) out["not_passed"] = score.red;
  out["made"] = score.made;
  out["looked_at"] = score.mutants.size() - all.open;
  out["noticed"] = all.noticed;
  out["observable"] = all.observable();
  out["score"] =
      all.observable() == 0
          ? OrderedJson(nullptr)
          : OrderedJson(static_cast<double>(all.noticed) / static_cast<double>(all.observable()));
  out["equivalent"] = all.equivalent;
  out["invalid"] = all.invalid;
  out["unknown"] = all.unknown;
  out["passed_over"] = score.passed_over;
  out["mutants"] = OrderedJson::array();
  for (std::size_t i = 0; i < score.mutants.size(); ++i) {
    out["mutants"].push_back(json_of(score.mutants[i], score.judgements[i]));
  }
  return base::json_text(out) + '\n';
}

}  // namespace parallax::tools
