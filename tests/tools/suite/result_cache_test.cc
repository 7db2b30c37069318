#include "tools/suite/result_cache.h"

#include <doctest/doctest.h>

#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

class Workshop {
 public:
  Workshop() { write("model.e", "fluent On()\n"); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder.path() / name) << text;
  }
  std::string path(const std::string& name) const { return (folder.path() / name).string(); }
  CaseResult pass() const {
    InputHashes hashes;
    CaseResult out;
    out.outcome = Outcome::kPassed;
    out.repeatable = true;
    out.answer = "abc";
    out.inputs = {{path("model.e"), hashes.of(path("model.e"))}, {path("gone.e"), ""}};
    return out;
  }
  SuiteCase one(std::int64_t traces = 2) const {
    harness::ManifestCase check;
    check.id = "a";
    check.expect.traces = traces;
    return {"suite.yaml", "a", "suite.yaml", check};
  }
  ResultCache cache(std::uint64_t seed = 1) const {
    return ResultCache(folder.path() / "cache", {"program", seed, false});
  }
  bool hits(const ResultCache& in, const SuiteCase& looked_for) const {
    InputHashes hashes;
    std::size_t damaged = 0;
    const bool found = in.find(looked_for, hashes, damaged).has_value();
    CHECK(damaged == 0);
    return found;
  }

  test::TemporaryFolder folder;
};

TEST_CASE("a pass is found again while its case and its files are the same") {
  const Workshop shop;
  REQUIRE(shop.cache().store(shop.one(), shop.pass()));
  CHECK(shop.hits(shop.cache(), shop.one()));
  CHECK_FALSE(shop.hits(shop.cache(2), shop.one()));  // another seed
  CHECK_FALSE(shop.hits(shop.cache(), shop.one(3)));  // another expectation
  const ResultCache other(shop.folder.path() / "cache", {"other program", 1, false});
  CHECK_FALSE(shop.hits(other, shop.one()));
  shop.write("gone.e", "now it is there");
  CHECK_FALSE(shop.hits(shop.cache(), shop.one()));
  fs::remove(shop.path("gone.e"));
  CHECK(shop.hits(shop.cache(), shop.one()));
  shop.write("model.e", "fluent Off()\n");
  CHECK_FALSE(shop.hits(shop.cache(), shop.one()));
  // Both states of the file are kept beside each other.
  REQUIRE(shop.cache().store(shop.one(), shop.pass()));
  CHECK(shop.hits(shop.cache(), shop.one()));
  shop.write("model.e", "fluent On()\n");
  CHECK(shop.hits(shop.cache(), shop.one()));
}

TEST_CASE("only what would come out the same again is kept") {
  const Workshop shop;
  const auto is_kept = [&](const SuiteCase& one, const CaseResult& result) {
    fs::remove_all(shop.folder.path() / "cache");
    CHECK(shop.cache().store(one, result));
    return fs::exists(shop.folder.path() / "cache");
  };
  CHECK(is_kept(shop.one(), shop.pass()));
  auto result = shop.pass();
  result.outcome = Outcome::kFailed;
  CHECK_FALSE(is_kept(shop.one(), result));
  result = shop.pass();
  result.attempts = 2;
  CHECK_FALSE(is_kept(shop.one(), result));
  result = shop.pass();
  result.repeatable = false;
  CHECK_FALSE(is_kept(shop.one(), result));
  result = shop.pass();
  result.inputs.clear();
  CHECK_FALSE(is_kept(shop.one(), result));
  auto foreign = shop.one();
  foreign.command = {"python3", "simulator.py"};
  CHECK_FALSE(is_kept(foreign, shop.pass()));
}

TEST_CASE("an entry that was changed, cut off or forged is not used") {
  const Workshop shop;
  REQUIRE(shop.cache().store(shop.one(), shop.pass()));
  fs::path entry;
  for (const auto& at : fs::recursive_directory_iterator(shop.folder.path() / "cache")) {
    if (at.is_regular_file()) entry = at.path();
  }
  std::ifstream in(entry);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const auto is_refused = [&](const std::string& changed) {
    std::ofstream(entry) << changed;
    InputHashes hashes;
    std::size_t damaged = 0;
    const bool found = shop.cache().find(shop.one(), hashes, damaged).has_value();
    return !found && damaged == 1;
  };
  auto changed = text;
  changed.replace(changed.find("\"abc\""), 5, "\"abd\"");
  CHECK(is_refused(changed));
  for (std::size_t length = 0; length < text.size() - 1; length += 7) {
    CHECK_MESSAGE(is_refused(text.substr(0, length)), length);
  }
  for (const auto* other :
       {"[]", "{}", "null", "{\"entry\":1,\"sha256\":2}", "{\"entry\":{},\"sha256\":\"x\"}"}) {
    CHECK_MESSAGE(is_refused(other), other);
  }
  std::ofstream(entry) << text;
  CHECK(shop.hits(shop.cache(), shop.one()));
}

TEST_CASE("a cache of one case keeps the last states of its files, not all there ever were") {
  const Workshop shop;
  for (int i = 0; i < 40; ++i) {
    shop.write("model.e", "fluent F" + std::to_string(i) + "()\n");
    REQUIRE(shop.cache().store(shop.one(), shop.pass()));
  }
  std::size_t files = 0;
  for (const auto& at : fs::recursive_directory_iterator(shop.folder.path() / "cache")) {
    files += at.is_regular_file() ? 1 : 0;
  }
  CHECK(files == 16);
  CHECK(shop.hits(shop.cache(), shop.one()));
}

}  // namespace
}  // namespace parallax::tools
