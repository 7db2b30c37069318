// Printing and parsing are inverse, on random trees and on deep ones.

#include "compiler/syntax/printer.h"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <string>

#include "tests/compiler/front_end.h"
#include "tests/compiler/syntax/tree_text.h"
#include "tests/support/random.h"

namespace parallax::test {
namespace {

using compiler::Ast;
using compiler::Node;
using compiler::NodeId;
using compiler::NodeKind;
using compiler::Operator;

constexpr std::string_view kNames = "a time27 Cat _x 0 12 0.5 Happens count sum";

/// Random trees over a text that holds the names.
class Generator {
 public:
  Generator(Ast& ast, Random& random) : ast_(ast), random_(random) {}

  NodeId tree(std::uint32_t size) {
    if (size <= 1) return leaf();
    switch (random_.below(9)) {
      case 0:
        return unary(size);
      case 1:
        return quantifier(size);
      case 2:
        return apply(size);
      case 3:
        return aggregate(size);
      default:
        return binary(size);
    }
  }

 private:
  struct Name {
    std::uint32_t begin, length;
    NodeKind kind;
  };
  static constexpr std::array<Name, 7> kLeaves = {{{0, 1, NodeKind::kName},
                                                   {2, 6, NodeKind::kName},
                                                   {9, 3, NodeKind::kName},
                                                   {13, 2, NodeKind::kName},
                                                   {16, 1, NodeKind::kNumber},
                                                   {18, 2, NodeKind::kNumber},
                                                   {21, 3, NodeKind::kNumber}}};

  NodeId leaf(std::uint32_t choices = 7) {
    const auto& name = kLeaves.at(random_.below(choices));
    Node node;
    node.kind = name.kind;
    node.begin = name.begin;
    node.name_length = name.length;
    return ast_.add(node);
  }

  NodeId unary(std::uint32_t size) {
    constexpr std::array<Operator, 3> kPrefixes = {Operator::kNot, Operator::kNegate,
                                                   Operator::kPlus};
    Node node;
    node.kind = NodeKind::kUnary;
    node.op = kPrefixes.at(random_.below(3));
    const auto child = tree(size - 1);
    return ast_.add(node, &child, 1);
  }

  NodeId quantifier(std::uint32_t size) {
    Node node;
    node.kind = random_.below(2) == 0 ? NodeKind::kForall : NodeKind::kExists;
    std::vector<NodeId> children;
    for (std::uint32_t i = 0; i <= random_.below(3); ++i) children.push_back(leaf(4));
    children.push_back(tree(size - 1));
    return ast_.add(node, children.data(), children.size());
  }

  NodeId aggregate(std::uint32_t size) {
    Node node;
    node.kind = random_.below(2) == 0 ? NodeKind::kCount : NodeKind::kSum;
    node.begin = node.kind == NodeKind::kCount ? 33 : 39;
    node.name_length = node.kind == NodeKind::kCount ? 5 : 3;
    std::vector<NodeId> children;
    for (std::uint32_t i = 0; i <= random_.below(3); ++i) children.push_back(leaf(4));
    if (node.kind == NodeKind::kSum) children.push_back(tree(size / 3));
    children.push_back(tree(size - 1));
    return ast_.add(node, children.data(), children.size());
  }

  NodeId apply(std::uint32_t size) {
    Node node;
    node.kind = NodeKind::kApply;
    node.begin = 25;
    node.name_length = 7;
    std::vector<NodeId> children;
    const auto count = random_.below(4);
    for (std::uint32_t i = 0; i < count; ++i) children.push_back(tree((size - 1) / count));
    return ast_.add(node, children.data(), children.size());
  }

  NodeId binary(std::uint32_t size) {
    Node node;
    node.kind = NodeKind::kBinary;
    node.op = static_cast<Operator>(random_.below(16));
    const bool flat = node.op == Operator::kAnd || node.op == Operator::kOr;
    const auto count = flat ? 2 + random_.below(3) : 2;
    std::vector<NodeId> children;
    for (std::uint32_t i = 0; i < count; ++i) children.push_back(tree((size - 1) / count));
    return ast_.add(node, children.data(), children.size());
  }

