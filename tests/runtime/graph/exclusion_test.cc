// `mutex` and `xor` counted from their definition: in a pair of names the n-th argument of a sort
// is one variable. The disjunction of `xor` numbers arguments only in names that have several. The
// oracle reads the statement itself and knows nothing of its expansion.

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "runtime/graph/trace_count.h"
#include "tests/support/random.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

constexpr int kObjects = 2;

/// Names with their numbers of arguments of one sort, in a statement.
struct Exclusion {
  bool is_xor = false;
  bool are_predicates = false;
  std::vector<int> arities;

  std::string text() const {
    std::string out = "range time 0 0\nsort jar\njar J1, J2\n";
    std::string names;
    for (std::size_t i = 0; i < arities.size(); ++i) {
      const auto name = "N" + std::to_string(i);
      out += (are_predicates ? "predicate " : "fluent ") + name + "(";
      for (int k = 0; k < arities[i]; ++k) out += k > 0 ? ",jar" : "jar";
      out += ")\n";
      names += (i > 0 ? ", " : "") + name;
    }
    return out + (is_xor ? "xor " : "mutex ") + names + "\n";
  }
};

int power(int exponent) { return 1 << exponent; }  // of kObjects

/// The number of the instance of name `i` whose arguments are the first bits of `assignment`.
int instance(const Exclusion& exclusion, std::size_t i, int assignment) {
  int before = 0;
  for (std::size_t k = 0; k < i; ++k) before += power(exclusion.arities[k]);
  return before + assignment % power(exclusion.arities[i]);
}

bool excludes_pairs(const Exclusion& exclusion, int state, int assignment) {
  int true_names = 0;
  for (std::size_t i = 0; i < exclusion.arities.size(); ++i) {
    true_names += state >> instance(exclusion, i, assignment) & 1;
  }
  return true_names <= 1;
}

/// The only argument of a name is the variable `jar`, the last bit; others are jar1, jar2, ...
bool has_one(const Exclusion& exclusion, int state, int assignment, int jar) {
  for (std::size_t i = 0; i < exclusion.arities.size(); ++i) {
    const int chosen = exclusion.arities[i] == 1 ? jar : assignment;
    if ((state >> instance(exclusion, i, chosen) & 1) != 0) return true;
  }
  return false;
}

/// Assigns every instance a truth value in all ways and keeps those that the definition admits.
int count_by_definition(const Exclusion& exclusion) {
  const auto& arities = exclusion.arities;
  const int variables = *std::max_element(arities.begin(), arities.end());
  const int instances = std::accumulate(arities.begin(), arities.end(), 0,
                                        [](int sum, int arity) { return sum + power(arity); });
  int admitted = 0;
  for (int state = 0; state < 1 << instances; ++state) {
    bool fits = true;
    for (int assignment = 0; assignment < power(variables) && fits; ++assignment) {
      fits = excludes_pairs(exclusion, state, assignment);
      for (int jar = 0; jar < kObjects && fits && exclusion.is_xor; ++jar) {
        fits = has_one(exclusion, state, assignment, jar);
      }
    }
    admitted += fits ? 1 : 0;
  }
  return admitted;
}

long count_by_parallax(const Exclusion& exclusion) {
  const TextModel model(exclusion.text());
  REQUIRE(model.ground != nullptr);
  runtime::TraceQuery query;
  query.distinct = runtime::Distinct::kAll;
  return runtime::count_traces(model.compiled, query).count.get_si();
}

TEST_CASE("names with one and two arguments of a sort share the first one") {
  // Each jar is full, or has any of the two beside it, or neither: 5 states a jar.
  CHECK(count_by_definition({false, false, {2, 1}}) == 25);
  CHECK(count_by_parallax({false, false, {2, 1}}) == 25);
}

TEST_CASE("random mutex and xor statements admit what their definition admits") {
  static_assert(kObjects == 2, "instances are numbered in bits");
  Random random(7);
  for (int i = 0; i < 120; ++i) {
    Exclusion exclusion;
    exclusion.is_xor = random.below(3) == 0;
    exclusion.are_predicates = random.below(4) == 0;
    const auto names = 2 + random.below(3);
    for (std::size_t k = 0; k < static_cast<std::size_t>(names); ++k) {
      exclusion.arities.push_back(static_cast<int>(random.below(3)));
    }
    CAPTURE(exclusion.text());
    CHECK(count_by_parallax(exclusion) == count_by_definition(exclusion));
  }
}

}  // namespace
}  // namespace parallax::test
