#include "tools/app/coverage_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "compiler/base/words.h"
#include "harness/confidence/rounding.h"

namespace parallax::tools {
namespace {

using Entry = std::pair<const CoverageKey, CoverageCount>;

constexpr std::size_t kMostListed = 40;  // of a group, in the text

std::vector<const Entry*> entries_of(const Coverage& coverage, CoverageGroup group) {
  std::vector<const Entry*> out;
  for (const auto& entry : coverage.items) {
    if (entry.first.group == group) out.push_back(&entry);
  }
  return out;
}

/// A name in a tracefile ends at a comma or the end of the line.
std::string plain(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == '\n' || c == '\r'; }, ' ');
  return text;
}

std::string uncovered_line(const Entry& entry) {
  const auto& [key, count] = entry;
  const auto& what = count.text.empty() ? key.id : count.text;
  if (key.group == CoverageGroup::kTraces) return "    " + base::printable(key.id) + '\n';
  std::string why;
  if (count.traces > 0) why = fmt::format("  (in {} of the model's traces)", *count.traces);
  if (count.traces == 0) why = "  (in no trace that was looked at)";
  return base::printable(fmt::format("    {}:{}  {}{}", key.file, key.line, what, why)) + '\n';
}

void add_group(const Coverage& coverage, CoverageGroup group, std::string& out) {
  const auto entries = entries_of(coverage, group);
  if (entries.empty()) return;
  std::vector<const Entry*> missed;
  std::int64_t in_traces = 0;
  bool has_traces = false;
  for (const auto* entry : entries) {
    if (entry->second.hits == 0) missed.push_back(entry);
    if (entry->second.traces > 0) ++in_traces;
    has_traces = has_traces || entry->second.traces.has_value();
  }
  out += fmt::format("  {:<10}{} of {} simulated", kCoverageGroups.of(group),
                     entries.size() - missed.size(), entries.size());
  if (has_traces && group != CoverageGroup::kTraces)
    out += fmt::format(", {} in traces", in_traces);
  out += missed.empty() ? "\n" : "; not simulated:\n";
  for (std::size_t i = 0; i < std::min(missed.size(), kMostListed); ++i) {
    out += uncovered_line(*missed[i]);
  }
  if (missed.size() > kMostListed) {
    out += fmt::format("    and {} more (--json lists them)\n", missed.size() - kMostListed);
  }
}

nlohmann::ordered_json json_of(const Entry& entry) {
  const auto& [key, count] = entry;
  nlohmann::ordered_json out = {
      {"id", key.id}, {"file", key.file}, {"line", key.line}, {"column", key.column}};
  if (!count.text.empty()) out["text"] = count.text;
  out["hits"] = count.hits;
  if (count.traces) out["traces"] = *count.traces;
  return out;
}

std::string_view lacking_text(const WorldBehaviour& one) {
  if (one.what == "event") return "no such event is possible there";
  if (one.what == "outcome") return "it cannot end so there";
  return one.event == "start" ? "it does not begin so" : "it has no such state after it";
}

/// Lists the behaviours that only the model or only the world has, where plans were executed.
void add_differences(const Coverage& coverage, std::string& out) {
  const auto more = [&](std::size_t count) {
    if (count <= kMostListed) return;
    out += fmt::format("    and {} more (--json lists them)\n", count - kMostListed);
  };
  const auto& never = coverage.never_shown;
  if (!never.empty()) {
    out += "  model behaviours that the world never showed\n";
    for (std::size_t i = 0; i < std::min(never.size(), kMostListed); ++i) {
      const auto& [scenario, one, possible, executions, confidence, bound] = never[i];
      out += fmt::format(
          "    {}:{}  {} {}: possible in {} of {} executions; with confidence {} in fewer than "
          "{} of such\n",
          one.file, one.line, one.event, one.outcome, possible, executions,
          harness::level_text(confidence), harness::percent_up(bound));
    }
    more(never.size());
    out +=
        "    (such: executions from a start drawn as these were, in which the model has it "
        "possible;"
        "\n    each bound holds by itself)\n";
  }
  const auto& lacking = coverage.lacking;
  if (lacking.empty()) return;
  out += "  world behaviours that the model lacks\n";
  for (std::size_t i = 0; i < std::min(lacking.size(), kMostListed); ++i) {
    const auto& one = lacking[i];
    out += fmt::format("    {}{}{} {}: {}{}{} ({} execution{}, the first 1.{})\n", one.place,
                       one.place.empty() ? "" : "  ", one.event, one.outcome, lacking_text(one),
                       one.fluents.empty() ? "" : "; observed: ", fmt::join(one.fluents, ", "),
                       one.runs, base::agreed(one.runs, "", "s"), one.example);
  }
  more(lacking.size());
}

nlohmann::ordered_json json_of(const NeverShown& one) {
  const auto& what = one.behaviour;
  return {{"scenario", one.scenario},
          {"file", what.file},
          {"line", what.line},
          {"column", what.column},
          {"event", what.event},
          {"outcome", what.outcome},
          {"possible", one.possible},
          {"executions", one.executions},
          {"confidence", one.confidence},
          {"bound", one.bound}};
}

