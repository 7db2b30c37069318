// Inputs made to hurt: each must be answered within 2 s and 256 MB, in a process of its own.

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PARALLAX_TEST_INSTRUMENTED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(PARALLAX_TEST_INSTRUMENTED) || !defined(NDEBUG)
constexpr bool kLimitsHold = false;  // instrumented or unoptimised code is another matter
#else
constexpr bool kLimitsHold = true;
#endif
constexpr long kMostKilobytes = 256 * 1024;

struct Answer {
  bool ended = false;  // by itself
  int verdict = 0;     // 0: checked without an error, 1: with one
  double seconds = 0;
  long kilobytes = 0;
};

std::string repeated(std::string_view piece, std::size_t count) {
  std::string out;
  out.reserve(piece.size() * count);
  for (std::size_t i = 0; i < count; ++i) out += piece;
  return out;
}

/// Load, check and print the messages, in a child process.
Answer answer(const std::function<std::string()>& text) {
  const auto child = ::fork();
  if (child == 0) {
    // An endless run is killed by a signal at the CPU limit; a benchmark measures the speed of the
    // others.
    const ::rlimit cpu{60, 60};
    ::setrlimit(RLIMIT_CPU, &cpu);
    base::SourceFiles files;
    base::DiagnosticSink sink;
    const auto file = files.add("hostile.e", text());
    const auto ast = compiler::load_model_text(file, "/nonexistent", {}, files, sink);
    bool good = false;
    if (ast) good = compiler::check_model(*ast, files, sink).has_value();
    std::size_t size = 0;
    for (const auto& d : sink.sorted()) size += base::to_text(d, files, {}).size();
    // Every message is short, whatever the input.
    if (size > 100'000) ::_exit(2);
    ::_exit(good ? 0 : 1);
  }
  int status = 0;
  ::rusage usage{};
  ::wait4(child, &status, 0, &usage);
  Answer out;
  out.ended = WIFEXITED(status);
  out.verdict = out.ended ? WEXITSTATUS(status) : -1;
  out.seconds = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  out.kilobytes = usage.ru_maxrss;
  return out;
}

struct Hostile {
  const char* name;
  int verdict;
  std::function<std::string()> text;
};

constexpr std::size_t kDeep = 100'000;
constexpr std::size_t kLong = 10'000'000;  // bytes

void check_all(const std::vector<Hostile>& cases) {
  for (const auto& c : cases) {
    CAPTURE(c.name);
    const auto got = answer(c.text);
    CHECK(got.ended);
    CHECK(got.verdict == c.verdict);
    if (std::getenv("PARALLAX_SHOW_FIGURES") != nullptr) {
      std::cout << got.seconds << " s " << got.kilobytes / 1024 << " MB " << c.name << "\n";
    }
    if (kLimitsHold) {
      CHECK(got.kilobytes < kMostKilobytes);
    }
  }
}

TEST_CASE("hostile: deep nesting is refused or read, never a crash") {
  const std::string p = "predicate P()\n";
  check_all({
      {"closed parentheses", 1,
       [&] { return p + repeated("(", kDeep) + "P()" + repeated(")", kDeep) + "."; }},
      {"open parentheses", 1, [&] { return p + repeated("(", kDeep); }},
      {"open brackets", 1, [&] { return p + repeated("[", kDeep); }},
      {"open braces", 1, [&] { return p + repeated("{", kDeep); }},
      {"closing parentheses", 1, [&] { return p + repeated(")", kDeep); }},
      {"negations", 1, [&] { return p + repeated("!", kDeep) + "P()."; }},
      {"minus signs", 1, [&] { return p + repeated("-", kDeep) + "1=1."; }},
      {"calls", 1, [&] { return p + repeated("F(", kDeep) + repeated(")", kDeep) + "."; }},
      {"quantifiers", 1, [&] { return p + repeated("[time] ", kDeep) + "P()."; }},
      {"implications", 1, [&] { return p + repeated("P() -> ", kDeep) + "P()."; }},
      {"19,000 negations", 0, [&] { return p + repeated("!", 19'000) + "P()."; }},
      {"19,000 implications", 0, [&] { return p + repeated("P() -> ", 19'000) + "P()."; }},
      {"6,000 conditions of an effect", 0,
       [&] {
         return "range time 0 1\nfluent F()\nevent E()\n" + p + repeated("[time] P() -> (", 6'000) +
                "Initiates(E(),F(),time)" + repeated(")", 6'000) + ".";
       }},
  });
}

TEST_CASE("hostile: long texts are read in linear time") {
  const std::string p = "predicate P()\n";
  check_all({
      {"a comment of 10 MB", 0, [&] { return p + ";" + std::string(kLong, 'x'); }},
      {"a conjunction of 100,000 atoms", 0, [&] { return p + repeated("P() & ", kDeep) + "P()."; }},
      {"a formula of 10 MB", 1, [&] { return p + repeated("P() & ", kLong / 6) + "P()."; }},
      {"a formula of 10 MB of variables", 1, [&] { return p + repeated("a&", kLong / 2) + "a."; }},
      {"an argument list of 10 MB", 1,
       [&] { return p + "P(" + repeated("1,", kLong / 2) + "1)."; }},
      {"10 MB of quantified variables", 1,
       [&] { return p + "[" + repeated("time,", kLong / 5) + "time] P()."; }},
      {"an identifier of 1 MB", 1, [&] { return p + "P(" + std::string(1'000'000, 'X') + ")."; }},
      {"a variable of 1 MB", 1, [&] { return "[" + std::string(1'000'000, 'x') + "] P()."; }},
      {"a sort of 1 MB", 1, [&] { return "range " + std::string(1'000'000, 'x') + " 0 1\n"; }},
      {"a number of 1 MB", 1, [&] { return "1=" + std::string(1'000'000, '1') + "."; }},
      {"10 MB of illegal bytes", 1, [&] { return std::string(kLong, '\xFF'); }},
      {"10 MB of NUL bytes", 1, [&] { return std::string(kLong, '\0'); }},
      {"10 MB of periods", 1, [&] { return std::string(kLong, '.'); }},
      {"5 million stray brackets on lines", 1, [&] { return repeated(")\n", kLong / 2); }},
      {"5 million illegal characters", 1, [&] { return repeated("@ ", kLong / 2); }},
      {"10 MB of blank lines", 0, [&] { return std::string(kLong, '\n'); }},
      {"a million broken statements", 1, [&] { return repeated("sort 1 2\n", 1'000'000); }},
      {"a million undeclared names", 1, [&] { return repeated("P(A).\n", 1'000'000); }},
  });
}

TEST_CASE("hostile: huge models are read, or refused at the place where they get too large") {
  check_all({
      {"a billion timepoints", 0,
       [] { return "range time 0 1000000000\nfluent F()\n[time] HoldsAt(F(),time).\n"; }},
      {"a range of all integers", 0,
       [] {
         return "sort v: integer\nrange v -9223372036854775808 9223372036854775807\n"
                "predicate P(v)\n[v] P(v).\n";
       }},
      {"a million constants on one line", 0,
       [] {
         std::string text = "sort a\na C";
         for (int i = 0; i < 1'000'000; ++i) text += ",C" + std::to_string(i);
         return text + "\n";
       }},
      {"a million constants on their own lines", 0,
       [] {
         std::string text = "sort a\n";
         for (int i = 0; i < 1'000'000; ++i) text += "a C" + std::to_string(i) + "\n";
         return text;
       }},
      {"five variables over a million constants", 0,
       [] {
         std::string text = "sort a\npredicate P(a,a,a,a,a)\na C";
         for (int i = 0; i < 1'000'000; ++i) text += ",C" + std::to_string(i);
         return text + "\n[a1,a2,a3,a4,a5] P(a1,a2,a3,a4,a5).\n";
       }},
      {"a million facts", 1,
       [] { return "sort a\na A\npredicate P(a)\n" + repeated("P(A).\n", 1'000'000); }},
      {"a mutex of 3,000 events", 1,
       [] {
         std::string text = "range time 0 1\nmutex E0", events;
         for (int i = 0; i < 3'000; ++i) {
           events += "event E" + std::to_string(i) + "()\n";
           if (i > 0) text += ",E" + std::to_string(i);
         }
         return events + text + "\n";
       }},
      {"a chain of 20,000 sorts", 1,
       [] {
         // Letters only: base 26.
         const auto name = [](int i) {
           std::string out = "s";
           for (int k = 0; k < 4; ++k, i /= 26) out += static_cast<char>('a' + i % 26);
           return out;
         };
         std::string text;
         for (int i = 0; i < 20'000; ++i) text += "sort " + name(i) + ": " + name(i + 1) + "\n";
         return text;
       }},
  });
}

}  // namespace
}  // namespace parallax::test
