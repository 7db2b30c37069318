// Certificates as JSON, written and read. What is read is a claim of whoever wrote the file: every
// member is required and has its range, so that nothing that is missing becomes a default.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/json.h"
#include "harness/geometry_proof/certificate.h"
#include "harness/geometry_proof/proof_assumptions.h"

namespace parallax::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKind = "parallax geometry proof";
/// Sums of shares may be rounded otherwise by another compiler.
constexpr double kShareRounding = 1e-9;

Json json_of(const StartBox& box) {
  Json out = Json::array();
  for (const Bounds1& one : box) out.push_back({one.lower, one.upper});
  return out;
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

/// Reads required members and keeps the first thing that was wrong, so that callers read straight
/// on.
class Members {
 public:
  const std::optional<std::string>& fault() const { return fault_; }
  bool failed() const { return fault_.has_value(); }
  void fail(std::string why) {
    if (!fault_) fault_ = std::move(why);
  }

  /// The value of a type that base::json_as knows; the default of the type where there is none.
  template <typename T>
  T get(const Json& object, const char* name, const char* kind) {
    const Json* member = base::json_member(object, name);
    auto value = member == nullptr ? std::nullopt : base::json_as<T>(*member);
    if (!value) fail(fmt::format("`{}` is {}", name, member == nullptr ? "missing" : kind));
    return value.value_or(T());
  }
  std::string text(const Json& object, const char* name) {
    return get<std::string>(object, name, "no text");
  }
  double number(const Json& object, const char* name) {
    return get<double>(object, name, "no number");
  }
  std::int64_t count(const Json& object, const char* name, std::int64_t least) {
    const auto value = get<std::int64_t>(object, name, "no whole number");
    if (value < least) fail(fmt::format("`{}` is {}", name, value));
    return value;
  }
  const Json& list(const Json& object, const char* name) {
    static const Json kNone = Json::array();
    const Json* member = base::json_member(object, name);
    if (member != nullptr && member->is_array()) return *member;
    fail(fmt::format("`{}` is {}", name, member == nullptr ? "missing" : "no list"));
    return kNone;
  }
  const Json& object(const Json& parent, const char* name) {
    static const Json kNone = Json::object();
    const Json* member = base::json_member(parent, name);
    if (member != nullptr && member->is_object()) return *member;
    fail(fmt::format("`{}` is {}", name, member == nullptr ? "missing" : "no object"));
    return kNone;
  }
  std::vector<std::string> texts(const Json& parent, const char* name) {
    std::vector<std::string> out;
    for (const Json& one : list(parent, name)) {
      const auto text = base::json_as<std::string>(one);
      if (!text) fail(fmt::format("`{}` has an element that is no text", name));
      out.push_back(text.value_or(std::string()));
    }
    return out;
  }
  Bounds1 range(const Json& json, std::string_view name) {
    Bounds1 out{0.0, 0.0};
    const bool is_pair =
        json.is_array() && json.size() == 2 && json[0].is_number() && json[1].is_number();
    if (is_pair) out = {json[0].get<double>(), json[1].get<double>()};
    const bool is_range =
        is_pair && std::isfinite(out.lower) && std::isfinite(out.upper) && out.lower <= out.upper;
    if (!is_range) fail(fmt::format("the range of `{}` is none", name));
    return out;
  }
  StartBox box(const Json& object, const char* name) {
    StartBox out;
    for (const Json& one : list(object, name)) out.push_back(range(one, name));
    return out;
  }

 private:
  std::optional<std::string> fault_;
};

void read_assumptions(Members& in, const Json& document, ProofAssumptions& out) {
  const Json& given = in.object(document, "assumptions");
  for (const AssumptionField& field : assumption_fields()) {
    const double value = in.number(given, field.name);
    out.*field.value = value;
    const auto why = wrong_assumption(value);
    if (!why.empty()) in.fail(fmt::format("its assumption `{}` {}", field.name, why));
  }
  const Json& sliders = in.object(given, "sliders");
  for (const auto& [name, json] : sliders.items()) {
    out.sliders.emplace_back(name, in.range(json, name));
  }
  if (given.size() != assumption_fields().size() + 1) {
    in.fail("it assumes something that is not known here");
  }
}

std::optional<BoxVerdict> verdict_of(const std::string& word) {
  for (const auto verdict : {BoxVerdict::kSafe, BoxVerdict::kRefuted, BoxVerdict::kOpen}) {
    if (word == to_string(verdict)) return verdict;
  }
  return std::nullopt;
}

void read_boxes(Members& in, const Json& json, const StartBox& region, TestCertificate& test) {
  for (const Json& one : in.list(json, "boxes")) {
    if (in.failed()) return;
    DecidedBox box;
    const std::string word = in.text(one, "verdict");
    const auto verdict = verdict_of(word);
    if (!verdict) in.fail(fmt::format("`{}` is no verdict of a box", word));
    box.verdict = verdict.value_or(BoxVerdict::kOpen);
    box.bounds = in.box(one, "bounds");
    if (box.bounds.size() != region.size()) {
      return in.fail(fmt::format("box {} of `{}` has no `bounds` for each of {} variables",
                                 test.boxes.size(), test.test.function, region.size()));
    }
    if (base::json_member(one, "culprit") != nullptr) box.culprit = in.text(one, "culprit");
    test.boxes.push_back(std::move(box));
  }
}

/// Shares and counts follow from the boxes: what is said of them is compared, and not believed.
void check_sums(Members& in, const StartBox& region, const TestCertificate& said,
                TestCertificate& test) {
  std::int64_t open = 0;
  for (const DecidedBox& box : test.boxes) {
    add_share(box, region, test);
    open += box.verdict == BoxVerdict::kOpen ? 1 : 0;
  }
  const auto compare = [&](const char* name, double stated, double real) {
    if (std::abs(stated - real) <= kShareRounding) return;
    in.fail(fmt::format("`{}` of `{}` is {}, and its boxes have {}", name, test.test.function,
                        stated, real));
  };
  compare("safe", said.safe, test.safe);
  compare("refuted", said.refuted, test.refuted);
  compare("open", said.open, test.open);
  // Each halving makes one box two, which are examined.
  if (said.examined != 2 * std::ssize(test.boxes) - 1 || said.unconfirmed > open) {
    in.fail(fmt::format("`examined` or `unconfirmed` of `{}` does not go with its boxes",
                        test.test.function));
  }
}

TestCertificate read_test(Members& in, const Json& json, const StartBox& region) {
  TestCertificate test, said;
  test.test.controller = in.text(json, "controller");
  test.test.function = in.text(json, "function");
  test.test.source = in.text(json, "source");
  test.test.refusal = in.text(json, "refusal");
  test.test.statement = in.text(json, "asks");
  test.assumed = in.texts(json, "assumed");
  test.examined = said.examined = in.count(json, "examined", 1);
  test.unconfirmed = said.unconfirmed = in.count(json, "unconfirmed", 0);
  said.safe = in.number(json, "safe");
  said.refuted = in.number(json, "refuted");
  said.open = in.number(json, "open");
  read_boxes(in, json, region, test);
  if (!in.failed()) check_sums(in, region, said, test);
  return test;
}

ActionCertificate read_action(Members& in, const Json& json, const StartBox& region) {
  ActionCertificate action;
  action.number = static_cast<std::size_t>(in.count(json, "number", 0));
  action.event = in.text(json, "event");
  action.controller = in.text(json, "controller");
  for (const Json& one : in.list(json, "tests")) {
    if (in.failed()) break;
    action.tests.push_back(read_test(in, one, region));
  }
  if (base::json_member(json, "left_to_simulation") != nullptr) {
    action.left_to_simulation = in.text(json, "left_to_simulation");
  }
  return action;
}

}  // namespace

