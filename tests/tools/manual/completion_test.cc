// Completions by the shells themselves: each loads the script and is asked as if somebody typed.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "tests/tools/manual/help_text.h"

namespace parallax::test {
namespace {

using Words = std::set<std::string>;

Words lines_of(const std::string& text) {
  Words words;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) words.insert(line);
  }
  return words;
}

/// A folder with the scripts, and some files to be found.
class Completions {
 public:
  Completions() {
    std::filesystem::create_directories(cli.folder() / "sub");
    std::filesystem::create_directories(cli.folder() / "scripts");
    for (const auto* shell : {"bash", "zsh", "fish"}) {
      const std::string file = std::string(shell) == "zsh" ? "_parallax" : shell;
      const auto made = cli.parallax({"completion", shell, "-o", "scripts/" + file});
      REQUIRE(made.code == 0);
      CHECK(cli.parallax({"completion", shell}).out == cli.read("scripts/" + file));
    }
  }
  CliFixture cli;

  ProcessResult run(const std::vector<std::string>& command) const {
    ProcessOptions options;
    options.folder = cli.folder().string();
    return run_process(command, options);
  }
};

/// bash, which splits lines at `=`, as it does before it calls a completion.
class Bash : public Completions {
 public:
  /// Completions that bash would offer for the last of these words.
  Words offers(const std::vector<std::string>& line) const {
    std::vector<std::string> command = {
        "bash",
        "--norc",
        "--noprofile",
        "-c",
        "source scripts/bash; COMP_WORDS=(\"$@\"); COMP_CWORD=$((${#COMP_WORDS[@]} - 1));"
        "COMPREPLY=(); _parallax; printf '%s\\n' \"${COMPREPLY[@]}\"",
        "bash",
        "parallax"};
    command.insert(command.end(), line.begin(), line.end());
    const auto result = run(command);
    CHECK(result.code == 0);
    CHECK(result.err.empty());
    return lines_of(result.out);
  }
};

TEST_CASE("bash: the commands, and those that begin so") {
  const Bash bash;
  const auto listed = listed_commands(bash.cli);
  CHECK(bash.offers({""}) == Words(listed.begin(), listed.end()));
  CHECK(bash.offers({"re"}) == Words{"record", "repair", "replay", "replay-adapter", "report"});
  CHECK(bash.offers({"--v"}) == Words{"--version"});
  CHECK(bash.offers({"worke"}).empty());
}

TEST_CASE("bash: of every command the options of its help, and no others") {
  const Bash bash;
  for (const auto& name : listed_commands(bash.cli)) {
    CAPTURE(name);
    const auto help = read_help(bash.cli.parallax({name, "--help"}).out);
    CHECK(bash.offers({name, "-"}) == Words(help.options.begin(), help.options.end()));
    for (const auto& [option, values] : help.values) {
      CHECK_MESSAGE(bash.offers({name, option, ""}) == Words(values.begin(), values.end()), option);
    }
  }
}

TEST_CASE("bash: values, behind a blank and behind the sign") {
  const Bash bash;
  CHECK(bash.offers({"run", "--criterion", "cl"}) == Words{"clean-runs", "clopper-pearson"});
  CHECK(bash.offers({"run", "--color", "=", "a"}) == Words{"always", "auto"});
  CHECK(bash.offers({"run", "--color", "="}) == Words{"always", "auto", "never"});
  CHECK(bash.offers({"run", "--color", "=", ""}) == Words{"always", "auto", "never"});
  // A number is a number: no files, and the word after it is the scenario.
  CHECK(bash.offers({"run", "--seed", ""}).empty());
  CHECK(bash.offers({"run", "--seed", "7", "ed"}) == Words{"edge.yaml"});
  CHECK(bash.offers({"run", "--seed", "=", "7", "ed"}) == Words{"edge.yaml"});
  CHECK(bash.offers({"run", "--resume", "ed"}) == Words{"edge.yaml"});
  CHECK(bash.offers({"completion", ""}) == Words{"bash", "fish", "zsh"});
  CHECK(bash.offers({"ledger", "s"}) == Words{"status"});
  CHECK(bash.offers({"help", "se"}) == Words{"seeds"});
  CHECK(bash.offers({"no-such-command", "x"}).empty());
}

