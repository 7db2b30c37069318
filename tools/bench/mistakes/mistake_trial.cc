#include "tools/bench/mistakes/mistake_trial.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tools/bench/child_run.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kFirst = "first";
constexpr const char* kSecond = "second";
constexpr const char* kRandom = "random";
constexpr std::size_t kWalks = 24;
constexpr std::size_t kWalkLength = 7;
constexpr int kDiscrepancy = 1;  // exit code of `run`

std::string text_of(const std::vector<std::string>& lines) { return joined(lines, "\n") + "\n"; }

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string file_text(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string scenario(const std::string& plan, const std::string& model, const std::string& start) {
  return "include: " + plan + ".yaml\nname: mistakes\nmodel: [" + model + ", " + start +
         "]\nsimulator: {model: [truth.e, truth_start.e]}\n";
}

/// The document that a command printed with `--json`; empty if it printed none.
json document(const std::string& text) {
  auto out = json::parse(text, nullptr, false);
  return out.is_object() ? out : json::object();
}

bool is_filled(const json& proposal, const char* key) {
  const auto found = proposal.find(key);
  if (found == proposal.end()) return false;
  return found->is_string() ? !found->get<std::string>().empty() : !found->empty();
}

}  // namespace

const std::vector<MistakeWorld>& mistake_worlds() {
  static const std::vector<MistakeWorld> all = {
      {"bakery", false},  {"lab", false},  {"depot", false},  {"post", false},
      {"aquarium", true}, {"stage", true}, {"railway", true}, {"board", true}};
  return all;
}

const char* to_string(Shown shown) {
  static constexpr std::array<const char*, 6> kNames = {"first plan", "second plan", "refused",
                                                        "permissive", "invisible",   "no model"};
  return kNames.at(static_cast<std::size_t>(shown));
}

std::string to_json(const MistakeOutcome& outcome) {
  return json{{"world", outcome.world},
              {"number", outcome.number},
              {"kind", outcome.kind},
              {"about", outcome.about},
              {"of_demanded", outcome.of_demanded},
              {"shown", to_string(outcome.shown)},
              {"proposals", outcome.proposals},
              {"right_rank", outcome.right_rank},
              {"right_second", outcome.right_second},
              {"right_random", outcome.right_random},
              {"first_is_marked", outcome.first_is_marked},
              {"list_s", outcome.list_s},
              {"first", outcome.first}}
      .dump();
}

std::optional<MistakeOutcome> read_outcome(const std::string& line) {
  const auto in = document(line);
  if (!in.contains("world") || !in.contains("shown")) return std::nullopt;
  MistakeOutcome out;
  out.world = in["world"];
  out.number = in["number"];
  out.kind = in["kind"];
  out.about = in["about"];
  out.of_demanded = in.value("of_demanded", false);
  for (int i = 0; i <= static_cast<int>(Shown::kNoModel); ++i) {
    if (in["shown"] == to_string(static_cast<Shown>(i))) out.shown = static_cast<Shown>(i);
  }
  out.proposals = in["proposals"];
  out.right_rank = in["right_rank"];
  out.right_second = in["right_second"];
  out.right_random = in["right_random"];
  out.first_is_marked = in["first_is_marked"];
  out.list_s = in["list_s"];
  out.first = in["first"];
  return out;
}

std::optional<MistakeTrial> MistakeTrial::make(const MistakeWorld& world,
                                               const TrialOptions& options, std::string& error) {
  MistakeTrial trial(world, options);
  if (!trial.prepare(error)) return std::nullopt;
  return trial;
}

std::string MistakeTrial::path(const std::string& name) const {
  return (fs::path(options_.folder) / world_.name / name).string();
}

void MistakeTrial::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name)) << text;
}

std::string MistakeTrial::read(const std::string& name) const { return file_text(path(name)); }

