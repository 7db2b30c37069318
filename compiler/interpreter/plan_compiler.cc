#include "compiler/interpreter/plan_compiler.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/base/suggest.h"
#include "compiler/interpreter/designator_use.h"
#include "compiler/interpreter/function_calls.h"
#include "compiler/interpreter/lisp_macros.h"
#include "compiler/interpreter/plan_races.h"
#include "compiler/interpreter/plan_reach.h"
#include "compiler/interpreter/plan_structures.h"
#include "compiler/lisp/lisp_library.h"

namespace parallax::compiler {
namespace {

bool defines_function(std::string_view head) {
  return head == "defun" || head == "def-cram-function" || head == "def-top-level-cram-function";
}

bool defines_global(std::string_view head) {
  return head == "defparameter" || head == "defvar" || head == "defconstant";
}

bool is_housekeeping(std::string_view head) {
  return head == "in-package" || head == "defpackage" || head == "declaim" || head == "declare" ||
         head == "proclaim" || head == "export" || head == "def-fact-group" || head == "defgeneric";
}

bool defines_structure(std::string_view head) { return head == "defstruct" || head == "defclass"; }

bool is_definition(std::string_view head) {
  return defines_function(head) || defines_global(head) || head == "defmacro";
}

/// Collects the file's definitions, compiles them, then the forms to be run.
class PlanCompiler {
 public:
  PlanCompiler(LispText& text, ValueStore& values, base::DiagnosticSink& sink, bool interleave,
               const PlanBinding& binding, std::optional<base::FileId> entry_file)
      : text_(text),
        binding_(binding),
        entry_file_(entry_file),
        sink_(sink),
        c_(text, values, sink, interleave),
        reach_(text.data) {
    c_.code.code().classes = FailureClasses(binding.failures);
    c_.entry_file = entry_file;
  }

  base::Result<PlanCode> compile(const std::optional<std::string>& entry) {
    if (text_.forms.empty()) {
      return sink_.error(codes::kNoPlanEntry, base::SourceRange{text_.file, 0, 0},
                         "the file has no forms");
    }
    if (!check_entry_call()) return sink_.already_reported();
    for (const auto form : text_.forms) flatten(form);
    named_ = note_designator_use(text_, c_.code.code());
    // Failure classes come first: a handler or a method may stand above the definition of its
    // class.
    for (const auto form : forms_) {
      if (c_.data.head(form) == "define-condition") define_condition(form, c_.data.children(form));
    }
    find_reached(entry);
    collect_definitions();
    add_library();
    expand_forms();
    if (!missing_ && bare_forms_.empty() && functions_.empty()) {
      return c_.error(codes::kNoPlanEntry, text_.forms.front(), "only definitions of variables");
    }
    compile_functions();
    if (!missing_) compile_main(entry);
    if (c_.failed()) return sink_.already_reported();
    note_races(c_.code.code(), runs_any_function());
    c_.code.code().function_names.insert(text_.keys.begin(), text_.keys.end());
    return std::move(c_.code.code());
  }

 private:
  /// May a perform or a goal run a function that its form does not name?
  bool runs_any_function() const {
    const auto runs = [](const auto& entry) { return entry.plan.has_value(); };
    return named_.contains("def-fact-group") ||
           std::any_of(binding_.entries.begin(), binding_.entries.end(), runs);
  }

  /// The user gives one call as the plan's beginning.
  bool check_entry_call() {
    if (!entry_file_) return true;
    std::vector<DatumId> written;
    for (const auto form : text_.forms) {
      if (c_.data.source(form).file == *entry_file_) written.push_back(form);
    }
    if (written.size() == 1 && !c_.data.children(written.front()).empty()) return true;
    const auto place = written.empty()       ? base::SourceRange{*entry_file_, 0, 0}
                       : written.size() == 1 ? c_.data.source(written.front())
                                             : c_.data.source(written[1]);
    (void)sink_.error(codes::kNoPlanEntry, place,
                      written.size() > 1 ? "the entry is one call, and this is another one"
                                         : "the entry is empty: give a function or a call of it");
    return false;
  }

