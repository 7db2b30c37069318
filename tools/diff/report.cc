#include <fmt/format.h>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "tools/diff/model_difference.h"

namespace parallax::tools {
namespace {

using compiler::Fact;
using compiler::FactDifference;
using compiler::FactKind;
using OrderedJson = nlohmann::ordered_json;

std::string line(char mark, const Fact& fact) {
  return fmt::format("  {} {}  {}\n", mark, to_string(fact.place), fact.shown);
}

OrderedJson json_of(const Fact& fact) {
  return {{"text", fact.shown}, {"file", fact.place.file}, {"line", fact.place.line}};
}

std::string summary(const FactDifference& difference) {
  std::string out;
  const auto add = [&](std::size_t count, const char* what) {
    if (count != 0) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, what);
  };
  add(difference.removed.size(), "removed");
  add(difference.added.size(), "added");
  add(difference.changed.size(), "changed");
  return out;
}

}  // namespace

FactReport compare(const std::vector<Fact>& old_facts, const std::vector<Fact>& new_facts) {
  return {old_facts, new_facts, compiler::compare_facts(old_facts, new_facts)};
}

FactDifference of_kind(const FactReport& report, FactKind kind) {
  auto out = report.difference;
  std::erase_if(out.removed, [&](std::size_t i) { return report.old_facts[i].kind != kind; });
  std::erase_if(out.added, [&](std::size_t i) { return report.new_facts[i].kind != kind; });
  std::erase_if(out.changed,
                [&](const auto& pair) { return report.old_facts[pair.first].kind != kind; });
  return out;
}

std::string to_text(const FactReport& report, FactKind kind, const std::string& title, bool stat) {
  const auto difference = of_kind(report, kind);
  if (difference.empty()) return {};
  auto out = fmt::format("{}: {}\n", title, summary(difference));
  if (stat) return out;
  for (const auto i : difference.removed) out += line('-', report.old_facts[i]);
  for (const auto i : difference.added) out += line('+', report.new_facts[i]);
  for (const auto& [i, j] : difference.changed) {
    out += line('~', report.old_facts[i]);
    out += line(' ', report.new_facts[j]);
  }
  return out;
}

std::string to_json(const FactReport& report, FactKind kind) {
  const auto difference = of_kind(report, kind);
  OrderedJson out = {{"removed", OrderedJson::array()},
                     {"added", OrderedJson::array()},
                     {"changed", OrderedJson::array()}};
  for (const auto i : difference.removed) out["removed"].push_back(json_of(report.old_facts[i]));
  for (const auto i : difference.added) out["added"].push_back(json_of(report.new_facts[i]));
  for (const auto& [i, j] : difference.changed) {
    out["changed"].push_back(
        {{"old", json_of(report.old_facts[i])}, {"new", json_of(report.new_facts[j])}});
  }
  return base::json_text(out);
}

namespace {

using OrderedJson = nlohmann::ordered_json;
using runtime::DifferenceAnswer;

constexpr std::size_t kMaxNames = 10;  // that are listed in one line

std::string number_of(const runtime::TraceNumber& number) {
  return (number.exact ? "" : "at least ") + number.value.get_str();
}

std::string some(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size() && i < kMaxNames; ++i) {
    out += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > kMaxNames) out += fmt::format(" and {} more", names.size() - kMaxNames);
  return out;
}

/// The trace up to the timepoint that rules it out; later events are left out.
runtime::Trace beginning(const runtime::Witness& witness) {
  auto trace = witness.trace;
  trace.points.resize(static_cast<std::size_t>(witness.excluded_by) + 1);
  trace.points.back().happens.clear();
  return trace;
}

/// One direction: the names of both sides, and what is known of it.
struct SideView {
  const char* name;  // "lost"
  const ModelRevision& kept;
  const ModelRevision& refused;
  const runtime::OneSided& traces;
  const std::optional<std::vector<RevisionEdit>>& edits;
  std::set<std::string> edited_places;  // of the refusing side
};

