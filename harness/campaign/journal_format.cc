#include "harness/campaign/journal_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "compiler/base/json.h"
#include "harness/campaign/result_json.h"
#include "harness/simulator/command_files.h"
#include "harness/simulator/state_json.h"

namespace parallax::harness {
namespace {

using Json = nlohmann::json;  // what is read: the library reads ordered objects in quadratic time
using OrderedJson = nlohmann::ordered_json;  // what is written

constexpr int kJournalFormat = 1;

/// Thrown by the decoders below and caught in this file: what a line lacks.
struct Foreign {
  std::string why;
};

const Json& field(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) throw Foreign{fmt::format("`{}` is missing", name)};
  return *found;
}

template <typename T>
T get(const Json& object, const char* name) {
  auto value = base::json_as<T>(field(object, name));
  if (!value) throw Foreign{fmt::format("`{}` has the wrong type", name)};
  return *std::move(value);
}

const Json& list(const Json& object, const char* name) {
  const auto& value = field(object, name);
  if (!value.is_array()) throw Foreign{fmt::format("`{}` is no list", name)};
  return value;
}

std::vector<std::string> strings(const Json& values, const char* name) {
  std::vector<std::string> out;
  if (!values.is_array()) throw Foreign{fmt::format("`{}` is no list of texts", name)};
  for (const auto& value : values) {
    if (!value.is_string()) throw Foreign{fmt::format("`{}` is no list of texts", name)};
    out.push_back(value.get<std::string>());
  }
  return out;
}

State state_of(const Json& object, const char* what) {
  if (!object.is_object()) throw Foreign{fmt::format("`{}` is no state", what)};
  State state;
  for (const auto& [name, value] : object.items()) {
    if (value.is_boolean()) {
      state[name] = value.get<bool>();
    } else if (value.is_number_float()) {
      state[name] = value.get<double>();
    } else if (value.is_number_integer()) {
      state[name] = value.get<std::int64_t>();
    } else if (value.is_string()) {
      state[name] = value.get<std::string>();
    } else {
      throw Foreign{fmt::format("`{}` of `{}` is no value of a state", name, what)};
    }
  }
  return state;
}

template <typename Enum>
Enum word_of(const Json& object, const char* name, std::initializer_list<Enum> known) {
  const auto word = get<std::string>(object, name);
  for (const auto value : known) {
    if (to_string(value) == word) return value;
  }
  throw Foreign{fmt::format("`{}` is `{}`", name, word)};
}

OrderedJson json_of(const ActionCall& call) {
  return {{"controller", call.controller},
          {"arguments", state_json<OrderedJson>(call.arguments)},
          {"time_limit_s", call.time_limit_s}};
}

/// A number of things, from `least` on.
std::int64_t count_of(const Json& object, const char* name, std::int64_t least) {
  const auto count = get<std::int64_t>(object, name);
  if (count < least) throw Foreign{fmt::format("`{}` is {}, less than {}", name, count, least)};
  return count;
}

double duration_of(const Json& object, const char* name) {
  const auto seconds = get<double>(object, name);
  if (!(seconds >= 0.0)) throw Foreign{fmt::format("`{}` is {}, less than 0", name, seconds)};
  return seconds;
}

TraceLine trace_line_of(const Json& object, const std::shared_ptr<compiler::SymbolTable>& symbols) {
  auto trace = std::make_shared<CampaignTrace>();
  TraceLine line;
  trace->number = count_of(object, "trace", 1);
  trace->key = get<std::string>(object, "key");
  trace->symbols = symbols;
  if (object.contains("start_state")) line.start_state = count_of(object, "start_state", 2);
  if (object.contains("initial_states")) {
    line.initial_states = get<std::string>(object, "initial_states");
  }
  std::vector<std::vector<std::string>> holds;
  for (const auto& fluents : list(object, "holds")) holds.push_back(strings(fluents, "holds"));
  std::vector<std::vector<std::string>> events;
  for (const auto& event : list(object, "events")) {
    auto& happening = events.emplace_back();
    happening.push_back(get<std::string>(event, "event"));
    trace->plan.push_back({get<std::string>(event, "source"), {}});
    if (event.contains("demanded")) {
      trace->plan.back().event = happening.front();
      const auto demanded = strings(field(event, "demanded"), "demanded");
      happening.insert(happening.end(), demanded.begin(), demanded.end());
    }
    line.calls.push_back({get<std::string>(event, "controller"),
                          state_of(field(event, "arguments"), "arguments"),
                          duration_of(event, "time_limit_s")});
  }
  if (holds.size() != events.size() + 1) {
    throw Foreign{"`holds` has not one list for every timepoint of its events"};
  }
  for (std::size_t t = 0; t < holds.size(); ++t) {
    const auto happens = t < events.size() ? events[t] : std::vector<std::string>();
    trace->points.push_back(runtime::point_of_names(holds[t], happens, *symbols));
  }
  line.trace = std::move(trace);
  return line;
}

/// Reads the path of an executed plan.
ExecutedPath path_of(const Json& object) {
  ExecutedPath path;
  path.start = count_of(object, "start_state", 1);
  if (object.contains("target")) path.target = get<std::string>(object, "target");
  for (const auto& step : list(object, "path")) {
    path.steps.push_back(
        {count_of(step, "step", 0),
         get<std::string>(step, "event"),
         get<std::string>(step, "source"),
         {get<std::string>(step, "controller"), state_of(field(step, "arguments"), "arguments"),
          duration_of(step, "time_limit_s")},
         get<bool>(step, "succeeded"),
         get<std::string>(step, "object"),
         get<std::string>(step, "condition")});
  }
  path.end = word_of(object, "end",
                     {PathEnd::kDone, PathEnd::kFailed, PathEnd::kPerformLimit, PathEnd::kTimeLimit,
                      PathEnd::kCut});
  path.detail = get<std::string>(object, "detail");
  return path;
}

SampleRecord record_of(const Json& object) {
  SampleRecord record;
  record.trace = count_of(object, "trace", 1);
  record.sample = count_of(object, "sample", 1);
  record.attempt = count_of(object, "attempt", 0);
  const auto phase = get<std::string>(object, "phase");
  if (phase != "certify" && phase != "confirm" && phase != "search" && phase != "visit") {
    throw Foreign{"`phase` is `" + phase + "`"};
  }
  // A search has numbers of its own, so its simulations are found as others are.
  record.searched = phase == "search";
  record.visit = phase == "visit";
  record.phase = phase == "confirm" ? DrawPhase::kConfirm : DrawPhase::kCertify;
  record.seed = get<std::uint64_t>(object, "seed");
  record.status = word_of(object, "status", {SampleStatus::kOk, SampleStatus::kLost});
  record.rejected = count_of(object, "rejected", 0);
  if (object.contains("redrawn")) record.redrawn = count_of(object, "redrawn", 1);
  record.retries = count_of(object, "retries", 0);
  record.reason = recorded_words(get<std::string>(object, "reason"));
  record.initial = state_of(field(object, "initial"), "initial");
  for (const auto& state : list(object, "observations")) {
    record.observations.push_back(state_of(state, "observations"));
  }
  for (const auto& outcome : list(object, "outcomes")) {
    record.outcomes.push_back(
        {word_of(outcome, "status", {SimStatus::kOk, SimStatus::kFailed, SimStatus::kTruncated}),
         recorded_words(get<std::string>(outcome, "reason")), duration_of(outcome, "sim_time_s"),
         outcome.contains("object") ? get<std::string>(outcome, "object") : std::string(),
         outcome.contains("margins") ? state_of(field(outcome, "margins"), "margins") : State()});
  }
  record.digest = get<std::string>(object, "digest");
  if (object.contains("kind")) record.kind = get<std::string>(object, "kind");
  if (object.contains("path")) {
    record.path = path_of(object);
  } else if (object.contains("start_state")) {
    record.start_state = count_of(object, "start_state", 1);
  }
  return record;
}

Json parse(std::string_view line) {
  auto object = base::parse_json(line);
  if (object.is_discarded()) throw Foreign{"it is not JSON"};
  if (!object.is_object()) throw Foreign{"it is no JSON object"};
  return object;
}

OrderedJson json_of(const JournalHeader& header) {
  return {{"journal", kJournalFormat},
          {"scenario", header.scenario},
          {"start_folder", header.start_folder},
          {"scenario_hash", header.scenario_hash},
          {"seed", header.seed},
          {"tool_version", header.tool_version},
          {"simulator",
           {{"name", header.simulator.name},
            {"version", header.simulator.version},
            {"determinism", header.simulator.determinism},
            {"seeds", header.simulator.seeds},
            {"timestep_s", header.simulator.timestep_s}}}};
}

template <typename AnyJson>
std::optional<HeaderDifference> differing(const AnyJson& a, const AnyJson& b,
                                          const std::string& path) {
  if (a.is_object() && b.is_object()) {
    for (const auto& [name, value] : a.items()) {
      const auto other = b.find(name);
      const auto inner = path.empty() ? name : path + "." + name;
      if (other == b.end()) return HeaderDifference{inner, base::json_text(value), "absent"};
      if (auto found = differing(value, *other, inner)) return found;
    }
    for (const auto& [name, value] : b.items()) {
      const auto inner = path.empty() ? name : path + "." + name;
      if (!a.contains(name)) return HeaderDifference{inner, "absent", base::json_text(value)};
    }
    return std::nullopt;
  }
  if (a == b) return std::nullopt;
  return HeaderDifference{path, base::json_text(a), base::json_text(b)};
}

/// Two digests of which one may not be known.
bool changed(const std::string& recorded, const std::string& now) {
  return !recorded.empty() && !now.empty() && recorded != now;
}

}  // namespace

