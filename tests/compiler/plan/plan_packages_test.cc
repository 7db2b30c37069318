#include <doctest/doctest.h>

#include <algorithm>

#include "compiler/base/diagnostic_printer.h"
#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

/// The files of one plan, named 0.lisp, 1.lisp and so on.
Unrolled unroll_files(const Strings& texts, const UnrollOptions& options = {}) {
  Unrolled out;
  std::vector<base::FileId> plan;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    plan.push_back(out.files.add(std::to_string(i) + ".lisp", texts[i]));
  }
  const auto bind = out.files.add("plan.bind", std::string(kBinding));
  const auto binding = parse_plan_binding(out.files, bind, out.sink);
  if (!binding) return out;
  auto graph = unroll_plan(out.files, plan, *binding, LineLocator(), options, out.sink);
  if (graph) out.graph = std::move(*graph);
  return out;
}

/// "CPL060 1.lisp:2 text" of the first error.
std::string first_error(const Unrolled& plan) {
  for (const auto& entry : plan.sink.sorted()) {
    const auto& info = base::info(entry.code);
    if (info.severity != base::Severity::kError) continue;
    const auto place = entry.range ? plan.files.place(*entry.range) : std::string();
    return std::string(info.id) + " " + place + " " + entry.message;
  }
  return {};
}

TEST_CASE("packages: functions and globals of files before and behind are found") {
  const auto plan = unroll_files({"(go-home)", prelude(), "(defun go-home () (go1) (go2))"});
  CHECK(first_error(plan).empty());
  REQUIRE(plan.graph);
  CHECK(plan.events("++") == Strings{"Go(r1)", "Go(r2)", "DONE"});
}

TEST_CASE("packages: a name of two packages is two functions") {
  const Strings files = {
      "(defpackage :a (:use :cpl) (:export #:run #:*p1*))"
      "(defpackage #:demo-b (:use :cpl :a) (:nicknames b) (:shadow run))",
      "(in-package :a)" + prelude() + "(defun run () (go1))",
      "(in-package \"DEMO-B\")"
      "(defun run () (a::go2))"
      "(defun both () (run) (a:run) (b::run) (exe:perform (desig:a motion (type going) (target "
      "*p1*))))",
      "(in-package a)(b::both)"};
  const auto plan = unroll_files(files);
  CHECK(first_error(plan).empty());
  REQUIRE(plan.graph);
  CHECK(plan.events("++++") == Strings{"Go(r2)", "Go(r1)", "Go(r2)", "Go(r1)", "DONE"});
}

TEST_CASE("packages: an entry may carry its package") {
  const Strings files = {"(defpackage a)(defpackage b)", "(in-package a)" + prelude(),
                         "(in-package a)(defun run () (go1))",
                         "(in-package b)(defun run () (a::go2))"};
  for (const auto& [entry, event] : std::vector<std::pair<std::string, std::string>>{
           {"a::run", "Go(r1)"}, {"b:run", "Go(r2)"}, {"a::go2", "Go(r2)"}, {"go1", "Go(r1)"}}) {
    CAPTURE(entry);
    UnrollOptions options;
    options.entry = entry;
    const auto plan = unroll_files(files, options);
    REQUIRE(plan.graph);
    CHECK(plan.events("+") == Strings{event, "DONE"});
  }
}

TEST_CASE("packages: imports, re-exports and local nicknames name the same function") {
  const auto plan =
      unroll_files({"(defpackage a (:export go1 go2))"
                    "(defpackage b (:use a) (:export go1))"
                    "(defpackage c (:import-from b go1) (:local-nicknames (x a)))",
                    "(in-package a)" + prelude(), "(in-package c)(go1)(x:go2)(b:go1)"});
  CHECK(first_error(plan).empty());
  REQUIRE(plan.graph);
  CHECK(plan.events("+++") == Strings{"Go(r1)", "Go(r2)", "Go(r1)", "DONE"});
}

TEST_CASE("packages: keywords and data are the same everywhere") {
  const auto plan = unroll_files(
      {"(defpackage a (:export pick sig))(defpackage b (:use a))", "(in-package a)" + prelude(),
       "(in-package b)(defun target () 1)(defun object () 2)",
       "(in-package a)(defun use (&key target) (if (eq target 'box) (pick) (sig)))",
       "(in-package b)(a::use :target 'box)"
       "(perform (an action (type picking-up) (arm left) (object (an object (name box)))))"});
  CHECK(first_error(plan).empty());
  REQUIRE(plan.graph);
  CHECK(plan.events("++") == Strings{"PickUp(left,box)", "PickUp(left,box)", "DONE"});
}

