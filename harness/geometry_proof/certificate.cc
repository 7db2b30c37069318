#include "harness/geometry_proof/certificate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/json.h"

namespace parallax::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKind = "parallax geometry proof";

Json json_of(const StartBox& box) {
  Json out = Json::array();
  for (const Bounds1& one : box) out.push_back({one.lower, one.upper});
  return out;
}

bool read_range(const Json& json, Bounds1& out) {
  if (!json.is_array() || json.size() != 2 || !json[0].is_number() || !json[1].is_number()) {
    return false;
  }
  out = {json[0].get<double>(), json[1].get<double>()};
  return std::isfinite(out.lower) && std::isfinite(out.upper) && out.lower <= out.upper;
}

bool read_box(const Json& json, StartBox& out) {
  if (!json.is_array()) return false;
  for (const Json& one : json) {
    if (!read_range(one, out.emplace_back())) return false;
  }
  return true;
}

double volume_share(const StartBox& box, const StartBox& region) {
  double share = 1.0;
  for (std::size_t i = 0; i < box.size(); ++i) {
    share *= (box[i].upper - box[i].lower) / (region[i].upper - region[i].lower);
  }
  return share;
}

void add_share(const DecidedBox& box, const StartBox& region, TestCertificate& test) {
  double& share = box.verdict == BoxVerdict::kSafe      ? test.safe
                  : box.verdict == BoxVerdict::kRefuted ? test.refuted
                                                        : test.open;
  share += volume_share(box.bounds, region);
}

Json json_of(const TestCertificate& test) {
  Json boxes = Json::array();
  for (const DecidedBox& box : test.boxes) {
    Json one = {{"verdict", to_string(box.verdict)}, {"bounds", json_of(box.bounds)}};
    if (!box.culprit.empty()) one["culprit"] = box.culprit;
    boxes.push_back(std::move(one));
  }
  return {{"controller", test.test.controller},
          {"function", test.test.function},
          {"source", test.test.source},
          {"refusal", test.test.refusal},
          {"asks", test.test.statement},
          {"assumed", test.assumed},
          {"examined", test.examined},
          {"unconfirmed", test.unconfirmed},
          {"safe", test.safe},
          {"refuted", test.refuted},
          {"open", test.open},
          {"boxes", std::move(boxes)}};
}

std::string text_member(const Json& object, const char* name) {
  const Json* member = base::json_member(object, name);
  return member == nullptr ? std::string() : base::json_as<std::string>(*member).value_or("");
}

double number_member(const Json& object, const char* name, double fallback) {
  const Json* member = base::json_member(object, name);
  return member == nullptr ? fallback : base::json_as<double>(*member).value_or(fallback);
}

std::int64_t count_member(const Json& object, const char* name) {
  const Json* member = base::json_member(object, name);
  return member == nullptr ? 0 : base::json_as<std::int64_t>(*member).value_or(0);
}

std::optional<std::string> read_test(const Json& json, const StartBox& region,
                                     TestCertificate& test) {
  test.test.controller = text_member(json, "controller");
  test.test.function = text_member(json, "function");
  test.test.source = text_member(json, "source");
  test.test.statement = text_member(json, "asks");
  test.unconfirmed = count_member(json, "unconfirmed");
  const Json* assumed = base::json_member(json, "assumed");
  const Json none = Json::array();
  for (const Json& one : assumed != nullptr && assumed->is_array() ? *assumed : none) {
    test.assumed.push_back(base::json_as<std::string>(one).value_or(""));
  }
  const Json* boxes = base::json_member(json, "boxes");
  if (test.test.function.empty() || boxes == nullptr || !boxes->is_array()) {
    return "a test lacks its `function` or its `boxes`";
  }
  for (const Json& one : *boxes) {
    DecidedBox box;
    const std::string verdict = text_member(one, "verdict");
    const Json* bounds = base::json_member(one, "bounds");
    if (verdict != "safe" && verdict != "refuted" && verdict != "open") {
      return fmt::format("`{}` is no verdict of a box", verdict);
    }
    box.verdict = verdict == "safe"      ? BoxVerdict::kSafe
                  : verdict == "refuted" ? BoxVerdict::kRefuted
                                         : BoxVerdict::kOpen;
    if (bounds == nullptr || !read_box(*bounds, box.bounds) || box.bounds.size() != region.size()) {
      return fmt::format("box {} of `{}` has no `bounds` for each of {} variables",
                         test.boxes.size(), test.test.function, region.size());
    }
    add_share(box, region, test);
    test.boxes.push_back(std::move(box));
  }
  return std::nullopt;
}

}  // namespace

