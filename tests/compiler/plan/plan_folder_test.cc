// The files that a plan's folder stands for, and their order.

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "compiler/lisp/system_definition.h"
#include "compiler/plan/plan_files.h"

namespace parallax::compiler {
namespace {

namespace fs = std::filesystem;

class PlanFolder {
 public:
  PlanFolder() {
    std::string name = (fs::temp_directory_path() / "parallax_plans_XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    folder_ = fs::path(name) / "pick_place";
    fs::create_directory(folder_);
  }
  ~PlanFolder() { fs::remove_all(folder_.parent_path()); }
  PlanFolder(const PlanFolder&) = delete;
  PlanFolder& operator=(const PlanFolder&) = delete;

  void write(const std::string& name, const std::string& text = "(list 1)") const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  /// Files "a" ... "d", which `system` orders.
  void write_system(const std::string& options) const {
    for (const char* name : {"a.lisp", "b.lisp", "c.lisp", "src/d.lisp", "src/e.lisp"}) write(name);
    write("pick-place.asd",
          "(in-package :asdf-user)\n(asdf:defsystem pick-place\n" + options + ")");
  }
  /// "b a c": the names loaded; or "CPL061: text" of the first error, a blank and the warnings.
  std::string loaded(std::vector<fs::path> more = {}) {
    base::SourceFiles files;
    base::DiagnosticSink sink;
    base::PathGate gate;
    gate.admit_from(folder_);
    std::vector<PlanEntry> paths = {{folder_, std::nullopt}};
    for (auto& path : more) paths.push_back({folder_ / path, std::nullopt});
    const auto plan = load_plan_files(paths, gate, files, sink);
    warnings_ = sink.warning_count();
    for (const auto& entry : sink.sorted()) {
      if (base::info(entry.code).severity != base::Severity::kError) continue;
      return std::string(base::info(entry.code).id) + ": " + entry.message;
    }
    std::string out;
    for (const auto file : *plan) {
      out += (out.empty() ? "" : " ") + fs::path(files[file].name()).stem().string();
    }
    return out;
  }
  std::size_t warnings() const { return warnings_; }
  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
  std::size_t warnings_ = 0;
};

TEST_CASE("plan folder: without a system definition the names order the files, with a warning") {
  PlanFolder plan;
  plan.write("c.lisp");
  CHECK(plan.loaded() == "c");
  CHECK(plan.warnings() == 0);
  plan.write("a.lisp");
  plan.write("notes.txt", "(");
  plan.write("deeper/z.lisp");
  plan.write(".hidden.lisp");
  CHECK(plan.loaded() == "a c");
  CHECK(plan.warnings() == 1);
}

TEST_CASE("plan folder: the system definition orders the files") {
  PlanFolder plan;
  SUBCASE("as written") {
    plan.write_system(":components ((:file \"c\") (:file \"a\"))");
    CHECK(plan.loaded() == "c a");
  }
  SUBCASE("what is needed goes first") {
    plan.write_system(
        ":author \"me\" :depends-on (roslisp cram-language) :components\n"
        "((:file \"a\" :depends-on (\"c\" #:b)) (:static-file \"x.txt\") (:file \"b\") (:file c))");
    CHECK(plan.loaded() == "c b a");
  }
  SUBCASE("modules, one inside the other, have folders") {
    plan.write_system(
        ":components ((:module \"src\" :depends-on (\"up\") :components ((:file \"e\" :depends-on "
        "(\"d\")) (:file \"d\"))) (:module \"up\" :pathname \"\" :serial t :components ((:file "
        "\"b\") (:file \"a\"))))");
    CHECK(plan.loaded() == "b a d e");
  }
  SUBCASE("of several the one that is called like the folder") {
    plan.write_system(":components ((:file \"b\"))");
    plan.write("pick-place-tests.asd", "(run-all-tests)");
    CHECK(plan.loaded() == "b");
  }
  CHECK(plan.warnings() == 0);
}

TEST_CASE("plan folder: a system definition is data; code and mistakes in it are refused") {
  struct Mistake {
    const char* text;
    std::string error;
  };
  const std::string read = "CPL061: cannot read the system definition: ";
  const Mistake cases[] = {
      {"(load \"x\")(defsystem p :components ((:file \"a\")))",
       read + "it is read as data, and this is code"},
      {"(defsystem p :perform (test-op (o c) (run)) :components ((:file \"a\")))",
       read + "the option `:perform` is code or unknown; it is read as data"},
      {"(defsystem p :pathname (run) :components ((:file \"a\")))",
       read + "it is read as data, and this is no text"},
      {"(defsystem p :components #.(list))", "CPL002: the reader macro `#.` is not in the subset"},
      {"(defsystem p :components ((:file \"a\" :around-compile \"f\")))",
       read + "an option of this kind is code or unknown; it is read as data"},
      {"(defsystem p :components ((:c-file \"a\")))",
       read + "there are no components of the kind `:c-file`"},
      {"(defsystem p :components ((:file \"a\" :depends-on (\"b\")) (:file \"b\" :depends-on "
       "(\"a\"))))",
       read + "`b` and `a` depend on each other"},
      {"(defsystem p :components ((:file \"a\" :depends-on (\"zz\"))))",
       read + "there is no component `zz` beside this one"},
      {"(defsystem p :components ((:file \"a\") (:file \"a\")))",
       read + "the component `a` is named twice"},
      {"(defsystem p :components ((:file \"a\") (:file \"b\" :pathname \"a.lisp\")))", "CPL062: "},
      {"(defsystem p :components ((:file \"../../secret\")))", "E1016: "},
      {"(defsystem p :components ((:file \"none\")))", "E0001: "},
      {"(defsystem p)(defsystem q)", read + "one file defines one system"},
      {"(in-package :asdf)", read + "it has no `defsystem`"},
      {"(defsystem p :components ())", "CPL062: "},
  };
  for (const auto& one : cases) {
    CAPTURE(one.text);
    PlanFolder plan;
    plan.write_system("");
    plan.write("pick-place.asd", one.text);
    CHECK(plan.loaded().starts_with(one.error));
  }
}

TEST_CASE("plan folder: files that stand twice, links out and folders without a plan are refused") {
  PlanFolder plan;
  CHECK(plan.loaded().ends_with("it holds no system definition (.asd) and no Lisp file"));
  plan.write("a.lisp");
  CHECK(plan.loaded({"a.lisp"}).ends_with("the plan names this file twice"));
  std::ofstream(plan.folder().parent_path() / "secret.lisp") << "(list 2)";
  fs::create_symlink("../secret.lisp", plan.folder() / "b.lisp");
  CHECK(plan.loaded().starts_with("E1016"));
  fs::remove(plan.folder() / "b.lisp");
  fs::create_symlink("a.lisp", plan.folder() / "b.lisp");
  CHECK(plan.loaded().ends_with("the plan names this file twice"));
  fs::remove(plan.folder() / "b.lisp");
  plan.write("x.asd", "(defsystem x)");
  plan.write("y.asd", "(defsystem y)");
  CHECK(plan.loaded().find("several system definitions") != std::string::npos);
}

TEST_CASE("plan folder: thousands of files and components, deep modules are bounded") {
  PlanFolder plan;
  for (int i = 0; i < 3000; ++i) plan.write("f" + std::to_string(i) + ".lisp");
  CHECK(plan.loaded().ends_with("the plan has more than 1000 files"));
  std::string chain = "(defsystem p :components (";
  for (int i = 0; i < 900; ++i) {
    chain += "(:static-file \"f" + std::to_string(i) + "\" :depends-on (\"f" +
             std::to_string(i + 1) + "\"))";
  }
  plan.write("pick-place.asd", chain +
                                   "(:static-file \"f900\") (:file \"f0.lisp\" :pathname "
                                   "\"f0.lisp\")))");
  CHECK(plan.loaded() == "f0");
  std::string many = "(defsystem p :components (";
  for (int i = 0; i < 3000; ++i) many += "(:file \"f" + std::to_string(i) + "\")";
  plan.write("pick-place.asd", many + "))");
  CHECK(plan.loaded().ends_with("there are more than 1000 components"));
  std::string deep = "(defsystem p :components ";
  for (int i = 0; i < 400; ++i) deep += "((:module \"m\" :pathname \"\" :components ";
  deep += "((:file \"f1\"))";
  for (int i = 0; i < 400; ++i) deep += "))";
  plan.write("pick-place.asd", deep + ")");
  CHECK(plan.loaded() == "f1");
}

}  // namespace
}  // namespace parallax::compiler