std::string edit_text(const SideView& side, const RevisionEdit& edit, bool lost) {
  // Undoing an edit of the new revision brings the old text back, and the other way round.
  const auto* kept = edit.kept ? &side.kept.facts[*edit.kept] : nullptr;
  const auto* refused = edit.refused ? &side.refused.facts[*edit.refused] : nullptr;
  const auto* before = lost ? kept : refused;
  const auto* after = lost ? refused : kept;
  if (before != nullptr && after != nullptr) {
    return fmt::format("      ~ {}  {}\n        {}  {}\n", to_string(before->place), before->shown,
                       to_string(after->place), after->shown);
  }
  return fmt::format("      {} {}  {}\n", before != nullptr ? '-' : '+',
                     to_string((before != nullptr ? before : after)->place),
                     (before != nullptr ? before : after)->shown);
}

std::string place_of(const compiler::Origin& origin) {
  return fmt::format("{}:{}", base::printable(origin.place.file), origin.place.begin.line);
}

std::string witness_text(const SideView& side, bool lost) {
  const auto& witness = *side.traces.witness;
  auto out =
      fmt::format("  {} such trace of {}, ruled out in {} by timepoint {}:\n",
                  witness.is_shortest ? "a shortest" : "one", base::printable(side.kept.name),
                  base::printable(side.refused.name), witness.excluded_by);
  out += beginning_text(witness);
  if (witness.impossible) {
    out += fmt::format("    {} is false in every trace of {}\n", *witness.impossible,
                       side.refused.name);
  }
  if (!witness.excluding.empty()) out += "    it contradicts\n";
  for (const auto i : witness.excluding) {
    const auto& origin = side.refused.compiled->origins[i];
    const auto* mark = side.edited_places.contains(place_of(origin)) ? " (edited)" : "";
    out += fmt::format("      {}  {}: {}{}\n", place_of(origin), to_string(origin.kind),
                       origin.text, mark);
  }
  if (side.edits && !side.edits->empty()) {
    out +=
        side.edits->size() == 1 ? "    it depends on the edit\n" : "    it depends on the edits\n";
    for (const auto& edit : *side.edits) out += edit_text(side, edit, lost);
  }
  return out;
}

std::string side_text(const SideView& side, bool lost, bool stat) {
  switch (side.traces.answer) {
    case DifferenceAnswer::kNone:
      return fmt::format("  {}: none\n", base::printable(side.name));
    case DifferenceAnswer::kUnknown:
      return fmt::format("  {}: unknown\n", base::printable(side.name));
    case DifferenceAnswer::kFound:
      break;
  }
  auto out = fmt::format("  {}: {}\n", base::printable(side.name), number_of(side.traces.count));
  return stat ? out : out + witness_text(side, lost);
}

std::set<std::string> edited_places(const std::vector<compiler::Fact>& facts,
                                    const compiler::FactDifference& difference, bool old_side) {
  std::set<std::string> out;
  for (const auto i : old_side ? difference.removed : difference.added) {
    out.insert(to_string(facts[i].place));
  }
  for (const auto& [i, j] : difference.changed) {
    out.insert(to_string(facts[old_side ? i : j].place));
  }
  return out;
}

SideView view(const ModelDifference& all, bool lost) {
  if (lost) {
    return {"lost",           all.old_side,   all.new_side,
            all.traces->lost, all.lost_edits, edited_places(all.new_side.facts, all.facts, false)};
  }
  return {"gained",           all.new_side,     all.old_side,
          all.traces->gained, all.gained_edits, edited_places(all.old_side.facts, all.facts, true)};
}

OrderedJson json_of(const runtime::TraceNumber& number) {
  // Beyond 2^53 as a text: JSON readers keep no larger numbers.
  const bool small = number.value <= mpz_class("9007199254740992");
  OrderedJson out;
  out["value"] = small ? OrderedJson(number.value.get_ui()) : OrderedJson(number.value.get_str());
  out["exact"] = number.exact;
  return out;
}

OrderedJson json_of(const std::optional<runtime::TraceNumber>& number) {
  return number ? json_of(*number) : OrderedJson(nullptr);
}

