#include "compiler/sema/declarations.h"

#include <algorithm>
#include <array>
#include <optional>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/names.h"
#include "compiler/base/codes/texts.h"
#include "compiler/sema/declarations.h"
#include "compiler/sema/elaborator.h"
#include "compiler/sema/name_advice.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

namespace {

bool is_symbol_name(std::string_view name) { return base::is_upper(name[0]) || name[0] == '_'; }

/// Constants may also be spelled like variables, `r1`: a name says less than a declaration.
bool is_constant_name(std::string_view name) {
  return is_symbol_name(name) || (name[0] >= 'a' && name[0] <= 'z');
}

std::string capitalized(std::string_view name) {
  std::string out(name);
  out[0] = base::to_upper(out[0]);
  return out;
}

class Declarer {
 public:
  Declarer(const ModelAst& model_ast, const IgnoredNames& ignored, const CheckOptions& options,
           Repetitions& repetitions, TypedModel& model, base::DiagnosticSink& sink)
      : model_ast_(model_ast),
        ignored_(ignored),
        options_(options),
        repetitions_(repetitions),
        model_(model),
        sink_(sink) {}

  void run() {
    declare_sorts(model_ast_, repetitions_, model_, sink_);
    reserve();
    // Several passes, so that the order of the statements does not matter.
    for_each([&](const Ast& ast, const Statement& statement) {
      if (statement.kind == StatementKind::kConstants) constants(ast, statement);
      if (statement.kind == StatementKind::kConstructor) constructor(ast, statement);
      if (statement.kind == StatementKind::kRange) range(ast, statement);
      if (statement.kind == StatementKind::kOption) {
        apply_option(ast, statement, model_.options, sink_);
      }
    });
    report_like_variables();
    override_time();
    find_core();
    check_finite_sorts(model_, sink_);
    for_each([&](const Ast& ast, const Statement& statement) {
      if (statement.kind == StatementKind::kNoninertial) mark(ast, statement, &Symbol::noninertial);
      if (statement.kind == StatementKind::kManualRelease) {
        mark(ast, statement, &Symbol::manual_release);
      }
      if (statement.kind == StatementKind::kCompletion) completion(ast, statement);
      if (statement.kind == StatementKind::kMinimize) {
        model_.objectives.push_back(
            {std::string(ast.text(statement.value)), ast.source(statement.value)});
      }
    });
    release_manually();
  }

 private:
  template <typename Visit>
  void for_each(const Visit& visit) {
    for (position_ = 0; position_ < model_ast_.order.size(); ++position_) {
      const auto& place = model_ast_.order[position_];
      visit(model_ast_.ast(place), model_ast_.statement(place));
    }
  }

  bool is_ignored(std::string_view name) const { return ignored_.contains(name, position_); }

  /// A million constants shall not be copied while the store grows.
  void reserve() {
    std::size_t objects = 0;
    for (const auto& place : model_ast_.order) {
      const auto& statement = model_ast_.statement(place);
      if (statement.kind == StatementKind::kConstants) objects += statement.item_count;
    }
    model_.objects.reserve(objects);
  }

  // --- constants ---

  /// A constant that reads as a variable of `sort`.
  struct LikeVariable {
    std::string name;
    base::SourceRange source;
    SortId sort;
  };

  void reads_as_variable(const LikeVariable& like) {
    const auto& sort = model_.sorts[like.sort];
    sink_.error(codes::kNameSpelling, like.source, shortened(like.name), "a constant")
        .note(sort.declared, "it would read as a variable of the sort `" + sort.name + "`")
        .fix(NameAdvice::replace(like.name, capitalized(like.name)));
  }

  bool has_constants(SortId sort) const {
    for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
      const auto below = model_.sorts.id_at(i);
      if (model_.is_subsort(below, sort) && !model_.sorts[below].constants.empty()) return true;
    }
    return false;
  }

