#include "compiler/interpreter/lisp_macros.h"

#include <fmt/core.h>

#include <utility>
#include <variant>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/destructuring.h"
#include "compiler/interpreter/variables.h"
#include "compiler/lisp/lisp_reader.h"

namespace parallax::compiler {

namespace {

constexpr std::uint32_t kMacroDepth = 1000;  // active calls of one function while expanding
constexpr std::int64_t kMacroLoop = 100000;

}  // namespace

PlanMacro declare_macro(FormCompiler& c, DatumId form, std::string_view name, DatumId parameters) {
  PlanMacro out;
  out.name = name;
  out.unit = c.code.declare_unit(name, form, 1);
  out.driver = c.code.declare_unit(name, form, 1);
  out.source = form;
  out.parameters = parameters;
  out.position = c.position;
  auto outside = c.code.suspend();
  c.code.enter_unit(out.driver);
  c.code.emit(PlanOp::kCall, out.unit, 0, form);
  c.code.leave_unit(PlanOp::kDone, form);
  c.code.resume(std::move(outside));
  return out;
}

void compile_macro(FormCompiler& c, const PlanMacro& macro, FormItems body) {
  c.code.enter_unit(macro.unit);
  const auto scope = c.code.scope().size();
  const auto block = c.code.open_block(macro.name);
  const auto inside = c.code.scope().size();
  const auto height = c.code.height();
  compile_macro_parameters(c, macro.parameters);
  c.compile_body(c.skip_declarations(body));
  close_variables(c, inside, c.code.height() - 1 - height, macro.source);
  c.code.close_block(block);
  c.code.leave_unit(PlanOp::kReturn, macro.source);
  c.code.cut_scope(scope);
}

MacroExpander::MacroExpander(FormCompiler& c)
    : c_(c),
      machine_(c.code.code(), c.data,
               {.max_call_depth = kMacroDepth, .max_loop = kMacroLoop, .max_steps = kMaxMacroSteps},
               nullptr, c.values, c.sink_) {}

std::nullopt_t MacroExpander::wrong(const PlanMacro& macro, DatumId call, std::string_view text) {
  c_.error(codes::kMacroExpansion, call, macro.name, text)
      .note(c_.data.source(macro.source), "the macro is defined here");
  return std::nullopt;
}

std::optional<DatumId> MacroExpander::expand(const PlanMacro& macro, DatumId call) {
  if (full_) return std::nullopt;
  if (macro.position > c_.position) {
    return wrong(macro, call, "it is used above its definition");
  }
  const auto exceeded = [&](std::size_t limit, std::string_view what) -> std::optional<DatumId> {
    full_ = true;
    c_.error(codes::kMacroLimit, call, limit, what)
        .note(c_.data.source(macro.source), fmt::format("`{}` is defined here", macro.name));
    return std::nullopt;
  };
  if (++expansions_ > kMaxMacroExpansions) return exceeded(kMaxMacroExpansions, "expansions");
  const auto errors = c_.sink_.error_count();
  if (!c_.complete(macro.unit)) {
    if (c_.sink_.error_count() != errors || refused_.contains(macro.unit)) {
      refused_.insert(macro.unit);
      return std::nullopt;
    }
    return wrong(macro, call, "it is used by its own definition");
  }
  auto state = machine_.start(macro.driver, {value_of(call, false)});
  if (!run(macro, call, state)) return std::nullopt;
  const auto begin = c_.data.end_id();
  trouble_.clear();
  const auto out = datum_of(c_.values.primary(state.stack.back()), c_.data.source(call), 0);
  c_.data.note_expansion(begin, call);
  if (out) return out;
  if (data_made_ > kMaxMacroData) return exceeded(kMaxMacroData, "data");
  if (trouble_.empty()) return exceeded(kMaxLispDepth, "nested forms");
  return wrong(macro, call, trouble_);
}

bool MacroExpander::run(const PlanMacro& macro, DatumId call, PlanState& state) {
  for (;;) {
    machine_.blame(PlanMachine::Blame{macro.parameters, call});
    const auto stop = machine_.run(state);
    if (const auto* missing = std::get_if<StopUnit>(&stop)) {
      const auto& name = c_.code.code().units[missing->unit].name;
      const auto source = c_.defined.unwritten.find(missing->unit);
      const bool later =
          source != c_.defined.unwritten.end() && source->second.position > c_.position;
      const auto errors = c_.sink_.error_count();
      if (!later && c_.complete(missing->unit)) continue;
      if (c_.sink_.error_count() != errors || refused_.contains(missing->unit)) {
        refused_.insert(missing->unit);
        return false;
      }
      wrong(macro, call,
            fmt::format("its expansion calls `{}`, which is defined {}", name,
                        later ? "below" : "by means of this call"));
      return false;
    }
    if (std::holds_alternative<StopDone>(stop)) return !c_.values.full();
    if (const auto* failed = std::get_if<StopFailed>(&stop)) {
      wrong(macro, call, fmt::format("its expansion fails with `{}`", failed->failure_class));
    } else if (std::holds_alternative<StopPerform>(stop)) {
      wrong(macro, call, "it performs while it is expanded; quote what is to be performed");
    } else if (std::holds_alternative<StopQuestion>(stop) ||
               std::holds_alternative<StopProof>(stop)) {
      wrong(macro, call, "it asks the model while it is expanded; quote the question");
    } else if (const auto* bound = std::get_if<StopBound>(&stop)) {
      wrong(macro, call, fmt::format("`{}` does not end", bound->form));
    } else if (std::holds_alternative<StopError>(stop)) {
      full_ = full_ || c_.values.full();
    }
    return false;
  }
}

ValueId MacroExpander::value_of(DatumId datum, bool made) {
  if (!c_.data.is_list(datum)) {
    if (c_.data[datum].kind == DatumKind::kCharacter) return c_.values.string(c_.data.name(datum));
    const auto& name = c_.data.name(datum);
    if (!c_.data.is_symbol(datum) || c_.data.key(datum) == name) return c_.datum_value(datum);
    Value symbol;
    symbol.kind = ValueKind::kSymbol;
    symbol.text = name;
    symbol.key = c_.data.key(datum);
    return c_.values.intern(std::move(symbol));
  }
  const auto items = c_.data.children(datum);
  if (items.empty()) return c_.values.nil();
  const auto known = values_.find({datum.index(), made});
  if (known != values_.end()) return known->second;
  std::vector<ValueId> parts;
  for (const auto item : items) parts.push_back(value_of(item, made));
  auto out = c_.values.nil();
  if (c_.data.is_dotted(datum)) {
    out = parts.back();
    parts.pop_back();
  }
  for (auto i = parts.size(); i-- > 0;) {
    Value value;
    value.kind = ValueKind::kCons;
    value.head = parts[i];
    value.tail = out;
    value.origin = {datum.index() + 1, static_cast<std::uint32_t>(i), made};
    out = c_.values.intern(std::move(value));
  }
  values_.emplace(std::pair(datum.index(), made), out);
  return out;
}

/// A datum of its own for an atom of a template.
DatumId MacroExpander::copy_of(DatumId atom, const base::SourceRange& place) {
  auto datum = c_.data[atom];
  if (c_.data.in_library(atom)) datum.source = place;
  if (datum.kind == DatumKind::kNumber)
    return c_.data.add_number(c_.data.number(atom), datum.source);
  const auto out =
      c_.data.add_named(datum.kind, std::string(c_.data.name(atom)),
                        std::string(c_.data.package(atom)), datum.source, datum.external);
  c_.data.set_key(out, std::string(c_.data.key(atom)));
  return out;
}

std::optional<DatumId> MacroExpander::datum_of(ValueId id, const base::SourceRange& place,
                                               std::size_t depth) {
  if (++data_made_ > kMaxMacroData || depth > kMaxLispDepth) return std::nullopt;
  const auto& value = c_.values[id];
  switch (value.kind) {
    case ValueKind::kNil:
      return c_.data.add_named(DatumKind::kSymbol, "nil", "", place);
    case ValueKind::kSymbol: {
      const auto kind = value.keyword ? DatumKind::kKeyword : DatumKind::kSymbol;
      const auto out = c_.data.add_named(kind, value.text, "", place);
      if (!value.key.empty()) c_.data.set_key(out, value.key);
      return out;
    }
    case ValueKind::kNumber:
      return c_.data.add_number(value.number, place);
    case ValueKind::kString:
      return c_.data.add_named(DatumKind::kString, value.text, "", place);
    case ValueKind::kCons:
      return list_of(id, place, depth);
    case ValueKind::kVector:
    case ValueKind::kQuaternion:
    case ValueKind::kPose:
    case ValueKind::kDesignator:
    case ValueKind::kFailure:
    case ValueKind::kModel:
    case ValueKind::kCounter:
    case ValueKind::kNotGiven:
    case ValueKind::kFurther:
    case ValueKind::kTransform:
    case ValueKind::kUnknown:
    case ValueKind::kFunction:
    case ValueKind::kValues:
    case ValueKind::kCell:
    case ValueKind::kNetwork:
      break;
  }
  trouble_ = fmt::format("its expansion contains {}, which is no code", c_.values.print(id));
  return std::nullopt;
}

std::optional<DatumId> MacroExpander::list_of(ValueId id, const base::SourceRange& call,
                                              std::size_t depth) {
  const auto first = c_.values[id].origin;
  auto place = call;
  if (first.list != 0) {
    const DatumId list(first.list - 1);
    if (!first.made && first.index == 0) return list;  // handed on as it is
    if (!c_.data.in_library(list)) place = c_.data.source(list);
  }
  std::vector<DatumId> items;
  while (c_.values.kind(id) == ValueKind::kCons) {
    const auto head = c_.values[id].head;
    const auto origin = c_.values[id].origin;
    std::optional<DatumId> item;
    if (origin.list == 0 || origin.index == kWholeTemplate) {
      item = datum_of(head, place, depth + 1);
    } else {
      const auto own = c_.data.children(DatumId(origin.list - 1))[origin.index];
      if (!origin.made) {
        item = own;
      } else if (c_.data.is_list(own)) {
        item = datum_of(head, c_.data.in_library(own) ? place : c_.data.source(own), depth + 1);
      } else {
        item = copy_of(own, place);
      }
      ++data_made_;
    }
    if (!item) return std::nullopt;
    items.push_back(*item);
    id = c_.values[id].tail;
  }
  if (c_.values.is_nil(id)) return c_.data.add_list(items, place);
  const auto tail = datum_of(id, place, depth + 1);
  if (!tail) return std::nullopt;
  return c_.data.add_dotted(std::move(items), *tail, place);
}

}  // namespace parallax::compiler