  /// Marks everything that the run can reach: from the entry, else from the forms at top level,
  /// else from the last function.
  void find_reached(const std::optional<std::string>& entry) {
    std::set<std::string, std::less<>> macros;
    std::vector<DatumId> others;
    std::vector<std::string> names;
    std::string last;
    for (const auto form : forms_) {
      const auto head = c_.data.head(form).value_or("");
      const auto items = c_.data.children(form);
      if (head == "def-fact-group") {
        reach_.add_facts(form);
      } else if (is_definition(head)) {
        if (items.size() < 2 || !c_.data.is_symbol(items[1])) continue;
        reach_.define(c_.data.key(items[1]), form);
        if (head == "defmacro") macros.insert(c_.data.key(items[1]));
        if (defines_function(head)) last = c_.data.key(items[1]);
      } else if (head == "define-condition") {
        reach_.add_slots(form);
      } else if (defines_structure(head)) {
        read_structure(form);
      } else if (head == "defmethod" && items.size() > 1 && c_.data.is_symbol(items[1])) {
        methods_[c_.data.key(items[1])].push_back(form);
      } else if (head == "defgeneric" && items.size() > 1 && c_.data.is_symbol(items[1])) {
        const auto key = c_.data.key(items[1]);
        for (const auto method : methods_of_generic(c_.data, form)) methods_[key].push_back(method);
      } else if (!is_housekeeping(head)) {
        others.push_back(form);
      }
    }
    for (const auto& [name, methods] : methods_) {
      DatumId function;
      auto error = read_methods(c_.data, methods, structures_, c_.code.code().classes, function);
      if (error) structure_errors_.emplace(methods.front(), *std::move(error));
      if (!error) reach_.define(name, generics_.emplace(name, function).first->second);
    }
    const auto expands = [&](DatumId form) {
      return c_.data.head(form) && macros.contains(c_.data.key(c_.data.children(form)[0]));
    };
    const bool bare = !std::all_of(others.begin(), others.end(), expands);
    if (entry || entry_file_) {
      std::erase_if(others, [&](DatumId form) { return !is_run(form) && !expands(form); });
    }
    if (entry) names.push_back(entry_key(*entry));
    if (!entry && !bare) names.push_back(last);
    for (const auto& bound : binding_.entries) {
      if (bound.plan) names.push_back(entry_key(*bound.plan));
    }
    reach_.find(others, names);
  }

  /// Its functions count as others do: where something that is reached names them.
  void read_structure(DatumId form) {
    PlanStructure structure;
    if (auto error = compiler::read_structure(c_.data, form, structures_, structure)) {
      structure_errors_.emplace(form, *std::move(error));
    }
    for (const auto function : structure.functions) {
      reach_.define(c_.data.name(c_.data.children(function)[1]), function);
      reach_.define(structure.name, function);  // (make-instance 'class ...) names the class
    }
    structures_.push_back(std::move(structure));
    structure_at_.emplace(form, structures_.size() - 1);
  }

  void define_structure(DatumId form) {
    if (!structure_at_.contains(form)) read_structure(form);
    const auto& structure = structures_[structure_at_.at(form)];
    const bool reached =
        std::any_of(structure.functions.begin(), structure.functions.end(), [&](DatumId function) {
          return reach_.contains(c_.data.name(c_.data.children(function)[1]));
        });
    if (!reached && !reach_.contains(structure.name)) return;
    if (const auto error = structure_errors_.find(form); error != structure_errors_.end()) {
      return c_.unsupported(error->second.at, error->second.text);
    }
    c_.code.code().classes.add_structure(structure.name);
    for (const auto function : structure.functions) {
      const auto items = c_.data.children(function);
      const auto name = c_.data.name(items[1]);
      if (!c_.defined.functions.contains(name)) {
        add_function(function, name, items);
      } else if (reach_.contains(name)) {
        c_.unsupported(form, fmt::format("`{}` is defined twice", name));
      }
    }
    for (const auto& [name, slot] : structure.accessors) c_.defined.accessors.emplace(name, slot);
  }

  /// All methods of a name are one function, of the first one's place.
  void define_method(DatumId form, const std::string& name) {
    if (const auto type = type_it_makes(c_.data, form); type && reach_.contains(*type)) {
      return c_.unsupported(form, "a method of what makes things");
    }
    if (!reach_.contains(name) || !made_generics_.insert(name).second) return;
    if (defined_.contains(name)) return;  // a `defun` stands for it
    if (c_.defined.functions.contains(name)) return c_.unsupported(form, "it is defined twice");
    if (const auto generic = generics_.find(name); generic != generics_.end()) {
      return add_function(generic->second, name, c_.data.children(generic->second));
    }
    const auto& error = structure_errors_.at(methods_.at(name).front());
    c_.unsupported(error.at, error.text);
  }

