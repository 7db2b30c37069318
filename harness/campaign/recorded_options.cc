#include "harness/campaign/recorded_options.h"

#include <fmt/format.h>

#include <array>
#include <span>

#include "compiler/base/json.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/result_json.h"

namespace parallax::harness {
namespace {

using Json = nlohmann::json;

/// The members of a header object. The first unknown member is kept in `wrong`.
class Fields {
 public:
  Fields(const Json& object, std::string name, std::string& wrong)
      : object_(object), name_(std::move(name)), wrong_(wrong) {
    if (!object_.is_object()) refuse(name_, "is no object");
  }

  const Json* find(const char* key) const { return base::json_member(object_, key); }
  std::string path(const char* key) const { return name_ + "." + key; }

  template <typename T>
  std::optional<T> get(const char* key) const {
    const auto* member = find(key);
    if (member == nullptr) return std::nullopt;
    auto value = base::json_as<T>(*member);
    if (!value) refuse(path(key), "has the wrong type");
    return value;
  }

  bool flag(const char* key) const { return get<bool>(key).value_or(false); }

  /// A number between 0 and 1, without them.
  std::optional<double> share(const char* key) const {
    auto value = get<double>(key);
    if (value && !(*value > 0.0 && *value < 1.0)) {
      refuse(path(key), fmt::format("is {}, not between 0 and 1", *value));
    }
    return value;
  }

  void count(const char* key) const {
    const auto value = get<std::int64_t>(key);
    if (value && *value < 0) refuse(path(key), fmt::format("is {}, less than 0", *value));
  }

  /// Which of the words it is.
  std::optional<std::size_t> word(const char* key, std::span<const std::string_view> words) const {
    const auto text = get<std::string>(key);
    if (!text) return std::nullopt;
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] == *text) return i;
    }
    refuse(path(key), fmt::format("is `{}`", *text));
    return std::nullopt;
  }

  void refuse(const std::string& what, const std::string& why) const {
    if (wrong_.empty()) wrong_ = fmt::format("`{}` {}", what, why);
  }

 private:
  const Json& object_;
  std::string name_;
  std::string& wrong_;
};

template <typename Enum, std::size_t kCount>
void set_word(const Fields& fields, const char* key, const base::WordTable<Enum, kCount>& words,
              auto& value) {
  if (const auto index = fields.word(key, words)) value = static_cast<Enum>(*index);
}

PaperRuleSpec paper_of(const Fields& fields) {
  PaperRuleSpec paper;
  paper.preset = fields.get<std::string>("preset").value_or(paper.preset);
  set_word(fields, "sigma", kSigmaWords, paper.sigma);
  set_word(fields, "root", kRootWords, paper.root);
  set_word(fields, "intercept", kInterceptWords, paper.intercept);
  set_word(fields, "interval", kIntervalWords, paper.interval);
  fields.count("extra_runs");
  paper.extra_runs = fields.get<std::int64_t>("extra_runs").value_or(paper.extra_runs);
  paper.exempt_inherited = fields.flag("exempt_inherited");
  paper.tolerance_m = fields.get<double>("tolerance_m").value_or(paper.tolerance_m);
  if (!(paper.tolerance_m >= 0.0)) fields.refuse(fields.path("tolerance_m"), "is less than 0");
  paper.bonferroni = fields.flag("bonferroni");
  return paper;
}

void read_criterion(const Fields& fields, std::string& wrong, RecordedOptions& out) {
  set_word(fields, "kind", kCriterionWords, out.criterion);
  set_word(fields, "family", kFamilyWords, out.family);
  fields.count("runs");
  out.criterion_runs = fields.get<std::int64_t>("runs");
  out.confidence_level = fields.share("confidence");
  out.epsilon = fields.share("epsilon");
  if (const auto* paper = fields.find("paper")) {
    out.paper = paper_of(Fields(*paper, fields.path("paper"), wrong));
  }
}

}  // namespace