  /// Some tools declare variables, as in `agent agent1`. Where the sort has constants of its own, a
  /// variable is meant, and a further object would change every formula about the sort.
  void report_like_variables() {
    for (const auto& like : like_variables_) {
      if (has_constants(like.sort)) {
        sink_.warning(codes::kVariableDeclared, like.source, shortened(like.name),
                      model_.sorts[like.sort].name);
      } else {
        reads_as_variable(like);
      }
    }
  }

  void constants(const Ast& ast, const Statement& statement) {
    const auto sort = resolve_sort(ast, statement.sort, model_, sink_);
    for (std::uint32_t i = 0; !sort && i < statement.item_count; ++i) {
      model_.refuse(ast.text(ast.items(statement)[i].name));
    }
    if (!sort) return;
    for (std::uint32_t i = 0; i < statement.item_count; ++i) {
      const auto word = ast.items(statement)[i].name;
      // To the 2005 reasoner an ignored constant is a constant all the same.
      if (options_.old_reasoner || !is_ignored(ast.text(word)))
        constant(ast, word, *sort, statement.additional);
    }
  }

  void constant(const Ast& ast, Word word, SortId sort_id, bool additional) {
    const auto name = ast.text(word);
    const auto& sort = model_.sorts[sort_id];
    const auto like = model_.find_sort(sort_of_variable(name));
    if (!is_constant_name(name)) {
      sink_.error(codes::kNameSpelling, ast.source(word), shortened(name), "a constant");
    } else if (like == sort_id && sort.reified && name != sort.name) {
      // Old models declare `fluent fluent2` before they use the variable.
      sink_.warning(codes::kVariableDeclared, ast.source(word), shortened(name), sort.name);
    } else if (like == sort_id) {
      like_variables_.push_back({std::string(name), ast.source(word), sort_id});
    } else if (like) {
      reads_as_variable({std::string(name), ast.source(word), *like});
    } else if (sort.reified) {
      sink_.error(codes::kReifiedConstant, ast.source(word), shortened(name), sort.name)
          .note(sort.declared, "sort `" + sort.name + "` declared here")
          .fix("write `" + sort.name + " " + shortened(name) + "()`");
    } else if (sort.integer) {
      sink_.error(codes::kIntegerConstant, ast.source(word), sort.name, shortened(name))
          .note(sort.declared, "sort `" + sort.name + "` declared here");
    } else if (const auto before = model_.find_object(name)) {
      second_declaration(ast, word, *before, sort_id, additional);
    } else {
      const auto id = model_.objects.add({std::string(name), {sort_id}, ast.source(word)});
      model_.object_index.insert(id.index(), [this](std::uint32_t position) {
        return std::string_view(model_.objects[ObjectId(position)].name);
      });
      model_.sorts[sort_id].constants.push_back(id);
    }
  }

  void second_declaration(const Ast& ast, Word word, ObjectId id, SortId sort, bool additional) {
    Object& object = model_.objects[id];
    const bool same =
        std::find(object.sorts.begin(), object.sorts.end(), sort) != object.sorts.end();
    if (same) {
      repetitions_.note(object.name, ast.source(word), object.declared);
    } else if (!additional) {
      const auto& first = model_.sorts[object.sorts.front()].name;
      sink_.error(codes::kSecondSort, ast.source(word), shortened(object.name), first)
          .note(object.declared, "first declared here")
          .fix("write `" + model_.sorts[sort].name + "! " + shortened(object.name) +
               "` if it belongs to both");
    } else {
      object.sorts.push_back(sort);
      model_.sorts[sort].constants.push_back(id);
    }
  }

  void report_twice(const Ast& ast, Word word, std::string_view name,
                    const base::SourceRange& first) {
    sink_.error(codes::kDeclaredTwice, ast.source(word), shortened(name))
        .note(first, "first declared here");
  }

  // --- symbols ---

  SymbolKind kind_of(SortId sort) const {
    const auto below = [&](std::string_view name) {
      const auto found = model_.find_sort(name);
      return found && model_.is_subsort(sort, *found);
    };
    if (below("predicate")) return SymbolKind::kPredicate;
    if (below("function")) return SymbolKind::kFunction;
    if (below("fluent")) return SymbolKind::kFluent;
    if (below("event")) return SymbolKind::kEvent;
    return SymbolKind::kReified;
  }

