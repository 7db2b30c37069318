#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/base/suggest.h"
#include "compiler/base/word_table.h"
#include "compiler/sema/declarations.h"
#include "compiler/sema/name_advice.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

namespace {

enum class Values : std::uint8_t { kOnOff, kEncoding, kSolver, kFile, kOff };

struct OptionInfo {
  std::string_view name;
  Values values;
  bool DeclaredOptions::*flag;  // null: accepted, without meaning for us
};

constexpr std::array<OptionInfo, 13> kOptions = {{
    {"encoding", Values::kEncoding, nullptr},
    {"founded", Values::kOnOff, nullptr},
    {"trajectory", Values::kOnOff, &DeclaredOptions::trajectory},
    {"manualrelease", Values::kOnOff, &DeclaredOptions::manual_release},
    {"renaming", Values::kOnOff, &DeclaredOptions::renaming},
    {"timediff", Values::kOnOff, &DeclaredOptions::time_diff},
    {"modeldiff", Values::kOnOff, &DeclaredOptions::model_diff},
    {"showpred", Values::kOnOff, &DeclaredOptions::show_predicates},
    {"debug", Values::kOnOff, nullptr},
    {"tmpfilerm", Values::kOnOff, nullptr},
    {"finalstatefile", Values::kFile, nullptr},
    {"solver", Values::kSolver, nullptr},
    {"weighted", Values::kOff, nullptr},
}};

constexpr auto kExpectedValues = base::word_table<Values>(
    "`on` or `off`", "`2` or `3`", "`relsat`, `walksat`, `minisat`, `maxwalksat` or `wmaxsat`",
    "a path", "`off` (weighted formulas are not supported)");

bool allowed(Values values, std::string_view value) {
  switch (values) {
    case Values::kOnOff:
      return value == "on" || value == "off";
    case Values::kEncoding:
      return value == "2" || value == "3";
    case Values::kSolver:
      return value == "relsat" || value == "walksat" || value == "minisat" ||
             value == "maxwalksat" || value == "wmaxsat";
    case Values::kOff:
      return value == "off";
    case Values::kFile:
      return !value.empty();
  }
  return false;
}

}  // namespace

void apply_option(const Ast& ast, const Statement& statement, DeclaredOptions& options,
                  base::DiagnosticSink& sink) {
  const auto name = ast.text(statement.name);
  const auto value = ast.text(statement.value);
  for (const auto& option : kOptions) {
    if (option.name != name) continue;
    if (!allowed(option.values, value)) {
      sink.error(codes::kOptionValue, ast.source(statement.value), name, shortened(value),
                 kExpectedValues.of(option.values));
      return;
    }
    if (option.flag != nullptr) options.*option.flag = value == "on";
    if (name == "founded") {
      options.founded = value == "on" ? std::optional(ast.source(statement.value)) : std::nullopt;
    }
    if (option.values == Values::kEncoding) options.encoding = value == "3" ? 3 : 2;
    return;
  }
  auto report = sink.error(codes::kUnknownOption, ast.source(statement.name), shortened(name));
  std::vector<std::string> names;
  for (const auto& option : kOptions) names.emplace_back(option.name);
  if (const auto near = base::nearest_name(name, names)) {
    report.fix(NameAdvice::replace(name, *near));
  }
}

}  // namespace parallax::compiler
