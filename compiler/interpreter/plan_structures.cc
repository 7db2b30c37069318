// Structures and classes become functions of the plan: the maker takes the slots by keyword, and
// each accessor reads a slot by its name. What they hold stands in a cell (cell_builtins.cc).
#include "compiler/interpreter/plan_structures.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <string_view>

namespace parallax::compiler {
namespace {

class StructureReader {
 public:
  StructureReader(LispData& data, DatumId form, const std::vector<PlanStructure>& known,
                  PlanStructure& out)
      : data_(data), form_(form), known_(known), out_(out) {}

  std::optional<StructureError> read() {
    const auto items = children(form_);
    if (items.size() < 2) return wrong(form_, "expected a name");
    return data_.head(form_) == "defstruct" ? read_struct(items) : read_class(items);
  }

 private:
  StructureError wrong(DatumId at, std::string text) const { return {at, std::move(text)}; }
  /// A copy: data that is added may move what is there.
  std::vector<DatumId> children(DatumId datum) const {
    const auto items = data_.children(datum);
    return {items.begin(), items.end()};
  }
  DatumId symbol(std::string_view name) {
    return data_.add_named(DatumKind::kSymbol, name, "", data_.source(form_));
  }
  DatumId keyword(std::string_view name) {
    return data_.add_named(DatumKind::kKeyword, name, "", data_.source(form_));
  }
  DatumId list(const std::vector<DatumId>& items) {
    return data_.add_list(items, data_.source(form_));
  }
  DatumId quoted(DatumId datum) { return list({symbol("quote"), datum}); }

  bool include(std::string_view parent) {
    const auto found = std::find_if(known_.begin(), known_.end(),
                                    [&](const PlanStructure& one) { return one.name == parent; });
    if (found == known_.end()) return false;
    out_.types.insert(out_.types.end(), found->types.begin(), found->types.end());
    out_.slots.insert(out_.slots.end(), found->slots.begin(), found->slots.end());
    return true;
  }

  PlanStructure::Slot* find_slot(std::string_view name) {
    const auto same = std::find_if(out_.slots.begin(), out_.slots.end(),
                                   [&](const auto& other) { return other.name == name; });
    return same == out_.slots.end() ? nullptr : &*same;
  }

  /// A slot of a class that an inherited one already is keeps what it does not say itself.
  std::optional<StructureError> add_class_slot(PlanStructure::Slot slot, DatumId at) {
    auto* same = find_slot(slot.name);
    if (same == nullptr) {
      out_.slots.push_back(std::move(slot));
      return std::nullopt;
    }
    if (!same->keyword.empty() && !slot.keyword.empty() && slot.keyword != same->keyword) {
      return wrong(at, "a slot with two initargs");
    }
    if (slot.initial) same->initial = slot.initial;
    if (!slot.keyword.empty()) same->keyword = slot.keyword;
    return std::nullopt;
  }

