// Names, sorts and well-formedness inside formulas.

#include <doctest/doctest.h>

#include "tests/compiler/front_end.h"
#include "tests/compiler/typed_text.h"

namespace parallax::test {
namespace {

// Eleven lines; the formulas below start on line 12.
constexpr const char* kFormulaWorld =
    "sort object\nsort cup: object\nsort room\nsort level: integer\n"
    "range level 0 3\nrange time 0 5\ncup Cup1, Cup2\nroom Hall\n"
    "fluent Filled(cup)\nevent Fill(cup,level)\npredicate P(object)\n";

CheckedText check(const std::string& formulas) { return CheckedText(kFormulaWorld + formulas); }

/// The first axiom as text.
std::string typed(const std::string& formula) {
  const auto checked = check(formula);
  if (!checked.model) return checked.text();
  return TypedText(*checked.model).axiom(checked.model->axioms.at(0));
}

TEST_CASE("formulas keep their structure and lose only unary plus") {
  CHECK(typed("[cup,time] HoldsAt(Filled(cup),time) & time<3 -> P(cup) | !P(Cup1).") ==
        "[cup,time]((HoldsAt(Filled(cup),time) & time<3) -> (P(cup) | !P(Cup1)))");
  CHECK(typed("{level1,level2} level1+2*level2 >= +3 <-> P(Cup1).") ==
        "{level1,level2}((level1+(2*level2))>=3 <-> P(Cup1))");
  CHECK(typed("[time] time > -1 & -time <= 3/2%2.") == "[time](time>-1 & (0-time)<=((3/2)%2))");
  CHECK(typed("Happens(Fill(Cup1,0),0).") == "Happens(Fill(Cup1,0),0)");
  CHECK(typed("Delta: [event,time] !Happens(event,time).") ==
        "Delta: [event,time]!Happens(event,time)");
  CHECK(typed("[time] count{cup: HoldsAt(Filled(cup),time)} >= time.") ==
        "[time]count{cup:HoldsAt(Filled(cup),time)}>=time");
  CHECK(typed("5 < sum{cup,level: 2*level: P(cup) & level>1}.") ==
        "sum{cup,level:(2*level):(P(cup) & level>1)}>5");
  CHECK(typed("[object] {object} P(object).") == "[object]{object}P(object)");
}

TEST_CASE("an inner quantifier of the same name binds its own variable") {
  const auto checked = check("[cup] P(cup) & ({cup} P(cup)) & P(cup).");
  REQUIRE_MESSAGE(checked.model, checked.text());
  const auto& model = *checked.model;
  const auto& all = model.formulas[model.axioms[0].formula];
  const auto& conjunction = model.formulas[all.children[0]];
  const auto variable = [&](compiler::TypedFormulaId atom) {
    return model.terms[model.formulas[atom].terms[0]].variable;
  };
  const auto& inner = model.formulas[conjunction.children[1]];
  CHECK(variable(conjunction.children[0]) == all.variables[0]);
  CHECK(variable(inner.children[0]) == inner.variables[0]);
  CHECK_FALSE(inner.variables[0] == all.variables[0]);
  CHECK(variable(conjunction.children[2]) == all.variables[0]);
}

struct Wrong {
  const char* formula;
  const char* place;
  const char* text;  // something the message says
};

TEST_CASE("wrong names, sorts and shapes are located and explained") {
  const std::vector<Wrong> cases = {
      {"HoldsAt(Filed(Cup1),0).", "E2101 12:9-13", "no fluent `Filed` of 1 argument(s)"},
      {"HoldsAt(Filed(Cup1),0).", "E2101 12:9-13", "fix: replace `Filed` with `Filled`"},
      {"HoldsAt(Filed(Cup1),0).", "E2101 12:9-13", "m.e:9:8-18: note: `Filled(cup)` declared"},
      {"HoldAt(Filled(Cup1),0).", "E2101 12:1-6", "no predicate `HoldAt`"},
      {"P(Cpu1).", "E2101 12:3-6", "no constant `Cpu1`"},
      {"P(Cpu1).", "E2101 12:3-6", "with `Cup1`"},
      {"P(Filled).", "E2101 12:3-8", "write `Filled` with its arguments"},
      {"P(Cup1()).", "E2101 12:3-6", "without parentheses"},
      {"[cup] P(cpu).", "E2102 12:9-11", "with `cup`"},
      {"P(x) & P(x).", "E2102 12:3-3", "variable `x` is not bound"},
      {"[cupp1] P(cupp1).", "E2103 12:2-6", "no sort `cupp` for the variable `cupp1`"},
      {"P(Cup1,Cup2).", "E2104 12:1-12", "`P` takes 1 argument(s), found 2"},
      {"[time] HoldsAt(Filled(),time).", "E2104 12:16-23", "takes 1 argument(s), found 0"},
      {"P(Hall).", "E2105 12:3-6", "has sort `object`, found `Hall` of sort `room`"},
      {"[room] P(room).", "E2105 12:10-13", "found `room` of sort `room`"},
      {"P(3).", "E2105 12:3-3", "of sort `integer`"},
      {"P(1+2).", "E2105 12:3-5", "of sort `integer`"},
      {"Happens(Filled(Cup1),0).", "E2105 12:9-20", "has sort `event`, found `Filled(Cup1)`"},
      {"Happens(Fill(Cup1,Hall),0).", "E2105 12:19-22", "argument 2 of `Fill`"},
      {"Filled(Cup1).", "E2106 12:1-12", "write `HoldsAt(Filled(Cup1),time)`"},
      {"Fill(Cup1,1).", "E2106 12:1-12", "write `Happens(Fill(Cup1,1),time)`"},
      {"Cup1.", "E2106 12:1-4", "found the constant `Cup1`"},
      {"[cup] cup & P(cup).", "E2106 12:7-9", "found the variable `cup`"},
      {"P.", "E2106 12:1-1", "as in `P(object)`"},
      {"3 -> P(Cup1).", "E2106 12:1-1", "found the number `3`"},
      {"[time] time+1.", "E2106 12:8-13", "found the term `time+1`"},
      {"[time] -time.", "E2106 12:8-12", "found the term `-time`"},
      {"[time1,time2] !time1=time2.", "E2107 12:15-20", "write `!(x=y)` or `x!=y`"},
      {"P(P(Cup1)).", "E2107 12:3-9", "found the predicate `P(Cup1)`"},
      {"P(1<2).", "E2107 12:3-5", "found the formula `1<2`"},
      {"P([cup] P(cup)).", "E2107 12:3-14", "found the formula"},
      {"[cup] cup < 3.", "E2108 12:7-9", "`<` needs integers, found `cup` of sort `cup`"},
      {"[cup] cup+1 = 2.", "E2108 12:7-9", "`+` needs integers"},
      {"[cup] -cup = 2.", "E2108 12:8-10", "`-` needs integers"},
      {"Cup1 = Hall.", "E2109 12:1-11", "`Cup1` of sort `cup` cannot equal `Hall`"},
      {"[cup] cup != 3.", "E2109 12:7-14", "of sort `integer`"},
      {"HoldsAt(Filled(Cup1),6).", "E2110 12:22-22", "6 lies outside the range of sort `time`"},
      {"Happens(Fill(Cup1,-1),0).", "E2110 12:19-20", "-1 lies outside"},
      {"[time] time = 0.5.", "E2111 12:15-17", "`0.5` is not an integer"},
      {"[time] time^2 = 4.", "E2112 12:8-13", "`^` is not supported"},
      {"#count{cup: P(cup)} >= 1.", "E1020 12:1-6", "replace `#count` with `count`"},
      {"count{cup; P(cup)}.", "E1025 12:7-9", "not as it should be before the end of the text"},
      {"count{cup: 1: P(cup)} > 1.", "E1025 12:13-13", "before `:`"},
      {"sum{level: P(Cup1)} > 1.", "E1025 12:19-19", "before `}`"},
      {"sum{level: level: 1: P(Cup1)} > 1.", "E1025 12:20-20", "before `:`"},
      {"count{} > 1.", "E1013 12:7-7", "found `}`"},
      {"count{cup: P(cup) > 1.", "E1005 12:22-22", "`{` is not closed before `.`"},
      {"P(count{cup: P(cup)).", "E1005 12:19-19", "`{` is not closed before `)`"},
      {"count{cup: P(cup)}.", "E2115 12:1-18", "not compared with a number"},
      {"count{cup: P(cup)}+1 > 1.", "E2115 12:1-18", "not compared with a number"},
      {"P(count{cup: P(cup)}).", "E2115 12:3-20", "not compared with a number"},
      {"1 < count{cup: P(cup)} & count{cup: P(cup)} = count{object: P(object)}.", "E2115 12:47-70",
       "not compared with a number"},
      {"count{cup: P(cup)} = Hall.", "E2108 12:22-25", "`=` needs integers, found `Hall`"},
      {"sum{cup: cup: P(cup)} = 1.", "E2108 12:10-12", "`sum` needs integers, found `cup`"},
      {"count{cupp: P(cupp)} = 1.", "E2103 12:7-10", "no sort `cupp`"},
      {"count{cup: P(cup)} = 1 & P(cup).", "E2102 12:28-30", "variable `cup`"},
      {"[time] time = 99999999999999999999.", "E1002 12:15-34", "64 bits"},
      {"[time] time = -9223372036854775809.", "E1002 12:16-34", "64 bits"},
      {"[time] time = -(-9223372036854775808).", "E1002 12:15-37", "64 bits"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.formula);
    const auto checked = check(c.formula);
    CHECK(checked.places() == Strings{c.place});
    CHECK_MESSAGE(checked.text().find(c.text) != std::string::npos, checked.text());
  }
}

TEST_CASE("the least number can be written, though its counterpart is none") {
  CHECK(check("[time] time > -9223372036854775808.").model);
  CHECK(check("sort v: integer\nrange v -9223372036854775808 -9223372036854775807\npredicate Q(v)\n"
              "Q(-9223372036854775808).")
            .model);
}

TEST_CASE("several errors in one formula are all reported, and later formulas are checked") {
  const auto checked = check("P(Foo) & P(Bar) & Q(x).\nP(Baz).\nP(Cup1).\n");
  CHECK(checked.places() == Strings{"E2101 12:3-5", "E2101 12:12-14", "E2101 12:19-19",
                                    "E2102 12:21-21", "E2101 13:3-5"});
}

TEST_CASE("variables of wider and overlapping sorts may stand for narrower ones") {
  CHECK(check("[object,time] HoldsAt(Filled(object),time).").model);
  CHECK(check("[cup] P(cup).").model);
  CHECK(check("[time,level] Happens(Fill(Cup1,time),level).").model);
  CHECK(check("sort vessel\nvessel! Cup1\n[vessel,time] HoldsAt(Filled(vessel),time).").model);
}

TEST_CASE("equations compare terms of every sort that share elements") {
  CHECK(check("[event1,event2] event1=event2.").model);
  CHECK(check("[fluent,cup] fluent=Filled(cup).").model);
  CHECK(check("[object] object=Cup1.").model);
  CHECK(check("[time,level] time!=level+1.").model);
  CHECK(check("[event,fluent] event=fluent.").codes() == Strings{"E2109"});
}

TEST_CASE("an existential quantifier over an empty sort is false, which is suspicious") {
  const auto checked = check("sort ghost\n{ghost} P(Cup1).\n[ghost] P(Cup2).\n");
  CHECK(checked.places() == Strings{"W2002 13:2-6"});
  CHECK(checked.model);
}

TEST_CASE("functions: facts with constants become the table, other equations stay axioms") {
  const auto checked = check(
      "function Size(cup): level\nfunction Next(room,level): room\nSize(Cup1)=2.\n"
      "Size(Cup2)=-1.\nNext(Hall,3)=Hall.\nSize(Cup1)=2.\n[cup] Size(cup)<3.\n"
      "2=Size(Cup1).\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  CHECK(checked.places() == Strings{"W2004 15:12-13"});
  const TypedText text(*checked.model);
  Strings values;
  for (const auto& entry : checked.model->function_values) {
    std::string out = checked.model->symbols[entry.function].name;
    for (const auto argument : entry.arguments) out += " " + text.term(argument);
    values.push_back(out + " = " + text.term(entry.value));
  }
  CHECK(values == Strings{"Size Cup1 = 2", "Size Cup2 = -1", "Next Hall 3 = Hall"});
  CHECK(checked.model->axioms.size() == 2);
  const auto twice = check("function Size(cup): level\nSize(Cup1)=2.\nSize(Cup1)=1.\n");
  CHECK(twice.places() == Strings{"E2304 14:1-12"});
}

TEST_CASE("weighted formulas are left out with a warning") {
  const auto checked = check("5: P(Cup1).\n");
  CHECK(checked.codes() == Strings{"W2006"});
  CHECK(checked.model->axioms.empty());
}

TEST_CASE("formulas 10,000 deep are checked without recursion") {
  const std::size_t depth = 10'000;
  std::string quantifiers, chain = "P(Cup1)", sum = "0";
  for (std::size_t i = 0; i < depth; ++i) {
    quantifiers += "[cup] ";
    chain = i % 100 == 0 ? "(" + chain + ") -> P(Cup1)" : chain + " -> P(Cup1)";
    sum += "+1";
  }
  CHECK(check(std::string(depth, '!') + "P(Cup1).").model);
  CHECK(check(quantifiers + "P(cup).").model);
  CHECK(check(chain + ".").model);
  CHECK(check("[level] level < " + sum + ".").model);
  CHECK(check(quantifiers + "[time] Initiates(Fill(cup,1),Filled(cup),time).").model);
}

}  // namespace
}  // namespace parallax::test
