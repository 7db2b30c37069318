// Declared ranges at both ends of the 64-bit integers, through every command that takes a model. A
// loop over a range that tests its end after counting on never ends there, or counts around.

#include <doctest/doctest.h>

#include <array>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/tools/manual/help_text.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

using Words = std::vector<std::string>;

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PARALLAX_TEST_INSTRUMENTED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(PARALLAX_TEST_INSTRUMENTED)
constexpr const char* kBounds = "exec \"$@\"";  // its shadow takes terabytes
#else
constexpr const char* kBounds = "ulimit -v 2000000; exec \"$@\"";
#endif

/// The program with bounded memory. The time limit only protects from waiting for ever.
ProcessResult bounded(const CliFixture& cli, const Words& words) {
  Words command = {"/bin/sh", "-c", kBounds, "sh", CliFixture::program()};
  command.insert(command.end(), words.begin(), words.end());
  ProcessOptions options;
  options.folder = cli.folder().string();
  options.limit = std::chrono::seconds(120);
  return run_process(command, options);
}

std::string joined(const Words& words) {
  std::string out;
  for (const auto& word : words) out += word + ' ';
  return out;
}

constexpr const char* kLeast = "-9223372036854775808";
constexpr const char* kSecond = "-9223372036854775807";
constexpr const char* kLastButOne = "9223372036854775806";
constexpr const char* kMost = "9223372036854775807";

using Range = std::array<std::string, 2>;
/// Each has two elements, or one; with so few a model means the same wherever they lie.
const std::vector<Range> kPairs = {{kLastButOne, kMost}, {kLeast, kSecond}};
const std::vector<Range> kSingles = {{kMost, kMost}, {kLeast, kLeast}};
/// Too many elements for anything.
const std::vector<Range> kEndless = {{kLeast, kMost}, {"0", kMost}, {kLeast, "0"}};
const Range kPlainPair = {"4", "5"}, kPlainSingle = {"4", "4"};

std::string declared(const Range& range) {
  return "sort level: integer\nrange level " + range[0] + ' ' + range[1] +
         "\nfluent Mark(level)\nevent Lift(level)\npredicate Top(level)\n";
}

/// Quantifiers, comparisons, functions, effects and exclusions, no arithmetic. At most two numbers.
std::string plain(const Range& range) {
  std::string values = "Other(" + range[0] + ")=" + range[1] + ".\n";
  if (range[0] != range[1]) values += "Other(" + range[1] + ")=" + range[0] + ".\n";
  return "range time 0 1\n" + declared(range) + "function Other(level): level\n" + values +
         "[level] HoldsAt(Mark(level),0) -> Top(Other(level)).\n"
         "[level] Top(level) <-> !{level1} level1>level.\n"
         "[level,time] Initiates(Lift(level),Mark(level),time).\n"
         "[level] Top(level) -> !HoldsAt(Mark(level),0).\n"
         "mutex Lift\nmutex Mark\n"
         "minimize sum 1: Happens(Lift(level),time)\n";
}

/// Sums, differences and products at the ends: they may not fit, which is an error at its place.
std::vector<std::string> calculations(const Range& range) {
  const auto with = [&](const std::string& more) {
    return "range time 0 1\n" + declared(range) + more;
  };
  return {with("[level1,level2,time] level2=level1+1 & HoldsAt(Mark(level1),time) ->\n"
               "HoldsAt(Mark(level2),time).\n"),
          with("[level1,level2,time] level2=level1-1 & HoldsAt(Mark(level1),time) ->\n"
               "HoldsAt(Mark(level2),time).\n"),
          with("[level,time] HoldsAt(Mark(level),time) -> level*level>level.\n"),
          with("[level] Top(level+1) -> Top(level-1).\n"),
          with("[level,time] Initiates(Lift(level),Mark(level+1),time).\n"),
          with("minimize sum level: HoldsAt(Mark(level),time)\n"),
          with("[level,time] Happens(Lift(level),time) -> {level1} level1>level+time.\n")};
}