MistakeTrial::Ended MistakeTrial::run(const std::vector<std::string>& arguments,
                                      double limit_s) const {
  std::vector<std::string> command = {options_.program};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const auto output = path("output");
  const auto ended = run_child(command, {output, path(""), limit_s});
  if (!ended) return {};
  return {ended->code, ended->cost.cpu_s, file_text(output)};
}

/// Executes the plan of `PLAN.model.yaml`; the exit code of `parallax run`.
int MistakeTrial::run_plan(const std::string& plan) const {
  std::error_code ignored;
  fs::remove_all(path("out_" + plan), ignored);
  return run({"run", plan + ".model.yaml", "--epsilon", "0.3", "--jobs", "1", "--quiet", "--out",
              "out_" + plan})
      .code;
}

/// The different sequences of events that the runs of a folder performed.
std::optional<std::vector<EventSequence>> MistakeTrial::executed(const std::string& folder) const {
  std::set<EventSequence> all;
  for (const auto& line : lines_of(read(folder + "/journal.ndjson"))) {
    const auto sample = document(line);
    if (!sample.contains("path")) continue;
    EventSequence sequence;
    for (const auto& step : sample["path"]) sequence.push_back(step["event"]);
    all.insert(sequence);
  }
  if (all.empty()) return std::nullopt;
  return std::vector<EventSequence>(all.begin(), all.end());
}

std::vector<bool> MistakeTrial::are_executable(const std::vector<EventSequence>& sequences) const {
  write("walk.e", sequences_model({"truth.e", "truth_start.e"}, sequences));
  const auto ended = run({"consequences", "walk.e", "--horizon",
                          std::to_string(horizon_of(sequences)), "--json", "--quiet"});
  std::set<std::string> possible;
  const auto answer = document(ended.out);
  for (const auto& fact : answer.value("facts", json::array())) {
    if (fact["time"] == 0 && fact["in"] != "never") possible.insert(fact["name"]);
  }
  std::vector<bool> out;
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    out.push_back(possible.count("Sequence(q" + std::to_string(i) + ")") != 0);
  }
  return out;
}

bool MistakeTrial::prepare(std::string& error) {
  const auto from = fs::path(options_.worlds) / world_.name;
  std::error_code failed;
  fs::remove_all(path(""), failed);
  fs::create_directories(options_.folder, failed);
  fs::copy(from, path(""), failed);
  if (failed) {
    error = "cannot copy " + from.string() + ": " + failed.message();
    return false;
  }
  model_ = {lines_of(read("domain.e")), lines_of(read("rules.e")), lines_of(read("start.e"))};
  // The world loads declarations of its own: a proposal never changes the world.
  write("truth_domain.e", text_of(model_.declarations));
  auto truth = model_.rules;
  std::replace(truth.begin(), truth.end(), std::string("load domain.e"),
               std::string("load truth_domain.e"));
  write("truth.e", text_of(truth));
  write("truth_start.e", text_of(model_.start));
  write("model.e", text_of(model_.rules));
  std::map<std::string, std::vector<EventSequence>> sequences;
  for (const std::string plan : {kFirst, kSecond}) {
    write(plan + ".model.yaml", scenario(plan, "model.e", "start.e"));
    if (run_plan(plan) != 0) {
      error = "the model of " + world_.name + " is not right about itself in the " + plan + " plan";
      return false;
    }
    if (auto found = executed("out_" + plan)) sequences[plan] = std::move(*found);
  }
  sequences[kRandom] = random_sequences(model_, kWalks, kWalkLength, 1,
                                        [&](const auto& walks) { return are_executable(walks); });
  for (const auto& [name, of_name] : sequences) {
    horizons_[name] = horizon_of(of_name);
    write("truth_" + name + ".e", sequences_model({"truth.e", "truth_start.e"}, of_name));
    write("model_" + name + ".e", sequences_model({"model.e", "start.e"}, of_name));
    if (predicts(name)) continue;
    error = "the model of " + world_.name + " differs from itself on the " + name + " sequences";
    return false;
  }
  return true;
}

