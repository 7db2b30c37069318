#include <doctest/doctest.h>

#include "tests/compiler/artifact/written_model.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

std::string with(const std::string& text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, from);
  return text.substr(0, at) + to + text.substr(at + from.size());
}

std::string codes_of(const std::string& text) {
  const ReadText read(text);
  CHECK(bool(read.model) == !read.sink.has_errors());
  return read.codes();
}

}  // namespace

TEST_CASE("a file that is cut off at any line is refused at its end") {
  const auto text = WrittenModel(kReleases).artifact();
  for (std::size_t end = text.find('\n'); end + 1 < text.size(); end = text.find('\n', end + 1)) {
    const ReadText read(text.substr(0, end + 1));
    CHECK_FALSE(read.model);
    CHECK(read.sink.sorted().size() == 1);
  }
  CHECK(codes_of("") == "E6002");
}

TEST_CASE("one changed byte is refused or gives a model that can be written and read again") {
  const auto text = WrittenModel(kFall).artifact();
  FuzzRandom random(7);
  std::size_t refused = 0;
  constexpr std::size_t kCount = 2000;
  for (std::size_t i = 0; i < kCount; ++i) {
    auto damaged = text;
    damaged[random.below(text.size())] = static_cast<char>(random.below(256));
    const ReadText read(damaged);
    if (!read.model) {
      ++refused;
      CHECK(read.sink.has_errors());
      continue;
    }
    const auto again = compiler::to_artifact(*read.model);
    const ReadText second(again);
    REQUIRE(second.model);
    CHECK(compiler::to_artifact(*second.model) == again);
  }
  // The accepted damages change no meaning: carriage returns, comments of no entry, the
  // projection's blanks.
  CHECK(refused > kCount * 9 / 10);
}

TEST_CASE("every kind of damage has its message") {
  const auto text = WrittenModel(kReleases).artifact();
  CHECK(codes_of("p cnf 1 1\n1 0\n") == "E6002");
  CHECK(codes_of(with(text, "format 1.0", "format 2.0")) == "E6001");
  CHECK(codes_of(with(text, "format 1.0", "format 1")) == "E6003");
  CHECK(codes_of(with(text, "c dec horizon 3\n", "")) == "E6004");
  CHECK(codes_of(with(text, "c dec horizon 3\n", "c dec horizon 3\nc dec horizon 3\n")) == "E6005");
  CHECK(codes_of(with(text, "c dec horizon 3", "c dec horizon 99999999999999999999")) == "E6006");
  CHECK(codes_of(with(text, "c dec stride ", "c dec stride 9999999")) == "E6012");
  CHECK(codes_of(with(text, "c dec stride ", "c dec colour blue\nc dec stride ")) == "E6003");
  CHECK(codes_of(with(text, "c dec clauses ", "c dec clauses x")) == "E6010");
  CHECK(codes_of(with(text, "\"effect axiom\"", "\"side effect\"")) == "E6003");
  CHECK(codes_of(with(text, "p cnf ", "p cnf 1")) == "E6008");
  CHECK(codes_of(with(text, "c p show ", "c p show 1 ")) == "E6013");
  CHECK(codes_of(with(text, "c dec hash fnv1a64 ", "c dec hash fnv1a64 0")) == "E6003");
  CHECK(codes_of(with(text, "c dec hash", "c dec hash fnv1a64 0123456789abcdef\nc dec hash")) ==
        "E6005");
  CHECK(codes_of(text + "1 0\n") == "E6003");
  CHECK(codes_of(with(text, "c dec fluent Door() ", "c dec fluent In(1) ")) == "E6005");
  auto no_copy = text;  // the last clause is a copy in this model or a fixed one: change its sign
  const auto last = no_copy.rfind('\n', no_copy.size() - 2) + 1;
  no_copy.insert(last, "-9999999 ");
  CHECK(codes_of(no_copy) == "E6006");
}

std::string without_hash(const std::string& text) {
  const auto at = text.find("c dec hash ");
  REQUIRE(at != std::string::npos);
  return text.substr(0, at) + text.substr(text.find('\n', at) + 1);
}