  /// (defstruct name or (name option...) [text] slot or (slot default)...)
  std::optional<StructureError> read_struct(const std::vector<DatumId>& items) {
    const auto head = data_.is_list(items[1]) ? children(items[1]) : std::vector{items[1]};
    if (head.empty() || !data_.is_symbol(head[0])) return wrong(form_, "expected a name");
    out_.name = data_.name(head[0]);
    out_.types = {out_.name};
    auto prefix = out_.name + '-';
    auto maker = "make-" + out_.name, test = out_.name + "-p", copier = "copy-" + out_.name;
    for (std::size_t i = 1; i < head.size(); ++i) {
      const auto parts = children(head[i]);
      const std::string option(parts.empty() ? "" : data_.name(parts[0]));
      if (parts.size() > 2 ||
          (parts.size() == 2 && !data_.is_symbol(parts[1]) && !data_.is_string(parts[1]))) {
        return wrong(head[i], fmt::format("the option `{}` takes one name", option));
      }
      const std::string name(parts.size() == 2 && !data_.is_nil(parts[1]) ? data_.name(parts[1])
                                                                          : "");
      if (option == "include" && !include(name)) return wrong(head[i], "no structure above it");
      if (option == "type" || option == "named" || option == "initial-offset") {
        return wrong(head[i], fmt::format("the option `{}`", option));
      }
      if (option == "conc-name") prefix = name;
      if (option == "constructor" && parts.size() == 2) maker = name;
      if (option == "predicate" && parts.size() == 2) test = name;
      if (option == "copier" && parts.size() == 2) copier = name;
    }
    for (std::size_t i = 2; i < items.size(); ++i) {
      if (i == 2 && data_.is_string(items[i])) continue;
      const auto parts = data_.is_list(items[i]) ? children(items[i]) : std::vector{items[i]};
      if (parts.empty() || !data_.is_symbol(parts[0])) return wrong(items[i], "a slot is a name");
      const std::string name(data_.name(parts[0]));
      if (find_slot(name) != nullptr) return wrong(items[i], "a slot that is there already");
      out_.slots.push_back({name, parts.size() > 1 ? std::optional(parts[1]) : std::nullopt, name});
    }
    if (!maker.empty()) make_maker(maker, symbol("nil"));
    for (const auto& slot : out_.slots) make_accessor(prefix + slot.name, slot.name, true);
    if (!test.empty()) make_test(test);
    if (!copier.empty()) {
      define(copier, {symbol("object")}, list({symbol("copy-structure"), symbol("object")}));
    }
    return std::nullopt;
  }

  /// (defclass name (parent...) ((slot option value...)...) option...)
  std::optional<StructureError> read_class(const std::vector<DatumId>& items) {
    const bool shaped = items.size() >= 4 && data_.is_symbol(items[1]) &&
                        (data_.is_list(items[2]) || data_.is_nil(items[2])) &&
                        (data_.is_list(items[3]) || data_.is_nil(items[3]));
    if (!shaped) return wrong(form_, "expected a name, parents and slots");
    out_.name = data_.name(items[1]);
    out_.types = {out_.name};
    for (std::size_t i = 4; i < items.size(); ++i) {
      const auto parts = children(items[i]);
      const auto option = parts.empty() ? std::string() : std::string(data_.name(parts[0]));
      if (option != "documentation") return wrong(items[i], fmt::format("the option `{}`", option));
    }
    int parents = 0;
    for (const auto parent : children(items[2])) {
      const bool of_lisp =
          data_.is_symbol(parent, "standard-object") || data_.is_symbol(parent, "t");
      if (!data_.is_symbol(parent) || (!of_lisp && !include(data_.name(parent)))) {
        return wrong(parent, "no class above it");
      }
      if (!of_lisp && ++parents > 1) return wrong(parent, "a second parent");
    }
    for (const auto written : children(items[3])) {
      const auto parts = data_.is_list(written) ? children(written) : std::vector{written};
      if (parts.empty() || !data_.is_symbol(parts[0])) return wrong(written, "a slot is a name");
      PlanStructure::Slot slot{std::string(data_.name(parts[0])), std::nullopt, {}};
      for (std::size_t i = 1; i + 1 < parts.size(); i += 2) {
        const std::string option(data_.name(parts[i]));
        if (!takes_option(option, parts[i + 1]) || (option == "initarg" && !slot.keyword.empty())) {
          return wrong(written, fmt::format("`{}` of a slot", option));
        }
        if (option == "initarg") slot.keyword = data_.name(parts[i + 1]);
        if (option == "initform") slot.initial = parts[i + 1];
        if ((option == "accessor" || option == "reader") && data_.is_symbol(parts[i + 1])) {
          make_accessor(std::string(data_.name(parts[i + 1])), slot.name, option == "accessor");
        }
      }
      if (auto error = add_class_slot(std::move(slot), written)) return error;
    }
    make_maker("%make-" + out_.name, quoted(symbol("%unset")));
    return std::nullopt;
  }