/// Ranges of sorts that mean something of their own.
std::vector<std::string> own_meanings(const Range& range) {
  const auto words = range[0] + ' ' + range[1] + '\n';
  return {"range time " + words + "fluent F()\nevent E()\n[time] Initiates(E(),F(),time).\n",
          "range time 0 1\nrange offset " + words +
              "fluent F()\nfluent G(offset)\nevent E()\n[time] Initiates(E(),F(),time).\n"
              "[offset,time] Trajectory(F(),time,G(offset),offset).\n",
          "range time 0 1\nrange offset 0 1\nsort level: integer\nrange level " + words +
              "range level 0 1\nfluent F(level)\n[level,time] HoldsAt(F(level),time).\n"};
}

/// Calls of every command that takes a model's texts, for `m.e`; `n.e` is the same model.
std::vector<Words> questions() {
  std::vector<Words> out = {
      {"check", "m.e"},
      {"check", "m.e", "--compat", "decreasoner"},
      {"check", "m.e", "--no-lint"},
      {"fmt", "--stdout", "m.e"},
      {"compile", "m.e", "-o", "m.dec.cnf"},
      {"compile", "m.e", "--compat", "decreasoner", "-o", "old.dec.cnf"},
      {"traces", "m.e", "--check"},
      {"traces", "m.e", "--count", "--compat", "decreasoner"},
      {"traces", "m.e", "--count", "--distinct", "all"},
      {"traces", "m.e", "--sample", "2"},
      {"traces", "m.e", "--up-to-symmetry"},
      {"traces", "m.e", "--minimize", "count HoldsAt(Mark(level),time)"},
      {"traces", "m.e", "--minimize", "sum level: HoldsAt(Mark(level),time)"},
      {"traces", "m.e", "--until", "{level} HoldsAt(Mark(level),time)"},
      {"traces", "m.e", "--limit", "0", "--certify=m.drat"},
      {"verify", "m.e", "--property", "{level} HoldsAt(Mark(level),time)"},
      {"verify", "m.e", "--property", "[level] level+1>level"},
      {"consequences", "m.e"},
      {"explain", "m.e"},
      {"diff", "m.e", "n.e"},
      {"suite", "cases.yaml", "--no-cache"},
  };
  for (const auto* format : {"text", "jsonl", "itf", "csv", "decreasoner"}) {
    out.push_back({"traces", "m.e", "--format", format});
  }
  for (const auto* strategy : {"search", "graph", "components", "tree", "guarded", "blocking"}) {
    out.push_back({"traces", "m.e", "--strategy", strategy, "--limit", "0"});
  }
  for (const auto* stage : {"tokens", "ast", "typed", "lp", "cnf"}) {
    out.push_back({"compile", "m.e", std::string("--emit=") + stage});
  }
  return out;
}

class Model : public CliFixture {
 public:
  explicit Model(const std::string& text) {
    write("m.e", text);
    write("n.e", text);
    write("cases.yaml", "cases:\n  - id: m\n    model: m.e\n    expect: {traces: 1}\n");
  }
};

/// Success, a negative answer, or one error or several at their places.
void check_ended(const ProcessResult& result) {
  CAPTURE(result.code);
  CAPTURE(result.err.substr(0, 1000));
  // In the model, or in the formula of an option.
  static const std::regex placed("(m\\.e|--[a-z]+):[0-9]+:[0-9-]+: error\\[E[0-9]+\\]");
  const bool answered = result.code == 0 || result.code == 1;
  const bool refused = result.code == 3 && (std::regex_search(result.err, placed) ||
                                            std::regex_search(result.out, placed));
  CHECK((answered || refused));
}

void check_every_question(const std::string& text) {
  const Model model(text);
  CAPTURE(text);
  for (const auto& words : questions()) {
    CAPTURE(joined(words));
    check_ended(bounded(model, words));
  }
}

/// Everything that the compiler prints on its way; what is about plans needs one.
std::vector<Words> stages(const CliFixture& cli) {
  std::vector<Words> out;
  std::istringstream lines(cli.parallax({"compile", "--emit=help"}).out);
  for (std::string line; std::getline(lines, line);) {
    const auto stage = line.substr(0, line.find(' '));
    if (!stage.starts_with("cfg")) out.push_back({"compile", "m.e", "--emit=" + stage});
  }
  CHECK(out.size() > 20);
  return out;
}

