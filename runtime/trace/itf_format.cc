#include "runtime/trace/itf_format.h"

#include <algorithm>

#include "compiler/base/json.h"
#include "compiler/base/whole_number.h"
#include "runtime/trace/open_atoms.h"

namespace parallax::runtime {

std::optional<AtomText> split_atom(std::string_view atom) {
  const auto open = atom.find('(');
  if (open == std::string_view::npos || open == 0 || !atom.ends_with(')')) return std::nullopt;
  AtomText parts;
  parts.symbol = atom.substr(0, open);
  const auto inside = atom.substr(open + 1, atom.size() - open - 2);
  if (inside.empty()) return parts;
  std::size_t depth = 0, begin = 0;
  for (std::size_t i = 0; i <= inside.size(); ++i) {
    const char c = i < inside.size() ? inside[i] : ',';
    if (c == '(') ++depth;
    if (c == ')' && depth-- == 0) return std::nullopt;
    if (c != ',' || (depth > 0 && i < inside.size())) continue;
    if (depth > 0 || i == begin) return std::nullopt;
    parts.arguments.emplace_back(inside.substr(begin, i - begin));
    begin = i + 1;
  }
  return parts;
}

std::string join_atom(const AtomText& parts) {
  std::string out = parts.symbol + '(';
  for (std::size_t i = 0; i < parts.arguments.size(); ++i) {
    if (i > 0) out += ',';
    out += parts.arguments[i];
  }
  return out + ')';
}

namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kDescription = "https://apalache.informal.systems/docs/adr/015adr-trace.html";
constexpr std::int64_t kLargestInteger = (std::int64_t{1} << 53U) - 1;

std::string dumped(const Json& json) {
  return base::json_text(json);  // file names may be any bytes
}

/// Numbers become integers, large ones in the form that ITF has for them, all else strings.
Json argument_value(const std::string& text) {
  const auto number = base::whole_number<std::int64_t>(text);
  if (!number) return text;
  if (*number > kLargestInteger || *number < -kLargestInteger) return Json{{"#bigint", text}};
  return *number;
}

Json tuple(const std::string& atom) {
  auto values = Json::array();
  if (const auto parts = split_atom(atom)) {
    for (const auto& argument : parts->arguments) values.push_back(argument_value(argument));
  }
  return Json{{"#tup", std::move(values)}};
}

/// `is_open(i)` and `is_true(i)`: of the symbol's atom i. Open ones are not listed.
template <typename IsOpen, typename IsTrue>
Json map_of(const SymbolInstances& symbol, const IsOpen& is_open, const IsTrue& is_true) {
  auto pairs = Json::array();
  for (std::size_t i = 0; i < symbol.atoms.size(); ++i) {
    if (!is_open(i)) pairs.push_back(Json::array({tuple(symbol.atoms[i]), is_true(i)}));
  }
  return Json{{"#map", std::move(pairs)}};
}

Json map_of_fluents(const SymbolInstances& symbol, const std::vector<compiler::FluentId>& truths,
                    const std::vector<compiler::FluentId>& open) {
  const auto is_in = [&](const std::vector<compiler::FluentId>& fluents) {
    return [&](std::size_t i) { return contains(fluents, compiler::FluentId(symbol.ids[i])); };
  };
  return map_of(symbol, is_in(open), is_in(truths));
}

std::string joined(const Names& events) {
  std::string out;
  for (const auto event : events) out.append(out.empty() ? "" : "+").append(event);
  return out;
}

/// Members of an object.
std::string ending(const ListEnd& end) {
  return "\"traces\":" + std::to_string(end.traces) +
         ",\"complete\":" + (end.complete ? "true" : "false") + ',' + end.fields +
         "\"exploration\":" + dumped(end.exploration);
}

/// By event symbol, an option as Quint writes it: `None`, or `Some` set of argument tuples.
Json picks(const std::vector<SymbolInstances>& symbols,
           const std::vector<compiler::EventId>& happened) {
  auto out = Json::object();
  for (const auto& symbol : symbols) {
    auto tuples = Json::array();
    for (std::size_t i = 0; i < symbol.atoms.size(); ++i) {
      if (!contains(happened, compiler::EventId(symbol.ids[i]))) continue;
      tuples.push_back(tuple(symbol.atoms[i]));
    }
    out[symbol.symbol] = tuples.empty()
                             ? Json{{"tag", "None"}, {"value", {{"#tup", Json::array()}}}}
                             : Json{{"tag", "Some"}, {"value", {{"#set", std::move(tuples)}}}};
  }
  return out;
}

}  // namespace

