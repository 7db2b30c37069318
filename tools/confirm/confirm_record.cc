// JSON of `confirm` and `threshold`, and the findings that a run folder keeps.

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/write_gate.h"
#include "tools/app/kept_borders.h"
#include "tools/confirm/confirm.h"

namespace parallax::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kThresholdFile = "confirm/thresholds.json";
constexpr std::size_t kMostBytes = std::size_t{16} << 20U;

std::string id_text(harness::SampleId id) { return fmt::format("{}.{}", id.trace, id.sample); }

const char* end_word(TriedStarts::End end) {
  switch (end) {
    case TriedStarts::End::kNot:
      return "";
    case TriedStarts::End::kBudget:
      return "runs";
    case TriedStarts::End::kStopped:
      return "stopped";
    case TriedStarts::End::kLost:
    case TriedStarts::End::kFailed:
      break;
  }
  return "lost";
}

Json json_of(const std::optional<harness::Persistence>& seen) {
  if (!seen) return nullptr;
  Json out = {{"runs", seen->runs}, {"failures", seen->failures}};
  if (seen->runs > 0) {
    out["share"] = static_cast<double>(seen->failures) / static_cast<double>(seen->runs);
  }
  return out;
}

Json json_of(const harness::DiscrepancyStanding& standing) {
  return {{"is", to_string(standing.is)}, {"words", standing.words}};
}

Json json_of(const harness::BorderBracket& border) {
  Json out = {{"fails_at", border.fails},
              {"not_at", border.other},
              {"beyond", to_string(border.beyond)},
              {"tolerance", border.tolerance},
              {"narrow", border.is_narrow()}};
  if (border.no_start) out["no_start_at"] = *border.no_start;
  return out;
}

Json json_of(const StartParameter& parameter) {
  return {{"parameter", parameter.range.name}, {"unit", parameter.unit},
          {"value", parameter.failing},        {"lower", parameter.range.lower},
          {"upper", parameter.range.upper},    {"middle", parameter.range.middle()}};
}

/// Adds the initial state that the starts lie in, where there are several.
void add_place(const StartPlace& place, Json& out) {
  if (place.number == 0) return;
  out["initial_state"] = {{"number", place.number},
                          {"all", place.all ? Json(*place.all) : Json(nullptr)},
                          {"holds", place.holds}};
}

Json confirmation_document(const Confirmation& confirmation) {
  Json out = {{"status", "ok"},
              {"sample", id_text(confirmation.sample)},
              {"seed", confirmation.seed},
              {"digest", confirmation.digest},
              {"discrepancy", confirmation.words},
              {"verdict", to_string(confirmation.verdict())},
              {"standing", json_of(standing_of(confirmation))},
              {"finished", confirmation.finished()},
              {"ended_by", end_word(confirmation.end)},
              {"simulations", confirmation.runs}};
  add_place(confirmation.place, out);
  Json again = nullptr;
  if (confirmation.repeated) {
    again = {{"verdict", to_string(*confirmation.repeated)},
             {"bit_equal", !confirmation.difference.has_value()}};
    if (const auto& difference = confirmation.difference) {
      again["difference"] = {{"timepoint", difference->timepoint},
                             {"variable", difference->variable},
                             {"recorded", difference->a},
                             {"repeated", difference->b}};
    }
  }
  out["again"] = std::move(again);
  out["other_seeds"] = json_of(confirmation.other_seeds);
  out["half_step"] = json_of(confirmation.half_step);
  const auto& shrunk = confirmation.shrunk;
  out["middle"] = shrunk && shrunk->middle ? Json(to_string(*shrunk->middle)) : Json(nullptr);
  out["parameters"] = Json::array();
  for (std::size_t p = 0; p < confirmation.parameters.size(); ++p) {
    auto entry = json_of(confirmation.parameters[p]);
    entry["role"] = to_string(shrunk ? shrunk->roles[p] : harness::ParameterRole::kOpen);
    if (shrunk) {
      entry["shrunk"] = shrunk->start[p];
      for (const auto& border : shrunk->borders) {
        if (border.parameter == p) entry["border"] = json_of(border);
      }
    }
    out["parameters"].push_back(std::move(entry));
  }
  out["sentences"] = confirm_sentences(confirmation);
  return out;
}