  void constructor(const Ast& ast, const Statement& statement) {
    const auto name = ast.text(statement.name);
    if (is_ignored(name)) return;
    const auto sort = resolve_sort(ast, statement.sort, model_, sink_);
    Symbol symbol;
    symbol.name = std::string(name);
    symbol.declared = ast.source(Word{statement.name.begin, statement.source.end});
    bool complete = sort.has_value();
    for (std::uint32_t i = 0; i < statement.item_count; ++i) {
      const auto argument = resolve_sort(ast, ast.items(statement)[i].name, model_, sink_);
      if (argument) symbol.arguments.push_back(*argument);
      complete = complete && argument.has_value();
    }
    if (!sort || !check_constructor(ast, statement, *sort)) {
      model_.refuse(name);
      return;
    }
    symbol.kind = kind_of(*sort);
    complete = result_sort(ast, statement, *sort, symbol) && complete;
    if (const auto before = model_.find_symbol(name)) {
      const auto& first = model_.symbols[*before];
      if (complete && first.kind == symbol.kind && first.arguments == symbol.arguments &&
          first.result == symbol.result) {
        return repetitions_.note(name, ast.source(statement.name), first.declared);
      }
      return report_twice(ast, statement.name, name, first.declared);
    }
    // An incomplete one would only cause complaints about every use of it.
    if (!complete) {
      model_.refuse(name);
      return;
    }
    const auto id = model_.symbols.add(std::move(symbol));
    model_.symbol_index.insert(id.index(), [this](std::uint32_t position) {
      return std::string_view(model_.symbols[SymbolId(position)].name);
    });
  }

  bool check_constructor(const Ast& ast, const Statement& statement, SortId sort_id) {
    const auto name = ast.text(statement.name);
    const auto& sort = model_.sorts[sort_id];
    if (!is_symbol_name(name)) {
      // Declared all the same, so that its uses are understood.
      auto error = sink_.error(codes::kNameSpelling, ast.source(statement.name), shortened(name),
                               with_article(sort.name));
      if (base::is_lower(name[0])) {
        error.fix(NameAdvice::replace(name, capitalized(name)));
        model_.refuse(capitalized(name));  // its uses may be right already
      }
    }
    if (!sort.reified) {
      sink_.error(codes::kPlainConstructor, ast.source(statement.name), shortened(name), sort.name)
          .note(sort.declared, "sort `" + sort.name + "` declared here");
      return false;
    }
    return true;
  }

  bool result_sort(const Ast& ast, const Statement& statement, SortId sort, Symbol& symbol) {
    const bool given = !statement.value.empty();
    const auto name = shortened(symbol.name);
    if (symbol.kind == SymbolKind::kFunction) {
      if (!given) {
        sink_
            .error(codes::kResultSort, ast.source(statement.name),
                   "the function `" + name + "` has no result sort")
            .fix("add `: sort` after the closing parenthesis");
        return false;
      }
      symbol.result = resolve_sort(ast, statement.value, model_, sink_);
      return symbol.result.has_value();
    }
    if (given) {
      sink_.error(codes::kResultSort, ast.source(statement.value),
                  "the " + std::string(kind_word(symbol.kind)) + " `" + name +
                      "` cannot have a result sort");
      return false;
    }
    if (symbol.kind != SymbolKind::kPredicate) symbol.result = sort;
    return true;
  }

  // --- ranges ---

