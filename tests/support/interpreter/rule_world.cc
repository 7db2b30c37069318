#include "tests/support/interpreter/rule_world.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace parallax::test {
namespace {

std::string literal_text(const RuleLiteral& literal) {
  return (literal.value ? "" : "!") + literal.fluent;
}

std::string holds_text(const RuleLiteral& literal, const char* time) {
  return std::string(literal.value ? "" : "!") + "HoldsAt(" + literal.fluent + "," + time + ")";
}

std::string joined(const std::vector<std::string>& parts, const char* glue) {
  std::string out;
  for (const auto& part : parts) out += (out.empty() ? "" : glue) + part;
  return out;
}

std::string lower(std::string text) {
  for (auto& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string substituted(std::string text, const std::string& variable, const std::string& value) {
  const auto at = variable.empty() ? std::string::npos : text.find(variable);
  if (at != std::string::npos) text.replace(at, variable.size(), value);
  return text;
}

std::vector<std::string> RuleModel::fluents() const {
  std::vector<std::string> out;
  for (const auto& symbol : thing_fluents) {
    for (const auto& thing : things) out.push_back(symbol + "(" + thing.first + ")");
  }
  for (const auto& symbol : plain_fluents) out.push_back(symbol + "()");
  return out;
}

std::string RuleModel::model_text() const {
  std::vector<std::string> names;
  std::vector<std::string> kinds;
  for (const auto& [thing, kind] : things) {
    names.push_back(thing);
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
  }
  std::string out = "sort thing\nsort kind\nthing " + joined(names, ", ") + "\nkind " +
                    joined(kinds, ", ") + "\npredicate Kind(thing,kind)\n";
  for (const auto& symbol : thing_fluents) out += "fluent " + symbol + "(thing)\n";
  for (const auto& symbol : plain_fluents) out += "fluent " + symbol + "()\n";
  for (const auto& symbol : thing_events) out += "event " + symbol + "(thing)\n";
  for (const auto& symbol : kind_events) out += "event " + symbol + "(kind)\n";
  for (const auto& symbol : plain_events) out += "event " + symbol + "()\n";
  for (const auto& [thing, own] : things) {
    for (const auto& kind : kinds) {
      out += std::string(kind == own ? "" : "!") + "Kind(" + thing + "," + kind + ").\n";
    }
  }
  for (const auto& rule : rules) {
    std::vector<std::string> parts;
    for (const auto& literal : rule.condition) parts.push_back(holds_text(literal, "time"));
    out += "[time] " + joined(parts, " & ") + (parts.empty() ? "" : " -> ") +
           (rule.effect.value ? "Initiates(" : "Terminates(") + rule.event + "," +
           rule.effect.fluent + ",time).\n";
  }
  for (const auto& literal : start) out += holds_text(literal, "0") + ".\n";
  return out;
}

std::string RuleModel::binding_text() const {
  std::string out;
  for (const auto& binding : bindings) {
    const bool thing = binding.event.find("?o") != std::string::npos;
    const bool kind = binding.event.find("?k") != std::string::npos;
    std::vector<std::string> parts;
    if (binding.returns) parts.push_back("Kind(thing,?k)");
    for (const auto& literal : binding.success) {
      parts.push_back(substituted(literal_text(literal), binding.returns ? "?o" : "", "thing"));
    }
    out += "action " + binding.type +
           (thing  ? " (:object ?o)"
            : kind ? " (:object type ?k)"
                   : "") +
           " -> " + binding.event + " ok: " + (binding.returns ? "{thing} " : "") +
           joined(parts, " & ") + (binding.offset == 0 ? " @t" : " @t+1") +
           (binding.returns ? " returns thing" : "") + " else " + binding.failure_class + "\n";
  }
  return out;
}

std::string RuleModel::constraint_text() const {
  std::vector<std::string> parts;
  for (const auto& literal : goal) parts.push_back(holds_text(literal, "time"));
  if (!goal_event.empty()) parts.push_back("Happens(" + goal_event + ",time-1)");
  return joined(parts, " & ");
}

RuleWorld::RuleWorld(const RuleModel& model) : model_(model) {
  for (const auto& fluent : model.fluents()) {
    const bool fixed = std::any_of(model.start.begin(), model.start.end(),
                                   [&](const auto& literal) { return literal.fluent == fluent; });
    if (!fixed) free_.push_back(fluent);
  }
}

void RuleWorld::reset(std::size_t initial_state) {
  state_.clear();
  last_event_.clear();
  for (const auto& literal : model_.start) state_[literal.fluent] = literal.value;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    state_[free_[i]] = ((initial_state >> i) & 1U) != 0;
  }
}

bool RuleWorld::all(const std::vector<RuleLiteral>& literals, const std::string& variable,
                    const std::string& value) const {
  return std::all_of(literals.begin(), literals.end(), [&](const auto& literal) {
    return state_.at(substituted(literal.fluent, variable, value)) == literal.value;
  });
}

World::Outcome RuleWorld::perform(const PlanItem& designator) {
  const auto type = designator.key("type")->text;
  const auto binding = std::find_if(model_.bindings.begin(), model_.bindings.end(),
                                    [&](const auto& candidate) { return candidate.type == type; });
  if (binding == model_.bindings.end()) throw std::runtime_error("no binding for " + type);
  std::string name;
  if (const auto* object = designator.key("object")) {
    name = object->text;
    if (object->kind == PlanItem::Kind::kDesignator) {
      name = object->key(binding->returns ? "type" : "name")->text;
    }
  }
  const std::string variable = binding->returns ? "?k" : "?o";
  Outcome out;
  out.event = substituted(binding->event, variable, name);
  out.failure_class = binding->failure_class;
  const auto judge = [&] {
    if (!binding->returns) {
      out.success = all(binding->success, "?o", name);
      return;
    }
    for (const auto& [thing, kind] : model_.things) {
      if (kind == name && all(binding->success, "?o", thing)) out.returns.push_back(thing);
    }
    out.success = !out.returns.empty();
  };
  if (binding->offset == 0) judge();
  auto next = state_;
  for (const auto& rule : model_.rules) {
    if (rule.event == out.event && all(rule.condition, "", "")) {
      next[rule.effect.fluent] = rule.effect.value;
    }
  }
  state_ = next;
  last_event_ = out.event;
  if (binding->offset == 1) judge();
  return out;
}

bool RuleWorld::holds(const std::vector<PlanItem>& fluent) const {
  for (const auto& [name, value] : state_) {
    auto wanted = fluent[0].text + "(" + (fluent.size() > 1 ? fluent[1].text : "") + ")";
    if (lower(name) == wanted) return value;
  }
  throw std::runtime_error("no fluent " + fluent[0].text);
}

bool RuleWorld::hit() const {
  return all(model_.goal, "", "") &&
         (model_.goal_event.empty() || model_.goal_event == last_event_);
}

}  // namespace parallax::test