TEST_CASE("packages: what clashes or is not visible is refused where it stands") {
  struct Case {
    Strings files;
    std::string error;
  };
  const Case cases[] = {
      {{"(defpackage a)", "(defpackage a)(list 1)"},
       "CPL060 1.lisp:1 package `a`: two packages have this name"},
      {{"(defpackage a (:nicknames b))\n(defpackage b)(list 1)"},
       "CPL060 0.lisp:2 package `b`: two packages have this name"},
      {{"(in-package a)(list 1)", "(defpackage a)"},
       "CPL060 1.lisp:1 package `a`: it is entered before it is defined"},
      {{"(defpackage a (:export f))(defpackage b (:export f))\n(defpackage c (:use a b))(list 1)"},
       "CPL060 0.lisp:2 package `c`: `a` and `b` both give it a symbol `f`"},
      {{"(defpackage a (:export f))\n(defpackage c (:use a) (:import-from x f))(list 1)"},
       "CPL060 0.lisp:2 package `c`: `x` and `a` both give it a symbol `f`"},
      {{"(defpackage a)(in-package a)(defun f () 1)", "\n(a:f)"},
       "CPL060 1.lisp:2 package `a`: it does not export `f`"},
      {{"(defpackage a)(in-package a)(defun f () 1)", "\n\n(f)"},
       "CPL010 1.lisp:3 no form or function `f`"},
      {{"(defpackage a)(in-package a)(defvar *v* 1)", "(list *v*)"},
       "CPL004 1.lisp:1 no variable `*v*` here"},
      {{"(defpackage a (:run-this))(list 1)"},
       "CPL060 0.lisp:1 package `defpackage`: no option of this kind is read"},
      {{"(in-package)(list 1)"},
       "CPL060 0.lisp:1 package `in-package`: expected the name of a package"},
      {{"(list 1)", "(list #.(run))", "(list"},
       "CPL002 1.lisp:1 the reader macro `#.` is not in the subset"},
  };
  for (const auto& one : cases) {
    CAPTURE(one.files.back());
    const auto plan = unroll_files(one.files);
    CHECK_FALSE(plan.graph);
    CHECK(first_error(plan) == one.error);
  }
}

TEST_CASE("packages: a binding table names a function of one of two packages") {
  const std::string plan =
      "(defpackage kitchen (:use cl) (:export fetch))(defpackage hall (:use cl))"
      "(in-package kitchen)(defun fetch (?o) (perform (an action (type opening) (object ?o))))"
      "(in-package hall)(defun fetch (?o) (perform (an action (type closing) (object ?o))))"
      "(defun only-here (?o) (fetch ?o))"
      "(cl-user::perform (an action (type fetching) (object (an object (name d1)))))";
  const auto events = [&](const std::string& call) {
    const auto unrolled = unroll(
        plan, {}, std::string(kBinding) + "action kitchen::fetching (:object ?o) -> plan " + call);
    if (!unrolled.graph) return unrolled.codes();
    return unrolled.events("+");
  };
  CHECK(events("kitchen::fetch(?o)") == Strings{"OpenDrawer(d1)", "DONE"});
  CHECK(events("kitchen:fetch (?o)") == Strings{"OpenDrawer(d1)", "DONE"});
  CHECK(events("hall::fetch(?o)") == Strings{"CloseDrawer(d1)", "DONE"});
  CHECK(events("hall::only-here(?o)") == Strings{"CloseDrawer(d1)", "DONE"});
  CHECK(events("only-here(?o)") == Strings{"CloseDrawer(d1)", "DONE"});
  CHECK(events("cellar::fetch(?o)") == Strings{"CPL010"});
  CHECK(events("hall::(?o)") == Strings{"E4001"});
  // An alias may have a prefix as well; it makes no difference.
  const auto alias =
      unroll(prelude() + "(perform (an action (type x:shutting) (object (an object (name d1)))))",
             {}, std::string(kBinding) + "action y::shutting = z::closing");
  REQUIRE(alias.graph.has_value());
  CHECK(alias.events("+") == Strings{"CloseDrawer(d1)", "DONE"});
}

TEST_CASE("packages: many of them, using each other in circles, are bounded") {
  std::string circle;
  for (int i = 0; i < 900; ++i) {
    circle += "(defpackage p" + std::to_string(i) + " (:use p" + std::to_string((i + 1) % 900) +
              ") (:export go1))";
  }
  const auto plan = unroll_files({circle, "(in-package p3)(defun go1 () 1)(go1)"});
  CHECK(first_error(plan).empty());
  std::string many;
  for (int i = 0; i < 2000; ++i) many += "(defpackage p" + std::to_string(i) + ")";
  CHECK(unroll_files({many}).has("CPL060"));
  std::string wide = "(defpackage w (:export";
  for (int i = 0; i < 20000; ++i) wide += " s" + std::to_string(i);
  wide += "))";
  for (int i = 0; i < 900; ++i) wide += "(defpackage u" + std::to_string(i) + " (:use w))";
  CHECK(first_error(unroll_files({wide})).find("packages inherit more than") != std::string::npos);
}

TEST_CASE("packages: a rule finds what Lisp has, whatever another package calls so") {
  const auto plan =
      unroll(prelude() +
             "(in-package :mine)(defun ensure-list (x) (list x x))(in-package :cl-user)"
             "(def-fact-group g (p) (<- (p ?x) (lisp-fun alexandria:ensure-list 1 ?x)))"
             "(when (equal (var-value '?x (car (prolog '(p ?x)))) '(1)) (sig))");
  CHECK(plan.codes().empty());
  CHECK(plan.events("+") == Strings{"Signal()", "DONE"});
}

}  // namespace
}  // namespace parallax::compiler