JournalHeader journal_header(const Scenario& scenario, const CampaignOptions& options,
                             const SimulatorInfo& simulator) {
  JournalHeader header;
  header.scenario = scenario.name;
  header.start_folder = options.start_folder;
  header.scenario_hash = options.scenario_hash;
  header.seed = options.seed;
  header.tool_version = options.tool_version;
  header.arithmetic = options.arithmetic;
  header.build = options.build;
  header.mixed = options.mixed;
  header.simulator = simulator;
  header.simulator.parameters.clear();
  header.simulator.actions.clear();
  header.simulator.arguments.clear();
  header.command_hash = hash_of_command(scenario.simulator.command);
  header.max_runs = scenario.limits.max_runs;
  header.options = recorded_options_json(scenario, options);
  header.asked = std::get<RecordedOptions>(recorded_options(header.options));
  return header;
}

std::string encode(const JournalHeader& header) {
  auto out = json_of(header);
  if (!header.arithmetic.empty()) out["arithmetic"] = header.arithmetic;
  if (!header.build.empty()) out["build"] = header.build;
  if (header.mixed) out["mixed"] = true;
  if (!header.command_hash.empty()) out["simulator"]["command_hash"] = header.command_hash;
  if (header.max_runs > 0) out["max_runs"] = header.max_runs;
  out["options"] = base::parse_ordered_json(header.options);
  return base::json_text(out);
}

