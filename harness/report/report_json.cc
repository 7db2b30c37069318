#include <fmt/format.h>

#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "harness/campaign/result_json.h"
#include "harness/campaign/start_words.h"
#include "harness/report/discrepancy_summary.h"
#include "harness/report/law_json.h"
#include "harness/report/opinion_words.h"
#include "harness/report/report.h"
#include "harness/report/report_words.h"
#include "harness/report/standing.h"
#include "harness/report/text_layout.h"
#include "harness/simulator/state_json.h"

namespace parallax::harness {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string text_of(const OrderedJson& json, int indent) {
  return base::json_text(json, indent) + '\n';
}

/// {"box.x": [1, 2], "box.y": 0}
OrderedJson json_of(const std::vector<SampledDimension>& dimensions) {
  OrderedJson out = OrderedJson::object();
  for (const auto& [variable, interval] : dimensions) {
    if (interval.lower == interval.upper) {
      out[variable] = interval.lower;
    } else {
      out[variable] = {interval.lower, interval.upper};
    }
  }
  return out;
}

/// [{"body": "milk1", "region": "pw1", "share": 0.08, "axes": {"x": [0.1, 0.24]}, "fixed": ["z"]}]
OrderedJson json_of(const std::vector<StartShare>& shares) {
  OrderedJson out = OrderedJson::array();
  for (const auto& share : shares) {
    OrderedJson axes = OrderedJson::object();
    for (const auto& axis : share.axes) axes[axis.axis] = {axis.drawn, axis.whole};
    out.push_back({{"body", share.body},
                   {"region", share.region},
                   {"share", share.share},
                   {"axes", std::move(axes)},
                   {"fixed", share.fixed}});
  }
  return out;
}

OrderedJson json_of(const std::vector<DivergingFluent>& fluents) {
  auto out = OrderedJson::array();
  for (const auto& fluent : fluents) {
    out.push_back({{"fluent", fluent.fluent},
                   {"timepoint", fluent.timepoint},
                   {"predicted", fluent.predicted},
                   {"observed", fluent.observed}});
    if (!fluent.measured.empty()) out.back()["measured"] = fluent.measured;
  }
  return out;
}

std::vector<std::string> ignored_names(const std::vector<ComparedFluents>& compared) {
  std::vector<std::string> names;
  for (const auto& entry : compared) {
    if (entry.how == ComparedFluents::How::kIgnored) names.push_back(entry.fluent);
  }
  return names;
}

/// [{"fluent": "Holding(..)", "compared": "every-step"}, {.., "compared": "ignored", "why": ".."}]
OrderedJson json_of(const std::vector<ComparedFluents>& compared) {
  auto out = OrderedJson::array();
  for (const auto& entry : compared) {
    out.push_back({{"fluent", entry.fluent}, {"compared", to_string(entry.how)}});
    if (!entry.why.empty()) out.back()["why"] = entry.why;
  }
  return out;
}

OrderedJson json_of(const std::vector<CoverItem>& items) {
  auto out = OrderedJson::array();
  for (const auto& item : items) out.push_back({{"place", item.place}, {"what", item.what}});
  return out;
}

OrderedJson json_of(const CoverResult& cover) {
  OrderedJson out = {{"end", to_string(cover.end)},
                     {"items", cover.items},
                     {"shown", cover.items - std::ssize(cover.left)},
                     {"executions", cover.drawn},
                     {"lost", cover.lost},
                     {"confidence", cover.confidence},
                     {"bound", cover.bound},
                     {"epsilon", cover.epsilon}};
  out["left"] = json_of(cover.left);
  out["impossible"] = json_of(cover.unreachable);
  return out;
}

OrderedJson json_of(const SearchResult& search) {
  OrderedJson out = {{"strategy", to_string(search.spec.strategy)},
                     {"asked", search.spec.runs},
                     {"simulations", search.runs},
                     {"invalid", search.invalid},
                     {"lost", search.lost},
                     {"found", search.found},
                     {"contradicting", search.contradicting}};
  if (search.nearest) {
    out["nearest"] = {
        {"sample", *search.nearest}, {"margin", search.margin}, {"part", search.part}};
  }
  return out;
}

/// The figures of the paper's rule after the last run.
void add_paper_figures(const PaperFigures& figures, OrderedJson& out) {
  const auto& verdict = figures.verdict;
  const auto ends = [](const Interval& of) { return OrderedJson{of.lower, of.upper}; };
  out["runs"] = figures.runs;
  out["quantile"] = verdict.z;
  out["starts"] = OrderedJson::array();
  for (std::size_t i = 0; i < figures.x_names.size(); ++i) {
    out["starts"].push_back({{"name", figures.x_names[i]}, {"range", ends(figures.x_range[i])}});
  }
  out["intervals"] = OrderedJson::array();
  for (const auto& one : verdict.intervals) {
    out["intervals"].push_back({{"name", one.name},
                                {"b", one.coefficients},
                                {"intercept", one.intercept},
                                {"sse", one.sse},
                                {"sigma", one.sigma},
                                {"lower", one.lower},
                                {"upper", one.upper},
                                {"cell", ends(one.cell)},
                                {"inside", one.inside}});
  }
  out["exempt"] = verdict.exempt;
  out["why_not"] = verdict.why_not;
}

OrderedJson json_of(const TraceResult& result, const std::vector<ComparedFluents>& compared) {
  const auto& trace = *result.trace;
  auto events = OrderedJson::array();
  auto sources = OrderedJson::array();
  for (std::size_t t = 0; t < trace.event_count(); ++t) {
    auto event = event_json<OrderedJson>(trace, t);
    events.push_back(std::move(event["event"]));
    sources.push_back(std::move(event["source"]));
  }
  OrderedJson out = {{"trace", trace.number},
                     {"verdict", to_string(result.verdict)},
                     {"events", std::move(events)},
                     {"sources", std::move(sources)},
                     {"initial_state", holds_json<OrderedJson>(trace, 0)},
                     {"start_region", json_of(result.start_region)},
                     {"start_shares", json_of(result.start_shares)},
                     {"not_compared", ignored_names(compared)},
                     {"simulations", result.simulations},
                     {"simulated_s", result.simulated_s},
                     {"guided", result.search ? result.search->runs : 0},
                     {"clean", result.clean},
                     {"admitted", result.admitted},
                     {"lost", result.lost},
                     {"retried", result.retried},
                     {"rejected", result.rejected},
                     {"strayed", result.strayed}};
  for (const auto& lost : result.losses) {
    out["losses"].push_back(
        {{"reason", lost.kind}, {"count", lost.count}, {"example", lost.example}});
  }
  if (result.of_the_solver > 0) out["of_the_solver"] = result.of_the_solver;
  out["certified"] = {{"confidence", result.certified_level},
                      {"epsilon", result.certified_epsilon}};
  out["error_share"] = result.error_share;
  out["paper"] = {{"stopped_at", nullptr}, {"variant", result.paper_variant}};
  if (result.paper_stopped_at) out["paper"]["stopped_at"] = *result.paper_stopped_at;
  out["not_covered"] = result.not_covered;
  if (!result.loop) out["initial_states"] = starts_json<OrderedJson>(result.starts);
  if (result.loop) {
    out["initial_states"] = result.loop->initial_states;
    out["initial_states_tried"] = result.starts.tried;
    if (result.starts.visits > 0) out["initial_states_visits"] = result.starts.visits;
    if (!result.starts.unrealisable.empty()) {
      out["initial_states_without_start"] = result.starts.unrealisable;
    }
    out["start_law"] = result.loop->has_weights ? "weights" : "uniform";
    out["unfinished"] = result.loop->unfinished;
    if (result.loop->guided) out["chosen_starts"] = *result.loop->guided;
    out["paths"] = OrderedJson::array();
    for (const auto& path : result.loop->paths) {
      out["paths"].push_back({{"events", path.events},
                              {"outcomes", path.outcomes},
                              {"end", to_string(path.end)},
                              {"detail", path.detail},
                              {"simulations", path.runs},
                              {"example", path.example}});
    }
    if (result.loop->cover) out["until_covered"] = json_of(*result.loop->cover);
  }
  if (result.loop && !result.loop->causes.empty()) {
    out["causes_runs"] = result.loop->causes_runs;
    out["causes_unseen"] = result.loop->causes_unseen;
    out["causes"] = OrderedJson::array();
    for (const auto& rate : result.loop->causes) {
      out["causes"].push_back({{"cause", rate.cause},
                               {"count", rate.count},
                               {"rate", rate.rate},
                               {"lower", rate.lower},
                               {"upper", rate.upper},
                               {"example", rate.example},
                               {"reason", rate.reason}});
    }
  }
  if (result.law) out["law"] = law_json<OrderedJson>(*result.law);
  if (!result.left_out.empty()) out["left_out"] = result.left_out;
  if (result.search) out["search"] = json_of(*result.search);
  out["claim"] = result.claim;
  out["caveats"] = result.caveats;
  return out;
}

/// The path of an executed plan, and where the model cannot follow it.
void add_path(const Discrepancy& found, OrderedJson& out) {
  const auto& record = found.record;
  auto steps = OrderedJson::array();
  for (std::size_t i = 0; i < record.outcomes.size(); ++i) {
    const auto& step = record.path->steps[i];
    steps.push_back({{"event", step.event},
                     {"source", step.source},
                     {"outcome", step.succeeded ? "ok" : "failed"},
                     {"object", step.object},
                     {"condition", step.condition}});
  }
  const auto& differs = *found.path;
  out["path"] = std::move(steps);
  out["path_end"] = to_string(record.path->end);
  out["start_state"] = record.path->start;
  out["differs"] = {{"event", differs.event},
                    {"impossible", differs.impossible},
                    {"outcome", differs.outcome},
                    {"together", differs.together}};
}

OrderedJson json_of(const CampaignResult& result, const Discrepancy& found) {
  auto outcomes = OrderedJson::array();
  for (const auto& outcome : found.record.outcomes) {
    outcomes.push_back({{"status", to_string(outcome.status)},
                        {"reason", outcome.reason},
                        {"sim_time_s", outcome.sim_time_s}});
  }
  OrderedJson out = {{"trace", found.trace},
                     {"sample", found.sample},
                     {"seed", found.seed},
                     {"kind", to_string(found.kind)},
                     {"first_divergence", found.first_divergence},
                     {"cause",
                      {{"text", found.cause.text},
                       {"reason", found.cause.reason},
                       {"event", found.cause.event},
                       {"fluents", found.cause.fluents}}},
                     {"first", json_of(found.first)},
                     {"fluents", json_of(found.fluents)},
                     {"repeated", confirmation_key(found.confirmation)},
                     {"start", state_json<OrderedJson>(found.record.initial)},
                     {"end", state_json<OrderedJson>(found.end)},
                     {"outcomes", std::move(outcomes)},
                     {"words", discrepancy_sentence(result, found)},
                     {"replay", replay_command(result.replay_folder, found)}};
  const auto standing = standing_of(result, found);
  out["standing"] = {{"is", to_string(standing.is)}, {"words", standing.words}};
  if (found.path) add_path(found, out);
  if (found.record.start_state > 0) out["start_state"] = found.record.start_state;
  return out;
}

OrderedJson json_of(const CampaignResult& result, bool with_timing, bool with_figures = false) {
  OrderedJson out = {{"status", result.failed ? "error" : "ok"},
                     {"scenario", result.scenario},
                     {"seed", result.seed},
                     {"verdict", to_string(result.verdict)},
                     {"iterations", result.traces.size()},
                     {"simulations", result.simulations},
                     {"simulated_s", result.simulated_s},
                     {"tool_version", result.tool_version}};
  out["simulator"] = {{"name", result.simulator.name},
                      {"version", result.simulator.version},
                      {"determinism", result.simulator.determinism},
                      {"timestep_s", result.simulator.timestep_s}};
  if (!result.arms.empty()) out["simulator"]["arms"] = result.arms;
  out["criterion"] = base::parse_ordered_json(criterion_json(result.criterion));
  out["criterion"]["source"] = source_of(result.criterion.kind);
  out["criterion"]["may_be_watched"] = may_be_watched(result.criterion.kind);
  out["execution"] = to_string(result.execution);
  out["compare"] = to_string(result.comparison);
  out["compared"] = json_of(result.compared);
  if (result.spending) {
    out["family"] = {
        {"traces", nullptr}, {"error", result.spending->text()}, {"claim", result.claim}};
    if (const auto traces = result.spending->traces()) out["family"]["traces"] = *traces;
  }
  if (const auto text = in_states_text(result); !text.empty()) out["not_everywhere"] = text;
  out["traces"] = OrderedJson::array();
  for (const auto& trace : result.traces) {
    out["traces"].push_back(json_of(trace, result.compared));
    if (with_figures && trace.paper_figures) {
      add_paper_figures(*trace.paper_figures, out["traces"].back()["paper"]);
    }
  }
  out["discrepancies"] = OrderedJson::array();
  for (const auto& found : result.discrepancies) {
    out["discrepancies"].push_back(json_of(result, found));
  }
  if (!result.repetition.repetitions.empty()) {
    auto& repetition = out["repetition"];
    repetition["sample"] = fmt::format("{}.{}", result.repetition.trace, result.repetition.sample);
    for (const auto& one : result.repetition.repetitions) {
      auto& told = repetition[one.is_fresh ? "fresh_simulator" : "after_the_others"];
      told = {{"outcome", to_string(one.outcome)}};
      if (!one.detail.empty()) told["detail"] = one.detail;
    }
  }
  for (const auto& one : result.kinds) {
    out["kinds"].push_back({{"kind", one.kind}, {"simulations", one.simulations}});
  }
  if (!result.coverage.empty()) {
    for (const auto& share : result.coverage) {
      out["coverage"][share.group] = {{"covered", share.covered}, {"all", share.all}};
    }
  }
  if (result.second_opinion) {
    out["second_opinion"] = base::parse_ordered_json(opinion_json(*result.second_opinion));
  }
  out["exploration"] = result.exploration;
  if (!result.bounds.empty()) out["bounds"] = result.bounds;
  out["interrupted"] = result.interrupted;
  if (with_timing) {
    const auto& timing = result.timing;
    out["timing"] = {{"wall_s", timing.wall_s},
                     {"runs_made", timing.runs_made},
                     {"simulated_s", timing.simulated_s},
                     {"traces_wall_s", OrderedJson::array()}};
    for (const auto& trace : result.traces) out["timing"]["traces_wall_s"].push_back(trace.wall_s);
  }
  return out;
}

}  // namespace

