#include "tools/app/coverage_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "compiler/base/json.h"

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

std::string_view name_of(CoverageGroup group) {
  return kCoverageGroups[static_cast<std::size_t>(group)];
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
  const auto why = count.traces > 0 ? fmt::format("in {} of the model's traces", count.traces)
                                    : std::string("in no trace that was looked at");
  if (key.group == CoverageGroup::kTraces) return fmt::format("    {}\n", key.id);
  return fmt::format("    {}:{}  {}  ({})\n", key.file, key.line, what, why);
}

void add_group(const Coverage& coverage, CoverageGroup group, std::string& out) {
  const auto entries = entries_of(coverage, group);
  if (entries.empty()) return;
  std::vector<const Entry*> missed;
  std::int64_t in_traces = 0;
  for (const auto* entry : entries) {
    if (entry->second.hits == 0) missed.push_back(entry);
    if (entry->second.traces > 0) ++in_traces;
  }
  out += fmt::format("  {:<10}{} of {} simulated", name_of(group), entries.size() - missed.size(),
                     entries.size());
  if (group != CoverageGroup::kTraces) out += fmt::format(", {} in traces", in_traces);
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
  out["traces"] = count.traces;
  return out;
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
    auto out = fmt::format("TN:\nSF:{}\n", file);
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
  auto out =
      fmt::format("{} run{}, {} simulation{}\n", coverage.runs, coverage.runs == 1 ? "" : "s",
                  coverage.simulations, coverage.simulations == 1 ? "" : "s");
  for (const auto& scenario : coverage.scenarios) out += fmt::format("  scenario  {}\n", scenario);
  for (std::size_t i = 0; i < kCoverageGroups.size(); ++i) {
    add_group(coverage, static_cast<CoverageGroup>(i), out);
  }
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
                                {"all_traces", coverage.all_traces}};
  for (const auto name : kCoverageGroups) {
    out[std::string(name)] = nlohmann::ordered_json::array();
  }
  for (const auto& entry : coverage.items) {
    out[std::string(name_of(entry.first.group))].push_back(json_of(entry));
  }
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