std::vector<ActionCertificate> certify(const std::vector<ProvableAction>& actions,
                                       const ProofLimits& limits) {
  std::vector<ActionCertificate> all;
  for (const ProvableAction& action : actions) {
    ActionCertificate one{
        action.number, action.event, action.controller, {}, action.left_to_simulation};
    for (const auto& test : action.tests) {
      const StartBox whole = test->scene().whole();
      ProofResult result = prove(test->check(), whole, limits);
      TestCertificate made{
          test->check().test(),   test->state().assumed, result.examined, 0, 0.0, 0.0, 0.0,
          std::move(result.boxes)};
      for (DecidedBox& box : made.boxes) {
        const bool stopped = limits.stop != nullptr && limits.stop->load();
        if (box.verdict != BoxVerdict::kOpen &&
            (stopped || !test->second().confirms(box.bounds, box.verdict, kSecondEffort))) {
          box.verdict = BoxVerdict::kOpen;
          ++made.unconfirmed;
        }
        add_share(box, whole, made);
      }
      one.tests.push_back(std::move(made));
    }
    all.push_back(std::move(one));
  }
  return all;
}

std::string certificate_json(const Certificate& certificate) {
  const ProofAssumptions& given = certificate.assumptions;
  Json sliders = Json::object();
  for (const auto& [name, range] : given.sliders) sliders[name] = {range.lower, range.upper};
  Json actions = Json::array();
  for (const ActionCertificate& action : certificate.actions) {
    Json tests = Json::array();
    for (const TestCertificate& test : action.tests) tests.push_back(json_of(test));
    Json one = {{"number", action.number},
                {"event", action.event},
                {"controller", action.controller},
                {"tests", std::move(tests)}};
    if (!action.left_to_simulation.empty()) {
      one["left_to_simulation"] = action.left_to_simulation;
    }
    actions.push_back(std::move(one));
  }
  const Json document = {{"kind", kKind},
                         {"version", 1},
                         {"status", certificate.stopped ? "stopped" : "ok"},
                         {"scenario", certificate.scenario},
                         {"scenario_hash", certificate.scenario_hash},
                         {"trace", certificate.trace},
                         {"variables", certificate.variables},
                         {"region", json_of(certificate.region)},
                         {"assumptions",
                          {{"drift", given.drift_m},
                           {"drift-rad", given.drift_rad},
                           {"sliding", given.sliding_m},
                           {"sliding-rad", given.sliding_rad},
                           {"goal", given.goal_m},
                           {"goal-rad", given.goal_rad},
                           {"parked", given.parked_m},
                           {"held", given.held_m},
                           {"held-rad", given.held_rad},
                           {"held-height", given.held_height_m},
                           {"lean", given.lean_rad},
                           {"sliders", std::move(sliders)}}},
                         {"actions", std::move(actions)}};
  return base::json_text(document) + "\n";
}

std::optional<std::string> read_certificate(std::string_view text, Certificate& certificate) {
  const Json document = base::parse_ordered_json(text);
  if (document.is_discarded() || text_member(document, "kind") != kKind) {
    return "it is no geometry proof of parallax";
  }
  if (count_member(document, "version") != 1) return "it has another version";
  certificate.scenario = text_member(document, "scenario");
  certificate.scenario_hash = text_member(document, "scenario_hash");
  certificate.trace = count_member(document, "trace");
  const Json* variables = base::json_member(document, "variables");
  const Json* region = base::json_member(document, "region");
  const Json* actions = base::json_member(document, "actions");
  if (variables == nullptr || region == nullptr || actions == nullptr || !actions->is_array() ||
      !variables->is_array() || !read_box(*region, certificate.region) ||
      certificate.region.size() != variables->size()) {
    return "it lacks its variables, its region or its actions";
  }
  for (const Bounds1& one : certificate.region) {
    if (!(one.lower < one.upper)) return "a variable of its region has no width";
  }
  for (const Json& name : *variables) {
    certificate.variables.push_back(base::json_as<std::string>(name).value_or(""));
  }
  if (const Json* given = base::json_member(document, "assumptions")) {
    ProofAssumptions& out = certificate.assumptions;
    out.drift_m = number_member(*given, "drift", out.drift_m);
    out.drift_rad = number_member(*given, "drift-rad", out.drift_rad);
    out.sliding_m = number_member(*given, "sliding", out.sliding_m);
    out.sliding_rad = number_member(*given, "sliding-rad", out.sliding_rad);
    out.goal_m = number_member(*given, "goal", out.goal_m);
    out.goal_rad = number_member(*given, "goal-rad", out.goal_rad);
    out.parked_m = number_member(*given, "parked", out.parked_m);
    out.held_m = number_member(*given, "held", out.held_m);
    out.held_rad = number_member(*given, "held-rad", out.held_rad);
    out.held_height_m = number_member(*given, "held-height", out.held_height_m);
    out.lean_rad = number_member(*given, "lean", out.lean_rad);
    const Json* sliders = base::json_member(*given, "sliders");
    const Json none = Json::object();
    for (const auto& [name, range] : (sliders != nullptr ? *sliders : none).items()) {
      if (!read_range(range, out.sliders.emplace_back(name, Bounds1{}).second)) {
        return fmt::format("the range of `{}` is none", name);
      }
    }
  }
  for (const Json& json : *actions) {
    ActionCertificate& action = certificate.actions.emplace_back();
    action.number =
        static_cast<std::size_t>(std::max<std::int64_t>(count_member(json, "number"), 0));
    action.event = text_member(json, "event");
    action.controller = text_member(json, "controller");
    action.left_to_simulation = text_member(json, "left_to_simulation");
    const Json* tests = base::json_member(json, "tests");
    if (tests == nullptr || !tests->is_array()) return "an action lacks its `tests`";
    for (const Json& one : *tests) {
      if (auto fault = read_test(one, certificate.region, action.tests.emplace_back())) {
        return fault;
      }
    }
  }
  return std::nullopt;
}