Json threshold_document(const Threshold& threshold) {
  Json out = {{"status", "ok"},
              {"sample", id_text(threshold.sample)},
              {"seed", threshold.seed},
              {"digest", threshold.digest},
              {"discrepancy", threshold.words},
              {"finished", threshold.finished()},
              {"ended_by", end_word(threshold.end)},
              {"simulations", threshold.runs}};
  add_place(threshold.place, out);
  out.update(json_of(threshold.parameter));
  out["tolerance"] = threshold.tolerance;
  out["again"] = threshold.repeated ? Json(to_string(*threshold.repeated)) : Json(nullptr);
  out["points"] = Json::array();
  for (const auto& point : threshold.scan.points) {
    out["points"].push_back({{"value", point.value}, {"verdict", to_string(point.verdict)}});
  }
  out["borders"] = Json::array();
  for (const auto& border : threshold.scan.borders) out["borders"].push_back(json_of(border));
  out["sentences"] = threshold_sentences(threshold);
  return out;
}

/// A document that the folder keeps; null where there is none that can be read.
Json read_kept(const std::string& run_dir, const char* name) {
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::path(run_dir) / name, error)) return nullptr;
  base::DiagnosticSink unread;
  const auto text = base::read_file_of(run_dir, name, unread, kMostBytes);
  if (!text) return nullptr;
  auto json = base::parse_ordered_json(*text);
  if (json.is_discarded()) return nullptr;
  return json;
}

std::string text_at(const Json& object, const char* name) {
  const auto* value = base::json_member(object, name);
  return value == nullptr ? std::string() : base::json_as<std::string>(*value).value_or("");
}

/// Is it about the simulation with this number, seed and digest?
struct Simulation {
  harness::SampleId id;
  std::uint64_t seed;
  const std::string& digest;
};
bool is_of(const Json& object, const Simulation& simulation) {
  const auto* seed = base::json_member(object, "seed");
  return seed != nullptr && base::json_as<std::uint64_t>(*seed) == simulation.seed &&
         text_at(object, "sample") == id_text(simulation.id) &&
         text_at(object, "digest") == simulation.digest;
}

std::vector<std::string> sentences_of(const Json& object) {
  std::vector<std::string> out;
  const auto* list = base::json_member(object, "sentences");
  if (list == nullptr || !list->is_array()) return out;
  for (const auto& sentence : *list) {
    if (auto text = base::json_as<std::string>(sentence)) out.push_back(*std::move(text));
  }
  return out;
}

base::Status write(const std::string& run_dir, const char* name, const Json& document,
                   base::DiagnosticSink& sink) {
  const auto place = std::filesystem::path(run_dir) / name;
  if (!base::check_unnamed_output(place.parent_path(), run_dir, "another run folder", sink)) {
    return sink.already_reported();
  }
  return base::write_file_atomically(place, base::json_text(document, 1) + '\n', sink);
}

}  // namespace

std::string confirm_json(const Confirmation& confirmation) {
  return base::json_text(confirmation_document(confirmation)) + '\n';
}

std::string threshold_json(const Threshold& threshold) {
  return base::json_text(threshold_document(threshold)) + '\n';
}

KeptFindings kept_findings(const std::string& run_dir, const harness::SampleRecord& record) {
  const Simulation simulation{{record.trace, record.sample}, record.seed, record.digest};
  KeptFindings out;
  const auto confirmed = read_kept(run_dir, kConfirmFile);
  if (is_of(confirmed, simulation)) {
    out.confirmed = sentences_of(confirmed);
    if (const auto* standing = base::json_member(confirmed, "standing")) {
      out.standing = {harness::standing_named(text_at(*standing, "is")),
                      text_at(*standing, "words")};
    }
  }
  const auto kept = read_kept(run_dir, kThresholdFile);
  const auto* list = base::json_member(kept, "thresholds");
  if (list == nullptr || !list->is_array()) return out;
  for (const auto& entry : *list) {
    if (!is_of(entry, simulation)) continue;
    for (auto& sentence : sentences_of(entry)) out.thresholds.push_back(std::move(sentence));
  }
  return out;
}

base::Status keep_finding(const std::string& run_dir, const Confirmation& confirmation,
                          base::DiagnosticSink& sink) {
  return write(run_dir, kConfirmFile, confirmation_document(confirmation), sink);
}

base::Status keep_finding(const std::string& run_dir, const Threshold& threshold,
                          base::DiagnosticSink& sink) {
  auto entries = Json::array();
  const auto kept = read_kept(run_dir, kThresholdFile);
  const auto* list = base::json_member(kept, "thresholds");
  const auto& name = threshold.parameter.range.name;
  if (list != nullptr && list->is_array()) {
    for (const auto& entry : *list) {
      const bool same = is_of(entry, {threshold.sample, threshold.seed, threshold.digest});
      if (same && text_at(entry, "parameter") != name) entries.push_back(entry);
    }
  }
  entries.push_back(threshold_document(threshold));
  return write(run_dir, kThresholdFile, {{"thresholds", std::move(entries)}}, sink);
}

}  // namespace parallax::tools
