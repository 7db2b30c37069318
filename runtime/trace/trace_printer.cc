#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "compiler/base/json.h"
#include "runtime/trace/trace.h"
#include "runtime/trace/trace_format.h"

namespace parallax::runtime {
namespace {

template <typename Id>
std::vector<Id> only_in(const std::vector<Id>& a, const std::vector<Id>& b) {
  std::vector<Id> out;
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

bool is_plain(char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; }

/// `["A","B"]`; atoms are names and numbers, but a name in the text may need escapes.
template <typename Text>
std::string json_list(const std::vector<Text>& names) {
  std::string out = "[";
  for (const auto& name : names) {
    if (out.size() > 1) out += ',';
    if (std::all_of(name.begin(), name.end(), is_plain)) {
      out.append(1, '"').append(name).append(1, '"');
    } else {
      out += base::json_text(nlohmann::json(name));
    }
  }
  return out += ']';
}

class TextFormat final : public TraceFormat {
 public:
  std::string head(const std::string& number, const std::string& orbit) const override {
    return "trace " + number + (orbit.empty() ? "" : ", stands for " + orbit) + '\n';
  }
  std::string introduction(Timepoint t) const override { return "  " + std::to_string(t) + '\n'; }
  std::string point(const compiler::SymbolTable& symbols, const TracePoint* before,
                    const TracePoint& point) const override {
    std::string out;
    if (before == nullptr) {
      append(out, "  ", sorted_names(symbols, point.holds));
    } else {
      append(out, "- ", sorted_names(symbols, only_in(before->holds, point.holds)));
      append(out, "+ ", sorted_names(symbols, only_in(point.holds, before->holds)));
    }
    append(out, "> ", sorted_names(symbols, point.happens));
    if (point.returned) append(out, "= ", {*point.returned});
    return out;
  }
  std::string tail(const std::vector<std::string>&) const override { return ""; }
};

class JsonlFormat final : public TraceFormat {
 public:
  /// `tells_all`: also ReleasedAt and user predicates.
  explicit JsonlFormat(bool tells_all) : tells_all_(tells_all) {}
  std::string head(const std::string& number, const std::string& orbit) const override {
    return "{\"trace\":" + number + (orbit.empty() ? "" : ",\"orbit\":" + orbit) +
           ",\"timepoints\":[";
  }
  std::string introduction(Timepoint t) const override {
    return (t == 0 ? "{\"time\":" : ",{\"time\":") + std::to_string(t);
  }
  std::string point(const compiler::SymbolTable& symbols, const TracePoint*,
                    const TracePoint& point) const override {
    return ",\"happens\":" + json_list(sorted_names(symbols, point.happens)) +
           ",\"holds\":" + json_list(sorted_names(symbols, point.holds)) +
           (tells_all_ ? ",\"released\":" + json_list(sorted_names(symbols, point.released)) : "") +
           (point.returned ? ",\"returned\":" + base::json_text(nlohmann::json(*point.returned))
                           : "") +
           '}';
  }
  std::string tail(const std::vector<std::string>& predicates) const override {
    return (tells_all_ ? "],\"predicates\":" + json_list(predicates) : "]") + "}\n";
  }

 private:
  bool tells_all_;
};

std::string without_end(std::string line) {
  line.pop_back();
  return line;
}

/// The object on this line with how the plan ended.
std::string with_ending(std::string object, const Trace& trace) {
  if (trace.ended.empty()) return object;
  object.pop_back();
  return object + ",\"ended\":" + base::json_text(nlohmann::json(trace.ended)) + '}';
}

}  // namespace

const TraceFormat& text_format() {
  static const TextFormat format;
  return format;
}

const TraceFormat& jsonl_format() {
  static const JsonlFormat format(true);
  return format;
}

std::string format_trace(const TraceFormat& format, const Trace& trace) {
  return format_trace(format, trace, std::to_string(trace.number));
}

std::string format_trace(const TraceFormat& format, const Trace& trace, const std::string& number) {
  static const compiler::SymbolTable kNoSymbols;
  const auto& symbols = trace.symbols == nullptr ? kNoSymbols : *trace.symbols;
  auto out = format.head(number, trace.orbit);
  const TracePoint* before = nullptr;
  Timepoint t = 0;
  for (const auto& point : trace.points) {
    out += format.introduction(t++);
    out += format.point(symbols, before, point);
    before = &point;
  }
  return out + format.tail(trace.predicates);
}

std::string to_text(const Trace& trace) {
  auto out = format_trace(text_format(), trace);
  if (!trace.ended.empty()) out += "  plan ended: " + trace.ended + '\n';
  return out;
}

std::string to_jsonl(const Trace& trace) {
  return with_ending(without_end(format_trace(jsonl_format(), trace)), trace);
}

std::string observable_jsonl(const Trace& trace) {
  static const JsonlFormat kFormat(false);
  return with_ending(without_end(format_trace(kFormat, trace)), trace);
}

}  // namespace parallax::runtime