  void range(const Ast& ast, const Statement& statement) {
    const auto id = resolve_sort(ast, statement.sort, model_, sink_);
    if (!id) return;
    Sort& sort = model_.sorts[*id];
    const auto [lower, upper] = ast.bounds(statement);
    if (!sort.integer) {
      sink_.error(codes::kRangeOfPlainSort, ast.source(statement.sort), sort.name)
          .note(sort.declared, "sort `" + sort.name + "` declared here");
    } else if (lower > upper) {
      sink_.error(codes::kRangeReversed, ast.source(statement.source), lower, upper);
    } else {
      if (sort.name == "time" && !sort.ranges.empty()) {
        sink_.warning(codes::kSecondTimeRange, ast.source(statement.source))
            .note(sort.ranges.front().declared, "the other range");
      }
      sort.ranges.push_back({lower, upper, ast.source(statement.source)});
    }
  }

  void override_time() {
    const auto time = model_.find_sort("time");
    if (!time) return;
    Sort& sort = model_.sorts[*time];
    auto lower = options_.time_lower;
    auto upper = options_.time_upper;
    if (!upper && sort.ranges.empty()) upper = options_.usual_time_upper;
    if (!lower && !upper) return;
    Sort::Range range{0, 0, sort.declared};
    for (const auto& given : sort.ranges) {
      if (!options_.time_lower) lower = std::min(lower.value_or(given.lower), given.lower);
      if (!options_.time_upper) upper = std::max(upper.value_or(given.upper), given.upper);
      range.declared = given.declared;
    }
    if (!upper) return;  // a lower bound alone is no range
    range.lower = lower.value_or(0);
    range.upper = *upper;
    if (range.lower > range.upper) {
      sink_.error(codes::kRangeReversed, range.declared, range.lower, range.upper);
      return;
    }
    sort.ranges = {range};
  }

  // --- what is said about symbols ---

  void find_core() {
    auto& core = model_.core;
    const auto predicate = [&](std::string_view name) -> std::optional<SymbolId> {
      const auto found = model_.find_symbol(name);
      if (!found || model_.symbols[*found].kind != SymbolKind::kPredicate) return std::nullopt;
      return found;
    };
    core.happens = predicate("Happens");
    core.holds_at = predicate("HoldsAt");
    core.released_at = predicate("ReleasedAt");
    core.initiates = predicate("Initiates");
    core.terminates = predicate("Terminates");
    core.releases = predicate("Releases");
    core.trajectory = predicate("Trajectory");
    core.anti_trajectory = predicate("AntiTrajectory");
    core.time = model_.find_sort("time");
    core.fluent = model_.find_sort("fluent");
    core.event = model_.find_sort("event");
    core.integer = model_.find_sort("integer");
  }

  /// The symbol that `word` names if it is of one of `kinds`; otherwise reports.
  std::optional<SymbolId> symbol(const Ast& ast, Word word, std::span<const SymbolKind> kinds,
                                 std::string_view wanted) {
    const auto name = ast.text(word);
    const auto found = model_.find_symbol(name);
    if (!found && model_.misdeclared.contains(name)) return std::nullopt;
    if (!found) {
      auto report = sink_.error(codes::kUnknownName, ast.source(word), wanted, shortened(name), "");
      if (const auto near = NameAdvice(model_, sink_).symbol(name, kinds)) {
        const auto& other = model_.symbols[*near];
        report.note(other.declared, "`" + signature(model_, other) + "` declared here");
        report.fix(NameAdvice::replace(name, other.name));
      }
      return std::nullopt;
    }
    const auto& symbol = model_.symbols[*found];
    if (std::find(kinds.begin(), kinds.end(), symbol.kind) != kinds.end()) return found;
    sink_
        .error(codes::kWrongKind, ast.source(word), shortened(name),
               with_article(kind_word(symbol.kind)), with_article(wanted))
        .note(symbol.declared, "`" + signature(model_, symbol) + "` declared here");
    return std::nullopt;
  }

  void mark(const Ast& ast, const Statement& statement, bool Symbol::*flag) {
    constexpr std::array<SymbolKind, 1> kFluents = {SymbolKind::kFluent};
    for (std::uint32_t i = 0; i < statement.item_count; ++i) {
      const auto word = ast.items(statement)[i].name;
      if (is_ignored(ast.text(word))) continue;
      const auto found = symbol(ast, word, kFluents, "fluent");
      if (found) model_.symbols[*found].*flag = true;
    }
  }