  bool define_name(DatumId form, DatumId name) {
    if (!c_.data.is_symbol(name)) {
      c_.malformed(form, "expected a name");
      return false;
    }
    const auto [entry, added] = defined_.emplace(c_.data.key(name), name);
    if (added) return true;
    c_.error(codes::kDuplicatePlanDefinition, name, c_.data.name(name))
        .note(c_.data.source(entry->second), "first defined here");
    return false;
  }

  void define_function(DatumId form, FormItems items) {
    if (items.size() < 3) return c_.malformed(form, "expected a name, parameters and a body");
    if (!define_name(form, items[1])) return;
    const auto& name = c_.data.key(items[1]);
    if (plan_forms().contains(c_.data.name(items[1])))
      return c_.unsupported(form, fmt::format("`{}` is a built-in form", name));
    add_function(form, name, items);
    functions_.emplace_back(c_.position, name);
  }

  void add_function(DatumId form, const std::string& name, FormItems items) {
    const auto function = declare_function(c_, form, name, items[2]);
    c_.code.code().functions.emplace(name, function.unit);
    c_.defined.functions.emplace(name, function);
    c_.defined.unwritten[function.unit] = {
        function, {}, c_.data.name(items[1]), items.subspan(3), c_.position};
  }

  void define_macro(DatumId form, FormItems items) {
    if (items.size() < 3) return c_.malformed(form, "expected a name, parameters and a body");
    if (define_name(form, items[1])) add_macro(form, c_.data.key(items[1]), items);
  }

  void add_macro(DatumId form, const std::string& name, FormItems items) {
    const auto macro = declare_macro(c_, form, c_.data.name(items[1]), items[2]);
    c_.defined.macros.emplace(name, macro);
    c_.defined.unwritten[macro.unit] = {{}, macro, macro.name, items.subspan(3), c_.position};
  }

  void define_global(DatumId form, FormItems items) {
    if (items.size() < 2) return c_.malformed(form, "expected a name and a value");
    // A function and a variable of one name live in different namespaces in Lisp; here they clash.
    if (!define_name(form, items[1])) return;
    c_.defined.globals.emplace(c_.data.key(items[1]),
                               static_cast<std::uint32_t>(c_.code.code().globals.size()));
    c_.code.code().globals.push_back({c_.data.key(items[1]), form});
    global_forms_.emplace_back(c_.position, form);
  }

  void define_condition(DatumId form, FormItems items) {
    if (items.size() < 3 || !c_.data.is_symbol(items[1]) || !c_.data.is_list(items[2])) {
      return c_.malformed(form, "expected a name and a list of parents");
    }
    std::vector<std::string> parents;
    for (const auto parent : c_.data.children(items[2])) {
      if (const auto known = c_.failure_class(parent)) parents.push_back(*known);
    }
    if (parents.empty()) parents.emplace_back("condition");
    if (items.size() > 3) note_slots(items[3]);
    if (c_.code.code().classes.add(c_.data.name(items[1]), std::move(parents))) return;
    c_.error(codes::kDuplicatePlanDefinition, items[1], c_.data.name(items[1]));
  }

  /// (name :initarg :key :reader function :initform form)...
  void note_slots(DatumId slots) {
    for (const auto written : c_.data.children(slots)) {
      const auto parts = c_.data.children(written);
      ConditionSlot slot;
      std::vector<DatumId> readers;
      for (std::size_t i = 1; i + 1 < parts.size(); i += 2) {
        const auto option = c_.data.is_keyword(parts[i]) ? c_.data.name(parts[i]) : "";
        if (option == "initarg") slot.initargs.push_back(c_.data.name(parts[i + 1]));
        if (option == "initform") slot.initial = parts[i + 1];
        if (option == "reader" || option == "accessor") readers.push_back(parts[i + 1]);
      }
      for (const auto reader : readers) {
        if (!c_.data.is_symbol(reader) || !named_.contains(c_.data.name(reader))) continue;
        c_.defined.readers.emplace(c_.data.key(reader), slot);
        c_.defined.read_initargs.insert(slot.initargs.begin(), slot.initargs.end());
      }
    }
  }