  bool takes_option(std::string_view option, DatumId value) const {
    static constexpr std::string_view kKnown[] = {"initarg", "initform", "accessor",
                                                  "reader",  "type",     "documentation"};
    return std::find(std::begin(kKnown), std::end(kKnown), option) != std::end(kKnown) ||
           (option == "allocation" && data_.name(value) == "instance");
  }

  void define(const std::string& name, std::vector<DatumId> parameters, DatumId body) {
    out_.functions.push_back(list({symbol("defun"), symbol(name), list(parameters), body}));
  }

  void make_accessor(const std::string& name, const std::string& slot, bool sets) {
    define(name, {symbol("object")},
           list({symbol("%typed-slot"), symbol("object"), quoted(symbol(slot)),
                 quoted(symbol(out_.name))}));
    if (sets) out_.accessors.emplace_back(name, out_.name + ' ' + slot);
  }

  void make_test(const std::string& name) {
    define(name, {symbol("object")},
           list({symbol("%structure-p"), symbol("object"), quoted(symbol(out_.name))}));
  }

  /// `nothing` stands in slots for which nothing is said.
  void make_maker(const std::string& name, DatumId nothing) {
    std::vector<DatumId> types, given, own;
    for (const auto& type : out_.types) types.push_back(symbol(type));
    std::vector<DatumId> body = {symbol("%make-structure"), quoted(list(types))};
    for (const auto& slot : out_.slots) {
      const auto initial = slot.initial.value_or(nothing);
      if (slot.keyword.empty()) {
        own.push_back(list({symbol(slot.name), initial}));
      } else {
        given.push_back(list({list({keyword(slot.keyword), symbol(slot.name)}), initial}));
      }
      body.push_back(quoted(symbol(slot.name)));
      body.push_back(symbol(slot.name));
    }
    std::vector<DatumId> parameters;
    if (!given.empty()) parameters.push_back(symbol("&key"));
    parameters.insert(parameters.end(), given.begin(), given.end());
    if (!own.empty()) parameters.push_back(symbol("&aux"));
    parameters.insert(parameters.end(), own.begin(), own.end());
    define(name, parameters, list(body));
  }

  LispData& data_;
  DatumId form_;
  const std::vector<PlanStructure>& known_;
  PlanStructure& out_;
};

/// One method: its parameters, with types, and its body.
struct Method {
  DatumId form;
  std::vector<std::pair<DatumId, std::optional<DatumId>>> required;  // name, type
  std::vector<DatumId> others;                                       // &key and the like
  std::vector<DatumId> body;
  std::vector<int> rank;  // how special each type is
};

class MethodReader {
 public:
  MethodReader(LispData& data, const std::vector<PlanStructure>& known,
               const FailureClasses& classes)
      : data_(data), known_(known), classes_(classes) {}

  std::optional<StructureError> read(const std::vector<DatumId>& forms, DatumId& out) {
    std::vector<Method> methods;
    for (const auto form : forms) {
      Method method;
      if (auto error = read_one(form, method)) return error;
      const auto& first = methods.empty() ? method : methods.front();
      if (method.required.size() != first.required.size()) {
        return StructureError{form, "its methods take different numbers of arguments"};
      }
      if (written(method.others) != written(first.others)) {
        return StructureError{form, "its methods take different keywords"};
      }
      if (auto error = add(std::move(method), methods)) return error;
    }
    const auto place = methods.front().form;
    std::stable_sort(methods.begin(), methods.end(),
                     [](const Method& a, const Method& b) { return a.rank > b.rank; });
    std::vector<DatumId> arguments;
    for (std::size_t i = 0; i < methods.front().required.size(); ++i) {
      arguments.push_back(symbol(place, fmt::format("%argument{}", i)));
    }
    std::vector<DatumId> ways = {symbol(place, "cond")};
    for (const auto& method : methods) ways.push_back(way(method, arguments));
    ways.push_back(
        list(place, {symbol(place, "t"),
                     list(place, {symbol(place, "error"),
                                  data_.add_named(DatumKind::kString, "no applicable method", "",
                                                  data_.source(place))})}));
    auto parameters = arguments;
    const auto& others = methods.front().others;
    parameters.insert(parameters.end(), others.begin(), others.end());
    out = list(place, {symbol(place, "defun"), children(place)[1], list(place, parameters),
                       list(place, ways)});
    return std::nullopt;
  }