  void completion(const Ast& ast, const Statement& statement) {
    constexpr std::array<SymbolKind, 1> kPredicates = {SymbolKind::kPredicate};
    if (is_ignored(ast.text(statement.name))) return;
    const auto found = symbol(ast, statement.name, kPredicates, "predicate");
    const auto& core = model_.core;
    // These three are completed anyway.
    if (!found || found == core.initiates || found == core.terminates || found == core.releases) {
      return;
    }
    Completion completion;
    completion.predicate = *found;
    completion.source = ast.source(statement.source);
    if (!statement.label.empty()) completion.label = std::string(ast.text(statement.label));
    model_.completions.push_back(std::move(completion));
  }

  void release_manually() {
    if (!model_.options.manual_release) return;
    for (std::size_t i = 0; i < model_.symbols.size(); ++i) {
      auto& found = model_.symbols[model_.symbols.id_at(i)];
      if (found.kind == SymbolKind::kFluent) found.manual_release = true;
    }
  }

  std::vector<LikeVariable> like_variables_;
  const ModelAst& model_ast_;
  const IgnoredNames& ignored_;
  const CheckOptions& options_;
  Repetitions& repetitions_;
  TypedModel& model_;
  base::DiagnosticSink& sink_;
  std::size_t position_ = 0;  // in ModelAst::order
};

}  // namespace

IgnoredNames::IgnoredNames(const ModelAst& model_ast) {
  for (std::size_t i = 0; i < model_ast.order.size(); ++i) {
    const auto& statement = model_ast.statement(model_ast.order[i]);
    if (statement.kind != StatementKind::kIgnore) continue;
    const Ast& ast = model_ast.ast(model_ast.order[i]);
    for (std::uint32_t k = 0; k < statement.item_count; ++k) {
      since_.emplace(ast.text(ast.items(statement)[k].name), i);
    }
  }
}

bool IgnoredNames::contains(std::string_view name, std::size_t at) const {
  const auto found = since_.find(name);
  return found != since_.end() && found->second < at;
}

bool IgnoredNames::concern(const Ast& ast, const Statement& formula) const {
  if (since_.empty()) return false;
  for (auto i = formula.first_node.index(); i <= formula.formula.index(); ++i) {
    const Node& node = ast[NodeId(i)];
    const bool named = node.kind == NodeKind::kName || node.kind == NodeKind::kApply;
    if (named && since_.contains(ast.name(node))) return true;
  }
  return false;
}

Repetitions::Repetitions(const ModelAst& ast, base::DiagnosticSink& sink) : sink_(sink) {
  for (const auto& file : ast.files) {
    const auto index = file.ast.file().index();
    if (index >= kinds_.size()) kinds_.resize(index + 1, kOwn);
    kinds_[index] = file.built_in ? kBuiltIn : file.repeats_foundation ? kCopy : kOwn;
  }
  told_.assign(kinds_.size(), false);
}

void Repetitions::note(std::string_view name, base::SourceRange again, base::SourceRange first) {
  // A foundation may be loaded after the declarations that repeat it.
  if (built_in(again)) std::swap(again, first);
  if (built_in(again) || is_copy(again) || is_copy(first)) return;
  if (!built_in(first)) {
    sink_.warning(codes::kDeclaredAgain, again, shortened(name)).note(first, "first declared here");
    return;
  }
  note_foundation(again, "`" + shortened(name) + "`");
}

void Repetitions::note_foundation(base::SourceRange again, std::string_view what) {
  const auto file = again.file.index();
  if (is_copy(again) || told_[file]) return;
  told_[file] = true;
  sink_.warning(codes::kFoundationRepeated, again, what);
}

void declare(const ModelAst& ast, const IgnoredNames& ignored, const CheckOptions& options,
             Repetitions& repetitions, TypedModel& model, base::DiagnosticSink& sink) {
  Declarer(ast, ignored, options, repetitions, model, sink).run();
}

}  // namespace parallax::compiler