std::string certificate_json(const GeometryCertificate& certificate) {
  Json assumptions = Json::object(), sliders = Json::object();
  for (const AssumptionField& field : assumption_fields()) {
    assumptions[field.name] = certificate.assumptions.*field.value;
  }
  for (const auto& [name, range] : certificate.assumptions.sliders) {
    sliders[name] = {range.lower, range.upper};
  }
  assumptions["sliders"] = std::move(sliders);
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
  Json document = {{"kind", kKind},
                   {"version", 1},
                   {"status", certificate.stopped ? "stopped" : "ok"},
                   {"scenario", certificate.scenario},
                   {"scenario_hash", certificate.scenario_hash},
                   {"trace", certificate.trace}};
  if (certificate.initial_state > 0) {
    document["initial_state"] = {{"number", certificate.initial_state},
                                 {"holds", certificate.holds}};
  }
  document["variables"] = certificate.variables;
  document["region"] = json_of(certificate.region);
  document["assumptions"] = std::move(assumptions);
  document["actions"] = std::move(actions);
  return base::json_text(document) + "\n";
}

std::optional<std::string> read_certificate(std::string_view text,
                                            GeometryCertificate& certificate) {
  const Json document = base::parse_ordered_json(text);
  const Json* kind = document.is_discarded() ? nullptr : base::json_member(document, "kind");
  if (kind == nullptr || *kind != kKind) return "it is no geometry proof of parallax";
  Members in;
  if (in.count(document, "version", 0) != 1) return "it has another version";
  const auto status = in.text(document, "status");
  if (status != "ok" && status != "stopped") in.fail(fmt::format("`status` is `{}`", status));
  certificate.stopped = status == "stopped";
  certificate.scenario = in.text(document, "scenario");
  certificate.scenario_hash = in.text(document, "scenario_hash");
  certificate.trace = in.count(document, "trace", 1);
  if (base::json_member(document, "initial_state") != nullptr) {
    const Json& state = in.object(document, "initial_state");
    certificate.initial_state = in.count(state, "number", 1);
    certificate.holds = in.text(state, "holds");
  }
  certificate.variables = in.texts(document, "variables");
  certificate.region = in.box(document, "region");
  if (certificate.region.size() != certificate.variables.size()) {
    in.fail("it has not one range for each of its variables");
  }
  for (const Bounds1& one : certificate.region) {
    if (!(one.lower < one.upper)) in.fail("a variable of its region has no width");
  }
  read_assumptions(in, document, certificate.assumptions);
  for (const Json& one : in.list(document, "actions")) {
    if (in.failed()) break;
    certificate.actions.push_back(read_action(in, one, certificate.region));
  }
  return in.fault();
}

}  // namespace parallax::harness
