#include "compiler/plan/formula_tree.h"

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <array>
#include <string>
#include <vector>

#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

struct Read {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::optional<FormulaTree> tree;

  std::string errors() const {
    std::string out;
    for (const auto& one : sink.sorted()) {
      out += fmt::format("{} {}-{} {}\n", base::info(one.code).id, one.range->begin, one.range->end,
                         one.message);
    }
    return out;
  }
};

Read read_formula(const std::string& text) {
  Read out;
  const auto file = out.files.add("plan.bind", text);
  const base::SourceRange range{file, 0, static_cast<std::uint32_t>(text.size())};
  auto tree = read_formula_tree(range, out.files[file].text(), out.sink);
  if (tree) out.tree = *std::move(tree);
  return out;
}

/// The leaves with their meaning: `x` a name, `x#0` a variable, `?x@0` a parameter, `?x$0` a
/// register.
std::string leaves(const FormulaTree& tree) {
  constexpr std::array<const char*, 4> kMarks = {"", "#", "@", "$"};
  std::string out;
  for (const auto& node : tree.nodes) {
    if (node.kind != NodeKind::kName) continue;
    out += (out.empty() ? "" : " ") + std::string(tree.name(node));
    if (node.leaf == LeafKind::kName) continue;
    out += kMarks[static_cast<std::size_t>(node.leaf)] + std::to_string(node.number);
  }
  return out;
}

/// The formula as the checker receives it, printed.
std::string printed(const FormulaTree& tree) {
  base::SourceFiles files;
  const auto ast = to_ast(tree, files.add("tree", tree.text), files);
  return print_formula(ast.ast, ast.root);
}

/// Values for parameters, in their order.
FormulaTree filled(const FormulaTree& tree, const std::vector<FormulaTree>& values) {
  return with_leaves(tree, [&](const FormulaNode& node) -> std::optional<FormulaTree> {
    if (node.leaf != LeafKind::kParameter) return std::nullopt;
    return values[node.number];
  });
}

TEST_CASE("a formula of a binding knows its variables and parameters") {
  const auto both = read_formula("exists i, j. On(i,j) & forall k. Free(k,?left-arm) | Base(i)");
  CHECK(both.errors().empty());
  REQUIRE(both.tree);
  CHECK(leaves(*both.tree) == "i#0 j#1 i#0 j#1 k#2 k#2 ?left-arm@0 i#0");
  CHECK(printed(*both.tree) == "{i,j} On(i,j) & [k] Free(k,?left-arm) | Base(i)");

  const auto scopes = read_formula("F(i) & (exists i. G(i) & {i} H(i)) & F(i)");
  REQUIRE(scopes.tree);
  CHECK(leaves(*scopes.tree) == "i i#0 i#0 i#1 i#1 i");

  const auto sums = read_formula("count{i: On(i,?x)}>=2 & sum{j: W(j): F(j)}=1 & F(i)");
  REQUIRE(sums.tree);
  CHECK(leaves(*sums.tree) == "i#0 i#0 ?x@0 j#1 j#1 j#1 i");
  CHECK(printed(*sums.tree) == "count{i: On(i,?x)}>=2 & sum{j: W(j): F(j)}=1 & F(i)");

  const auto words = read_formula("exists i j. On(i,j)");
  REQUIRE(words.tree);
  CHECK(leaves(*words.tree) == "i#0 j#1 i#0 j#1");
}

TEST_CASE("a mapped parameter is one leaf, and a quantified variable of its name is none") {
  const auto mapped = read_formula("At(region( ?p ),place) & {gaze} Sees(gaze)");
  REQUIRE(mapped.tree);
  CHECK(leaves(*mapped.tree) == "region( ?p )@0 place@1 gaze#0 gaze#0");
  CHECK(mapped.tree->parameters[0] == FormulaParameter{"?p", "region"});
  CHECK(mapped.tree->parameters[1] == FormulaParameter{"", "place"});
}

