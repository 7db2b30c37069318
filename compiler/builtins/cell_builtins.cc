// Things that a plan can change: fluents, hash tables, arrays and structures. Each is a cell, and
// what it holds is a value: of a fluent its value, of a table the list of pairs in the order in
// which they came, of an array the list of its dimensions and its elements, of a structure the list
// of its slots, each a pair. A change gives the cell another value.
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/builtins/builtin_call.h"

namespace parallax::compiler {
namespace {

constexpr std::string_view kFluent = "fluent";
constexpr std::string_view kTable = "hash table";
constexpr std::string_view kEqualTable = "hash table equal";
constexpr std::string_view kArray = "array";
constexpr std::string_view kStructure = "structure ";

bool is_cell(const BuiltinCall& c, ValueId id, std::string_view what) {
  return c.values.kind(id) == ValueKind::kCell && c.values[id].text.starts_with(what);
}

ValueId content_of(const BuiltinCall& c, ValueId cell) {
  return c.links.heap.content(c.values, cell).value_or(c.values.nil());
}

/// The value of `:name` among the arguments from `first` on.
std::optional<ValueId> keyword_argument(const BuiltinCall& c, std::size_t first,
                                        std::string_view name) {
  for (auto i = first; i + 1 < c.args.size(); i += 2) {
    const auto& key = c.values[c.args[i]];
    if (key.kind == ValueKind::kSymbol && key.text == name) return c.args[i + 1];
  }
  return std::nullopt;
}

// --- fluents ------------------------------------------------------------------------------------

BuiltinResult make_fluent(const BuiltinCall& c) {
  const auto value = keyword_argument(c, 0, "value").value_or(c.values.nil());
  return c.links.make_cell(c.values, std::string(kFluent), value);
}

bool is_fluent_value(const BuiltinCall& c, ValueId id) { return is_fluent(c.values[id]); }

BuiltinResult compute_now(const BuiltinCall& c, const std::string& operation,
                          const std::vector<ValueId>& arguments) {
  const bool all = operation == "fl-and";
  if (all || operation == "fl-or") {
    auto out = c.values.boolean(all);
    for (const auto argument : arguments) {
      out = argument;
      if (c.values.is_nil(argument) == all) break;
    }
    return out;
  }
  const bool word = operation.size() > 3 && operation.starts_with("fl-");
  const std::size_t prefix = word ? 3 : operation.starts_with("fl") ? 2 : 0;
  const auto builtin = find_builtin(operation.substr(prefix));
  if (!builtin) return BuiltinFailure{BuiltinError::kValue, "no function on fluents"};
  return call_builtin(*builtin, arguments, c.classes, c.location_samples, c.links, c.values);
}

/// Networks share their parts: each is computed once.
class NetworkReader {
 public:
  explicit NetworkReader(const BuiltinCall& c) : c_(c) {}

  /// The value of a fluent now; another value is itself.
  BuiltinResult read(ValueId id, int depth = 0) {
    constexpr int kDeepest = 1'000;
    if (is_cell(c_, id, kFluent)) return content_of(c_, id);
    if (c_.values.kind(id) != ValueKind::kNetwork) return id;
    if (const auto found = known_.find(id.index()); found != known_.end()) return found->second;
    if (depth > kDeepest) return BuiltinFailure{BuiltinError::kValue, "fluents nested too deep"};
    std::vector<ValueId> arguments;
    const std::string operation = c_.values[id].text;
    const auto parts = *c_.values.elements(c_.values[id].head);
    for (const auto part : parts) {
      auto value = read(part, depth + 1);
      if (!std::holds_alternative<ValueId>(value)) return value;
      arguments.push_back(std::get<ValueId>(value));
    }
    auto out = compute_now(c_, operation, arguments);
    if (const auto* value = std::get_if<ValueId>(&out)) known_.emplace(id.index(), *value);
    return out;
  }

