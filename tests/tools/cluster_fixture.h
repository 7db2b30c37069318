#pragma once

#include <fmt/format.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {

/// Scenarios whose simulator is a coin, and launchers as scripts, in the folder of a fixture.
class Cluster : public CliFixture {
 public:
  Cluster() {
    write("coin.e",
          "sort region\nregion goal, start\nfluent BoxIn(region)\nevent Push()\n"
          "[time] Initiates(Push(),BoxIn(goal),time).\n"
          "[time] Terminates(Push(),BoxIn(start),time).\n"
          "HoldsAt(BoxIn(start),0).\n!HoldsAt(BoxIn(goal),0).\n[time] Happens(Push(),time).\n");
  }

  /// coin.yaml: a discrepancy with probability `p`.
  void coin(double p, const std::string& kind) const {
    write("coin.yaml",
          fmt::format("model: coin.e\nhorizon: 1\nconstraints: [\"HoldsAt(BoxIn(goal),time)\"]\n"
                      "simulator: {{command: [{}, {}, {}, coin.log]}}\n"
                      "regions:\n  cells: {{goal: {{x: [0, 1]}}, start: {{x: [3, 4]}}}}\n"
                      "  gaps: allowed\nmapping:\n  BoxIn(region): {{inside: region, body: box}}\n"
                      "actions:\n  Push(): {{controller: push}}\n"
                      "limits: {{max_lost_in_a_row: 1000}}\n",
                      "\"" PARALLAX_COIN_SIMULATOR "\"", p, kind));
  }

  /// A launcher that is this shell script, whose words are the worker's.
  std::string script(const std::string& name, const std::string& text) const {
    write(name, text + "\n");
    return "sh " + name;
  }

  /// A launcher whose worker greets as `own` does and answers nothing more until a worker has
  /// greeted as `other`: so both take part, however slowly one of them starts. With `once_gone`
  /// the other one must have ended, too, as one does that is refused.
  std::string meets(const std::string& own, const std::string& other, const std::string& launcher,
                    bool once_gone = false) const {
    write(
        "meet.sh",
        "own=$1; other=$2; gone=$3; shift 3\n"
        "\"$@\" | { IFS= read -r line; printf '%s\\n' \"$line\"\n"
        "echo $$ > $own.$$; mv $own.$$ $own.greeted; tries=0\n"
        "until [ -e $other.greeted ] && { [ $gone = 0 ] || ! kill -0 $(cat $other.greeted); }; do\n"
        "  sleep 0.1; tries=$((tries + 1)); [ $tries -lt 600 ] || break\n"
        "done 2>/dev/null\n"
        "exec cat; }\n");
    return fmt::format("sh meet.sh {} {} {:d} {}", own, other, once_gone, launcher);
  }

  /// A launcher that goes wrong in 20 of 100 simulations.
  static std::string unruly(const std::string& kinds = "die,hang,lag") {
    return fmt::format("'{}' {} 20 trouble.log", PARALLAX_UNRULY_LAUNCHER, kinds);
  }

  std::size_t lines_of(const std::string& name) const {
    std::istringstream in(read(name));
    std::size_t count = 0;
    for (std::string line; std::getline(in, line);) ++count;
    return count;
  }
};

/// Files of a run folder in which two of them differ, but for times and the fixture's own folder.
inline std::string differing_files(const CliFixture& one, const CliFixture& other,
                                   const std::string& run) {
  const auto files = [&](const CliFixture& cli) {
    std::map<std::string, std::string> out;
    for (auto [path, text] : files_below(cli.folder() / run)) {
      const auto own = cli.folder().string();
      for (auto at = text.find(own); at != std::string::npos; at = text.find(own, at)) {
        text.replace(at, own.size(), "FOLDER");
      }
      out.emplace(path, without_timing(text));
    }
    return out;
  };
  const auto a = files(one), b = files(other);
  std::string out = a.empty() ? "there is none" : "";
  for (const auto& [path, text] : a) {
    const auto at = b.find(path);
    if (at == b.end() || at->second != text) out += path + '\n';
  }
  for (const auto& [path, text] : b) {
    if (!a.contains(path)) out += path + '\n';
  }
  return out;
}

}  // namespace parallax::test