TEST_CASE("bash: files where files are taken, and folders where folders are") {
  const Bash bash;
  bash.cli.write("a name with blanks.yaml", "");
  CHECK(bash.offers({"run", ""}) == Words{"a name with blanks.yaml", "common.yaml", "edge.yaml",
                                          "scenario.yaml", "scripts", "sub", "world.yaml",
                                          "wrong_model.yaml"});
  CHECK(bash.offers({"fmt", "d"}) == Words{"domain.e"});
  CHECK(bash.offers({"fmt", "domain.e", "sta"}) == Words{"start.e"});
  CHECK(bash.offers({"traces", "--plan", "f"}) == Words{"fetch.lisp"});
  bash.cli.write("domain.drat", "");
  CHECK(bash.offers({"traces", "--certify", "=", "d"}) == Words{"domain.drat"});
  CHECK(bash.offers({"traces", "--certify", "d"}) == Words{"domain.e"});
  CHECK(bash.offers({"replay", "s"}) == Words{"scripts", "sub"});
  CHECK(bash.offers({"run", "--out", "s"}) == Words{"scripts", "sub"});
  CHECK(bash.offers({"suite", "--merge", "scripts", "su"}) == Words{"sub"});
  CHECK(bash.offers({"run", "--footprint", "fe"}) == Words{"fetch.lisp"});
  CHECK(bash.offers({"bisect", "HEAD~1", "HEAD", "--", "ed"}) == Words{"edge.yaml"});
}

TEST_CASE("bash: behind -- stands a program, and then what it takes") {
  const Bash bash;
  CHECK(bash.offers({"record", "-o", "x", "--", "prin"}).contains("printf"));
  CHECK(bash.offers({"record", "-o", "x", "--", "cat", "edge.y"}) == Words{"edge.yaml"});
  CHECK(bash.offers({"record", "-o", "x", "--", "--js"}).empty());
}

/// fish says itself what it would offer.
class Fish : public Completions {
 public:
  Words offers(const std::string& line) const {
    const auto result =
        run({"/usr/bin/env", "HOME=" + cli.folder().string() + "/sub", "fish", "--no-config", "-c",
             "source scripts/fish; complete -C " + quoted("parallax " + line)});
    CHECK(result.code == 0);
    CHECK(result.err.empty());
    Words words;
    for (const auto& offer : lines_of(result.out)) words.insert(offer.substr(0, offer.find('\t')));
    return words;
  }

 private:
  static std::string quoted(const std::string& text) { return "'" + text + "'"; }
};

TEST_CASE("fish: commands, options, values and files") {
  if (!is_installed("fish")) {
    MESSAGE("fish is not installed: its completions were not tried");
    return;
  }
  const Fish fish;
  CHECK(fish.run({"fish", "-n", "scripts/fish"}).code == 0);
  const auto listed = listed_commands(fish.cli);
  CHECK(fish.offers("") == Words(listed.begin(), listed.end()));
  for (const auto* name : {"run", "suite", "traces", "ledger", "doctor"}) {
    CAPTURE(std::string(name));
    const auto help = read_help(fish.cli.parallax({name, "--help"}).out);
    Words wanted;
    for (const auto& option : help.options) {
      if (option.starts_with("--")) wanted.insert(option);
    }
    CHECK(fish.offers(std::string(name) + " --") == wanted);
    for (const auto& [option, values] : help.values) {
      if (!option.starts_with("--")) continue;
      CHECK_MESSAGE(fish.offers(std::string(name) + " " + option + " ") ==
                        Words(values.begin(), values.end()),
                    option);
    }
  }
  CHECK(fish.offers("run --criterion=cl") ==
        Words{"--criterion=clean-runs", "--criterion=clopper-pearson"});
  CHECK(fish.offers("run --seed ").empty());
  CHECK(fish.offers("run --seed 7 ed").contains("edge.yaml"));
  CHECK(fish.offers("run --resume ed").contains("edge.yaml"));
  CHECK(fish.offers("replay s") == Words{"scripts/", "sub/"});
  CHECK(fish.offers("completion ") == Words{"bash", "fish", "zsh"});
  CHECK(fish.offers("ledger s").contains("status"));
  CHECK_FALSE(fish.offers("ledger list s").contains("status"));
  CHECK(fish.offers("record -o x -- cat edge.y") == Words{"edge.yaml"});
}

