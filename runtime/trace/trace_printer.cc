#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "runtime/trace/trace.h"

namespace parallax::runtime {
namespace {

using Names = std::vector<std::string>;

Names only_in(const Names& a, const Names& b) {
  Names out;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

void append(std::string& out, std::string_view mark, const Names& names) {
  for (const auto& name : names) {
    out += "      ";
    out += mark;
    out += name;
    out += '\n';
  }
}

}  // namespace

std::string to_text(const Trace& trace) {
  std::string out = "trace " + std::to_string(trace.number) + '\n';
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto& point = trace.points[t];
    out += "  " + std::to_string(t) + '\n';
    if (t == 0) {
      append(out, "  ", point.holds);
    } else {
      append(out, "- ", only_in(trace.points[t - 1].holds, point.holds));
      append(out, "+ ", only_in(point.holds, trace.points[t - 1].holds));
    }
    append(out, "> ", point.happens);
  }
  return out;
}

std::string to_jsonl(const Trace& trace) {
  nlohmann::ordered_json out;
  out["trace"] = trace.number;
  auto points = nlohmann::ordered_json::array();
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto& point = trace.points[t];
    points.push_back({{"time", t},
                      {"happens", point.happens},
                      {"holds", point.holds},
                      {"released", point.released}});
  }
  out["timepoints"] = std::move(points);
  out["predicates"] = trace.predicates;
  return out.dump();
}

}  // namespace parallax::runtime