nlohmann::ordered_json json_of(const WorldBehaviour& one) {
  return {{"scenario", one.scenario}, {"source", one.place},
          {"event", one.event},       {"outcome", one.outcome},
          {"lacks", one.what},        {"observed", one.fluents},
          {"executions", one.runs},   {"example", fmt::format("1.{}", one.example)}};
}

/// The record of one file.
class LcovRecord {
 public:
  void add(const Entry& entry) {
    const auto& [key, count] = entry;
    if (key.group == CoverageGroup::kBranches) {
      branches_[{key.line, block_of(key)}].emplace_back(key.id, count.hits);
    } else if (key.group == CoverageGroup::kEvents || key.group == CoverageGroup::kHandlers) {
      functions_.push_back({key.line, plain(key.id), count.hits});
    }
    auto& line = lines_[key.line];
    line = std::max(line, count.hits);
  }

  std::string text(const std::string& file) const {
    auto out = fmt::format("TN:\nSF:{}\n", base::printable(file));
    std::int64_t hit = 0;
    for (const auto& f : functions_) out += fmt::format("FN:{},{}\n", f.line, f.name);
    for (const auto& f : functions_) {
      out += fmt::format("FNDA:{},{}\n", f.hits, f.name);
      hit += f.hits > 0 ? 1 : 0;
    }
    out += fmt::format("FNF:{}\nFNH:{}\n", functions_.size(), hit);
    std::int64_t found = 0, block = 0;
    hit = 0;
    for (const auto& [place, ways] : branches_) {
      const bool reached =
          std::any_of(ways.begin(), ways.end(), [](const auto& way) { return way.second > 0; });
      for (std::size_t i = 0; i < ways.size(); ++i) {
        ++found;
        hit += ways[i].second > 0 ? 1 : 0;
        // `-`: control was never there.
        out += fmt::format("BRDA:{},{},{},{}\n", place.first, block, i,
                           reached ? std::to_string(ways[i].second) : "-");
      }
      ++block;
    }
    out += fmt::format("BRF:{}\nBRH:{}\n", found, hit);
    hit = 0;
    for (const auto& [line, hits] : lines_) {
      out += fmt::format("DA:{},{}\n", line, hits);
      hit += hits > 0 ? 1 : 0;
    }
    return out + fmt::format("LF:{}\nLH:{}\nend_of_record\n", lines_.size(), hit);
  }

 private:
  struct Function {
    std::uint32_t line = 0;
    std::string name;
    std::int64_t hits = 0;
  };
  /// Both ways of one decision: its place, and its text without the value.
  static std::pair<std::uint32_t, std::string> block_of(const CoverageKey& key) {
    auto text = key.id;
    for (const std::string_view end : {" succeeds", " fails", ": true", ": false"}) {
      if (text.ends_with(end)) {
        text.resize(text.size() - end.size());
        break;
      }
    }
    return {key.column, text};
  }

  std::vector<Function> functions_;
  std::map<std::pair<std::uint32_t, std::pair<std::uint32_t, std::string>>,
           std::vector<std::pair<std::string, std::int64_t>>>
      branches_;  // by line and decision
  std::map<std::uint32_t, std::int64_t> lines_;
};

}  // namespace

std::string coverage_text(const Coverage& coverage) {
  auto out = fmt::format("{}, {}\n", base::counted(coverage.runs, "run"),
                         base::counted(coverage.simulations, "simulation"));
  for (const auto& scenario : coverage.scenarios)
    out += fmt::format("  scenario  {}\n", base::printable(scenario));
  for (std::size_t i = 0; i < kCoverageGroups.size(); ++i) {
    add_group(coverage, static_cast<CoverageGroup>(i), out);
  }
  add_differences(coverage, out);
  if (!coverage.all_traces) {
    out += "  there are more traces than were looked at (--limit)\n";
  }
  return out;
}

std::string coverage_json(const Coverage& coverage) {
  nlohmann::ordered_json out = {{"status", "ok"},
                                {"runs", coverage.runs},
                                {"simulations", coverage.simulations},
                                {"scenarios", coverage.scenarios},
                                {"executions", coverage.executions},
                                {"all_traces", coverage.all_traces}};
  for (const auto name : kCoverageGroups) {
    out[std::string(name)] = nlohmann::ordered_json::array();
  }
  for (const auto& entry : coverage.items) {
    out[std::string(kCoverageGroups.of(entry.first.group))].push_back(json_of(entry));
  }
  for (const auto* name : {"never_shown", "not_in_model"}) {
    out[name] = nlohmann::ordered_json::array();
  }
  for (const auto& one : coverage.never_shown) out["never_shown"].push_back(json_of(one));
  for (const auto& one : coverage.lacking) out["not_in_model"].push_back(json_of(one));
  return base::json_text(out);
}

std::string coverage_lcov(const Coverage& coverage) {
  std::map<std::string, LcovRecord> files;
  for (const auto& entry : coverage.items) {
    if (entry.first.group != CoverageGroup::kTraces) files[entry.first.file].add(entry);
  }
  std::string out;
  for (const auto& [file, record] : files) out += record.text(file);
  return out;
}

}  // namespace parallax::tools