namespace {

/// More halvings than any search makes.
constexpr int kMostHalvings = 2000;

bool fills(std::vector<const StartBox*> boxes, const StartBox& region, int halvings) {
  if (halvings > kMostHalvings) return false;
  if (boxes.size() == 1) {
    for (std::size_t i = 0; i < region.size(); ++i) {
      const Bounds1& one = (*boxes.front())[i];
      if (one.lower != region[i].lower || one.upper != region[i].upper) return false;
    }
    return true;
  }
  for (std::size_t axis = 0; axis < region.size(); ++axis) {
    const double middle = 0.5 * region[axis].lower + 0.5 * region[axis].upper;
    std::vector<const StartBox*> low, high;
    for (const StartBox* box : boxes) {
      if ((*box)[axis].upper <= middle) low.push_back(box);
      if ((*box)[axis].lower >= middle) high.push_back(box);
    }
    if (low.empty() || high.empty() || low.size() + high.size() != boxes.size()) continue;
    StartBox left = region, right = region;
    left[axis].upper = right[axis].lower = middle;
    boxes = {};  // not to be kept through the recursion
    return fills(std::move(low), left, halvings + 1) && fills(std::move(high), right, halvings + 1);
  }
  return false;
}

}  // namespace

bool fill(const std::vector<DecidedBox>& boxes, const StartBox& region) {
  std::vector<const StartBox*> all;
  for (const DecidedBox& box : boxes) {
    if (box.bounds.size() != region.size()) return false;
    all.push_back(&box.bounds);
  }
  return !all.empty() && fills(std::move(all), region, 0);
}

CertificateCheck check_certificate(const Certificate& certificate,
                                   const std::vector<ProvableAction>& actions,
                                   const std::atomic<bool>* stop) {
  CertificateCheck out;
  for (const ActionCertificate& claimed : certificate.actions) {
    if (claimed.tests.empty()) continue;
    const ProvableAction* action = nullptr;
    for (const ProvableAction& one : actions) {
      if (one.number == claimed.number) action = &one;
    }
    if (action == nullptr || action->event != claimed.event ||
        action->tests.size() != claimed.tests.size()) {
      out.mismatch = fmt::format("its action {} is {}, with {} tests", claimed.number,
                                 claimed.event, claimed.tests.size());
      return out;
    }
    for (std::size_t i = 0; i < claimed.tests.size(); ++i) {
      const TestCertificate& told = claimed.tests[i];
      const ActionTest& test = *action->tests[i];
      if (told.test.function != test.check().test().function) {
        out.mismatch = fmt::format("`{}` is no test of {}", told.test.function, claimed.event);
        return out;
      }
      if (!fill(told.boxes, certificate.region)) {
        out.mismatch = fmt::format("the boxes of {} do not fill the start region", claimed.event);
        return out;
      }
      for (const DecidedBox& box : told.boxes) {
        const double share = volume_share(box.bounds, certificate.region);
        if (box.verdict == BoxVerdict::kOpen) {
          out.open += share;
          continue;
        }
        (box.verdict == BoxVerdict::kSafe ? out.safe : out.refuted) += share;
        std::vector<double> middle;
        for (const Bounds1& one : box.bounds) middle.push_back(0.5 * (one.lower + one.upper));
        const bool stopped = stop != nullptr && stop->load();
        if (!stopped && test.second().refuses_at(middle) != (box.verdict == BoxVerdict::kRefuted)) {
          ++out.wrong;
        } else if (stopped || !test.second().confirms(box.bounds, box.verdict, kSecondEffort)) {
          ++out.unconfirmed;
        } else {
          ++out.confirmed;
        }
      }
    }
  }
  return out;
}

}  // namespace parallax::harness
