// parallax_fuzz: random models, compared between parallax, brute force and clingo.

#include <fmt/core.h>

#include <cstdio>
#include <map>

#include "tests/fuzz/differential.h"
#include "tests/fuzz/oracles.h"
#include "tests/fuzz/random_bodies.h"
#include "tests/support/deep.h"
#include "tools/cli/command_line.h"

namespace parallax::test {
namespace {

struct FuzzOptions {
  std::uint64_t seed = 1;
  std::uint64_t count = 1000;
  std::uint64_t deep_count = 0;    // 0: the same
  std::uint64_t large_every = 10;  // every n-th model is of the larger class
  std::size_t max_differences = 5;
  bool clingo = false;
  bool compat = false;
  bool effect_constraints = false;
  bool exclusions = false;
  bool aggregates = false;
  bool bodies = false;
  bool print = false;
  bool no_shrink = false;
};

struct FuzzFigures {
  std::uint64_t left_out = 0;
  std::uint64_t agree = 0, part = 0, refused = 0, mended = 0, differ = 0;
  std::uint64_t with_brute_force = 0, with_clingo = 0, with_traces = 0;
  std::size_t traces = 0;
  std::map<std::string, std::uint64_t> codes;
};

bool is_plausible(const std::string& codes) {
  // A formula that is false whatever happens, one that says nothing, an effect that depends on its
  // own absence, and a comparison of sorts that share no element.
  return codes == "E2109" || codes == "E3016" || codes == "E3003 E3016" || codes == "E3004 E3016" ||
         codes == "E3003 E3004 E3016" || codes == "E3003" || codes == "E3004" ||
         codes == "E3003 E3004";
}

void count(const Comparison& comparison, FuzzFigures& figures) {
  switch (comparison.kind) {
    case Comparison::Kind::kAgree:
      ++figures.agree;
      break;
    case Comparison::Kind::kPart:
      ++figures.part;
      break;
    case Comparison::Kind::kRefused:
      ++figures.refused;
      ++figures.codes[comparison.code];
      return;
    case Comparison::Kind::kLeftOut:
      ++figures.left_out;
      ++figures.codes[comparison.code];
      return;
    case Comparison::Kind::kDiffer:
      ++figures.differ;
      return;
  }
  figures.traces += comparison.traces;
  figures.with_traces += comparison.traces > 0 ? 1 : 0;
  figures.with_brute_force += comparison.brute_force ? 1 : 0;
  figures.with_clingo += comparison.clingo ? 1 : 0;
}

void report(const RandomModel& model, const Comparison& comparison,
            const DifferentialOptions& options, bool shrinks) {
  fmt::print("seed {}: {}\n{}\n", model.seed, comparison.code, comparison.detail);
  if (!shrinks) return fmt::print("{}\n", model.print());
  const auto small = shrink(model, comparison, options);
  const auto last = compare_oracles(small.print(), options);
  fmt::print("--- shrunk: {}\n{}--- whole model\n{}\n", last.detail, small.print(), model.print());
}

/// A refusal for a reason that the generator gives no occasion for is a difference.
Comparison compare(const RandomModel& model, const DifferentialOptions& options) {
  auto comparison = compare_oracles(model.print(), options);
  if (comparison.kind == Comparison::Kind::kRefused && !is_plausible(comparison.code)) {
    comparison.kind = Comparison::Kind::kDiffer;
    comparison.detail = "the generator makes no model that is wrong in this way";
    comparison.code = "refusal " + comparison.code;
  }
  return comparison;
}

/// The printed model has its seed on line 1, then a statement a line.
RandomModel without_lines(RandomModel model, const std::set<std::size_t>& lines) {
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    if (*line < 2 || *line - 2 >= model.statements.size()) continue;
    model.statements.erase(model.statements.begin() + static_cast<std::ptrdiff_t>(*line) - 2);
  }
  return model;
}

bool is_large(const FuzzOptions& options, std::uint64_t seed) {
  return options.clingo && options.large_every != 0 && seed % options.large_every == 0;
}

/// Compares the model and, where formulas are refused, also the model without them. Reports a
/// difference.
void fuzz_one(const RandomModel& model, const DifferentialOptions& comparing, bool shrinks,
              FuzzFigures& figures) {
  auto compared = model;
  auto comparison = compare(compared, comparing);
  count(comparison, figures);
  if (comparison.kind == Comparison::Kind::kRefused) {
    for (int round = 0; round < 4 && comparison.kind == Comparison::Kind::kRefused; ++round) {
      compared = without_lines(compared, comparison.lines);
      comparison = compare(compared, comparing);
    }
    if (comparison.kind == Comparison::Kind::kRefused) return;
    ++figures.mended;
    count(comparison, figures);
  }
  if (comparison.kind == Comparison::Kind::kDiffer) {
    report(compared, comparison, comparing, shrinks);
  }
}

void print(const FuzzFigures& figures) {
  fmt::print("{} models agree ({} with traces, {} traces), {} compared in part\n", figures.agree,
             figures.with_traces, figures.traces, figures.part);
  if (figures.with_brute_force + figures.with_clingo > 0) {
    fmt::print("brute force took part in {}, clingo in {}\n", figures.with_brute_force,
               figures.with_clingo);
  }
  for (const auto& [code, number] : figures.codes) fmt::print("{}: {}\n", code, number);
  fmt::print("{} refused ({} compared without the refused formulas), {} left out, {} differences\n",
             figures.refused, figures.mended, figures.left_out, figures.differ);
}

int fuzz(const FuzzOptions& options) {
  FuzzFigures figures;
  for (std::uint64_t i = 0; i < options.count; ++i) {
    const auto seed = options.seed + i;
    const bool large = is_large(options, seed);
    const auto model =
        options.bodies
            ? random_bodies(seed)
            : random_model(seed, large ? kSolverSize : kBruteForceSize,
                           {options.effect_constraints, options.exclusions, options.aggregates});
    if (options.print) {
      fmt::print("{}", model.print());
      continue;
    }
    DifferentialOptions comparing;
    comparing.clingo = options.clingo;
    comparing.brute_force = !large;
    if (options.exclusions) {
      // The added atoms are too many for all assignments; the statement is the oracle.
      comparing.brute_force = false;
      comparing.max_traces = 200;
    }
    comparing.compat = options.compat;
    fuzz_one(model, comparing, !options.no_shrink, figures);
    if (figures.differ >= options.max_differences) break;
  }
  if (!options.print) print(figures);
  return figures.differ == 0 ? 0 : 1;
}

int run(int argc, char** argv) {
  FuzzOptions options;
  tools::OptionTable table("parallax_fuzz",
                           "Compares parallax with brute force and clingo on random models");
  table.option("--seed", options.seed, "Seed of the first model").show_default();
  table.option("--count", options.count, "Number of models").show_default();
  table.option("--deep-count", options.deep_count, "Number of models where PARALLAX_DEEP=1 is set");
  table
      .option("--large-every", options.large_every,
              "Every n-th seed gives a larger model, for clingo alone; 0: none")
      .show_default();
  table.option("--max-differences", options.max_differences, "Stop after so many").show_default();
  table.flag("--clingo", options.clingo, "Compare with clingo as well, where it is installed");
  table.flag("--compat", options.compat,
             "Compare --compat decreasoner with a second implementation of its rules");
  table.flag("--effect-constraints", options.effect_constraints,
             "Add effect axioms whose conditions mention effects to every model");
  table.flag("--exclusions", options.exclusions,
             "Add events of unequal numbers of arguments and a mutex or xor over them");
  table.flag("--aggregates", options.aggregates, "Put counts and sums into every model");
  table.flag("--bodies", options.bodies,
             "Models of bodies that go from place to place, with preconditions and collisions");
  table.flag("--print", options.print, "Print the models instead of comparing");
  table.flag("--no-shrink", options.no_shrink, "Print differing models as they are");
  const auto line = tools::parse_and_print({table, "", false, {}}, argc, argv);
  if (line.exit_code) return *line.exit_code;
  if (options.clingo && !clingo_is_installed()) {
    fmt::print("clingo 5 is not installed: SKIPPED, brute force alone\n");
    options.clingo = false;
  }
  if (is_deep() && options.deep_count != 0) options.count = options.deep_count;
  std::fflush(stdout);
  return fuzz(options);
}

}  // namespace
}  // namespace parallax::test

int main(int argc, char** argv) { return parallax::test::run(argc, argv); }