bool same_but_for_places(const TraceLine& a, const TraceLine& b) {
  const auto &one = *a.trace, &other = *b.trace;
  if (one.number != other.number || one.key != other.key || a.calls != b.calls ||
      a.start_state != b.start_state || a.initial_states != b.initial_states) {
    return false;
  }
  if (one.points.size() != other.points.size()) return false;
  for (std::size_t t = 0; t < one.points.size(); ++t) {
    if (one.holds(t) != other.holds(t) || one.happens(t) != other.happens(t)) return false;
  }
  return true;
}

bool operator==(const TraceLine& a, const TraceLine& b) {
  return same_but_for_places(a, b) &&
         std::equal(a.trace->plan.begin(), a.trace->plan.end(), b.trace->plan.begin(),
                    b.trace->plan.end(),
                    [](const auto& x, const auto& y) { return x.source == y.source; });
}

std::string encode(const TraceLine& line) {
  const auto& trace = *line.trace;
  OrderedJson out = {{"trace", trace.number}, {"key", trace.key}};
  if (line.start_state > 0) out["start_state"] = line.start_state;
  if (!line.initial_states.empty()) out["initial_states"] = line.initial_states;
  auto holds = OrderedJson::array();
  for (std::size_t t = 0; t < trace.points.size(); ++t)
    holds.push_back(holds_json<OrderedJson>(trace, t));
  out["holds"] = std::move(holds);
  auto events = OrderedJson::array();
  for (std::size_t t = 0; t < trace.event_count(); ++t) {
    auto event = event_json<OrderedJson>(trace, t);
    if (!trace.plan[t].event.empty()) {
      auto& demanded = event["demanded"] = OrderedJson::array();
      for (const auto name : trace.happens(t)) {
        if (name != trace.event(t)) demanded.push_back(std::string(name));
      }
    }
    event.update(json_of(line.calls[t]));
    events.push_back(std::move(event));
  }
  out["events"] = std::move(events);
  return base::json_text(out);
}