TEST_CASE("a file whose hash was taken out is read; remarks of others do not count") {
  const auto text = WrittenModel(kReleases).artifact();
  const ReadText read(without_hash(text));
  REQUIRE(read.model);
  CHECK(compiler::to_artifact(*read.model) == text);
  CHECK(codes_of(with(text, "c dec stride ", "c kept since Monday\nc dec stride ")) == "");
}

TEST_CASE("a changed sign is found: in a copy by its section, elsewhere by the hash") {
  const auto text = WrittenModel(kReleases).artifact();
  std::size_t copies = 0, others = 0;
  for (auto at = text.find('\n', text.find("c p show")) + 1; at < text.size();
       at = text.find('\n', at) + 1) {
    auto damaged = text;
    if (text[at] == '-') {
      damaged.erase(at, 1);
    } else {
      damaged.insert(at, "-");
    }
    const auto codes = codes_of(damaged);
    CHECK((codes == "E6008" || codes == "E6009"));
    ++(codes == "E6008" ? others : copies);
    CHECK(codes_of(without_hash(damaged)) == (codes == "E6008" ? "" : "E6009"));
  }
  CHECK(copies > 10);
  CHECK(others > 10);
}

TEST_CASE("a newer minor version is read, and what is unknown in it is skipped with a warning") {
  const auto text = WrittenModel(kReleases).artifact();
  auto newer = with(without_hash(text), "format 1.0", "format 1.7");
  newer = with(newer, "c dec stride ", "c dec colour blue\nc dec stride ");
  const ReadText read(newer);
  CHECK(read.model);
  CHECK(read.codes() == "W6011");
}

TEST_CASE("terms of an objective are held against the model") {
  auto text = WrittenModel(kReleases).artifact();
  text = with(without_hash(text), "format 1.0", "format 1.1");
  const auto terms = [&](const std::string& lines) {
    return codes_of(with(text, "c dec axiom ", lines + "c dec axiom "));
  };
  const std::string begin = "c dec objective \"count Happens(event,time)\"\n";
  CHECK(terms(begin).empty());
  CHECK(terms(begin + "c dec term -3 at 2 1\nc dec term 4611686018427387900 at 3\n").empty());
  CHECK(terms("c dec term 1 at 3 1\n") == "E6004");
  CHECK(terms(begin + "c dec term 0 at 3 1\n") == "E6003");
  CHECK(terms(begin + "c dec term one at 3 1\n") == "E6003");
  CHECK(terms(begin + "c dec term 1 3 1\n") == "E6003");
  CHECK(terms(begin + "c dec term 1 at 3 0\n") == "E6003");
  CHECK(terms(begin + "c dec term 1 at 3 1 2\n") == "E6003");
  CHECK(terms(begin + "c dec term 1 at 4 1\n") == "E6006");
  CHECK(terms(begin + "c dec term 1 at 3 1000000\n") == "E6006");
  CHECK(terms(begin + "c dec term 4611686018427387904 at 3 1\n") == "E6006");
  CHECK(terms(begin + "c dec term -4611686018427387903 at 3 1\nc dec term 1 at 3\n") == "E6006");
  // The last variable is of the state at the horizon, which shorter traces do not have.
  const auto header = text.find("p cnf ") + 6;
  const auto last = text.substr(header, text.find(' ', header) - header);
  CHECK(terms(begin + "c dec term 1 at 2 " + last + '\n') == "E6006");
  CHECK(terms(begin + "c dec term 1 at 3 " + last + '\n').empty());
}

TEST_CASE("what the file claims is never believed beyond its size") {
  const auto text = WrittenModel(kReleases).artifact();
  CHECK(codes_of(with(text, "c dec horizon 3", "c dec horizon 1000000")) == "E6012");
  const auto at = text.find("c dec clauses ");
  const auto end = text.find('\n', at);
  const auto space = text.rfind(' ', end);
  const auto huge = text.substr(0, space) + " 4294967295x4294967295" + text.substr(end);
  CHECK(codes_of(huge) == "E6012");
}

}  // namespace parallax::test