/// zsh has to be interactive: it is given a terminal, and writes down what it would offer.
class Zsh : public Completions {
 public:
  Zsh() { std::filesystem::create_directories(cli.folder() / "home"); }
  Words offers(const std::string& line) const {
    const auto file = cli.folder() / "home" / "offers";
    std::filesystem::remove(file);
    cli.write("home/driver", kDriver);
    cli.write("home/inner", kInner);
    const auto result = run({"/usr/bin/env", "HOME=" + (cli.folder() / "home").string(),
                             "TERM=dumb", "zsh", "-f", "home/driver", "parallax " + line});
    CAPTURE(result.out);
    CAPTURE(result.err);
    CHECK(result.code == 0);
    return lines_of(cli.read("home/offers"));
  }

 private:
  static constexpr const char* kInner = R"(
PROMPT= RPROMPT=
fpath=($PWD/scripts $fpath)
autoload -Uz compinit
compinit -u -D
zstyle ':completion:*' completer _complete
compadd() {
  if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return; fi
  local -a hits
  builtin compadd -O hits "$@"
  print -rl -- $hits >>$HOME/offers
  builtin compadd "$@"
}
finish() { : >>$HOME/offers; : >$HOME/done; }
zle -N finish
bindkey '^I' complete-word
bindkey '^X' finish
: >$HOME/ready
)";
  static constexpr const char* kDriver = R"(
zmodload zsh/zpty
wait_for() {
  local -i i
  for ((i = 0; i < 1200; ++i)); do
    [[ -e $HOME/$1 ]] && return
    sleep 0.05
    zpty -r -t child read_text '*' 2>/dev/null
  done
  print "no $1"
  exit 1
}
rm -f $HOME/ready $HOME/done
zpty -b child zsh -f -i
zpty -w child 'source home/inner'
wait_for ready
sleep 0.1
zpty -n -w child "$1"$'\t\x18'
wait_for done
zpty -d child
)";
};

TEST_CASE("zsh: commands, options, values and files") {
  if (!is_installed("zsh")) {
    MESSAGE("zsh is not installed: its completions were not tried");
    return;
  }
  const Zsh zsh;
  CHECK(zsh.run({"zsh", "-n", "scripts/_parallax"}).code == 0);
  const auto listed = listed_commands(zsh.cli);
  CHECK(zsh.offers("") == Words(listed.begin(), listed.end()));
  for (const auto* name : {"run", "ledger", "doctor"}) {
    CAPTURE(name);
    const auto help = read_help(zsh.cli.parallax({name, "--help"}).out);
    Words wanted;
    for (const auto& option : help.options) {
      if (option.starts_with("--")) wanted.insert(option);
    }
    CHECK(zsh.offers(std::string(name) + " --") == wanted);
  }
  CHECK(zsh.offers("run --criterion cl") == Words{"clean-runs", "clopper-pearson"});
  CHECK(zsh.offers("run --criterion=cl") == Words{"clean-runs", "clopper-pearson"});
  CHECK(zsh.offers("run --seed ").empty());
  CHECK(zsh.offers("run --seed 7 ed") == Words{"edge.yaml"});
  CHECK(zsh.offers("traces --certify=do") == Words{"domain.e"});
  CHECK(zsh.offers("traces --certify do") == Words{"domain.e"});
  CHECK(zsh.offers("replay sc") == Words{"scripts"});
  CHECK(zsh.offers("ledger s") == Words{"status"});
  CHECK(zsh.offers("completion ") == Words{"bash", "fish", "zsh"});
  CHECK(zsh.offers("suite --merge scripts su") == Words{"sub"});
  CHECK(zsh.offers("record -o x -- cat edge.y") == Words{"edge.yaml"});
}

}  // namespace
}  // namespace parallax::test