std::string encode(const SampleRecord& record) {
  OrderedJson out = {{"trace", record.trace},
                     {"sample", record.sample},
                     {"attempt", record.attempt},
                     {"phase", record.phase == DrawPhase::kConfirm ? "confirm"
                               : record.searched                   ? "search"
                               : record.visit                      ? "visit"
                                                                   : "certify"},
                     {"seed", record.seed},
                     {"status", to_string(record.status)},
                     {"rejected", record.rejected},
                     {"retries", record.retries},
                     {"reason", record.reason},
                     {"initial", state_json<OrderedJson>(record.initial)}};
  if (record.redrawn > 0) out["redrawn"] = record.redrawn;
  if (record.start_state > 0) out["start_state"] = record.start_state;
  auto observations = OrderedJson::array();
  for (const auto& state : record.observations) {
    observations.push_back(state_json<OrderedJson>(state));
  }
  out["observations"] = std::move(observations);
  auto outcomes = OrderedJson::array();
  for (const auto& outcome : record.outcomes) {
    outcomes.push_back({{"status", to_string(outcome.status)},
                        {"reason", outcome.reason},
                        {"sim_time_s", outcome.sim_time_s}});
    if (!outcome.object.empty()) outcomes.back()["object"] = outcome.object;
    if (!outcome.margins.empty()) {
      outcomes.back()["margins"] = state_json<OrderedJson>(outcome.margins);
    }
  }
  out["outcomes"] = std::move(outcomes);
  out["digest"] = record.digest;
  if (!record.kind.empty()) out["kind"] = record.kind;
  if (!record.path) return base::json_text(out);
  out["start_state"] = record.path->start;
  if (!record.path->target.empty()) out["target"] = record.path->target;
  auto path = OrderedJson::array();
  for (const auto& step : record.path->steps) {
    OrderedJson entry = {{"step", step.step}, {"event", step.event}, {"source", step.source}};
    entry.update(json_of(step.call));
    entry.update(OrderedJson{
        {"succeeded", step.succeeded}, {"object", step.object}, {"condition", step.condition}});
    path.push_back(std::move(entry));
  }
  out["path"] = std::move(path);
  out["end"] = to_string(record.path->end);
  out["detail"] = record.path->detail;
  return base::json_text(out);
}

