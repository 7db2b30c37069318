#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/tools/cluster_fixture.h"

// Commands of the Slurm that tools/cluster-test has started, and the scripts in docs/guide/slurm.

namespace parallax::test {

/// A script that docs/guide/clusters.md names.
inline std::string script_of_page(const std::string& name) {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/guide/slurm/" + name);
  if (!in) throw std::runtime_error("docs/guide/slurm has no script " + name);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A command of Slurm in the fixture's folder, for whose jobs `parallax` is this build's.
inline ProcessResult slurm(const CliFixture& cli, std::vector<std::string> command) {
  const auto path = std::string(PARALLAX_BINARY_DIR) + ":" + std::getenv("PATH");
  command.insert(command.begin(), {"/usr/bin/env", "PATH=" + path});
  ProcessOptions options;
  options.folder = cli.folder().string();
  return run_process(command, options);
}

inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

/// Jobs that have not ended, as `squeue` prints them.
inline std::vector<std::string> jobs(const CliFixture& cli, const std::string& format,
                                     std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"squeue", "-h", "-r", "-o", format});
  const auto found = slurm(cli, more);
  REQUIRE(found.code == 0);
  return lines(found.out);
}

inline void wait_for_no_job(const CliFixture& cli) {
  for (int i = 0; i < 3000 && !jobs(cli, "%i").empty(); ++i) {
    run_process({"sleep", "0.05"});
  }
  CHECK(jobs(cli, "%i %j %T").empty());
}

inline std::string submit(const CliFixture& cli, std::vector<std::string> words) {
  words.insert(words.begin(), {"sbatch", "--parsable"});
  const auto found = slurm(cli, words);
  CAPTURE(found.err);
  REQUIRE(found.code == 0);
  return found.out.substr(0, found.out.find('\n'));
}

inline const std::vector<std::string> kRun = {"run", "scenario.yaml", "--record",
                                              "all", "--out",         "run"};

inline std::vector<std::string> with(std::vector<std::string> words,
                                     const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Lines of a run's journal so far.
inline std::size_t journal_lines(const CliFixture& cli) {
  std::ifstream journal(cli.folder() / "run/journal.ndjson");
  std::size_t count = 0;
  for (std::string line; std::getline(journal, line);) ++count;
  return count;
}

}  // namespace parallax::test