TEST_CASE("a model of few numbers says the same wherever they lie") {
  const auto compare = [](const Range& range, const Range& usual) {
    const Model model(plain(range)), control(plain(usual));
    auto all = questions();
    for (auto& words : stages(control)) all.push_back(std::move(words));
    for (const auto& words : all) {
      CAPTURE(range[0]);
      CAPTURE(joined(words));
      const auto result = bounded(model, words), wanted = bounded(control, words);
      // At an end a sum need not fit, and other programs have smaller numbers.
      const auto line = joined(words);
      if (line.find("sum level") != line.npos || line.find("+1") != line.npos ||
          line.find("--emit=lp") != line.npos) {
        check_ended(result);
        continue;
      }
      CHECK_MESSAGE(result.code == wanted.code, result.err);
      CHECK(result.code < 2);
    }
    for (const auto* distinct : {"observable", "all"}) {
      const Words count = {"traces", "m.e", "--count", "--distinct", distinct};
      CHECK(bounded(model, count).out == bounded(control, count).out);
    }
  };
  for (const auto& range : kPairs) compare(range, kPlainPair);
  for (const auto& range : kSingles) compare(range, kPlainSingle);
}

TEST_CASE("what does not fit is an error at its place, whatever is asked") {
  for (const auto& ranges : {kPairs, kSingles}) {
    for (const auto& range : ranges) {
      for (const auto& text : calculations(range)) check_every_question(text);
    }
  }
}

TEST_CASE("ranges of time and of offsets, and two of one sort") {
  for (const auto& ranges : {kPairs, kSingles}) {
    for (const auto& range : ranges) {
      for (const auto& text : own_meanings(range)) check_every_question(text);
    }
  }
}

TEST_CASE("a range of more numbers than there is memory for is refused at its place") {
  for (const auto& range : kEndless) {
    check_every_question(plain(range));
    for (const auto& text : own_meanings(range)) check_every_question(text);
    const Model model(plain(range));
    for (const Words& words : {Words{"check", "m.e"}, Words{"traces", "m.e", "--count"}}) {
      CHECK(bounded(model, words).code == 3);
    }
  }
}

/// Calls about a scenario and then about its runs, in this order. Its world is a model.
const std::vector<Words> kAboutScenarios = {
    {"check", "two/sticks.yaml"},
    {"traces", "two/sticks.yaml"},
    {"verify", "two/sticks.yaml", "--property", "HoldsAt(Parked(),time)"},
    {"run", "two/sticks.yaml", "--out", "out"},
    {"run", "two/agree.yaml", "--out", "good"},
    {"rates", "two/sticks.yaml", "--runs", "20"},
    {"monitor", "two/sticks.yaml", "out"},
    {"report", "out"},
    {"replay", "out"},
    {"explain", "out"},
    {"confirm", "out"},
    {"coverage", "good"},
    {"export", "out", "-o", "out.csv"},
    {"draw", "two/sticks.yaml", "--out", "pictures"},
    {"prove", "two/sticks.yaml"},
    {"repair", "out"},
    {"learn", "two/agree.yaml", "--out", "learned", "--max-runs", "20"},
    {"diff", "two/sticks.yaml", "two/agree.yaml"},
    {"ledger", "add", "out", "--ledger", "known.yaml"},
    {"ledger", "check", "out", "--ledger", "known.yaml"},
    {"suite", "two", "--no-cache"},
    {"bisect", "HEAD~1", "HEAD", "--", "two/sticks.yaml"},
};

/// The same of one with a physical world.
const std::vector<Words> kAboutPhysics = {
    {"check", "edge.yaml"},
    {"run", "edge.yaml", "--out", "edge"},
    {"threshold", "edge", "--parameter", "box.x"},
    {"draw", "edge", "--out", "drawn"},
    {"replay", "edge", "--record"},
    {"export", "edge", "-o", "moved.csv"},
};