OrderedJson witness_json(const SideView& side, bool lost) {
  const auto& witness = *side.traces.witness;
  OrderedJson out = base::parse_ordered_json(observable_jsonl(witness.trace));
  out.erase("trace");
  out["excluded_by"] = witness.excluded_by;
  out["events"] = witness.events;
  out["shortest"] = witness.is_shortest;
  out["impossible"] = witness.impossible ? OrderedJson(*witness.impossible) : OrderedJson(nullptr);
  out["contradicts"] = OrderedJson::array();
  for (const auto i : witness.excluding) {
    const auto& origin = side.refused.compiled->origins[i];
    out["contradicts"].push_back({{"what", to_string(origin.kind)},
                                  {"text", origin.text},
                                  {"file", origin.place.file},
                                  {"line", origin.place.begin.line},
                                  {"edited", side.edited_places.contains(place_of(origin))}});
  }
  out["edits"] = nullptr;
  if (!side.edits) return out;
  out["edits"] = OrderedJson::array();
  for (const auto& edit : *side.edits) {
    OrderedJson kept = edit.kept ? json_of(side.kept.facts[*edit.kept]) : OrderedJson(nullptr);
    OrderedJson refused =
        edit.refused ? json_of(side.refused.facts[*edit.refused]) : OrderedJson(nullptr);
    out["edits"].push_back(lost ? OrderedJson{{"old", kept}, {"new", refused}}
                                : OrderedJson{{"old", refused}, {"new", kept}});
  }
  return out;
}

OrderedJson side_json(const SideView& side, bool lost) {
  static constexpr const char* kAnswers[] = {"found", "none", "unknown"};
  OrderedJson out = {{"answer", kAnswers[static_cast<std::size_t>(side.traces.answer)]}};
  out["count"] = side.traces.answer == DifferenceAnswer::kUnknown ? OrderedJson(nullptr)
                                                                  : json_of(side.traces.count);
  out["witness"] = side.traces.witness ? witness_json(side, lost) : OrderedJson(nullptr);
  out["solver_calls"] = side.traces.solve_calls;
  out["refinements"] = side.traces.refinements;
  return out;
}

}  // namespace

std::string beginning_text(const runtime::Witness& witness) {
  const auto text = to_text(beginning(witness));
  std::string out;
  // The first line is the trace's number.
  for (auto at = text.find('\n') + 1; at < text.size();) {
    const auto end = text.find('\n', at);
    out += "    " + text.substr(at, end - at + 1);
    at = end + 1;
  }
  return out;
}

std::string witness_text(const ModelDifference& difference, bool lost) {
  return witness_text(view(difference, lost), lost);
}

std::string count_text(const runtime::TraceNumber& number) { return number_of(number); }

std::string traces_text(const ModelDifference& difference, bool stat) {
  if (!difference.traces) return {};
  const auto& traces = *difference.traces;
  const auto& names = traces.vocabulary;
  auto out = fmt::format("traces up to timepoint {}, on {} fluents and {} events\n", traces.horizon,
                         names.fluents, names.events);
  const auto only = [&](const ModelRevision& side, const std::vector<std::string>& list) {
    if (list.empty()) return;
    out += fmt::format("  not compared, as only {} has them: {}\n", base::printable(side.name),
                       some(list));
  };
  only(difference.old_side, names.only_first);
  only(difference.new_side, names.only_second);
  out += side_text(view(difference, true), true, stat);
  out += side_text(view(difference, false), false, stat);
  if (traces.first_count && traces.second_count) {
    out += fmt::format("  all: {} in {}, {} in {}\n", number_of(*traces.first_count),
                       base::printable(difference.old_side.name), number_of(*traces.second_count),
                       base::printable(difference.new_side.name));
  }
  return out;
}

std::string traces_json(const ModelDifference& difference) {
  if (!difference.traces) return "null";
  const auto& traces = *difference.traces;
  OrderedJson out = {{"horizon", traces.horizon},
                     {"shared_fluents", traces.vocabulary.fluents},
                     {"shared_events", traces.vocabulary.events},
                     {"only_old", traces.vocabulary.only_first},
                     {"only_new", traces.vocabulary.only_second},
                     {"old", json_of(traces.first_count)},
                     {"new", json_of(traces.second_count)}};
  out["lost"] = side_json(view(difference, true), true);
  out["gained"] = side_json(view(difference, false), false);
  return base::json_text(out);
}

}  // namespace parallax::tools