 private:
  std::vector<DatumId> children(DatumId datum) const {
    const auto items = data_.children(datum);
    return {items.begin(), items.end()};
  }
  DatumId symbol(DatumId place, std::string_view name) {
    return data_.add_named(DatumKind::kSymbol, name, "", data_.source(place));
  }
  DatumId list(DatumId place, const std::vector<DatumId>& items) {
    return data_.add_list(items, data_.source(place));
  }

  std::optional<StructureError> read_one(DatumId form, Method& out) {
    const auto items = children(form);
    if (items.size() < 3 || (!data_.is_list(items[2]) && !data_.is_nil(items[2]))) {
      return StructureError{form, "a method with a qualifier"};
    }
    out.form = form;
    out.body.assign(items.begin() + 3, items.end());
    for (const auto parameter : children(items[2])) {
      const bool word = data_.is_symbol(parameter) && data_.name(parameter).starts_with('&');
      if (word || !out.others.empty()) {
        out.others.push_back(parameter);
        continue;
      }
      const auto parts = data_.is_list(parameter) ? children(parameter) : std::vector{parameter};
      if (parts.empty() || parts.size() > 2 || !data_.is_symbol(parts[0])) {
        return StructureError{parameter, "a parameter is a name or (name type)"};
      }
      const auto type = parts.size() == 2 ? std::optional(parts[1]) : std::nullopt;
      out.required.emplace_back(parts[0], type);
      out.rank.push_back(type ? rank_of(*type) : 0);
    }
    return std::nullopt;
  }

  std::string written(const std::vector<DatumId>& items) const {
    std::string out;
    for (const auto item : items) out += print_datum(data_, item) + ' ';
    return out;
  }

  std::string types_of(const Method& method) const {
    std::string out;
    for (const auto& [name, type] : method.required) {
      out += (type ? print_datum(data_, *type) : "t") + ' ';
    }
    return out;
  }

  /// The last of several methods for the same types is left. Types of which we do not know which is
  /// the more special one are refused.
  std::optional<StructureError> add(Method method, std::vector<Method>& methods) const {
    for (auto& other : methods) {
      if (types_of(other) == types_of(method)) {
        other = std::move(method);
        return std::nullopt;
      }
      for (std::size_t i = 0; i < method.required.size(); ++i) {
        const auto& type = method.required[i].second;
        const auto& others = other.required[i].second;
        if (type && others && is_tie(*type, *others)) {
          return StructureError{*type, "which type of its methods comes first is not known"};
        }
      }
    }
    methods.push_back(std::move(method));
    return std::nullopt;
  }

  /// Which of two types is the more special one for a value of both that they may have?
  bool is_tie(DatumId type, DatumId other) const {
    if (print_datum(data_, type) == print_datum(data_, other)) return false;
    if (rank_of(type) == kUnknown && rank_of(other) == kUnknown) return true;
    const bool named = data_.is_symbol(type) && data_.is_symbol(other);
    return named && classes_.cross(data_.name(type), data_.name(other));
  }