std::string campaign_json(const CampaignResult& result, bool with_timing, bool with_figures) {
  return text_of(json_of(result, with_timing, with_figures), -1);
}

base::Status write_report(const CampaignResult& result, const std::filesystem::path& run_dir,
                          base::DiagnosticSink& sink) {
  const auto text = base::write_file_atomically(run_dir / "report.txt", campaign_text(result, {}),
                                                sink, base::TextForm::kLines);
  const auto json = base::write_file_atomically(run_dir / "report.json",
                                                text_of(json_of(result, false), 2), sink);
  if (!text || !json) return sink.already_reported();
  return base::Unit{};
}

std::string replay_json(const ReplayResult& result) {
  static constexpr std::string_view kOutcomes[] = {"identical", "differs", "cannot"};
  OrderedJson out = {{"status", "ok"},
                     {"sample", fmt::format("{}.{}", result.id.trace, result.id.sample)},
                     {"seed", result.seed},
                     {"outcome", kOutcomes[static_cast<std::size_t>(result.outcome)]},
                     {"timepoints", result.timepoints},
                     {"digest", result.digest}};
  if (!result.reason.empty()) out["reason"] = result.reason;
  if (result.machine.arithmetic) out["other_arithmetic"] = true;
  if (result.machine.build) out["other_build"] = true;
  if (const auto& difference = result.difference) {
    out["difference"] = {{"timepoint", difference->timepoint},
                         {"variable", difference->variable},
                         {"recorded", difference->recorded},
                         {"repeated", difference->repeated}};
  }
  return text_of(out, -1);
}

}  // namespace parallax::harness