 private:
  const BuiltinCall& c_;
  std::map<std::uint32_t, ValueId> known_;
};

}  // namespace

/// A function of fluents is a fluent; of other values it is computed.
BuiltinResult fluent_network(const BuiltinCall& c) {
  const std::vector<ValueId> arguments(c.args.begin(), c.args.end());
  const bool fluent = std::any_of(arguments.begin(), arguments.end(),
                                  [&](ValueId id) { return is_fluent_value(c, id); });
  if (!fluent) return compute_now(c, std::string(c.name), arguments);
  Value value;
  value.kind = ValueKind::kNetwork;
  value.text = c.name;
  value.head = c.values.list(arguments);
  return c.values.intern(std::move(value));
}

bool takes_fluents(std::string_view builtin) {
  static constexpr std::string_view kOperations[] = {"+", "-", "*",  "/",   "<",
                                                     ">", "=", "eq", "eql", "not"};
  return std::find(std::begin(kOperations), std::end(kOperations), builtin) !=
         std::end(kOperations);
}

bool is_fluent(const Value& value) {
  return value.kind == ValueKind::kNetwork ||
         (value.kind == ValueKind::kCell && value.text == kFluent);
}

namespace {

BuiltinResult value_of(const BuiltinCall& c) {
  if (!is_fluent_value(c, c.args[0])) return c.wrong(0, "a fluent");
  return NetworkReader(c).read(c.args[0]);
}

BuiltinResult set_value(const BuiltinCall& c) {
  if (!is_cell(c, c.args[0], kFluent)) return c.wrong(0, "a fluent that was made with a value");
  c.links.heap.change(c.values, c.args[0], c.args[1]);
  return c.args[1];
}

// --- hash tables --------------------------------------------------------------------------------

BuiltinResult make_table(const BuiltinCall& c) {
  const auto test = keyword_argument(c, 0, "test");
  auto name = test ? c.values[*test].text : "eql";
  if (test && c.values.kind(*test) == ValueKind::kFunction) {
    const auto& function = c.values[*test].function;
    name = function.builtin ? std::string(plan_builtins()[function.unit].name) : "";
  }
  if (name != "eq" && name != "eql" && name != "equal") {
    return BuiltinFailure{BuiltinError::kValue, "the test is eq, eql or equal"};
  }
  const auto what = name == "equal" ? kEqualTable : kTable;
  return c.links.make_cell(c.values, std::string(what), c.values.nil());
}

using Pairs = std::vector<ValueId>;

/// The pairs of the table at `table`, and the place of the key's among them.
std::variant<std::pair<Pairs, std::size_t>, BuiltinFailure> find_key(const BuiltinCall& c,
                                                                     std::size_t key,
                                                                     std::size_t table) {
  if (!is_cell(c, c.args[table], kTable)) return c.wrong(table, "a hash table");
  const bool structure = is_cell(c, c.args[table], kEqualTable);
  const auto is_model = [&](ValueId id) { return c.values.kind(id) == ValueKind::kModel; };
  const auto kind = c.values.kind(c.args[key]);
  if (!structure && (kind == ValueKind::kString || kind == ValueKind::kCons)) {
    return BuiltinFailure{BuiltinError::kValue,
                          "a string or list as key needs a table with the test equal"};
  }
  auto pairs = *c.values.elements(content_of(c, c.args[table]));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto known = c.values[pairs[i]].head;
    const bool same = structure ? is_equal(c, known, c.args[key]) : is_same(c, known, c.args[key]);
    if (same) return std::pair(std::move(pairs), i);
    if (is_model(known) || is_model(c.args[key])) {
      return BuiltinFailure{BuiltinError::kModelList, "a search among values of the model"};
    }
  }
  const auto end = pairs.size();
  return std::pair(std::move(pairs), end);
}

/// (gethash key table [default]): the value, and whether there is one.
BuiltinResult get_hash(const BuiltinCall& c) {
  const auto found = find_key(c, 0, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  const auto& [pairs, at] = std::get<0>(found);
  const bool known = at < pairs.size();
  const auto otherwise = c.args.size() > 2 ? c.args[2] : c.values.nil();
  return c.values.multiple({known ? c.values[pairs[at]].tail : otherwise, c.values.boolean(known)});
}

/// (%set-hash key table value)
BuiltinResult set_hash(const BuiltinCall& c) {
  auto found = find_key(c, 0, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  auto& [pairs, at] = std::get<0>(found);
  const auto pair = c.values.cons(c.args[0], c.args[2]);
  if (at == pairs.size()) pairs.emplace_back();
  pairs[at] = pair;
  c.links.heap.change(c.values, c.args[1], c.values.list(pairs));
  return c.args[2];
}

/// (remhash key table)
BuiltinResult remove_hash(const BuiltinCall& c) {
  auto found = find_key(c, 0, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  auto& [pairs, at] = std::get<0>(found);
  if (at == pairs.size()) return c.values.nil();
  pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(at));
  c.links.heap.change(c.values, c.args[1], c.values.list(pairs));
  return c.values.truth();
}

BuiltinResult clear_hash(const BuiltinCall& c) {
  if (!is_cell(c, c.args[0], kTable)) return c.wrong(0, "a hash table");
  c.links.heap.change(c.values, c.args[0], c.values.nil());
  return c.args[0];
}

/// The pairs (key . value) of a table, in the order in which they came.
BuiltinResult table_pairs(const BuiltinCall& c) {
  if (!is_cell(c, c.args[0], kTable)) return c.wrong(0, "a hash table");
  return content_of(c, c.args[0]);
}

template <bool kKeys>
BuiltinResult table_parts(const BuiltinCall& c) {
  if (!is_cell(c, c.args[0], kTable)) return c.wrong(0, "a hash table");
  std::vector<ValueId> out;
  const auto pairs = *c.values.elements(content_of(c, c.args[0]));
  for (const auto pair : pairs) {
    out.push_back(kKeys ? c.values[pair].head : c.values[pair].tail);
  }
  return c.values.list(out);
}

BuiltinResult table_size(const BuiltinCall& c) {
  if (!is_cell(c, c.args[0], kTable)) return c.wrong(0, "a hash table");
  const auto pairs = *c.values.elements(content_of(c, c.args[0]));
  return c.values.number(Number(static_cast<std::int64_t>(pairs.size())));
}

template <const std::string_view& kWhat>
BuiltinResult is_what(const BuiltinCall& c) {
  return c.values.boolean(is_cell(c, c.args[0], kWhat));
}

BuiltinResult is_any_fluent(const BuiltinCall& c) {
  return c.values.boolean(is_fluent_value(c, c.args[0]));
}

// --- arrays -------------------------------------------------------------------------------------

ValueId make_elements(const BuiltinCall& c, const std::vector<ValueId>& dimensions,
                      const std::vector<ValueId>& elements) {
  return c.links.make_cell(c.values, std::string(kArray),
                           c.values.cons(c.values.list(dimensions), c.values.list(elements)));
}

/// Stands where nothing was put: to read it is a mistake in the plan.
constexpr std::string_view kUnset = "%unset";

bool is_unset(const BuiltinCall& c, ValueId id) {
  return c.values.kind(id) == ValueKind::kSymbol && c.values[id].text == kUnset;
}

std::optional<std::size_t> natural_value(const BuiltinCall& c, ValueId id) {
  const auto& value = c.values[id];
  const bool fits = value.kind == ValueKind::kNumber && value.number.is_integer() &&
                    value.number.numerator() >= 0;
  return fits ? std::optional(static_cast<std::size_t>(value.number.numerator())) : std::nullopt;
}

BuiltinResult make_array(const BuiltinCall& c) {
  auto dimensions = c.values.elements(c.args[0]);
  if (!dimensions) dimensions = std::vector{c.args[0]};
  std::size_t size = 1;
  for (const auto dimension : *dimensions) {
    const auto length = natural_value(c, dimension);
    if (!length || *length > kMaxPlanValues) return c.wrong(0, "a natural number");
    size *= *length;
    if (size > kMaxPlanValues)
      return c.wrong(0, "a size of at most " + std::to_string(kMaxPlanValues));
  }
  const auto all =
      keyword_argument(c, 1, "initial-element").value_or(c.values.symbol(std::string(kUnset)));
  std::vector<ValueId> elements(size, all);
  if (const auto given = keyword_argument(c, 1, "initial-contents")) {
    auto known = c.values.elements(*given);
    if (!known || dimensions->size() != 1 || known->size() != size) {
      return BuiltinFailure{BuiltinError::kValue, "the contents are no list of that length"};
    }
    elements = *std::move(known);
  }
  return make_elements(c, *dimensions, elements);
}

ValueId vector_of(const BuiltinCall& c, const std::vector<ValueId>& items) {
  const auto length = c.values.number(Number(static_cast<std::int64_t>(items.size())));
  return make_elements(c, {length}, items);
}

BuiltinResult make_vector(const BuiltinCall& c) {
  return vector_of(c, {c.args.begin(), c.args.end()});
}

struct Element {
  std::vector<ValueId> all;
  std::size_t at = 0;
  ValueId dimensions;
};

/// The element of the array in front at the indices behind it.
std::variant<Element, BuiltinFailure> array_element(const BuiltinCall& c,
                                                    std::span<const ValueId> indices) {
  if (!is_cell(c, c.args[0], kArray)) return c.wrong(0, "an array");
  const auto whole = content_of(c, c.args[0]);
  const auto dimensions = *c.values.elements(c.values[whole].head);
  Element out{*c.values.elements(c.values[whole].tail), 0, c.values[whole].head};
  bool fits = dimensions.size() == indices.size();
  for (std::size_t i = 0; fits && i < indices.size(); ++i) {
    const auto index = natural_value(c, indices[i]);
    const auto length = *natural_value(c, dimensions[i]);
    fits = index && *index < length;
    if (fits) out.at = out.at * length + *index;
  }
  if (!fits) return BuiltinFailure{BuiltinError::kRaise, "simple-error"};
  return out;
}

/// (aref array index...)
BuiltinResult aref(const BuiltinCall& c) {
  const auto found = array_element(c, c.args.subspan(1));
  if (const auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  const auto& known = std::get<Element>(found);
  if (is_unset(c, known.all[known.at])) return c.wrong(0, "an array with a value there");
  return known.all[known.at];
}

/// (%set-aref array index... value)
BuiltinResult set_aref(const BuiltinCall& c) {
  auto found = array_element(c, c.args.subspan(1, c.args.size() - 2));
  if (const auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  auto& known = std::get<Element>(found);
  known.all[known.at] = c.args.back();
  c.links.heap.change(c.values, c.args[0],
                      c.values.cons(known.dimensions, c.values.list(known.all)));
  return c.args.back();
}

BuiltinResult array_dimensions(const BuiltinCall& c) {
  if (!is_cell(c, c.args[0], kArray)) return c.wrong(0, "an array");
  return c.values[content_of(c, c.args[0])].head;
}

/// (%elements sequence): those of an array, a list or a string as a list.
BuiltinResult sequence_elements(const BuiltinCall& c) {
  if (is_cell(c, c.args[0], kArray)) {
    const auto all = c.values[content_of(c, c.args[0])].tail;
    const auto items = *c.values.elements(all);
    for (const auto item : items) {
      if (is_unset(c, item)) return c.wrong(0, "an array with a value everywhere");
    }
    return all;
  }
  if (!c.values.elements(c.args[0])) return c.wrong(0, "an array");
  return c.args[0];
}

/// (coerce value 'list), 'vector, 'float
BuiltinResult coerce(const BuiltinCall& c) {
  const auto& type = c.values[c.args[1]];
  if (type.text == "list") return sequence_elements(c);
  if (type.text == "vector" || type.text == "array" || type.text == "simple-vector") {
    if (is_cell(c, c.args[0], kArray)) return c.args[0];
    const auto items = c.values.elements(c.args[0]);
    return items ? BuiltinResult(vector_of(c, *items)) : c.wrong(0, "a list");
  }
  const bool wide = type.text == "double-float";
  if (!wide && type.text != "float" && type.text != "single-float") {
    return c.wrong(1, "`list`, `vector` or a kind of float");
  }
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  return c.values.number(
      c.number(0)->as_float(wide ? Number::Kind::kDouble : Number::Kind::kSingle));
}

// --- structures ---------------------------------------------------------------------------------

/// (%make-structure types slot value ...): the type and those that it includes.
BuiltinResult make_structure(const BuiltinCall& c) {
  std::string what(kStructure);
  const auto types = *c.values.elements(c.args[0]);
  for (const auto type : types) what += c.values[type].text + ' ';
  std::vector<ValueId> slots;
  for (std::size_t i = 1; i + 1 < c.args.size(); i += 2) {
    slots.push_back(c.values.cons(c.args[i], c.args[i + 1]));
  }
  return c.links.make_cell(c.values, what, c.values.list(slots));
}

std::optional<std::size_t> place_of(const BuiltinCall& c, const std::vector<ValueId>& slots) {
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (c.values.same(c.values[slots[i]].head, c.args[1])) return i;
  }
  return std::nullopt;
}

/// Is the structure of the type, or of one that includes it?
bool is_structure_of(const BuiltinCall& c, ValueId structure, ValueId type) {
  return c.values[structure].text.find(' ' + c.values[type].text + ' ') != std::string::npos;
}

/// (slot-value structure slot), (%typed-slot structure slot type), (%set-slot structure slot value
/// [type]). A thing of another kind is a Lisp error.
BuiltinResult structure_slot(const BuiltinCall& c) {
  const bool sets = c.name == "%set-slot";
  const std::size_t type = sets ? 3 : 2;
  const BuiltinFailure other{BuiltinError::kRaise, "type-error"};
  if (c.values.kind(c.args[0]) == ValueKind::kUnknown) return c.wrong(0, "a structure");
  if (!is_cell(c, c.args[0], kStructure)) return other;
  auto slots = *c.values.elements(content_of(c, c.args[0]));
  const auto at = place_of(c, slots);
  if (!at || (c.args.size() > type && !is_structure_of(c, c.args[0], c.args[type]))) return other;
  const auto held = c.values[slots[*at]].tail;
  if (!sets && is_unset(c, held)) return c.wrong(0, "a structure with a value in that slot");
  if (!sets) return held;
  slots[*at] = c.values.cons(c.args[1], c.args[2]);
  c.links.heap.change(c.values, c.args[0], c.values.list(slots));
  return c.args[2];
}

BuiltinResult copy_structure(const BuiltinCall& c) {
  if (!is_cell(c, c.args[0], kStructure)) return c.wrong(0, "a structure");
  const std::string what = c.values[c.args[0]].text;
  return c.links.make_cell(c.values, what, content_of(c, c.args[0]));
}

/// (%structure-p value type)
BuiltinResult is_structure(const BuiltinCall& c) {
  return c.values.boolean(is_cell(c, c.args[0], kStructure) &&
                          is_structure_of(c, c.args[0], c.args[1]));
}

constexpr BuiltinEntry kCellTable[] = {
    {{"make-fluent", 0, kAnyNumber}, make_fluent},
    {{"value", 1, 1}, value_of},
    {{"peek-value", 1, 1}, value_of},
    {{"%set-value", 2, 2}, set_value},
    {{"fl-and", 0, kAnyNumber}, fluent_network},
    {{"fl-or", 0, kAnyNumber}, fluent_network},
    {{"fl-not", 1, 1}, fluent_network},
    {{"fl-eq", 2, 2}, fluent_network},
    {{"fl-eql", 2, 2}, fluent_network},
    {{"fl<", 1, kAnyNumber}, fluent_network},
    {{"fl>", 1, kAnyNumber}, fluent_network},
    {{"fl=", 1, kAnyNumber}, fluent_network},
    {{"fl+", 0, kAnyNumber}, fluent_network},
    {{"fl-", 1, kAnyNumber}, fluent_network},
    {{"fl*", 0, kAnyNumber}, fluent_network},
    {{"fl/", 1, kAnyNumber}, fluent_network},
    {{"make-hash-table", 0, kAnyNumber}, make_table},
    {{"gethash", 2, 3}, get_hash},
    {{"%set-hash", 3, 3}, set_hash},
    {{"remhash", 2, 2}, remove_hash},
    {{"clrhash", 1, 1}, clear_hash},
    {{"hash-table-count", 1, 1}, table_size},
    {{"hash-table-keys", 1, 1}, table_parts<true>},
    {{"hash-table-values", 1, 1}, table_parts<false>},
    {{"hash-table-alist", 1, 1}, table_pairs},
    {{"hash-table-p", 1, 1}, is_what<kTable>},
    {{"make-array", 1, kAnyNumber}, make_array},
    {{"vector", 0, kAnyNumber}, make_vector},
    {{"aref", 1, kAnyNumber}, aref},
    {{"svref", 2, 2}, aref},
    {{"%set-aref", 2, kAnyNumber}, set_aref},
    {{"array-dimensions", 1, 1}, array_dimensions},
    {{"arrayp", 1, 1}, is_what<kArray>},
    {{"vectorp", 1, 1}, is_what<kArray>},
    {{"%elements", 1, 1}, sequence_elements},
    {{"coerce", 2, 2}, coerce},
    {{"%make-structure", 1, kAnyNumber}, make_structure},
    {{"slot-value", 2, 2}, structure_slot},
    {{"%typed-slot", 3, 3}, structure_slot},
    {{"%set-slot", 3, 4}, structure_slot},
    {{"copy-structure", 1, 1}, copy_structure},
    {{"%structure-p", 2, 2}, is_structure},
    {{"fluent-p", 1, 1}, is_any_fluent},
};

}  // namespace

std::span<const BuiltinEntry> cell_builtins() { return kCellTable; }

}  // namespace parallax::compiler