std::string recorded_options_json(const Scenario& scenario, const CampaignOptions& options) {
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson json = {{"criterion", base::parse_ordered_json(criterion_json(scenario.criterion))},
                      {"limits",
                       {{"max_traces", scenario.limits.max_traces},
                        {"max_rejected_starts", scenario.limits.max_rejected_starts},
                        {"max_lost_in_a_row", scenario.limits.max_lost_in_a_row}}},
                      {"keep_going", options.keep_going},
                      {"compare", to_string(scenario.comparison())},
                      {"match", scenario.match_model ? "model" : "trace"}};
  if (scenario.until_covered) json["until_covered"] = true;
  if (scenario.search.runs > 0) {
    json["search"] = {{"runs", scenario.search.runs},
                      {"strategy", to_string(scenario.search.strategy)}};
  }
  if (options.all_hits) json["hits"] = "all";
  if (options.split_initial) json["split_initial"] = true;
  if (options.random_sequences) json["random_sequences"] = true;
  if (scenario.execution == Execution::kClosedLoop) {
    json["execution"] = to_string(scenario.execution);
    if (scenario.starts == Starts::kGuided) json["starts"] = to_string(scenario.starts);
    json["limits"]["max_performs"] = scenario.limits.max_performs;
    json["limits"]["max_simulated_s"] = scenario.limits.max_simulated_s;
  }
  return base::json_text(json);
}

std::variant<RecordedOptions, std::string> recorded_options(std::string_view text) {
  using namespace std::string_view_literals;
  const auto json = base::parse_json(text);
  std::string wrong;
  RecordedOptions out;
  const Fields fields(json, "options", wrong);
  if (const auto* criterion = fields.find("criterion")) {
    read_criterion(Fields(*criterion, "options.criterion", wrong), wrong, out);
  }
  if (const auto* limits = fields.find("limits")) {
    const Fields counts(*limits, "options.limits", wrong);
    for (const auto* name :
         {"max_traces", "max_rejected_starts", "max_lost_in_a_row", "max_performs"}) {
      counts.count(name);
    }
    const auto seconds = counts.get<double>("max_simulated_s");
    if (seconds && !(*seconds > 0.0)) {
      counts.refuse("options.limits.max_simulated_s", "is not above 0");
    }
  }
  out.keep_going = fields.flag("keep_going");
  out.until_covered = fields.flag("until_covered");
  if (const auto* search = fields.find("search")) {
    const Fields parts(*search, "options.search", wrong);
    parts.count("runs");
    out.search.runs = parts.get<std::int64_t>("runs").value_or(0);
    set_word(parts, "strategy", kSearchStrategies, out.search.strategy);
  }
  out.split_initial = fields.flag("split_initial");
  out.random_sequences = fields.flag("random_sequences");
  out.all_hits = fields.word("hits", std::array{"first"sv, "all"sv}) == std::size_t{1};
  set_word(fields, "compare", kComparisons, out.compare);
  if (const auto word = fields.word("match", std::array{"trace"sv, "model"sv})) {
    out.match_model = *word == 1;
  }
  set_word(fields, "execution", kExecutions, out.execution);
  set_word(fields, "starts", kStartsWords, out.starts);
  if (!wrong.empty()) return wrong;
  return out;
}

void RecordedOptions::apply(Scenario& scenario, CampaignOptions& options) const {
  auto& spec = scenario.criterion;
  spec.kind = criterion.value_or(spec.kind);
  spec.confidence_level = confidence_level.value_or(spec.confidence_level);
  spec.epsilon = epsilon.value_or(spec.epsilon);
  spec.runs = criterion_runs.value_or(0);
  spec.family = family;
  spec.paper = paper.value_or(spec.paper);
  scenario.match_model = match_model.value_or(scenario.match_model);
  scenario.compare = compare.value_or(scenario.comparison());
  scenario.starts = starts;
  scenario.until_covered = scenario.until_covered || until_covered;
  scenario.search = search;
  options.keep_going = keep_going;
  options.all_hits = all_hits;
  options.split_initial = split_initial;
}

}  // namespace parallax::harness