  Ast& ast_;
  Random& random_;
};

TEST_CASE("printer: parsing what was printed gives the same tree, for 5,000 random trees") {
  Random random(2026);
  FrontEnd names;
  const auto name_file = names.add(std::string(kNames));
  for (int round = 0; round < 5'000; ++round) {
    Ast ast(name_file, names.files[name_file].text());
    const auto root = Generator(ast, random).tree(1 + random.below(60));
    const auto text = print_formula(ast, root);
    FrontEnd front;
    const auto file = front.add(text);
    const auto parsed = compiler::parse_formula(file, front.files, front.sink);
    REQUIRE_MESSAGE(parsed.has_value(), text << "\n" << front.text());
    REQUIRE_MESSAGE(same_tree(ast, root, parsed->ast, parsed->root), tree_text(ast, root) << "\n"
                                                                                          << text);
    REQUIRE(print_formula(parsed->ast, parsed->root) == text);
  }
}

TEST_CASE("printer: no parenthesis is printed that could be left out") {
  const Strings formulas = {"A() -> B() -> C()",
                            "A() -> (B() -> C())",
                            "(A() & B()) & C()",
                            "A() & {x} B() | C()",
                            "(A() & {x} B()) | C()",
                            "({x} P(x)) -> Q()",
                            "!(a=b)",
                            "-a+b",
                            "2*(-a)*b",
                            "a-(b-c)",
                            "(a<b)<c",
                            "!{x} P(x) & Q(x)",
                            "count{x,y: {z} P(x,y,z) | Q()}>=1 & sum{x: 2*W(x): P(x)}+1<3"};
  for (const auto& formula : formulas) {
    FrontEnd front;
    const auto file = front.add(formula);
    const auto parsed = compiler::parse_formula(file, front.files, front.sink);
    REQUIRE(parsed);
    auto printed = print_formula(parsed->ast, parsed->root);
    if (formula == "(A() & {x} B()) | C()") {
      CHECK(printed == "A() & ({x} B()) | C()");
    } else {
      CHECK(printed == formula);
    }
  }
}

TEST_CASE("same_tree: tells trees apart by operator, name and shape") {
  const auto tree = [](FrontEnd& front, const char* text) {
    const auto file = front.add(text);
    auto parsed = compiler::parse_formula(file, front.files, front.sink);
    return std::move(*parsed);
  };
  FrontEnd front;
  const auto a = tree(front, "P(x) & Q()");
  const auto same = tree(front, " P( x )&Q( ) ");
  CHECK(same_tree(a.ast, a.root, same.ast, same.root));
  for (const auto* text : {"P(x) | Q()", "P(y) & Q()", "P(x) & Q() & Q()", "P() & Q()", "P(x)"}) {
    const auto other = tree(front, text);
    CHECK_FALSE(same_tree(a.ast, a.root, other.ast, other.root));
  }
}

TEST_CASE("printer: trees 10,000 deep are printed and parsed without recursion") {
  const std::size_t depth = 10'000;
  std::string negations(depth, '!');
  std::string quantifiers, chain = "A()", brackets = "A()";
  for (std::size_t i = 0; i < depth; ++i) {
    quantifiers += "[x] ";
    chain += " -> A()";
  }
  const Strings formulas = {negations + "A()", quantifiers + "A()", chain,
                            std::string(depth, '(') + "A()" + std::string(depth, ')')};
  for (const auto& formula : formulas) {
    FrontEnd front;
    const auto file = front.add(formula);
    const auto parsed = compiler::parse_formula(file, front.files, front.sink);
    REQUIRE_MESSAGE(parsed.has_value(), front.text());
    const auto text = print_formula(parsed->ast, parsed->root);
    FrontEnd again;
    const auto second_file = again.add(text);
    const auto second = compiler::parse_formula(second_file, again.files, again.sink);
    REQUIRE(second);
    CHECK(same_tree(parsed->ast, parsed->root, second->ast, second->root));
  }
}

}  // namespace
}  // namespace parallax::test