std::variant<JournalHeader, ForeignLine> decode_header(std::string_view line) try {
  const auto object = parse(line);
  const auto format = get<std::int64_t>(object, "journal");
  if (format != kJournalFormat) return ForeignLine{fmt::format("`journal` is {}", format)};
  JournalHeader header;
  header.scenario = get<std::string>(object, "scenario");
  if (object.contains("start_folder")) {
    header.start_folder = get<std::string>(object, "start_folder");
  }
  header.scenario_hash = get<std::string>(object, "scenario_hash");
  header.seed = get<std::uint64_t>(object, "seed");
  header.tool_version = get<std::string>(object, "tool_version");
  if (object.contains("arithmetic")) header.arithmetic = get<std::string>(object, "arithmetic");
  if (object.contains("build")) header.build = get<std::string>(object, "build");
  if (object.contains("mixed")) header.mixed = get<bool>(object, "mixed");
  const auto& simulator = field(object, "simulator");
  header.simulator.name = get<std::string>(simulator, "name");
  header.simulator.version = get<std::string>(simulator, "version");
  header.simulator.determinism = get<std::string>(simulator, "determinism");
  header.simulator.seeds = get<bool>(simulator, "seeds");
  header.simulator.timestep_s = get<double>(simulator, "timestep_s");
  if (simulator.contains("command_hash")) {
    header.command_hash = get<std::string>(simulator, "command_hash");
  }
  if (object.contains("max_runs")) header.max_runs = count_of(object, "max_runs", 0);
  header.options = base::json_text(field(object, "options"));
  auto asked = recorded_options(header.options);
  if (auto* why = std::get_if<std::string>(&asked)) return ForeignLine{*std::move(why)};
  header.asked = std::get<RecordedOptions>(std::move(asked));
  return header;
} catch (const Foreign& foreign) {
  return ForeignLine{foreign.why};
}

std::variant<TraceLine, SampleRecord, ForeignLine> decode_line(
    std::string_view line, const std::shared_ptr<compiler::SymbolTable>& symbols) try {
  const auto object = parse(line);
  if (object.contains("events")) return trace_line_of(object, symbols);
  return record_of(object);
} catch (const Foreign& foreign) {
  return ForeignLine{foreign.why};
}

bool command_changed(const JournalHeader& recorded, const std::string& command_hash) {
  return !recorded.command_hash.empty() && recorded.command_hash != command_hash;
}

MachineChange machine_change(const JournalHeader& recorded, const SampleRecord& record,
                             const std::string& arithmetic, const std::string& build) {
  const auto slash = record.kind.find('/');
  const bool has_kind = slash != std::string::npos;
  return {changed(has_kind ? record.kind.substr(slash + 1) : recorded.arithmetic, arithmetic),
          changed(has_kind ? record.kind.substr(0, slash) : recorded.build, build)};
}

std::optional<HeaderDifference> header_difference(const JournalHeader& recorded,
                                                  const JournalHeader& now) {
  auto before = json_of(recorded);
  auto after = json_of(now);
  // The same file may be named from elsewhere; the hash over its text is what counts.
  for (const auto* name : {"scenario", "start_folder"}) {
    before.erase(name);
    after.erase(name);
  }
  if (recorded.mixed != now.mixed) {
    const auto word = [](const JournalHeader& header) { return header.mixed ? "yes" : "no"; };
    return HeaderDifference{"permission for workers of several kinds (--mixed)", word(recorded),
                            word(now)};
  }
  if (auto found = differing(before, after, {})) return found;
  if (!now.mixed && changed(recorded.arithmetic, now.arithmetic)) {
    return HeaderDifference{"processor's arithmetic", recorded.arithmetic, now.arithmetic};
  }
  if (!now.mixed && changed(recorded.build, now.build)) {
    return HeaderDifference{"program's build, or that of a library", recorded.build, now.build};
  }
  if (command_changed(recorded, now.command_hash)) {
    return HeaderDifference{"simulator's program or script", recorded.command_hash,
                            now.command_hash};
  }
  return differing(base::parse_json(recorded.options), base::parse_json(now.options), "options");
}

}  // namespace parallax::harness
