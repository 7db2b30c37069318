#include "tools/cli/replayed_trace.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compiler/base/json.h"
#include "compiler/base/words.h"

namespace parallax::tools {

std::string replayed_text(const ReplayedTrace& trace, const base::SourceFiles& files) {
  if (trace.agrees) {
    if (trace.hidden == 0) return fmt::format("trace {}: agrees\n", trace.number);
    return fmt::format("trace {}: agrees, with values for {} atoms that it does not mention\n",
                       trace.number, trace.hidden);
  }
  if (trace.undecided) {
    return fmt::format("trace {}: undecided at timepoint {}: {}\n", trace.number, trace.timepoint,
                       trace.reason);
  }
  const auto place = trace.source ? files.place(*trace.source) : std::string();
  return fmt::format("trace {}: fails at timepoint {}{}\n", trace.number, trace.timepoint,
                     place.empty() ? "" : ", " + place);
}

namespace {

nlohmann::ordered_json replayed_json(const ReplayedTrace& trace, const base::SourceFiles& files) {
  if (trace.agrees) return {{"trace", trace.number}, {"agrees", true}, {"hidden", trace.hidden}};
  nlohmann::ordered_json out = {
      {"trace", trace.number},
      {"agrees", trace.undecided ? nlohmann::ordered_json() : nlohmann::ordered_json(false)},
      {"timepoint", trace.timepoint},
      {"text", trace.reason}};
  if (trace.source) {
    const auto& file = files[trace.source->file];
    const auto position = file.position(trace.source->begin);
    out["file"] = file.name();
    out["line"] = position.line;
    out["column"] = position.column;
  }
  return out;
}

}  // namespace

std::string replay_document(const ReplayedTraces& replay, const base::SourceFiles& files) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& trace : replay.traces) list.push_back(replayed_json(trace, files));
  const nlohmann::ordered_json document = {
      {"status", replay.sound ? "ok" : "error"},
      {"traces", replay.seen},
      {"agree", replay.seen - replay.failed - replay.undecided},
      {"fail", replay.failed},
      {"undecided", replay.undecided},
      {"checked", replay.checked},
      {"complete", replay.finished},
      {"list", std::move(list)}};
  return base::json_text(document) + '\n';
}

int answer_replay(const ModelOptions& model, const ReplayTracesOptions& options,
                  Invocation& invocation) {
  const bool as_json = invocation.options().json;
  const auto& files = invocation.files();
  const auto say = [&](const ReplayedTrace& trace) {
    if (!as_json) invocation.result(replayed_text(trace, files));
  };
  const auto result = replay_traces(model, options, say, invocation);
  if (!result) return 0;
  if (!result->closed) {
    invocation.remark("the file does not say how its list ended: there may be more traces");
  }
  if (invocation.stopped()) invocation.remark("stopped before the last trace");
  if (as_json) {
    invocation.document(replay_document(*result, files));
  } else {
    const auto open =
        result->undecided > 0 ? fmt::format("{} undecided, ", result->undecided) : std::string();
    invocation.result(fmt::format(
        "{} replayed, {}: {} agree, {} fail, {}{} checked\n", base::counted(result->seen, "trace"),
        result->finished ? "complete" : "stopped",
        result->seen - result->failed - result->undecided, result->failed, open, result->checked));
  }
  if (!result->sound) return 5;
  if (result->failed > 0) return 1;
  return result->finished && result->undecided == 0 ? 0 : 4;
}

}  // namespace parallax::tools