/// Calls that are refused whatever the model says, with their exit codes. The scenarios with a
/// physical world give `export` and `draw` their work; `prove` would need a mobile robot.
const std::map<std::string, int> kRefused = {
    {"export out -o out.csv ", 2},                // nothing moves where the world is a model
    {"draw two/sticks.yaml --out pictures ", 2},  // there is no `world` to draw
    {"prove two/sticks.yaml ", 3},                // nothing of it is known as geometry
};

/// Answered, yes or no or undecided; or refused as listed.
bool is_expected(const Words& words, int code) {
  const auto refused = kRefused.find(joined(words));
  if (refused != kRefused.end()) return code == refused->second;
  return code == 0 || code == 1 || code == 4;
}

/// Two scenarios whose models have such a range, the first one in two revisions.
class Scenarios : public TwoModels {
 public:
  explicit Scenarios(const Range& range) {
    const std::string top = "[level] Top(level) <-> !{level1} level1>level.\n";
    write("two/domain.e", read("two/domain.e") + declared(range) + top +
                              "[level,time] Initiates(Lift(level),Mark(level),time).\n"
                              "[level] !HoldsAt(Mark(level),0).\n"
                              "[level,time] !Happens(Lift(level),time).\n");
    write("domain.e", read("domain.e") + "sort level: integer\nrange level " + range[0] + ' ' +
                          range[1] + "\npredicate Top(level)\n" + top);
    const auto made =
        run_process({"/bin/sh", "-c",
                     "git init -q . && git config user.name n && git config user.email e@x &&"
                     " git add two && git commit -qm one && echo '; two' >> two/start.e &&"
                     " git commit -qam two"},
                    {folder().string(), {}});
    REQUIRE_MESSAGE(made.code == 0, made.err);
  }
};

TEST_CASE("a scenario whose model has such ranges gives every command the same answer") {
  auto all = kAboutScenarios;
  all.insert(all.end(), kAboutPhysics.begin(), kAboutPhysics.end());
  const Scenarios control(kPlainPair);
  std::vector<int> wanted;
  for (const auto& words : all) wanted.push_back(bounded(control, words).code);
  for (const auto& range : kPairs) {
    const Scenarios scenarios(range);
    for (std::size_t i = 0; i < all.size(); ++i) {
      CAPTURE(range[0]);
      CAPTURE(joined(all[i]));
      CAPTURE(wanted[i]);
      CHECK(is_expected(all[i], wanted[i]));
      const auto result = bounded(scenarios, all[i]);
      CHECK_MESSAGE(result.code == wanted[i], result.err);
    }
  }
}

TEST_CASE("a scenario whose model has too many numbers is refused by every command") {
  for (const auto& range : kEndless) {
    const Scenarios scenarios(range);
    auto all = kAboutScenarios;
    all.insert(all.end(), kAboutPhysics.begin(), kAboutPhysics.end());
    for (const auto& words : all) {
      CAPTURE(range[0]);
      CAPTURE(joined(words));
      const auto result = bounded(scenarios, words);
      CHECK_MESSAGE(result.code > 0, result.out);
      CHECK_MESSAGE(result.code < 128, result.err);
    }
  }
}

TEST_CASE("no command that takes a model is left out") {
  const CliFixture cli;
  // They take no model: texts about simulators, the program and its messages.
  std::set<std::string> known = {"new",    "adapter-check", "record",      "replay-adapter",
                                 "doctor", "help",          "diagnostics", "completion",
                                 "man",    "calibrate",     "schema"};
  known.insert("lsp");  // a conversation, which texts of its own begin
  for (const auto& words : questions()) known.insert(words.front());
  for (const auto& words : kAboutScenarios) known.insert(words.front());
  for (const auto& words : kAboutPhysics) known.insert(words.front());
  const auto listed = listed_commands(cli);
  CHECK(listed.size() > 25);
  for (const auto& name : listed) CHECK_MESSAGE(known.contains(name), name);
}

}  // namespace
}  // namespace parallax::test
