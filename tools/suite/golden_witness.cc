#include "tools/suite/golden_witness.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "compiler/base/json.h"

namespace parallax::tools {
namespace {

constexpr std::string_view kHead = "trace ";

/// The first line with its end.
std::string_view front_line(std::string_view text) {
  return text.substr(0, std::min(text.find('\n'), text.size() - 1) + 1);
}

std::vector<ListedTrace> traces_in(std::string_view text) {
  std::vector<ListedTrace> out;
  while (!text.empty()) {
    const auto line = front_line(text);
    text.remove_prefix(line.size());
    if (!line.starts_with(kHead) || !line.ends_with('\n')) continue;
    // Its lines are the indented ones below.
    std::size_t size = 0;
    while (size < text.size() && text[size] == ' ') size += front_line(text.substr(size)).size();
    out.push_back(
        {line.substr(kHead.size(), line.size() - kHead.size() - 1), text.substr(0, size)});
    text.remove_prefix(size);
  }
  return out;
}

std::optional<ListedTrace> shortest_without(const std::vector<ListedTrace>& traces,
                                            const std::vector<ListedTrace>& others) {
  std::set<std::string_view> known;
  for (const auto& trace : others) known.insert(trace.text);
  std::optional<ListedTrace> best;
  std::ptrdiff_t fewest = 0;
  for (const auto& trace : traces) {
    if (known.contains(trace.text)) continue;
    const auto lines = std::count(trace.text.begin(), trace.text.end(), '\n');
    if (best && lines >= fewest) continue;
    best = trace;
    fewest = lines;
  }
  return best;
}

}  // namespace

ListDifference list_difference(std::string_view expected, std::string_view found) {
  const auto before = traces_in(expected), now = traces_in(found);
  return {shortest_without(before, now), shortest_without(now, before)};
}

std::string jsonl_of(const ListedTrace& trace) {
  constexpr std::size_t kMark = 6;  // column of the mark of a fluent or event
  auto points = nlohmann::json::array();
  std::set<std::string, std::less<>> holds;
  for (auto text = trace.text; !text.empty();) {
    auto line = front_line(text);
    text.remove_prefix(line.size());
    if (line.ends_with('\n')) line.remove_suffix(1);
    const auto indent = std::min(line.find_first_not_of(' '), line.size());
    if (indent == 2) {
      if (!points.empty()) points.back()["holds"] = holds;
      points.push_back({{"time", points.size()}, {"happens", nlohmann::json::array()}});
      continue;
    }
    if (indent < kMark || line.size() < kMark + 3 || points.empty()) return {};
    const auto name = line.substr(kMark + 2);
    switch (line[kMark]) {
      case ' ':
      case '+':
        holds.emplace(name);
        break;
      case '-':
        holds.erase(std::string(name));
        break;
      case '>':
        points.back()["happens"].push_back(name);
        break;
      case '=':
        points.back()["returned"] = name;
        break;
      default:
        return {};
    }
  }
  if (points.empty()) return {};
  points.back()["holds"] = holds;
  return base::json_text(nlohmann::json{{"trace", 1}, {"timepoints", points}}) + '\n';
}

std::string refusal_of(std::string_view replay_document) {
  const auto json = base::parse_json(replay_document);
  const auto* list = base::json_member(json, "list");
  if (list == nullptr || !list->is_array() || list->empty()) return {};
  const auto& first = list->front();
  const auto member = [&](const char* name) {
    const auto* found = base::json_member(first, name);
    return found == nullptr ? nlohmann::json() : *found;
  };
  if (!member("text").is_string() || !member("timepoint").is_number_integer()) return {};
  auto out = fmt::format("ruled out at timepoint {}: {}", member("timepoint").get<std::int64_t>(),
                         member("text").get<std::string>());
  if (member("file").is_string() && member("line").is_number_integer()) {
    out += fmt::format("\n  {}:{}", member("file").get<std::string>(),
                       member("line").get<std::int64_t>());
  }
  return out;
}

}  // namespace parallax::tools
