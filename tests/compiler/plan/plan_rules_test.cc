#include <doctest/doctest.h>
#include <fmt/ranges.h>

#include <set>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

/// Two functions, each a perform that tells them apart, and rules.
std::string ruled(std::string_view rules, std::string_view rest) {
  return prelude() + R"(
(defun fetch (&key ((:object ?object)) ((:arms ?arms)) &allow-other-keys)
  (dolist (?arm ?arms)
    (perform (an action (type picking-up) (arm ?arm) (object ?object)))))
(defun carry (?object ?arm)
  (perform (an action (type picking-up) (arm ?arm) (object ?object))))
(def-fact-group rules (desig:action-grounding)
)" + std::string(rules) +
         ")\n" + std::string(rest);
}

constexpr std::string_view kFetch =
    "(perform (an action (type fetching) (object (an object (name spoon1)))))";

TEST_CASE("rules: an action runs the function that its rule names, with its properties by key") {
  const auto plan = unroll(ruled(R"(
  (<- (desig:action-grounding ?action-designator (fetch ?resolved))
    (spec:property ?action-designator (:type :fetching))
    (spec:property ?action-designator (:object ?some))
    (desig:current-designator ?some ?object)
    (-> (spec:property ?action-designator (:arms ?arms))
        (true)
        (equal ?arms (:left :right)))
    (desig:designator :action ((:type :fetching) (:object ?object) (:arms ?arms)) ?resolved)))",
                                 kFetch));
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("++") == Strings{"PickUp(left,spoon1)", "PickUp(right,spoon1)", "DONE"});
}

TEST_CASE("rules: rules of old name the arguments one by one; the first that holds is taken") {
  const auto plan = unroll(ruled(R"(
  (<- (desig:action-grounding ?d (carry ?object :left))
    (spec:property ?d (:type :fetching))
    (spec:property ?d (:heavy t))
    (spec:property ?d (:object ?object)))
  (<- (desig:action-grounding ?d (carry ?object ?arm))
    (spec:property ?d (:type :fetching))
    (spec:property ?d (:object ?object))
    (member ?arm (:right :left)))
  (<- (desig:action-grounding ?d (carry ?object :left))
    (spec:property ?d (:type :fetching))
    (spec:property ?d (:object ?object))))",
                                 kFetch));
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("+") == Strings{"PickUp(right,spoon1)", "DONE"});
}

TEST_CASE("rules: an entry of the binding table is taken before a rule") {
  const auto plan = unroll(ruled(R"(
  (<- (desig:action-grounding ?d (carry ?object :right))
    (spec:property ?d (:type :picking-up))
    (spec:property ?d (:object ?object))))",
                                 "(perform (an action (type picking-up) (arm left) "
                                 "(object (an object (name spoon1)))))"));
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("+") == Strings{"PickUp(left,spoon1)", "DONE"});
}