  /// Lists the forms at top level, including those inside a `progn` or `eval-when` there.
  void flatten(DatumId form) {
    std::vector<DatumId> open = {form};
    while (!open.empty()) {
      const auto datum = open.back();
      open.pop_back();
      const auto head = c_.data.head(datum).value_or("");
      const std::size_t skipped = head == "progn" ? 1 : (head == "eval-when" ? 2 : 0);
      const auto items = c_.data.children(datum);
      if (skipped == 0 || items.size() <= skipped) {
        forms_.push_back(datum);
        continue;
      }
      const auto inside = items.subspan(skipped);
      open.insert(open.end(), inside.rbegin(), inside.rend());
    }
  }

  /// True for a definition, and for a form that has no part in the run.
  bool define(DatumId form, bool always) {
    const auto head = c_.data.head(form).value_or("");
    const auto items = c_.data.children(form);
    const bool named = items.size() > 1 && c_.data.is_symbol(items[1]);
    if (is_definition(head) && named && !always && !reach_.contains(c_.data.key(items[1]))) {
      define_name(form, items[1]);
      return true;
    }
    c_.check_dots(form);
    if (defines_function(head)) {
      define_function(form, items);
    } else if (head == "defmacro") {
      define_macro(form, items);
    } else if (defines_global(head)) {
      define_global(form, items);
    } else if (defines_structure(head)) {
      define_structure(form);
    } else if (named && (head == "defmethod" ||
                         (head == "defgeneric" && methods_.contains(c_.data.key(items[1]))))) {
      define_method(form, c_.data.key(items[1]));
    } else {
      return is_housekeeping(head) || head == "define-condition";
    }
    return true;
  }

  void collect_definitions() {
    for (std::size_t i = 0; i < forms_.size(); ++i) {
      c_.position = i + 1;
      if (!define(forms_[i], false)) others_.emplace_back(i + 1, forms_[i]);
    }
  }

  /// Functions of our own Lisp that the plan does not define itself.
  void add_library() {
    c_.position = 0;
    for (const auto form : add_lisp_library(c_.data)) {
      const auto items = c_.data.children(form);
      const auto& name = c_.data.key(items[1]);
      if (defined_.contains(name) && reach_.contains(name)) continue;
      if (c_.data.head(form) == "defmacro") {
        add_macro(form, name, items);
      } else {
        add_function(form, name, items);
      }
    }
  }

  /// The calls of macros at top level may define something as well.
  void expand_forms() {
    for (const auto& [position, form] : others_) {
      c_.position = position;
      std::vector<DatumId> open = {form};
      while (!open.empty()) {
        const auto datum = open.back();
        open.pop_back();
        const auto items = c_.data.children(datum);
        const auto head = c_.data.head(datum).value_or("");
        const auto* macro = c_.data.head(datum) ? c_.find_macro(items.front()) : nullptr;
        if (macro != nullptr) {
          const auto expansion = c_.expand(*macro, datum);
          if (expansion) open.push_back(*expansion);
          missing_ = missing_ || !expansion;
        } else if (datum != form && (head == "progn" || head == "eval-when") && items.size() > 1) {
          const auto inside = items.subspan(head == "progn" ? 1 : 2);
          open.insert(open.end(), inside.rbegin(), inside.rend());
        } else if (datum != form && head == "define-condition") {
          define_condition(datum, items);
        } else if ((datum == form || !define(datum, true)) && is_run(form)) {
          bare_forms_.emplace_back(position, datum);
        }
      }
    }
    const auto by_position = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::stable_sort(functions_.begin(), functions_.end(), by_position);
    std::stable_sort(global_forms_.begin(), global_forms_.end(), by_position);
    for (const auto& [position, name] : functions_) c_.defined.function_order.push_back(name);
  }