/// Do `model.e` and `start.e` allow what the world allows on these sequences?
bool MistakeTrial::predicts(const std::string& sequences) const {
  return run({"diff", "truth_" + sequences + ".e", "model_" + sequences + ".e", "--horizon",
              std::to_string(horizons_.at(sequences)), "--traces-only", "--stat", "--quiet"})
             .code == 0;
}

bool MistakeTrial::apply(const std::string& patch, const std::string& folder) const {
  write("patch", patch);
  const auto where = fs::path(folder).is_absolute() ? folder : path(folder);
  const auto ended = run_child({"git", "apply", path("patch")}, {path("output"), where, 60.0});
  return ended && ended->code == 0;
}

/// Asks for proposals and tries the first three.
void MistakeTrial::propose(const std::vector<Mistake>& mistakes, const std::string& run_of,
                           MistakeOutcome& outcome) const {
  const auto ended =
      run({"repair", "out_" + run_of, "--limit", "3", "--json", "--quiet"}, options_.list_limit_s);
  outcome.list_s = ended.cpu_s;
  const auto proposals = document(ended.out).value("proposals", json::array());
  outcome.proposals = static_cast<int>(proposals.size());
  if (proposals.empty()) return;
  const auto& first = proposals[0];
  outcome.first = first.value("words", "");
  outcome.first_is_marked = first.value("only_begins", false) || is_filled(first, "tied") ||
                            is_filled(first, "refuted_by") || is_filled(first, "leaves_open");
  const auto other = run_of == kFirst ? kSecond : kFirst;
  const auto wrong_model = text_of(with_mistakes(model_.rules, mistakes, false));
  const auto wrong_start = text_of(with_mistakes(model_.start, mistakes, true));
  for (int rank = 1; rank <= outcome.proposals; ++rank) {
    const auto& proposal = proposals[static_cast<std::size_t>(rank - 1)];
    write("domain.e", text_of(model_.declarations));
    write("model.e", wrong_model);
    write("start.e", wrong_start);
    if (!apply(proposal.value("patch", ""), proposal.value("patch_folder", ""))) continue;
    if (!predicts(run_of)) continue;
    outcome.right_rank = rank;
    outcome.right_second = predicts(other);
    outcome.right_random = predicts(kRandom);
    return;
  }
}

MistakeOutcome MistakeTrial::measure(const std::vector<Mistake>& mistakes, int number) const {
  MistakeOutcome outcome;
  outcome.world = world_.name;
  outcome.number = number;
  outcome.kind = mistakes.size() > 1 ? "two mistakes" : to_string(mistakes[0].kind);
  for (const auto& mistake : mistakes) {
    const auto& lines = mistake.in_start ? model_.start : model_.rules;
    const auto demanded = terms_in(lines[mistake.line], demanded_events(model_));
    outcome.of_demanded = outcome.of_demanded || !demanded.empty();
    outcome.about += (outcome.about.empty() ? "" : "; ") + lines[mistake.line] + " => " +
                     (mistake.text.empty() ? "(dropped)" : mistake.text);
  }
  write("domain.e", text_of(model_.declarations));
  write("model.e", text_of(with_mistakes(model_.rules, mistakes, false)));
  write("start.e", text_of(with_mistakes(model_.start, mistakes, true)));
  if (run({"check", "model.e", "start.e", "--horizon", "3", "--quiet"}).code != 0) return outcome;
  std::string shown_by;
  for (const std::string plan : {kFirst, kSecond}) {
    const auto code = run_plan(plan);
    if (code == 0) continue;
    outcome.shown = code != kDiscrepancy ? Shown::kRefused
                    : plan == kFirst     ? Shown::kFirstPlan
                                         : Shown::kSecondPlan;
    shown_by = plan;
    break;
  }
  if (shown_by.empty()) {
    const bool same = predicts(kFirst) && predicts(kSecond);
    outcome.shown = same ? Shown::kInvisible : Shown::kPermissive;
  } else {
    propose(mistakes, shown_by, outcome);
  }
  return outcome;
}

}  // namespace parallax::tools