/// The value that a goal gives ?x, as the type of a detection; "none" if it fails.
void check_goals(const std::vector<std::pair<std::string, std::string>>& cases) {
  for (const auto& one : cases) {
    const auto& goal = one.first;
    const auto& wanted = one.second;
    CAPTURE(goal);
    const auto plan = unroll(prelude() + R"(
(defun note (?x) (perform (a motion (type detecting) (object (an object (type ?x))))))
(defun twice (?n) (* 2 ?n))
(defun sum (&key (a 1) (b a)) (+ a b))
(defun lost (?n) (fail 'object-unreachable))
(defun wrong (?n) (error "no ~a" ?n))
(def-fact-group knowledge ()
  (<- (colour red)) (<- (colour green)) (<- (colour blue))
  (<- (arm left)) (<- (arm right))
  (<- (first-colour ?c) (colour ?c) (cut))
  (<- (path ?a ?b) (edge ?a ?b))
  (<- (path ?a ?c) (edge ?a ?b) (path ?b ?c))
  (<- (edge 1 2)) (<- (edge 2 3)))
(let ((solutions (prolog ')" +
                             goal + R"()))
  (note (if solutions (var-value '?x (lazy-car solutions)) 'none))))");
    for (const auto& entry : plan.sink.sorted()) MESSAGE(entry.message);
    CHECK(plan.codes().empty());
    REQUIRE(plan.graph.has_value());
    const auto events = plan.events("+");
    CHECK(events.front() == "Detect(" + wanted + ")");
  }
}

TEST_CASE("rules: control") {
  check_goals({
      {"(equal ?x 1)", "1"},
      {"(and (colour ?x) (not (equal ?x red)))", "green"},
      {"(or (fail) (equal ?x 2) (equal ?x 3))", "2"},
      {"(and (or (equal ?x 1) (equal ?x 2)) (equal ?x 2))", "2"},
      {"(-> (colour ?c) (equal ?x ?c) (equal ?x none-such))", "red"},
      {"(-> (colour black) (true) (equal ?x other))", "other"},
      // The test's first solution is the only one; then is tried in all its ways.
      {"(and (-> (colour ?c) (equal ?x ?c)) (equal ?x green))", "none"},
      {"(and (*-> (colour ?c) (equal ?x ?c)) (equal ?x green))", "green"},
      {"(and (-> (true) (member ?x (1 2 3))) (> ?x 2))", "3"},
      {"(and (once (colour ?x)) (equal ?x green))", "none"},
      {"(once (or (and (fail) (equal ?x 1)) (equal ?x 2)))", "2"},
      {"(not (equal ?x 1))", "none"},
      {"(and (not (colour black)) (equal ?x 5))", "5"},
      {"(and (first-colour ?x) (equal ?x green))", "none"},
      {"(first-colour ?x)", "red"},
      {"(and (call (colour ?x)) (equal ?x blue))", "blue"},
      {"(and (forall (colour ?c) (member ?c (red green blue))) (equal ?x 1))", "1"},
      {"(and (forall (colour ?c) (member ?c (red green))) (equal ?x 1))", "none"},
      {"(and (path 1 ?x) (equal ?x 3))", "3"},
  });
}

TEST_CASE("rules: terms and lists") {
  check_goals({
      {"(== (?x . ?_) (7 8))", "7"},
      {"(equal (1 ?x) (?_ 2))", "2"},
      {"(and (equal ?y (a . ?z)) (equal ?z (b)) (equal (a ?x) ?y))", "b"},
      {"(and (equal ?y (?y)) (equal ?x 1))", "none"},  // no term stands in itself
      {"(and (findall ?c (colour ?c) ?all) (length ?all ?x))", "3"},
      {"(and (findall ?c (fail) ?all) (length ?all ?x))", "0"},
      {"(and (bagof ?c (fail) ?all) (equal ?x 1))", "none"},
      {"(and (setof ?c (or (colour ?c) (colour ?c)) ?all) (length ?all ?x))", "3"},
      {"(and (setof ?c (colour ?c) (?_ ?x . ?_)))", "green"},
      {"(and (append (1 2) (3) (?_ ?_ ?x)))", "3"},
      {"(and (bound ?x) (equal ?x 1))", "none"},
      {"(and (equal ?x 1) (bound ?x))", "1"},
      {"(and (equal ?y (1 ?z)) (not (ground ?y)) (equal ?x 1))", "1"},
      {"(and (< 1 2 ) (>= 2 2) (not (> 1 2)) (equal ?x 4))", "4"},
      {"(and (equal :left left) (equal ?x 1))", "none"},
  });
}

TEST_CASE("rules: functions of the plan and built-in ones") {
  check_goals({
      {"(lisp-fun twice 4 ?x)", "8"},
      {"(lisp-fun sum :b 5 ?x)", "6"},
      {"(lisp-fun sum :a 5 ?x)", "10"},
      {"(lisp-fun + 1 2 3 ?x)", "6"},
      {"(lisp-fun list 1 2 (?_ ?x))", "2"},
      {"(and (lisp-pred identity 1) (equal ?x 1))", "1"},
      {"(and (lisp-pred identity nil) (equal ?x 1))", "none"},
      // An error in a Lisp function fails the goal.
      {"(or (lisp-fun wrong 1 ?x) (equal ?x 9))", "9"},
      {"(and (lisp-fun make-designator :object () ?d) (lisp-type ?d desig:object-designator) "
       "(equal ?x 1))",
       "1"},
  });
}

TEST_CASE("rules: a failure in a function leaves the perform") {
  const auto plan = unroll(ruled(R"(
  (<- (desig:action-grounding ?d (carry ?object :left))
    (spec:property ?d (:type :fetching))
    (lisp-fun choose ?d ?object)))",
                                 R"(
(defun choose (?d) (fail 'object-unreachable))
(with-failure-handling
    ((object-unreachable (e) (go1) (return)))
)" + std::string(kFetch) + ")"));
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("+") == Strings{"Go(r1)", "DONE"});
}

TEST_CASE("rules: no rule whose conditions hold is a failed designator") {
  const std::string rules = R"(
  (<- (desig:action-grounding ?d (carry ?object :left))
    (spec:property ?d (:type :fetching))
    (spec:property ?d (:heavy t))
    (spec:property ?d (:object ?object))))";
  const auto failed = unroll(ruled(rules, kFetch));
  REQUIRE(failed.graph.has_value());
  CHECK(failed.events("") == Strings{"FAILED(designator-reference-failure)"});
  // Nothing says anything of this type.
  const auto unknown = unroll(ruled(rules, "(perform (an action (type juggling)))"));
  CHECK(unknown.codes() == Strings{"CPL030"});
  // Trying again at one timepoint ends somewhere.
  const auto again = unroll(ruled(
      rules, "(with-failure-handling ((plan-failure (e) (retry))) " + std::string(kFetch) + ")"));
  REQUIRE(again.graph.has_value());
  REQUIRE(again.terminals().size() == 1);
  CHECK(again.terminals()[0].starts_with("BOUND(perform at plan.lisp:"));
}

constexpr std::string_view kQueries = R"(
query robot-free-hand (?arm) ok: HandFree(?arm) @t
query object-in-hand (?o ?arm) ok: Holding(?arm,?o) @t
)";

Unrolled unroll_asking(const std::string& plan) {
  UnrollOptions options;
  options.query_candidates = {{{"left", "right"}}, {{"spoon1", "cup1"}, {"left", "right"}}};
  return unroll(plan, options, std::string(kBinding) + std::string(kQueries));
}

TEST_CASE("rules: what only the model knows is asked, and each answer is a way of its own") {
  const auto plan = unroll_asking(ruled(R"(
  (<- (desig:action-grounding ?d (fetch ?resolved))
    (spec:property ?d (:type :fetching))
    (spec:property ?d (:object ?object))
    (setof ?arm (man-int:robot-free-hand ?arm) ?arms)
    (desig:designator :action ((:type :fetching) (:object ?object) (:arms ?arms)) ?resolved)))",
                                        kFetch));
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  const auto dump = dump_text(*plan.graph, plan.files);
  CHECK(dump.find("HandFree(left)") != std::string::npos);
  CHECK(dump.find("HandFree(right)") != std::string::npos);
  CHECK(plan.terminals() == Strings{"DONE", "FAILED(designator-reference-failure)",
                                    "FAILED(manipulation-pose-unreachable)"});
  // Both hands are free, then one of them.
  CHECK(plan.events("++++") == Strings{"PickUp(left,spoon1)", "PickUp(right,spoon1)", "DONE"});
  CHECK(plan.events("-++") == Strings{"PickUp(right,spoon1)", "DONE"});
  CHECK(plan.events("--") == Strings{"FAILED(designator-reference-failure)"});
}

TEST_CASE("rules: free variables of prolog") {
  const auto plan = unroll_asking(prelude() + R"(
(let ((bindings (car (prolog:prolog '(cpoe:object-in-hand ?object ?arm)))))
  (if bindings
      (cut:with-vars-bound (?object ?arm) bindings
        (perform (an action (type picking-up) (arm ?arm) (object ?object))))
      (go1))))");
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  Strings events;
  for (const auto& location : plan.graph->locations) events.push_back(location.event.text);
  std::sort(events.begin(), events.end());
  CHECK(events == Strings{"Go(r1)", "PickUp(left,cup1)", "PickUp(left,spoon1)",
                          "PickUp(right,cup1)", "PickUp(right,spoon1)"});
  // No object is a hand; a variable that stands twice has one value.
  const auto twice = unroll_asking(prelude() + "(if (prolog '(object-in-hand ?x ?x)) (go1) (go2))");
  REQUIRE(twice.graph.has_value());
  REQUIRE(twice.graph->locations.size() == 1);
  CHECK(twice.graph->locations.begin()->event.text == "Go(r2)");
  const auto length = unroll_asking(prelude() + "(length (prolog '(object-in-hand ?o :left)))");
  CHECK(length.codes() == Strings{"CPL008"});
  const auto all = unroll_asking(prelude() + R"(
(dotimes (i (length (force-ll (prolog '(object-in-hand ?o :left))))) (go1)))");
  CHECK(all.codes().empty());
  REQUIRE(all.graph.has_value());
  CHECK(all.graph->locations.size() == 3);  // twice, once of two, never
}

/// The first events, or ends, that control can come to where exactly the atoms of `facts` hold.
/// Guards are atoms and disjunctions of atoms.
std::set<std::string> first_events(const Unrolled& plan, const std::set<std::string>& facts) {
  const auto holds = [&](std::string guard) {
    std::erase_if(guard, [](char c) { return c == ' '; });
    for (std::size_t begin = 0; begin <= guard.size();) {
      const auto end = std::min(guard.find('|', begin), guard.size());
      auto atom = guard.substr(begin, end - begin);
      if (atom.starts_with('(')) atom = atom.substr(1, atom.size() - 2);
      if (facts.contains(atom)) return true;
      begin = end + 1;
    }
    return false;
  };
  std::set<std::string> out;
  std::vector<PlanTarget> open = {plan.graph->entry};
  while (!open.empty()) {
    const auto where = open.back();
    open.pop_back();
    if (const auto* silent = std::get_if<BranchId>(&where)) {
      const auto& branch = plan.graph->branches[*silent];
      const bool truth = branch.free || holds(branch.guard.text);
      if (truth) open.push_back(branch.if_true);
      if (branch.free || !truth) open.push_back(branch.if_false);
    } else if (const auto* id = std::get_if<LocationId>(&where)) {
      out.insert(plan.graph->locations[*id].event.text);
    } else if (plan.target(where) != "NEVER") {
      out.insert(plan.target(where));
    }
  }
  return out;
}

TEST_CASE("rules: candidates that fail later are tried in one order, and nothing is lost") {
  const Strings objects = {"o1", "o2", "o3", "o4", "o5", "o6", "o7"};
  const auto asking = [&](const std::string& goal) {
    UnrollOptions options;
    options.query_candidates = {{{"left", "right"}}, {objects, {"left", "right"}}};
    auto plan = unroll(prelude() + "(let ((b (car (prolog '" + goal + R"())))
  (if b
      (with-vars-bound (?o) b
        (perform (an action (type picking-up) (arm left) (object (an object (name ?o))))))
      (go1))))",
                       options, std::string(kBinding) + std::string(kQueries));
    CHECK(plan.codes().empty());
    REQUIRE(plan.graph.has_value());
    return plan;
  };
  struct Case {
    std::string goal;
    std::set<std::string> fit;      // objects that meet the conditions known to the plan itself
    std::set<std::string> needed;   // further conditions besides Holding(left,?o)
    std::set<std::string> blocked;  // objects that something else rules out
  };
  const std::vector<Case> cases = {
      {"(and (object-in-hand ?o :left) (member ?o (:o2 :o6)))", {"o2", "o6"}, {}, {}},
      {"(and (object-in-hand ?o :left) (fail))", {}, {}, {}},
      {"(and (object-in-hand ?o :left) (member ?o (:o1 :o3 :o7)) (robot-free-hand :right))",
       {"o1", "o3", "o7"},
       {"HandFree(right)"},
       {}},
      {"(and (object-in-hand ?o :left) (not (object-in-hand ?o :right)))",
       {objects.begin(), objects.end()},
       {},
       {"o1", "o2"}},
  };
  for (const auto& one : cases) {
    CAPTURE(one.goal);
    const auto plan = asking(one.goal);
    CHECK(plan.graph->branches.size() < 6000);  // orders of seven are 13,700
    for (std::uint32_t held = 0; held < 128; ++held) {
      for (const bool further : {false, true}) {
        std::set<std::string> facts = one.needed;
        if (!further) facts.clear();
        std::set<std::string> wanted;
        for (std::size_t i = 0; i < objects.size(); ++i) {
          const bool blocked = further && one.blocked.contains(objects[i]);
          if (blocked) facts.insert("Holding(right," + objects[i] + ")");
          if ((held >> i & 1U) == 0) continue;
          facts.insert("Holding(left," + objects[i] + ")");
          const bool met = one.needed.empty() || further;
          if (one.fit.contains(objects[i]) && met && !blocked) {
            wanted.insert("PickUp(left," + objects[i] + ")");
          }
        }
        if (wanted.empty()) wanted.insert("Go(r1)");
        CAPTURE(held);
        CAPTURE(further);
        CHECK(fmt::format("{}", fmt::join(first_events(plan, facts), " ")) ==
              fmt::format("{}", fmt::join(wanted, " ")));
      }
    }
  }
}

TEST_CASE("rules: bad ones are located and bounded") {
  const auto codes = [&](std::string_view rules) {
    const auto plan = unroll(ruled(rules, kFetch));
    CAPTURE(rules);
    CHECK(plan.sink.error_count() == 1);
    for (const auto& entry : plan.sink.sorted()) return entry.message;
    return std::string();
  };
  CHECK(codes("(fetch ?x)") ==
        "rule: `fetch`: a fact group holds clauses: (<- (predicate argument...) goal...)");
  CHECK(codes("(<- fetch)") == "rule: `<-`: a clause proves (predicate argument...)");
  CHECK(codes("(<- (action-grounding ?d ?s) (action-grounding ?d ?s))")
            .starts_with("rule: `<-`: the proof takes more than 200000 steps"));
  CHECK(codes("(<- (action-grounding ?d ?s) (or (fail) (grow (?d) ?s))) "
              "(<- (grow ?x ?s) (grow (?x . ?x) ?s))")
            .starts_with("rule: `<-`: the proof takes more than 200000 steps"));
  CHECK(codes("(<- (action-grounding ?d (nowhere ?d)))") ==
        "rule: `action-grounding`: the plan has no function `nowhere` to carry out the action");
  CHECK(codes("(<- (action-grounding ?d ?s))") ==
        "rule: `action-grounding`: its solution has a variable that nothing binds");
  CHECK(codes("(<- (action-grounding ?d (carry ?d)))") == "`carry`: no value for `?arm`");
  CHECK(codes("(<- (action-grounding ?d (carry ?d 1 2)))") == "`carry`: unexpected argument 2");
  CHECK(codes("(<- (action-grounding ?d (fetch 1)))").starts_with("`fetch`: unexpected argument"));
  CHECK(codes("(<- (action-grounding ?d (fetch ?d)) (lisp-fun nowhere ?d ?x))") ==
        "no form or function `nowhere`");
  // A goal that cannot be computed is an error, not a goal that fails.
  CHECK(codes("(<- (action-grounding ?d (fetch ?d)) (lisp-fun list ?a ?b ?x))") ==
        "rule: `list`: two arguments are free variables");
  CHECK(codes("(<- (action-grounding ?d (fetch ?d)) (lisp-fun + 1 a ?x))") ==
        "`+`: argument 2 is a, not a number");
  CHECK(codes("(<- (action-grounding ?d (fetch ?d)) (lisp-fun carry 1 ?x))") ==
        "`carry`: no value for `?arm`");
  CHECK(codes("(<- (action-grounding ?d (fetch ?d)) (unheard-of ?d))") ==
        "no binding for query `unheard-of` with 1 arguments");
  CHECK(codes("(<- (action-grounding ?d (fetch ?d)) (lisp-fun go1 ?x))") ==
        "`perform` is not in the subset here: a function that a rule calls cannot perform");
}

TEST_CASE("rules: two packages have a function of one name; each rule means its own") {
  const auto plan = unroll(R"(
(defpackage a (:use :cl))
(defpackage b (:use :cl))
(in-package :a)
(defun fetch (&key ((:object ?o)) &allow-other-keys)
  (perform (an action (type picking-up) (arm left) (object ?o))))
(in-package :b)
(defun fetch (&key ((:object ?o)) &allow-other-keys)
  (perform (an action (type picking-up) (arm right) (object ?o))))
(def-fact-group rules (desig:action-grounding)
  (<- (desig:action-grounding ?d (a::fetch ?d))
    (spec:property ?d (:type :fetching))
    (spec:property ?d (:heavy t)))
  (<- (desig:action-grounding ?d (fetch ?d))
    (spec:property ?d (:type :fetching))))
(perform (an action (type fetching) (object (an object (name spoon1)))))
(perform (an action (type fetching) (object (an object (name spoon1))) (heavy t))))");
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("++") == Strings{"PickUp(right,spoon1)", "PickUp(left,spoon1)", "DONE"});
}

TEST_CASE("rules: values of every kind come through") {
  const auto plan = with_prelude(R"(
(defun tell (&key n s p d l x (z 7) ((:type type)) &allow-other-keys)
  (if (and (eql n 3) (equal s "a b") (eq p *p1*) (eq (desig-prop-value d :type) :cup)
           (equal l '(1 (2 :z))) (null x) (eql z 7) (eq type :telling))
      (go1)
      (go2)))
(def-fact-group rules (desig:action-grounding)
  (<- (desig:action-grounding ?d (tell ?d)) (spec:property ?d (:type :telling))))
(let ((?d (an object (type cup))) (?l '(1 (2 :z))))
  (perform (an action (type telling) (n 3) (s "a b") (p *p1*) (d ?d) (l ?l) (x nil)))))");
  CHECK(plan.events("+") == Strings{"Go(r1)", "DONE"});
}

TEST_CASE("rules: an action that carries itself out ends as a recursion does") {
  const std::string rule = R"(
(def-fact-group rules (desig:action-grounding)
  (<- (desig:action-grounding ?d (again ?d)) (spec:property ?d (:type :again))))
(perform (an action (type again))))";
  const auto idle =
      unroll("(defun again (&key &allow-other-keys) (perform (an action (type again))))" + rule);
  CHECK(idle.codes() == Strings{"CPL050"});
  const auto busy = unroll(
      prelude() +
      "(defun again (&key &allow-other-keys) (go1) (perform (an action (type again))))" + rule);
  REQUIRE(busy.graph.has_value());
  CHECK(busy.terminals().size() == 2);
}

TEST_CASE("rules: what a proof was told it does not ask again") {
  const auto plan = unroll_asking(prelude() + R"(
(when (prolog '(and (robot-free-hand :left) (robot-free-hand :left) (not (robot-free-hand :right))))
  (go1)))");
  REQUIRE(plan.graph.has_value());
  CHECK(plan.graph->branches.size() == 2);
  // The same text gives the same graph.
  const auto once_more = unroll_asking(prelude() + R"(
(when (prolog '(and (robot-free-hand :left) (robot-free-hand :left) (not (robot-free-hand :right))))
  (go1)))");
  CHECK(dump_text(*plan.graph, plan.files) == dump_text(*once_more.graph, once_more.files));
}

TEST_CASE("rules: the function that carries an action out is a task of its own") {
  // Its clean-up runs before the caller's handler is asked.
  const auto plan = unroll(ruled(R"(
  (<- (desig:action-grounding ?d (carefully ?object))
    (spec:property ?d (:type :fetching))
    (spec:property ?d (:object ?object))))",
                                 R"(
(defun carefully (?object)
  (unwind-protect (perform (an action (type picking-up) (arm left) (object ?object))) (go2)))
(with-failure-handling
    ((plan-failure (e) (go1) (return)))
)" + std::string(kFetch) + ")"));
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("-++") == Strings{"PickUp(left,spoon1)", "Go(r2)", "Go(r1)", "DONE"});
}

}  // namespace
}  // namespace parallax::compiler