  /// The greater the more special; types that exclude each other may have any order.
  int rank_of(DatumId type) const {
    constexpr int kEql = 10'000, kStructure = 1'000, kCondition = 500;
    static constexpr std::string_view kTypes[] = {"t",       "sequence", "list",  "symbol",
                                                  "number",  "real",     "float", "rational",
                                                  "integer", "cons",     "null",  "keyword"};
    if (data_.is_list(type)) return kEql;
    const auto& name = data_.name(type);
    for (const auto& one : known_) {
      if (one.name == name) return kStructure + static_cast<int>(one.types.size());
    }
    const auto* found = std::find(std::begin(kTypes), std::end(kTypes), name);
    if (found != std::end(kTypes)) return static_cast<int>(found - std::begin(kTypes));
    return classes_.canonical(name) == name ? kCondition + classes_.depth(name) : kUnknown;
  }

  /// ((and (typep argument 'type)...) (let ((name argument)...) form...))
  DatumId way(const Method& method, const std::vector<DatumId>& arguments) {
    std::vector<DatumId> test = {symbol(method.form, "and")}, bindings;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const auto& [name, type] = method.required[i];
      bindings.push_back(list(method.form, {name, arguments[i]}));
      if (!type) continue;
      const auto quoted = list(method.form, {symbol(method.form, "quote"), eql_of(*type)});
      test.push_back(list(method.form, {symbol(method.form, "typep"), arguments[i], quoted}));
    }
    std::vector<DatumId> body = {symbol(method.form, "let"), list(method.form, bindings)};
    body.insert(body.end(), method.body.begin(), method.body.end());
    return list(method.form, {list(method.form, test), list(method.form, body)});
  }

  /// (eql 'a) names a value, (eql a) as a type means the symbol.
  DatumId eql_of(DatumId type) {
    if (!data_.is_list(type)) return type;
    auto parts = children(type);
    if (parts.size() == 2 && data_.head(parts[1]) == "quote") parts[1] = children(parts[1])[1];
    return list(type, parts);
  }

  static constexpr int kUnknown = 100;  // `string` and the like
  LispData& data_;
  const std::vector<PlanStructure>& known_;
  const FailureClasses& classes_;
};

}  // namespace

std::vector<DatumId> methods_of_generic(LispData& data, DatumId form) {
  const std::vector<DatumId> items(data.children(form).begin(), data.children(form).end());
  std::vector<DatumId> out;
  for (std::size_t i = 2; i < items.size(); ++i) {
    const std::vector<DatumId> parts(data.children(items[i]).begin(),
                                     data.children(items[i]).end());
    if (parts.empty() || !data.is_keyword(parts[0]) || data.name(parts[0]) != "method") continue;
    std::vector<DatumId> method = {
        data.add_named(DatumKind::kSymbol, "defmethod", "", data.source(items[i])), items[1]};
    method.insert(method.end(), parts.begin() + 1, parts.end());
    out.push_back(data.add_list(method, data.source(items[i])));
  }
  return out;
}

std::optional<std::string> type_it_makes(const LispData& data, DatumId form) {
  static constexpr std::string_view kMaking[] = {"initialize-instance", "shared-initialize",
                                                 "reinitialize-instance", "make-instance"};
  const auto items = data.children(form);
  const auto& name = data.name(items[1]);
  if (std::find(std::begin(kMaking), std::end(kMaking), name) == std::end(kMaking)) {
    return std::nullopt;
  }
  for (const auto item : items.subspan(2)) {
    if (!data.is_list(item)) continue;
    const auto first = data.children(data.children(item).front());
    return first.size() == 2 ? data.name(first[1]) : std::string("make-instance");
  }
  return std::nullopt;
}

std::optional<StructureError> read_methods(LispData& data, const std::vector<DatumId>& methods,
                                           const std::vector<PlanStructure>& known,
                                           const FailureClasses& classes, DatumId& out) {
  return MethodReader(data, known, classes).read(methods, out);
}

std::optional<StructureError> read_structure(LispData& data, DatumId form,
                                             const std::vector<PlanStructure>& known,
                                             PlanStructure& out) {
  return StructureReader(data, form, known, out).read();
}

}  // namespace parallax::compiler
