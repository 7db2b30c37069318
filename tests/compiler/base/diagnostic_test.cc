#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "compiler/base/codes/files.h"
#include "compiler/base/codes/names.h"
#include "compiler/base/diagnostic_printer.h"

namespace parallax::base {
namespace {

struct Text {
  SourceFiles files;
  FileId file = files.add("dir/a.e", "sort agent\n\tf\xC3\xA4r X\n");
  SourceRange at(std::uint32_t begin, std::uint32_t end) const { return {file, begin, end}; }
};

TEST_CASE("a message that quotes a megabyte is shortened in the middle") {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  sink.error_about(codes::kUsage, "", "no `" + std::string(1'000'000, 'x') + "` here")
      .note("see " + std::string(1'000'000, 'y'));
  const auto text = base::to_text(sink.sorted().front(), files, {});
  CHECK(text.size() < 10'000);
  CHECK(text.find("no `xxx") != std::string::npos);
  CHECK(text.find("xxx` here") != std::string::npos);
}

TEST_CASE("registry: codes are unique, well formed, in order, with help and a lower-case format") {
  std::set<std::string_view> ids;
  for (const auto& info : all_diagnostics()) {
    CAPTURE(info.id);
    CHECK(ids.insert(info.id).second);
    CHECK(info.id.size() >= 5);
    CHECK(!info.help.empty());
    CHECK(!info.format.empty());
    CHECK_FALSE(info.format.ends_with('.'));
    CHECK_FALSE((info.format[0] >= 'A' && info.format[0] <= 'Z' && info.format[1] >= 'a' &&
                 info.format[1] <= 'z'));
    CHECK(&base::info(info.code) == &info);
    CHECK((info.severity == Severity::kWarning) == (info.id[0] == 'W'));
  }
}

TEST_CASE("sink: sorted by file, place and code, without duplicates, unlocated ones first") {
  Text text;
  const auto other = text.files.add("b.e", "x\n");
  DiagnosticSink sink;
  sink.error(codes::kInvalidText, SourceRange{other, 0, 1});
  sink.error(codes::kInvalidText, text.at(5, 6));
  sink.error(codes::kInvalidText, text.at(2, 3));
  sink.error(codes::kInvalidText, text.at(5, 6));
  sink.error_about(codes::kFileNotFound, "c.e", "gone");
  const auto sorted = sink.sorted();
  REQUIRE(sorted.size() == 4);
  CHECK_FALSE(sorted[0].range);
  CHECK(sorted[1].range->begin == 2);
  CHECK(sorted[2].range->begin == 5);
  CHECK(sorted[3].range->file == other);
  CHECK(sink.error_count() == 5);
}

TEST_CASE("sink: errors beyond the limit are counted, not kept, and can still be annotated") {
  Text text;
  DiagnosticSink sink(2);
  for (std::uint32_t i = 0; i < 5; ++i) {
    sink.error(codes::kInvalidText, text.at(i, i + 1)).note("why").fix("how");
  }
  CHECK(sink.error_count() == 5);
  CHECK(sink.sorted().size() == 2);
}

TEST_CASE("sink: warnings beyond the limit are counted, muted ones are not") {
  Text text;
  DiagnosticSink sink(20, 3);
  sink.mute(codes::kWeightedFormula);
  for (std::uint32_t i = 0; i < 5; ++i) {
    sink.warning(codes::kUnusedSort, text.at(i, i + 1), "a").note("kept or not");
    sink.warning(codes::kWeightedFormula, text.at(i, i + 1));
  }
  CHECK(sink.warning_count() == 5);
  CHECK(sink.sorted().size() == 3);
  CHECK_FALSE(sink.has_errors());
  // Errors cannot be muted.
  sink.mute(codes::kInvalidText);
  sink.error(codes::kInvalidText, text.at(0, 1));
  CHECK(sink.error_count() == 1);
}

TEST_CASE("sink: the exit code follows the class of the errors; warnings have none") {
  Text text;
  DiagnosticSink sink;
  CHECK(sink.exit_code() == 0);
  sink.warning(codes::kWeightedFormula, text.at(0, 1));
  CHECK(sink.exit_code() == 0);
  CHECK_FALSE(sink.has_errors());
  sink.error(codes::kInvalidText, text.at(0, 1));
  CHECK(sink.exit_code() == 3);
  sink.error_about(codes::kFileNotFound, "c.e", "gone");
  CHECK(sink.exit_code() == 2);
}

TEST_CASE("result: a failure exists only after a report, and its value may not be taken") {
  DiagnosticSink sink;
  const auto failing = [&]() -> Result<int> {
    return sink.error_about(codes::kUsage, "", "wrong flag");
  };
  auto result = failing();
  CHECK_FALSE(result);
  CHECK(sink.has_errors());
  CHECK_THROWS_AS(static_cast<void>(result.value()), ContractViolation);
  CHECK(*Result<int>(7) == 7);
  DiagnosticSink silent;
  CHECK_THROWS_AS(static_cast<void>(silent.already_reported()), ContractViolation);
}

TEST_CASE("printer: place, code, excerpt with caret, notes and fix") {
  Text text;
  DiagnosticSink sink;
  sink.error(codes::kUnknownSort, text.at(5, 10), "agent")
      .note(text.at(0, 4), "the keyword")
      .note("no place")
      .fix("replace it");
  CHECK(to_text(sink.sorted()[0], text.files, {}) ==
        "dir/a.e:1:6-10: error[E2001]: no sort `agent`\n"
        "    1 | sort agent\n"
        "      |      ^~~~~\n"
        "dir/a.e:1:1-4: note: the keyword\n"
        "note: no place\n"
        "fix: replace it\n");
}

TEST_CASE("printer: columns count code points and a tab is one column") {
  Text text;
  DiagnosticSink sink;
  sink.error(codes::kUnknownSort, text.at(17, 18), "X");
  CHECK(to_text(sink.sorted()[0], text.files, {}) ==
        "dir/a.e:2:6: error[E2001]: no sort `X`\n"
        "    2 |  f\xC3\xA4r X\n"
        "      |      ^\n"
        "help: Declare it with `sort`, or correct the name.\n");
}

TEST_CASE(
    "printer: the advice of the registry, unless there is better, and only if it is asked for") {
  Text text;
  DiagnosticSink sink;
  sink.error(codes::kUnknownSort, text.at(17, 18), "X").help("Ask somebody.");
  const auto diagnostic = sink.sorted()[0];
  const auto ending = [&](const DiagnosticStyle& style) {
    const auto out = to_text(diagnostic, text.files, style);
    return out.substr(out.find("^\n") + 2);
  };
  CHECK(ending({}) == "help: Ask somebody.\n");
  CHECK(ending({.help = false}).empty());
  const auto parsed = nlohmann::json::parse(to_json(sink.sorted(), text.files));
  CHECK(parsed[0]["help"] == "Ask somebody.");
}

TEST_CASE("printer: control bytes, invalid bytes and direction marks are made visible") {
  CHECK(printable("a\x1b[31m") == "a\\u001b[31m");
  CHECK(printable("\xFF") == "\\xff");
  CHECK(printable("\xE2\x80\xAE") == "\\u202e");
  CHECK(printable("\xED\xA0\x80") == "\\xed\\xa0\\x80");  // a surrogate
  CHECK(printable("gr\xC3\xBC\xC3\x9F") == "gr\xC3\xBC\xC3\x9F");
}

TEST_CASE("printer: JSON has the same fields and is JSON whatever the text") {
  Text text;
  DiagnosticSink sink;
  sink.error(codes::kUnknownSort, text.at(5, 10), "a\"\xFF\n").note(text.at(0, 4), "n");
  sink.warning(codes::kWeightedFormula, text.at(12, 13));
  const auto parsed = nlohmann::json::parse(to_json(sink.sorted(), text.files));
  REQUIRE(parsed.size() == 2);
  CHECK(parsed[0]["path"] == "dir/a.e");
  CHECK(parsed[0]["line"] == 1);
  CHECK(parsed[0]["column"] == 6);
  CHECK(parsed[0]["end_column"] == 11);
  CHECK(parsed[0]["code"] == "E2001");
  CHECK(parsed[0]["severity"] == "error");
  CHECK(parsed[0]["notes"][0]["message"] == "n");
  CHECK(parsed[1]["severity"] == "warning");
}

TEST_CASE("colour is used only when asked for") {
  Text text;
  DiagnosticSink sink;
  sink.error(codes::kUnknownSort, text.at(5, 10), "agent");
  CHECK(to_text(sink.sorted()[0], text.files, {}).find('\x1b') == std::string::npos);
  CHECK(to_text(sink.sorted()[0], text.files, {.color = true}).find('\x1b') != std::string::npos);
}

}  // namespace
}  // namespace parallax::base
