#include "compiler/base/source_file.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "compiler/base/contract.h"
#include "compiler/base/id.h"

namespace parallax::base {
namespace {

TEST_CASE("positions: lines and columns are 1-based, columns count code points") {
  const SourceFile file("f", "ab\n\xC3\xA4x\r\n\nz");
  CHECK(file.position(0) == LineColumn{1, 1});
  CHECK(file.position(2) == LineColumn{1, 3});  // the line break belongs to its line
  CHECK(file.position(3) == LineColumn{2, 1});
  CHECK(file.position(5) == LineColumn{2, 2});
  CHECK(file.position(8) == LineColumn{3, 1});
  CHECK(file.position(9) == LineColumn{4, 1});
  CHECK(file.position(1000) == LineColumn{4, 2});
}

TEST_CASE("positions on lines of any length count every code point before them") {
  const std::string pieces[] = {"a", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\xA4\x96", "\n"};
  std::string text;
  std::vector<std::pair<std::uint32_t, LineColumn>> begins;
  LineColumn here;
  for (std::uint32_t i = 0; i < 12000; ++i) {
    begins.emplace_back(static_cast<std::uint32_t>(text.size()), here);
    const auto& piece = pieces[i % 5000 == 4999 ? 4 : (i * 2654435761U >> 20U) % 4];
    text += piece;
    here = piece == "\n" ? LineColumn{here.line + 1, 1} : LineColumn{here.line, here.column + 1};
  }
  const SourceFile file("f", text);
  CHECK(std::all_of(begins.begin(), begins.end(),
                    [&](const auto& begin) { return file.position(begin.first) == begin.second; }));
  CHECK(file.position(static_cast<std::uint32_t>(text.size())) == here);
}

TEST_CASE("lines come without their end, also CRLF, and beyond the last one empty") {
  const SourceFile file("f", "ab\ncd\r\n\nz");
  CHECK(file.line(1) == "ab");
  CHECK(file.line(2) == "cd");
  CHECK(file.line(3) == "");
  CHECK(file.line(4) == "z");
  CHECK(file.line(5) == "");
  CHECK(file.line(0) == "");
  CHECK(file.line_begin(2) == 3);
  CHECK(file.line_begin(99) == 9);
}

TEST_CASE("an empty text has one empty line") {
  const SourceFile file("f", "");
  CHECK(file.position(0) == LineColumn{1, 1});
  CHECK(file.line(1) == "");
}

TEST_CASE("ranges: text of a range, refused outside the file") {
  SourceFiles files;
  const auto id = files.add("f", "sort agent\n");
  CHECK(files.text({id, 5, 10}) == "agent");
  CHECK(files.place({id, 5, 10}) == "f:1");
  CHECK_THROWS_AS(static_cast<void>(files.text({id, 5, 100})), ContractViolation);
  CHECK_THROWS_AS(static_cast<void>(files[FileId(7)]), ContractViolation);
}

TEST_CASE("views into a text stay valid while files are added") {
  SourceFiles files;
  const auto first = files.add("a", "x");  // short: would move with its string
  const auto view = files[first].text();
  for (int i = 0; i < 1000; ++i) files.add("b", "y");
  CHECK(view.data() == files[first].text().data());
  CHECK(view == "x");
}

struct LetterTag {};
using LetterId = Id<LetterTag>;

TEST_CASE("store: ids are positions in order of adding") {
  Store<LetterId, char> store;
  CHECK(store.empty());
  const auto a = store.add('a');
  const auto b = store.add('b');
  CHECK(store.size() == 2);
  CHECK(store[a] == 'a');
  CHECK(store.id_at(1) == b);
  CHECK(std::string(store.begin(), store.end()) == "ab");
}

}  // namespace
}  // namespace parallax::base
