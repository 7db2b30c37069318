#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {

/// The fixture's folder as a real repository of git.
class GitFixture : public CliFixture {
 public:
  GitFixture() { git({"init", "--quiet", "--initial-branch=main", "."}); }

  std::string git(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(),
                     {"git", "-c", "user.name=Ann", "-c", "user.email=ann@example.org", "-c",
                      "commit.gpgSign=false"});
    ProcessOptions options;
    options.folder = folder().string();
    const auto result = run_process(arguments, options);
    CHECK_MESSAGE(result.code == 0, result.err);
    auto out = result.out;
    while (out.ends_with('\n')) out.pop_back();
    return out;
  }
  /// Everything that is there; its hash.
  std::string commit(const std::string& subject) const {
    git({"add", "--all"});
    git({"commit", "--quiet", "--allow-empty", "--message", subject});
    return git({"rev-parse", "HEAD"});
  }
};

}  // namespace parallax::test
