#include "compiler/builtins/plan_value.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "compiler/builtins/unknown_values.h"
#include "compiler/plan/failure_classes.h"

namespace parallax::compiler {
namespace {

void append(std::string& out, std::string_view text) {
  out += fmt::format("{}:{};", text.size(), text);
}

void append(std::string& out, const PlanPose& p) {
  append(out, p.frame);
  for (const double part : {p.x_m, p.y_m, p.z_m, p.qx, p.qy, p.qz, p.qw}) {
    out += fmt::format("{:a};", part);  // hexadecimal: exact
  }
}

/// A text that is equal for equal values only.
std::string fingerprint(const Value& value) {
  std::string out = fmt::format("{} ", static_cast<int>(value.kind));
  switch (value.kind) {
    case ValueKind::kNil:
    case ValueKind::kNotGiven:
    case ValueKind::kFurther:
      break;
    case ValueKind::kSymbol:
      out += value.keyword ? ":" : "";
      append(out, value.text);
      out += value.key;
      break;
    case ValueKind::kString:
    case ValueKind::kFailure:
      append(out, value.text);
      break;
    case ValueKind::kNumber:
    case ValueKind::kCounter:
      out += fmt::format("{} ", static_cast<int>(value.number.kind()));
      out += value.number.exact() ? value.number.to_string()
                                  : fmt::format("{:a}", value.number.value());
      break;
    case ValueKind::kCons:
      out += fmt::format("{} {}", value.head.index(), value.tail.index());
      if (value.origin.list != 0) {
        out += fmt::format(" {} {} {}", value.origin.list, value.origin.index, value.origin.made);
      }
      break;
    case ValueKind::kFunction: {
      const auto& f = value.function;
      out += fmt::format("{} {} {} {} {}", f.unit, f.builtin, f.link, f.reach, value.head.index());
      break;
    }
    case ValueKind::kValues:
      out += fmt::format("{}", value.head.index());
      break;
    case ValueKind::kVector:
    case ValueKind::kQuaternion:
    case ValueKind::kPose:
    case ValueKind::kTransform:
      append(out, value.pose);
      append(out, value.text);
      out += fmt::format("{}", value.head.index());
      break;
    case ValueKind::kUnknown:
    case ValueKind::kNetwork:
      append(out, value.text);
      out += fmt::format("{}", value.head.index());
      break;
    case ValueKind::kCell:
      append(out, value.text);
      out += fmt::format("{}", value.identity);
      break;
    case ValueKind::kDesignator:
      out += fmt::format("{} {} ", static_cast<int>(value.designator), value.identity);
      break;
    case ValueKind::kModel:
      out += fmt::format("{} ", value.model.index());
      break;
  }
  for (const auto& [key, item] : value.keys) {
    append(out, key);
    out += fmt::format("{} ", item.index());
  }
  return out;
}

std::string print_number(const Number& number) {
  if (number.is_integer())
    return fmt::format("{}{}", number.numerator(), number.is_float() ? ".0" : "");
  return fmt::format("{}", number.value());
}

}  // namespace

ValueStore::ValueStore() {
  intern({});
  truth_ = symbol("t");
}

ValueId ValueStore::intern(Value value) {
  auto text = fingerprint(value);
  const auto found = ids_.find(text);
  if (found != ids_.end()) return found->second;
  note_parts(value);
  text_size_ += value.text.size();
  from_data_ = from_data_ || value.origin.list != 0 || !value.key.empty();
  const auto id = values_.add(std::move(value));
  ids_.emplace(std::move(text), id);
  return id;
}

/// Collects the registers, identities and function links that the value and its parts refer to.
void ValueStore::note_parts(Value& value) const {
  const auto include = [&](ValueId part) {
    const auto& from = values_[part];
    value.registers.insert(value.registers.end(), from.registers.begin(), from.registers.end());
    value.identities.insert(value.identities.end(), from.identities.begin(), from.identities.end());
    value.function.link = std::max(value.function.link, from.function.link);
    value.function.reach = std::max(value.function.reach, from.function.reach);
  };
  const auto tidy = [](auto& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  value.registers.clear(), value.identities.clear();
  if (value.kind == ValueKind::kModel) value.registers = {value.model};
  if (value.identity != 0) value.identities = {value.identity};
  const bool pair = value.kind == ValueKind::kCons;
  if (pair || value.kind == ValueKind::kFunction || value.kind == ValueKind::kValues) {
    include(value.head);
  }
  if (pair) include(value.tail);
  if (value.kind == ValueKind::kUnknown || value.kind == ValueKind::kNetwork) include(value.head);
  for (const auto& [key, part] : value.keys) include(part);
  tidy(value.registers), tidy(value.identities);
}

ValueId ValueStore::symbol(std::string_view name) {
  Value value;
  value.kind = ValueKind::kSymbol;
  value.text = name;
  return intern(std::move(value));
}

ValueId ValueStore::keyword(std::string_view name) {
  Value value;
  value.kind = ValueKind::kSymbol;
  value.text = name;
  value.keyword = true;
  return intern(std::move(value));
}

ValueId ValueStore::string(std::string_view text) {
  Value value;
  value.kind = ValueKind::kString;
  value.text = text;
  return intern(std::move(value));
}

ValueId ValueStore::number(const Number& number) {
  Value value;
  value.kind = ValueKind::kNumber;
  value.number = number;
  return intern(std::move(value));
}

ValueId ValueStore::counter(std::int64_t count) {
  Value value;
  value.kind = ValueKind::kCounter;
  value.number = Number(count);
  return intern(std::move(value));
}

ValueId ValueStore::cons(ValueId head, ValueId tail) {
  Value value;
  value.kind = ValueKind::kCons;
  value.head = head;
  value.tail = tail;
  return intern(std::move(value));
}

ValueId ValueStore::list(const std::vector<ValueId>& items) {
  auto out = nil();
  for (auto item = items.rbegin(); item != items.rend() && !full(); ++item) out = cons(*item, out);
  return out;
}

ValueId ValueStore::failure(std::string_view failure_class) {
  Value value;
  value.kind = ValueKind::kFailure;
  value.text = failure_class;
  return intern(std::move(value));
}

ValueId ValueStore::envelope(ValueId error) {
  Value value;
  value.kind = ValueKind::kFailure;
  value.text = kErrorEnvelope;
  value.keys = {{"error", error}};
  return intern(std::move(value));
}

std::optional<ValueId> ValueStore::enveloped(ValueId failure) const {
  const auto& value = values_[failure];
  if (value.kind != ValueKind::kFailure || value.text != kErrorEnvelope) return std::nullopt;
  for (const auto& [slot, error] : value.keys) {
    if (slot == "error") return error;
  }
  return std::nullopt;  // the plan made it itself
}

ValueId ValueStore::not_given() {
  Value value;
  value.kind = ValueKind::kNotGiven;
  return intern(std::move(value));
}

ValueId ValueStore::multiple(const std::vector<ValueId>& all) {
  if (all.size() == 1) return all.front();
  Value value;
  value.kind = ValueKind::kValues;
  value.head = list(all);
  return intern(std::move(value));
}

ValueId ValueStore::primary(ValueId id) const {
  const auto& value = values_[id];
  if (value.kind != ValueKind::kValues) return id;
  return is_nil(value.head) ? nil() : values_[value.head].head;
}

ValueId ValueStore::gensym(std::string_view prefix) {
  return symbol(fmt::format("#:{}{}", prefix, ++gensyms_));
}

bool ValueStore::same(ValueId a, ValueId b) const {
  if (a == b) return true;
  const auto& left = values_[a];
  const auto& right = values_[b];
  return left.kind == ValueKind::kSymbol && right.kind == ValueKind::kSymbol &&
         left.keyword == right.keyword && left.text == right.text;
}

bool ValueStore::equal(ValueId a, ValueId b) const {
  std::vector<std::pair<ValueId, ValueId>> open = {{a, b}};
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;  // parts may be shared
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    if (same(x, y) || !seen.emplace(x.index(), y.index()).second) continue;
    const auto& left = values_[x];
    const auto& right = values_[y];
    // Without macros equal lists are the same.
    if (!from_data_ || left.kind != ValueKind::kCons || right.kind != ValueKind::kCons) {
      return false;
    }
    ++elements_read_;
    open.emplace_back(left.tail, right.tail);
    open.emplace_back(left.head, right.head);
  }
  return true;
}

bool ValueStore::may_be_two(ValueId id, bool equal) const {
  std::vector<ValueId> open = {id};
  std::set<std::uint32_t> seen;  // parts may be shared
  while (!open.empty()) {
    const auto next = open.back();
    open.pop_back();
    const auto& value = values_[next];
    switch (value.kind) {
      case ValueKind::kString:
        if (!equal) return true;
        break;
      case ValueKind::kCons:
        if (!equal) return true;
        if (!seen.insert(next.index()).second) break;
        open.push_back(value.tail);
        open.push_back(value.head);
        break;
      case ValueKind::kVector:
      case ValueKind::kQuaternion:
      case ValueKind::kPose:
      case ValueKind::kTransform:
      case ValueKind::kUnknown:
      case ValueKind::kFailure:
      case ValueKind::kNetwork:
        return true;
      case ValueKind::kDesignator:
        if (value.identity == 0) return true;
        break;
      case ValueKind::kFunction:
        if (!value.function.builtin && !is_nil(value.head)) return true;
        break;
      case ValueKind::kNil:
      case ValueKind::kSymbol:
      case ValueKind::kNumber:
      case ValueKind::kModel:
      case ValueKind::kCounter:
      case ValueKind::kNotGiven:
      case ValueKind::kFurther:
      case ValueKind::kValues:
      case ValueKind::kCell:
        break;
    }
  }
  return false;
}

ValueId ValueStore::model(ModelValueId id) {
  Value value;
  value.kind = ValueKind::kModel;
  value.model = id;
  return intern(std::move(value));
}

std::optional<std::vector<ValueId>> ValueStore::elements(ValueId id) const {
  std::vector<ValueId> out;
  while (kind(id) == ValueKind::kCons) {
    out.push_back(values_[id].head);
    id = values_[id].tail;
  }
  elements_read_ += static_cast<std::int64_t>(out.size());
  if (!is_nil(id)) return std::nullopt;
  return out;
}

std::optional<ValueId> ValueStore::key(ValueId designator, std::string_view name) const {
  if (kind(designator) != ValueKind::kDesignator) return std::nullopt;
  for (const auto& [key, value] : values_[designator].keys) {
    if (key == name) return value;
  }
  return std::nullopt;
}

std::string ValueStore::print(ValueId id) const {
  const auto& value = values_[id];
  switch (value.kind) {
    case ValueKind::kNil:
      return "nil";
    case ValueKind::kSymbol:
      return (value.keyword ? ":" : "") + value.text;
    case ValueKind::kString:
      return fmt::format("\"{}\"", value.text);
    case ValueKind::kNumber:
    case ValueKind::kCounter:
      return print_number(value.number);
    case ValueKind::kCons: {
      auto tail = id;
      while (kind(tail) == ValueKind::kCons) tail = values_[tail].tail;
      if (kind(tail) == ValueKind::kFurther) return "solutions, of which the first alone is known";
      return is_nil(tail) ? "a list" : "a dotted list";
    }
    case ValueKind::kVector:
      return "a vector";
    case ValueKind::kQuaternion:
      return "a rotation";
    case ValueKind::kPose:
      return fmt::format("the pose ({:.4g}, {:.4g}, {:.4g})", value.pose.x_m, value.pose.y_m,
                         value.pose.z_m);
    case ValueKind::kTransform:
      return fmt::format("the transform ({:.4g}, {:.4g}, {:.4g})", value.pose.x_m, value.pose.y_m,
                         value.pose.z_m);
    case ValueKind::kUnknown:
      return fmt::format("from `{}`, which only the robot knows", origin_of_unknown(*this, id));
    case ValueKind::kDesignator:
      return fmt::format("a designator ({})", to_string(value.designator));
    case ValueKind::kFailure:
      return fmt::format("the failure {}", value.text);
    case ValueKind::kModel:
      return "a value of the model";
    case ValueKind::kNotGiven:
      return "no argument";
    case ValueKind::kFurther:
      return "further solutions";
    case ValueKind::kFunction:
      return "a function";
    case ValueKind::kValues:
      return "several values";
    case ValueKind::kCell:
      return fmt::format("a {}", value.text.substr(0, value.text.find(' ')));
    case ValueKind::kNetwork:
      return "a fluent";
  }
  return {};
}

}  // namespace parallax::compiler
