#include "tools/diff/fact_report.h"

#include <fmt/format.h>

#include "compiler/base/json.h"

namespace parallax::tools {
namespace {

using compiler::Fact;
using compiler::FactDifference;
using compiler::FactKind;
using Json = nlohmann::ordered_json;

std::string line(char mark, const Fact& fact) {
  return fmt::format("  {} {}  {}\n", mark, to_string(fact.place), fact.shown);
}

Json json_of(const Fact& fact) {
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
  Json out = {{"removed", Json::array()}, {"added", Json::array()}, {"changed", Json::array()}};
  for (const auto i : difference.removed) out["removed"].push_back(json_of(report.old_facts[i]));
  for (const auto i : difference.added) out["added"].push_back(json_of(report.new_facts[i]));
  for (const auto& [i, j] : difference.changed) {
    out["changed"].push_back(
        {{"old", json_of(report.old_facts[i])}, {"new", json_of(report.new_facts[j])}});
  }
  return base::json_text(out);
}

}  // namespace parallax::tools
