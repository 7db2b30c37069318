#include "compiler/lisp/lisp_reader.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>

#include "compiler/lisp/number.h"
#include "tests/support/random.h"

namespace parallax::compiler {
namespace {

using test::Random;

struct LispReading {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::optional<LispText> text;
  /// All forms, printed.
  std::string printed() const {
    std::string out;
    for (const auto form : text->forms) {
      out += (out.empty() ? "" : " ") + print_datum(text->data, form);
    }
    return out;
  }
  std::string place(DatumId id) const {
    const auto source = text->data.source(id);
    const auto at = files[source.file].position(source.begin);
    return std::to_string(at.line) + ":" + std::to_string(at.column);
  }
};

LispReading lisp_reading(std::string text) {
  LispReading out;
  const auto file = out.files.add("plan.lisp", std::move(text));
  if (auto result = read_lisp(out.files, file, out.sink)) out.text = std::move(*result);
  return out;
}

TEST_CASE("reader: every kind of token") {
  struct Case {
    std::string input;
    const char* printed;
  };
  const Case cases[] = {
      {"(Perform ?X :LEFT *Pose*)", "(perform ?x :left *pose*)"},
      {"|Mixed Case| a|B|c \\X", "|Mixed Case| |aBc| |X|"},
      {"exe:perform desig::an cl-tf:make-pose", "exe::perform desig::an cl-tf::make-pose"},
      {"1 -0.2 1.5 0.75d0 1e-3 3/4 +7", "1 -0.2 1.5 0.75d0 0.001 3/4 7"},
      {R"("a \"b\" \\ ~a")", R"("a \"b\" \\ ~a")"},
      {"'x `(a ,b ,@c) #'f",
       "(quote x) (quasiquote (a (unquote b) (unquote-splicing c))) "
       "(function f)"},
      {"(a . b) (a b . (c . d)) (a . (b c)) (a . nil) (a .b 1.5)",
       "(a . b) (a b c . d) (a b c) (a) (a .b 1.5)"},
      {"(a . 'b) `(a . ,b) ((a . 1) . 2)",
       "(a quote b) (quasiquote (a . (unquote b))) ((a . 1) . 2)"},
      {"#\\a #\\Space #\\( ()", "#\\a #\\Space #\\( ()"},
      {"a ; comment ( \n b #| x #| y |# ) |# c", "a b c"},
      {"#+seecer a #-seecer b #+sbcl c #-sbcl d", "a d"},
      {"#+(and seecer (not ros)) x #+(or) y (1 #+nope 2 3)", "x (1 3)"},
      {"#-seecer #.(run) #-seecer #S(p :x 1) z", "z"},
      {"#+sbcl #+seecer a b", "b"},
      {"1+ 1- + - ... |..| /=", nullptr},
      {"(in-package #:demo)", "(in-package demo)"},
      {"\xC3\xA4pfel", "\xC3\xA4pfel"},
      {"|a\\|b| |1| ||", "|a\\|b| |1| ||"},
  };
  for (const auto& one : cases) {
    CAPTURE(one.input);
    const auto reading = lisp_reading(one.input);
    if (one.printed == nullptr) {
      CHECK_FALSE(reading.text.has_value());  // `...` is no symbol
      continue;
    }
    REQUIRE(reading.text.has_value());
    CHECK(reading.printed() == one.printed);
  }
}

TEST_CASE("reader: prefixes are kept apart from names") {
  const auto reading = lisp_reading("(exe:perform x)");
  REQUIRE(reading.text.has_value());
  const auto& data = reading.text->data;
  const auto head = data.children(reading.text->forms[0])[0];
  CHECK(data.name(head) == "perform");
  CHECK(data.package(head) == "exe");
  CHECK(data.head(reading.text->forms[0]) == "perform");
}

TEST_CASE("reader: every datum knows its place") {
  const auto reading = lisp_reading("(a\n  (\xC3\xA4 'b\n\t\"s\"))");
  REQUIRE(reading.text.has_value());
  const auto& data = reading.text->data;
  const auto outer = reading.text->forms[0];
  const auto inner = data.children(outer)[1];
  CHECK(reading.place(outer) == "1:1");
  CHECK(reading.place(inner) == "2:3");
  CHECK(reading.place(data.children(inner)[1]) == "2:6");
  CHECK(reading.place(data.children(data.children(inner)[1])[1]) == "2:7");
  CHECK(reading.place(data.children(inner)[2]) == "3:2");
  CHECK(reading.files.text(data.source(inner)) == "(\xC3\xA4 'b\n\t\"s\")");
  CHECK(reading.files.text(data.source(data.children(inner)[1])) == "'b");
}

std::string first_error(const LispReading& reading) {
  const auto all = reading.sink.sorted();
  REQUIRE_FALSE(all.empty());
  const auto at = reading.files[all[0].range->file].position(all[0].range->begin);
  return std::string(base::info(all[0].code).id) + " " + std::to_string(at.line) + ":" +
         std::to_string(at.column) + " " + all[0].message;
}

TEST_CASE("reader: what cannot be read is reported where it stands") {
  struct Case {
    std::string input;
    std::string error;
  };
  const Case cases[] = {
      {"(a\n(b c)", "CPL001 1:1 cannot read this datum: this list does not end"},
      {"a)\n", "CPL001 1:2 cannot read this datum: unmatched `)`"},
      {"(a \"b)", "CPL001 1:4 cannot read this datum: this string does not end"},
      {"a #| b", "CPL001 1:3 cannot read this datum: this comment does not end"},
      {"|a", "CPL001 1:1 cannot read this datum: this symbol does not end"},
      {"(. b)",
       "CPL001 1:2 cannot read this datum: a dot stands once in a list, behind a datum of it"},
      {"(a . b . c)",
       "CPL001 1:8 cannot read this datum: a dot stands once in a list, behind a datum of it"},
      {"(a . b c)",
       "CPL001 1:4 cannot read this datum: one datum stands behind a dot, and `)` behind that"},
      {"(a .)",
       "CPL001 1:4 cannot read this datum: one datum stands behind a dot, and `)` behind that"},
      {"(a ... b)", "CPL001 1:4 cannot read this datum: a symbol of dots only"},
      {"a . b",
       "CPL001 1:3 cannot read this datum: a dot stands once in a list, behind a datum of it"},
      {"(a ')", "CPL001 1:4 cannot read this datum: nothing follows this prefix"},
      {"'", "CPL001 1:1 cannot read this datum: nothing follows this prefix"},
      {"a:b:c", "CPL001 1:1 cannot read this datum: misplaced `:` in this symbol"},
      {"a:", "CPL001 1:1 cannot read this datum: misplaced `:` in this symbol"},
      {"1/0", "CPL001 1:1 cannot read this datum: this ratio has the denominator 0"},
      {"1e999", "CPL001 1:1 cannot read this datum: this number is out of range"},
      {"#.(x)", "CPL002 1:1 the reader macro `#.` is not in the subset"},
      {"#S(p)", "CPL002 1:1 the reader macro `#S` is not in the subset"},
      {"#2A((1))", "CPL002 1:1 the reader macro `#2A` is not in the subset"},
      {"#(1 2)", "CPL002 1:1 the reader macro `#(` is not in the subset"},
      {"#xFF", "CPL002 1:1 the reader macro `#x` is not in the subset"},
  };
  for (const auto& one : cases) {
    CAPTURE(one.input);
    const auto reading = lisp_reading(one.input);
    CHECK_FALSE(reading.text.has_value());
    CHECK(first_error(reading) == one.error);
  }
}

TEST_CASE("reader: an open list names the form in column 1 that it swallowed") {
  const auto reading = lisp_reading("(defun f ()\n  (a)\n(defun g () 1)\n(defun h () 2)");
  const auto all = reading.sink.sorted();
  REQUIRE(all.size() == 1);
  REQUIRE(all[0].notes.size() == 1);
  CHECK(reading.files[all[0].range->file].position(all[0].notes[0].range->begin).line == 3);
}

TEST_CASE("reader: several errors come out of one run") {
  const auto reading = lisp_reading("#.a (b . c d) #S(d) 1/0");
  CHECK(reading.sink.error_count() == 4);
}

std::string random_text(Random& random) {
  constexpr std::string_view kLetters = "abzAZ019?*-+/.:|\\\"'`,;#()[] \t\n&<=>~\xC3\xA4";
  std::string out;
  for (auto length = random.below(6); length > 0; --length) {
    const char c = kLetters[random.below(static_cast<std::uint32_t>(kLetters.size()))];
    out += c;
  }
  return out;
}

Number random_number(Random& random) {
  const auto small = static_cast<std::int64_t>(random.below(2001)) - 1000;
  switch (random.below(4)) {
    case 0:
      return Number(small);
    case 1:
      return *Number::ratio(small, static_cast<std::int64_t>(random.below(999)) + 1);
    case 2:
      return Number(std::int64_t{1} << 62) * Number(small + 5000);
    default:
      return Number::inexact(static_cast<double>(small) / 7.0);
  }
}

DatumId random_datum(LispData& data, Random& random, int depth) {
  const base::SourceRange nowhere;
  switch (random.below(depth > 0 ? 8 : 4)) {
    case 0:
      return data.add_named(DatumKind::kSymbol, random_text(random),
                            random.below(3) == 0 ? random_text(random) : "", nowhere);
    case 1: {
      auto name = random_text(random);
      if (name.empty()) name = "k";
      return data.add_named(DatumKind::kKeyword, name, "", nowhere);
    }
    case 2:
      return data.add_named(DatumKind::kString, random_text(random), "", nowhere);
    case 3:
      return data.add_number(random_number(random), nowhere);
    default: {
      std::vector<DatumId> items;
      for (auto count = random.below(5); count > 0; --count) {
        items.push_back(random_datum(data, random, depth - 1));
      }
      return data.add_list(items, nowhere);
    }
  }
}

TEST_CASE("reader: printing a datum and reading it again is the identity") {
  Random random(20240817);
  for (int round = 0; round < 3000; ++round) {
    LispData data;
    const auto datum = random_datum(data, random, 5);
    const auto text = print_datum(data, datum);
    CAPTURE(text);
    const auto reading = lisp_reading(text);
    REQUIRE(reading.text.has_value());
    REQUIRE(reading.text->forms.size() == 1);
    const auto again = reading.text->forms[0];
    REQUIRE(equal_data(data, datum, reading.text->data, again));
    REQUIRE(print_datum(reading.text->data, again) == text);
  }
}

}  // namespace
}  // namespace parallax::compiler
