// Option tables: the values that a line sets, the help that is shown, and the lines that are
// refused.

#include "tools/cli/command_line.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace parallax::tools {
namespace {

/// A program with two commands that have every kind of option.
struct Example {
  std::vector<std::string> files, folders, codes;
  std::string form = "text", proof, plan, bind;
  std::int64_t limit = 10;
  std::uint64_t seed = 1;
  double level = 0.9, rate = 1.0;
  int verbosity = 0, horizon = -1;
  bool count = false, form_given = false;
  OptionTable program{"example", "An example."}, list{"list", "Lists"}, secret{"secret", "Hides"};

  Example() {
    program.footer("See the manual.");
    secret.hide();
    list.option("files", files, "Files").required();
    list.option("-I,--include", folders, "Folder").list(ListForm::kOneEachTime);
    list.option("--allow", codes, "Code").list(ListForm::kAsManyAsFollowFromOne);
    list.option("--format", form, "Form")
        .check(OneOf{{"text", "csv"}})
        .show_default()
        .given(form_given);
    list.flag("--proof", proof, "Proof").named_value("[=FILE]");
    list.option("--plan", plan, "Plan").needs("--bind");
    list.option("--bind", bind, "Binding").needs("--plan");
    list.option("--limit", limit, "Limit").check(NonNegative{}).show_default();
    list.option("--rate", rate, "Rate").check(Positive{});
    list.option("--seed", seed, "Seed").check(WholeNumber{0, 99});
    list.option("--level", level, "Level").check(FiniteNumber{0.5, 0.99});
    list.option("--horizon", horizon, "Horizon").check(IntRange{0, 9});
    list.flag("-v,--verbose", verbosity, "Say more");
    list.flag("--count", count, "Count");
  }

  ParsedLine parse(std::vector<std::string> words) {
    words.insert(words.begin(), "example");
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    return parse_command_line({program, "example 1.2", true, {&list, &secret}},
                              static_cast<int>(argv.size()), argv.data());
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("a line fills the targets of its command") {
  Example example;
  const auto line = example.parse({"list",
                                   "a.e",
                                   "-I",
                                   "one",
                                   "b.e",
                                   "-I",
                                   "two",
                                   "--format",
                                   "csv",
                                   "--limit",
                                   "0",
                                   "--seed=7",
                                   "--level",
                                   "0.75",
                                   "--horizon",
                                   "3",
                                   "-vv",
                                   "--count",
                                   "--proof=a.drat",
                                   "--plan",
                                   "p.lisp",
                                   "--bind",
                                   "p.bind"});
  REQUIRE(line.error.empty());
  CHECK_FALSE(line.exit_code);
  CHECK(line.command == std::size_t{0});
  CHECK(example.files == std::vector<std::string>{"a.e", "b.e"});
  CHECK(example.folders == std::vector<std::string>{"one", "two"});
  CHECK(example.form == "csv");
  CHECK(example.form_given);
  CHECK(example.limit == 0);
  CHECK(example.seed == 7);
  CHECK(example.level == 0.75);
  CHECK(example.horizon == 3);
  CHECK(example.verbosity == 2);
  CHECK(example.count);
  CHECK(example.proof == "a.drat");
  CHECK(example.plan == "p.lisp");
}

TEST_CASE("what a line does not name keeps its value") {
  Example example;
  REQUIRE(example.parse({"list", "a.e", "--proof"}).error.empty());
  CHECK(example.form == "text");
  CHECK_FALSE(example.form_given);
  CHECK(example.limit == 10);
  CHECK(example.proof == "true");
}

TEST_CASE("a list takes the words that follow it only where it says so") {
  Example example;
  REQUIRE(example.parse({"list", "a.e", "--allow", "W1", "W2"}).error.empty());
  CHECK(example.codes == std::vector<std::string>{"W1", "W2"});
  CHECK(example.files == std::vector<std::string>{"a.e"});
}

TEST_CASE("a line that does not fit is refused with a reason and the names that were possible") {
  const auto error_of = [](const std::vector<std::string>& words) {
    Example example;
    const auto line = example.parse(words);
    CHECK(line.exit_code.value_or(0) != 0);
    CHECK_FALSE(line.known.empty());
    return line.error;
  };
  CHECK(error_of({}) == "A subcommand is required");
  CHECK(contains(error_of({"list"}), "files is required"));
  CHECK(contains(error_of({"list", "a.e", "--format", "xml"}), "xml not in {text,csv}"));
  CHECK(contains(error_of({"list", "a.e", "--seed", "1x"}), "1x is no whole number from 0 to 99"));
  CHECK(contains(error_of({"list", "a.e", "--level", "nan"}), "nan is no number from 0.5 to 0.99"));
  for (const std::string word : {"-1", "nan", "x"}) {
    CHECK(contains(error_of({"list", "a.e", "--limit=" + word}),
                   "--limit: " + word + " is no number from 0 on"));
  }
  for (const std::string word : {"-1", "0"}) {
    CHECK(contains(error_of({"list", "a.e", "--rate=" + word}),
                   "--rate: " + word + " is no number greater than 0"));
  }
  CHECK(contains(error_of({"list", "a.e", "--horizon", "10"}), "10 not in range 0 to 9"));
  CHECK(contains(error_of({"list", "a.e", "--plan", "p"}), "--plan requires --bind"));
  CHECK(contains(error_of({"list", "a.e", "--cuont"}), "--cuont"));

  Example example;
  const auto line = example.parse({"list", "a.e", "--cuont"});
  CHECK(line.command == std::size_t{0});
  CHECK(std::count(line.known.begin(), line.known.end(), "--count") == 1);
  const auto no_command = example.parse({"lits"});
  CHECK_FALSE(no_command.command);
  CHECK(std::count(no_command.known.begin(), no_command.known.end(), "list") == 1);
}

TEST_CASE("help and version are answers, not errors") {
  Example example;
  const auto version = example.parse({"--version"});
  CHECK(version.exit_code == 0);
  CHECK(version.output == "example 1.2\n");
  CHECK(version.error.empty());
  const auto general = example.parse({"--help"});
  CHECK(general.exit_code == 0);
  CHECK(contains(general.output, "An example."));
  CHECK(contains(general.output, "See the manual."));
  CHECK(contains(general.output, "list"));
  CHECK_FALSE(contains(general.output, "secret"));
  const auto special = example.parse({"list", "--help"});
  CHECK(contains(special.output, "--format TEXT:{text,csv}=text"));
  CHECK(contains(special.output, "--proof [=FILE]"));
}

TEST_CASE("help has options below their headings, commands below their subjects, itself last") {
  Example example;
  bool early = false;
  bool late = false;
  bool inner = false;
  example.list.set_subject("Look");
  CHECK(example.list.heading("First things") == "Options");
  example.list.flag("--early", early, "Early");
  {
    const UnderHeading heading(example.list, "Inner things");
    example.list.flag("--inner", inner, "Inner");
  }
  example.list.flag("--late", late, "Late");
  CHECK(contains(example.parse({"--help"}).output, "\nLook:\n  list "));
  const auto help = example.parse({"list", "--help"}).output;
  const auto first = help.find("\nFirst things:\n  --early");
  REQUIRE(first != std::string::npos);
  CHECK(help.find("  --late", first) < help.find("\n\n", first + 1));
  CHECK(contains(help, "\nInner things:\n  --inner"));
  CHECK(contains(help, "\nOptions:\n  -I,--include"));
  CHECK(help.find("\nGeneral:\n  -h,--help") > help.find("Inner things"));
  CHECK_FALSE(contains(help, "\n\n\n"));
}

}  // namespace
}  // namespace parallax::tools