  void compile_functions() {
    const auto first = text_.forms.front();
    c_.code.code().halt = c_.code.declare_unit("a computation", first, 0);
    c_.code.enter_unit(c_.code.code().halt);
    c_.code.leave_unit(PlanOp::kDone, first);
    c_.code.code().definitions = c_.code.declare_unit("the definitions", first, 0);
    c_.code.enter_unit(c_.code.code().definitions);
    for (const auto& [position, form] : global_forms_) {
      c_.position = position;
      const auto items = c_.data.children(form);
      if (items.size() > 2) {
        c_.compile(items[2]);
      } else {
        c_.nil(form);
      }
      c_.code.emit(PlanOp::kStoreGlobal, c_.defined.globals.at(c_.data.key(items[1])), 0, form);
      c_.code.adjust(-1);
    }
    c_.code.leave_unit(PlanOp::kDone, first);
    while (!c_.defined.unwritten.empty()) c_.complete(c_.defined.unwritten.begin()->first);
  }

  /// Does a form at top level run, unless a function is the entry?
  bool is_run(DatumId form) const {
    return !entry_file_ || c_.data.source(form).file == *entry_file_;
  }

  /// An entry may be named as `package::name` or `package:name`.
  std::string entry_key(std::string entry) const {
    const auto colon = entry.find(':');
    if (colon == std::string::npos) return entry;
    if (!entry.substr(colon).starts_with("::")) entry.insert(colon, ":");
    const auto found = text_.keys.find(entry);
    return found == text_.keys.end() ? entry : found->second;
  }

  void compile_main(const std::optional<std::string>& entry) {
    c_.code.code().main = c_.code.declare_unit("the plan", text_.forms.front(), 0);
    c_.code.enter_unit(c_.code.code().main);
    auto name = entry ? std::optional(entry_key(*entry)) : std::nullopt;
    if (!name && bare_forms_.empty() && !c_.defined.function_order.empty())
      name = c_.defined.function_order.back();
    if (!name) {
      for (std::size_t i = 0; i < bare_forms_.size(); ++i) {
        if (i > 0) c_.code.drop(bare_forms_[i].second);
        c_.position = bare_forms_[i].first;
        c_.compile(bare_forms_[i].second);
      }
      if (bare_forms_.empty()) c_.nil(text_.forms.front());
    } else if (const auto found = c_.defined.functions.find(*name);
               found == c_.defined.functions.end()) {
      std::vector<std::string> names = c_.defined.function_order;
      auto error = c_.error(codes::kNoPlanEntry, text_.forms.front(),
                            fmt::format("no function `{}`", *name));
      if (const auto near = base::nearest_name(*name, names)) {
        error.fix(fmt::format("name `{}`", *near));
      }
    } else if (Callee callee;
               !found->second.parameters.empty() && !found->second.parameters.front().optional) {
      c_.error(codes::kNoPlanEntry, found->second.source,
               fmt::format("`{}` needs arguments", *name))
          .fix(fmt::format("give them: --plan-entry \"({} ...)\"", *name));
    } else {
      callee.function = &found->second;
      compile_call(c_, found->second.source, *name, callee, {});
    }
    c_.code.leave_unit(PlanOp::kDone, text_.forms.front());
  }

  using Positioned = std::pair<std::size_t, DatumId>;  // a form and where it stands
  LispText& text_;
  const PlanBinding& binding_;
  std::optional<base::FileId> entry_file_;
  base::DiagnosticSink& sink_;
  FormCompiler c_;
  PlanReach reach_;
  std::vector<DatumId> forms_;                           // at top level
  std::map<std::string, DatumId, std::less<>> defined_;  // where, by name
  std::vector<std::pair<std::size_t, std::string>> functions_;
  std::vector<Positioned> global_forms_;
  std::vector<Positioned> others_;      // no definitions, but perhaps calls of macros that define
  std::vector<Positioned> bare_forms_;  // forms to be run
  bool missing_ = false;                // of them, an expansion
  std::vector<PlanStructure> structures_;
  std::map<std::string, std::vector<DatumId>, std::less<>> methods_;  // by name
  std::map<std::string, DatumId, std::less<>> generics_;  // the function of all methods of a name
  std::set<std::string, std::less<>> made_generics_;
  std::map<DatumId, std::size_t> structure_at_;
  std::map<DatumId, StructureError> structure_errors_;
  std::set<std::string, std::less<>> named_;  // all names, but those in definitions of conditions
};

}  // namespace

base::Result<PlanCode> compile_plan(LispText& text, const PlanStart& entry, bool interleave,
                                    const PlanBinding& binding, ValueStore& values,
                                    base::DiagnosticSink& sink) {
  return PlanCompiler(text, values, sink, interleave, binding, entry.forms).compile(entry.function);
}

}  // namespace parallax::compiler
