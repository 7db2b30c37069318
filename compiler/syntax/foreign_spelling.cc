#include "compiler/syntax/foreign_spelling.h"

#include <algorithm>
#include <array>
#include <string>

#include "compiler/base/codes/texts.h"

namespace parallax::compiler {
namespace {

using Kind = ForeignSpelling::Kind;

constexpr std::string_view kImplication = "implication", kEquivalence = "equivalence",
                           kConjunction = "conjunction", kDisjunction = "disjunction",
                           kNegation = "negation", kComment = "the beginning of a comment";

// Longest match first.
constexpr std::array<ForeignSpelling, 26> kSigns = {{
    {"<=>", kEquivalence, "<->", Kind::kOperator, Operator::kIff},
    {"==>", kImplication, "->", Kind::kOperator, Operator::kImplies},
    {"-->", kImplication, "->", Kind::kOperator, Operator::kImplies},
    {"\xE2\x86\x92", kImplication, "->", Kind::kOperator, Operator::kImplies},
    {"\xE2\x86\x94", kEquivalence, "<->", Kind::kOperator, Operator::kIff},
    {"\xE2\x88\xA7", kConjunction, "&", Kind::kOperator, Operator::kAnd},
    {"\xE2\x88\xA8", kDisjunction, "|", Kind::kOperator, Operator::kOr},
    {"\xE2\x89\xA0", "inequality", "!=", Kind::kOperator, Operator::kNotEqual},
    {"\xE2\x89\xA4", "at most", "<=", Kind::kOperator, Operator::kLessEqual},
    {"\xE2\x89\xA5", "at least", ">=", Kind::kOperator, Operator::kGreaterEqual},
    {"=>", kImplication, "->", Kind::kOperator, Operator::kImplies},
    {"==", "equality", "=", Kind::kOperator, Operator::kEqual},
    {"=<", "at most", "<=", Kind::kOperator, Operator::kLessEqual},
    {"<>", "inequality", "!=", Kind::kOperator, Operator::kNotEqual},
    {"~=", "inequality", "!=", Kind::kOperator, Operator::kNotEqual},
    {"\\=", "inequality", "!=", Kind::kOperator, Operator::kNotEqual},
    {"&&", kConjunction, "&", Kind::kOperator, Operator::kAnd},
    {"/\\", kConjunction, "&", Kind::kOperator, Operator::kAnd},
    {"||", kDisjunction, "|", Kind::kOperator, Operator::kOr},
    {"\\/", kDisjunction, "|", Kind::kOperator, Operator::kOr},
    {"//", kComment, ";", Kind::kComment},
    {"\xC2\xAC", kNegation, "!", Kind::kPrefix, Operator::kNot},
    {"~", kNegation, "!", Kind::kPrefix, Operator::kNot},
    {"#count", "a number of instances", "count", Kind::kComment},
    {"#sum", "a sum", "sum", Kind::kComment},
    {"#", kComment, ";", Kind::kComment},
}};

constexpr std::array<ForeignSpelling, 7> kWords = {{
    {"and", kConjunction, "&", Kind::kOperator, Operator::kAnd},
    {"or", kDisjunction, "|", Kind::kOperator, Operator::kOr},
    {"not", kNegation, "!", Kind::kPrefix, Operator::kNot},
    {"implies", kImplication, "->", Kind::kOperator, Operator::kImplies},
    {"iff", kEquivalence, "<->", Kind::kOperator, Operator::kIff},
    {"forall", "`for all`", "[variables]", Kind::kQuantifier},
    {"exists", "`there is`", "{variables}", Kind::kQuantifier},
}};

constexpr ForeignSpelling kComma = {",", kConjunction, "&", Kind::kOperator, Operator::kAnd};
constexpr ForeignSpelling kPercent = {"%", kComment, ";", Kind::kComment};

/// By byte: does a sign begin with it? The lexer asks at every token.
constexpr auto kSignStarts = [] {
  std::array<bool, 256> out{};
  for (const auto& sign : kSigns) out[static_cast<unsigned char>(sign.text.front())] = true;
  return out;
}();

}  // namespace

const ForeignSpelling* foreign_sign(std::string_view text) {
  if (text.empty() || !kSignStarts[static_cast<unsigned char>(text.front())]) return nullptr;
  const auto found = std::find_if(kSigns.begin(), kSigns.end(), [&](const ForeignSpelling& sign) {
    return text.starts_with(sign.text);
  });
  return found == kSigns.end() ? nullptr : &*found;
}

const ForeignSpelling* foreign_word(std::string_view word) {
  const auto found = std::find_if(kWords.begin(), kWords.end(),
                                  [&](const ForeignSpelling& known) { return known.text == word; });
  return found == kWords.end() ? nullptr : &*found;
}

const ForeignSpelling& foreign_comma() { return kComma; }
const ForeignSpelling& foreign_percent() { return kPercent; }

bool is_foreign_formula(std::string_view line) {
  line = line.substr(0, line.find_first_of(";\n"));
  // A declaration is made of names, commas, a colon and one pair of parentheses.
  return line.find_first_of(".&|=<>![{") != std::string_view::npos ||
         std::count(line.begin(), line.end(), '(') > 1;
}

void report_foreign(const ForeignSpelling& spelling, const base::SourceRange& range,
                    base::DiagnosticSink& sink) {
  auto error =
      sink.error(codes::kForeignSpelling, range, spelling.text, spelling.meaning, spelling.own);
  if (spelling.kind == Kind::kQuantifier) {
    error.fix("write `[room,time] ...` for all rooms and times, `{room} ...` for some room");
  } else {
    error.fix("replace `" + std::string(spelling.text) + "` with `" + std::string(spelling.own) +
              "`");
  }
}

}  // namespace parallax::compiler