ItfFormat::ItfFormat(const CompiledModel& model, ItfOptions options)
    : model_(&model),
      options_(std::move(options)),
      vocabulary_(vocabulary_of(model)),
      hash_(model_hash(model)) {}

std::string ItfFormat::meta(const Trace& trace, const std::optional<ListEnd>& end) const {
  Json meta = {{"format", "ITF"},           {"format-description", kDescription},
               {"source", options_.source}, {"status", "ok"},
               {"tool", options_.tool},     {"model", hash_},
               {"trace", trace.number}};
  if (const auto compat = model_->options.find("compat"); compat != model_->options.end()) {
    meta["compat"] = compat->second;
  }
  auto text = dumped(meta);
  if (end) text.replace(text.size() - 1, 1, "," + ending(*end) + '}');
  return text;
}

std::string ItfFormat::vars() const {
  auto names = Json::array({kItfAction, kItfPicks});
  for (const auto& symbol : vocabulary_.fluents) names.push_back(symbol.symbol);
  for (const auto& symbol : vocabulary_.releasable) {
    names.push_back(std::string(kItfReleased) + symbol.symbol);
  }
  for (const auto& symbol : vocabulary_.predicates) {
    names.push_back(std::string(kItfPredicate) + symbol.symbol);
  }
  return dumped(names);
}

std::string ItfFormat::state(const Trace& trace, const OpenAtoms& open, std::size_t t) const {
  static const std::vector<compiler::EventId> kNone;
  const auto& point = trace.points[t];
  const auto& happened = t > 0 ? trace.points[t - 1].happens : kNone;
  const auto names = t > 0 ? trace.happens(t - 1) : Names();
  auto events = Json::array();
  for (const auto event : names) {
    const auto parts = split_atom(event).value_or(AtomText{std::string(event), {}});
    Json entry = {{"event", parts.symbol}, {"arguments", parts.arguments}};
    const auto step = trace.points[t - 1].plan_step;
    const bool planned = step && model_->plan[*step].event == event;
    const auto declared = options_.declared.find(parts.symbol);
    if (planned || declared != options_.declared.end()) {
      const auto& place = planned ? model_->plan[*step].place : declared->second;
      entry["file"] = place.file;
      entry["line"] = place.begin.line;
    }
    events.push_back(std::move(entry));
  }
  Json state = {{"#meta", {{"index", t}, {"events", std::move(events)}}},
                {kItfAction, t == 0 ? std::string(kItfInit) : joined(names)},
                {kItfPicks, picks(vocabulary_.events, happened)}};
  for (const auto& symbol : vocabulary_.fluents)
    state[symbol.symbol] = map_of_fluents(symbol, point.holds, {});
  for (const auto& symbol : vocabulary_.releasable) {
    state[std::string(kItfReleased) + symbol.symbol] =
        map_of_fluents(symbol, point.released, open.released_at(t));
  }
  for (const auto& symbol : vocabulary_.predicates) {
    const auto is_in = [&](const std::vector<std::string>& atoms) {
      return [&](std::size_t i) { return contains(atoms, symbol.atoms[i]); };
    };
    state[std::string(kItfPredicate) + symbol.symbol] =
        map_of(symbol, is_in(open.predicates), is_in(trace.predicates));
  }
  return dumped(state);
}

std::string ItfFormat::trace(const Trace& trace, const OpenAtoms& open) {
  std::string out = "{\"#meta\":" + meta(trace, std::nullopt) + ",\"vars\":" + vars();
  out += ",\"states\":[";
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    if (t > 0) out += ',';
    out += state(trace, open, t);
  }
  return out + "]}\n";
}

std::string ItfFormat::document(const Trace& trace, const OpenAtoms& open,
                                const std::optional<ListEnd>& end) const {
  std::string out = "{\n\"#meta\":" + meta(trace, end) + ",\n\"vars\":" + vars();
  out += ",\n\"states\":[";
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    out += (t > 0 ? ",\n" : "\n") + state(trace, open, t);
  }
  return out + "\n]\n}\n";
}

std::string ItfFormat::end(const ListEnd& end) {
  return "{\"summary\":true," + ending(end) + ",\"model\":\"" + hash_ + "\"}\n";
}

}  // namespace parallax::runtime