TEST_CASE("what is no formula is reported where it stands") {
  CHECK(read_formula("F(?o").errors() ==
        "E1005 2-4 `(` is not closed before the end of the text\n");
  CHECK(read_formula("F(?o)) & (G()").errors() == "E1006 5-6 `)` closes nothing\n");
  CHECK(read_formula("F(?)").errors() == "E1001 2-3 illegal character `?`\n");
  CHECK(read_formula("exists . F(i)").errors() ==
        "E1013 7-8 expected a variable in the quantifier, found `.`\n");
  CHECK(read_formula("F(). G()").errors().starts_with("E10"));
  CHECK(read_formula("At(region(r1))").errors() ==
        "E4001 3-9 expected one variable as the argument of a mapping function, found something "
        "else\n");
  CHECK(read_formula("At(region(place(?p)))").errors().starts_with("E4001 3-9 "));
  CHECK(read_formula("exists ?o. At(?o)").errors() ==
        "E4001 7-9 expected the name of a quantified variable, found `?o`\n");
}

TEST_CASE("values keep the layout, and are not captured by a quantifier of their name") {
  const auto base = read_formula("exists x. Seen( x )  &  Base(?o, ?n)");
  REQUIRE(base.tree);
  const auto tree = filled(*base.tree, {constant_term("x"), constant_term("-12")});
  CHECK(tree.text == "exists x. Seen( x )  &  Base(x, -12)");
  CHECK(leaves(tree) == "x#0 x#0 x");
  // The variable is called otherwise, the constant stays.
  const auto renamed = with_leaves(tree, [](const FormulaNode& node) -> std::optional<FormulaTree> {
    if (node.leaf != LeafKind::kVariable) return std::nullopt;
    return constant_term("thing9000");
  });
  CHECK(renamed.text == "exists thing9000. Seen( thing9000 )  &  Base(x, -12)");
  CHECK(printed(renamed) == "{thing9000} Seen(thing9000) & Base(x,-12)");
}

TEST_CASE("registers are told from constants of the same name") {
  const auto held = read_formula("Held(?a,?b) & !Held(?a,?a)");
  REQUIRE(held.tree);
  const auto tree = filled(*held.tree, {register_term("?i1", ModelValueId(3)), constant_term("?i1"),
                                        constant_term("c"), constant_term("c")});
  CHECK(tree.text == "Held(?i1,?i1) & !Held(c,c)");
  CHECK(registers_in(tree) == std::set<ModelValueId>{ModelValueId(3)});
  CHECK(leaves(tree) == "?i1$3 ?i1 c c");
}

TEST_CASE("formulas are put together with their texts") {
  const std::vector<FormulaTree> arguments = {constant_term("r1"),
                                              register_term("?i2", ModelValueId(0))};
  const auto atom = application("On", arguments);
  CHECK(atom.text == "On(r1,?i2)");
  CHECK(application("E", {}).text == "E()");
  const auto equal = equal_terms(arguments[1], arguments[0]);
  CHECK(equal.text == "?i2=r1");
  const auto quantified = read_formula("exists i. G(i) | F()");
  REQUIRE(quantified.tree);
  const std::vector<FormulaTree> all = {*quantified.tree, atom, *quantified.tree};
  const auto any = disjunction(all);
  CHECK(any.text == "(exists i. G(i) | F()) | (On(r1,?i2)) | (exists i. G(i) | F())");
  CHECK(leaves(any) == "i#0 i#0 r1 ?i2$0 i#1 i#1");
  CHECK(printed(any) == "({i} G(i) | F()) | On(r1,?i2) | {i} G(i) | F()");
  const auto one = disjunction(std::vector<FormulaTree>{atom});
  CHECK(one.text == "(On(r1,?i2))");
  CHECK(printed(one) == "On(r1,?i2)");
  const std::vector<std::string> names = {"item9", "arm9"};
  CHECK(printed(exists(names, atom)) == "{item9,arm9} On(r1,?i2)");
  CHECK(exists(names, atom).text == "{item9,arm9} (On(r1,?i2))");
}

TEST_CASE("a text without blanks has the same tree") {
  const auto pair = read_formula(" Pair( ?a ,\n -1 + 2 ) ");
  REQUIRE(pair.tree);
  const auto tight = without_blanks(*pair.tree);
  CHECK(tight.text == "Pair(?a,-1+2)");
  CHECK(printed(tight) == printed(*pair.tree));
}

}  // namespace
}  // namespace parallax::compiler
