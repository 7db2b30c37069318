// Files that `load` finds, reads once, and refuses.

#include "compiler/syntax/loader.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "compiler/syntax/loader.h"
#include "compiler/syntax/printer.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, removed afterwards.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "parallax-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  fs::path write(const fs::path& name, std::string_view text) const {
    const auto path = path_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// The current folder is searched and is a root, so cases about roots choose it.
class CurrentFolder {
 public:
  explicit CurrentFolder(const fs::path& path) : before_(fs::current_path()) {
    fs::current_path(path);
  }
  CurrentFolder(const CurrentFolder&) = delete;
  CurrentFolder& operator=(const CurrentFolder&) = delete;
  ~CurrentFolder() { fs::current_path(before_); }

 private:
  fs::path before_;
};

struct Loaded : FrontEnd {
  std::optional<compiler::ModelAst> model;
  explicit Loaded(const std::vector<fs::path>& paths, compiler::LoadOptions options = {}) {
    options.implicit_foundations = false;
    auto result = compiler::load_model(paths, options, files, sink);
    if (result) model = std::move(*result);
  }
  /// The statements in the order in which they act.
  std::string order() const {
    std::string out;
    for (const auto& place : model.value().order) {
      const auto& statement = model->statement(place);
      out += model->ast(place).text(statement.source);
      out += '\n';
    }
    return out;
  }
};

TEST_CASE("load: a loaded file acts at the place of its load, looked up beside the loader") {
  const Folder folder;
  folder.write("sub/b.e", "sort b\nload c.e\nsort bb\n");
  folder.write("sub/c.e", "sort c\n");
  const auto main = folder.write("a.e", "sort a\nload sub/b.e\nsort aa\n");
  const Loaded loaded({main});
  REQUIRE(loaded.model);
  CHECK(loaded.order() == "sort a\nsort b\nsort c\nsort bb\nsort aa\n");
}

TEST_CASE("load: beside the loader comes before -I, and -I in the order given") {
  const Folder folder;
  folder.write("one/x.e", "sort one\n");
  folder.write("two/x.e", "sort two\n");
  folder.write("two/y.e", "sort why\n");
  const auto main = folder.write("main/a.e", "load x.e\nload y.e\n");
  compiler::LoadOptions options;
  options.include_dirs = {folder.path() / "one", folder.path() / "two"};
  CHECK(Loaded({main}, options).order() == "sort one\nsort why\n");
  folder.write("main/x.e", "sort beside\n");
  CHECK(Loaded({main}, options).order() == "sort beside\nsort why\n");
}

TEST_CASE("load: the current folder is searched last, and the built-in texts after it") {
  const Folder folder, current_path;
  current_path.write("shared/x.e", "sort here\n");
  const CurrentFolder current(current_path.path());
  const auto main = folder.write("a.e", "load shared/x.e\n");
  CHECK(Loaded({main}).order() == "sort here\n");
  folder.write("shared/x.e", "sort beside\n");
  CHECK(Loaded({main}).order() == "sort beside\n");
}

TEST_CASE("load: a file is read once, however it is reached, and rings are only warned of") {
  const Folder folder;
  folder.write("b.e", "load a.e\nload ./b.e\nsort b\n");
  fs::create_symlink("b.e", folder.path() / "link.e");
  const auto main = folder.write("a.e", "load a.e\nload b.e\nload link.e\nload ../" +
                                            folder.path().filename().string() + "/b.e\nsort a\n");
  const Loaded loaded({main, main});
  REQUIRE_MESSAGE(loaded.model, loaded.text());
  CHECK(loaded.order() == "sort b\nsort a\n");
  // a.e loads itself, b.e loads a.e and itself; the second ways to b.e close no ring.
  CHECK(loaded.codes() == Strings{"W1019", "W1019", "W1019"});
}

TEST_CASE("load: a missing file is reported at its load, with the nearest built-in one") {
  const Folder folder;
  const auto main = folder.write("a.e", "load foundations/EQ.e\nload nowhere.e\n");
  const Loaded loaded({main});
  CHECK_FALSE(loaded.model);
  CHECK(loaded.places() == Strings{"E1014 1:6-21", "E1014 2:6-14"});
  CHECK(loaded.text().find("with `foundations/EC.e`") != std::string::npos);
}

TEST_CASE("load: folders, FIFOs and devices are refused without being opened") {
  const Folder folder;
  fs::create_directory(folder.path() / "dir.e");
  REQUIRE(::mkfifo((folder.path() / "fifo.e").c_str(), 0600) == 0);
  const auto main = folder.write("a.e", "load dir.e\nload fifo.e\nload /dev/zero\n");
  const Loaded loaded({main});
  CHECK_FALSE(loaded.model);
  CHECK(loaded.codes() == Strings{"E1015", "E1015", "E1015"});
}

TEST_CASE("load: a main file that is no file is a usage error") {
  const Folder folder;
  CHECK(Loaded({folder.path()}).codes() == Strings{"E0003"});
  CHECK(Loaded({folder.path() / "none.e"}).codes() == Strings{"E0001"});
}

TEST_CASE("load: nothing outside the folders of the model is read unless permitted") {
  const Folder folder, outside;
  const CurrentFolder current(folder.path());
  const auto secret = outside.write("secret.e", "sort secret\n");
  fs::create_symlink(secret, folder.path() / "link.e");
  const auto relative = fs::relative(secret, folder.path()).string();
  const auto main = folder.write(
      "a.e", "load link.e\nload " + secret.string() + "\nload " + relative + "\nsort a\n");
  CHECK(Loaded({main}).codes() == Strings{"E1016", "E1016", "E1016"});
  compiler::LoadOptions include;
  include.include_dirs = {outside.path()};
  CHECK(Loaded({main}, include).order() == "sort secret\nsort a\n");
  compiler::LoadOptions allow;
  allow.allow_outside = true;
  CHECK(Loaded({main}, allow).order() == "sort secret\nsort a\n");
}

TEST_CASE("load: a sibling folder with a longer name is outside") {
  const Folder folder, elsewhere;
  folder.write("model-private/x.e", "sort x\n");
  const CurrentFolder current(elsewhere.path());
  const auto main = folder.write("model/a.e", "load ../model-private/x.e\n");
  CHECK(Loaded({main}).codes() == Strings{"E1016"});
}

TEST_CASE("load: NUL bytes and invalid UTF-8 are refused at their place") {
  const Folder folder;
  const auto nul = folder.write("nul.e", std::string("sort a\nso\0rt b\n", 14));
  const auto latin = folder.write("latin.e", "sort a\n; M\xFCller\n");
  CHECK(Loaded({nul}).places() == Strings{"E0006 2:3-3"});
  CHECK(Loaded({latin}).codes() == Strings{"E0006"});
}

TEST_CASE("load: syntax errors of all files are reported in one run") {
  const Folder folder;
  folder.write("b.e", "P(.\n");
  const auto main = folder.write("a.e", "load b.e\nQ(.\n");
  const Loaded loaded({main});
  CHECK(loaded.model);  // the readable part is there
  CHECK(loaded.codes() == Strings{"E1003", "E1003"});
}

TEST_CASE("foundations: they are built in, load each other, and are parsed without a message") {
  for (const auto& foundation : compiler::foundations()) {
    CAPTURE(foundation.path);
    FrontEnd front;
    const auto file = front.add("load " + std::string(foundation.path) + "\n");
    const auto model = compiler::load_model_text(file, ".", {}, front.files, front.sink);
    REQUIRE(model);
    CHECK(front.text() == "");
    CHECK(model->files.back().built_in);
  }
}

std::string first_built_in(const std::string& text) {
  FrontEnd front;
  const auto file = front.add(text);
  const auto model = compiler::load_model_text(file, ".", {}, front.files, front.sink);
  Strings names;
  for (const auto& loaded : model->files) {
    if (loaded.built_in) names.push_back(front.files[loaded.ast.file()].name());
  }
  std::string out;
  for (const auto& name : names) out += name.substr(name.find('/') + 1) + " ";
  return out;
}

TEST_CASE("foundations: a model that loads none gets Root and EC, first of all") {
  CHECK(first_built_in("sort a\n") == "EC.e Root.e ");
  CHECK(first_built_in("load foundations/Root.e\n") == "Root.e ");
  CHECK(first_built_in("load foundations/Root.e\nload foundations/EC.e\n") == "Root.e EC.e ");
}

TEST_CASE("foundations: a folder of that name beside the model makes no difference") {
  const Folder folder;
  folder.write("foundations/Root.e", "sort boolean\nsort integer\nreified sort predicate\n");
  folder.write("foundations/EC.e", "sort time: integer\nreified sort fluent\n");
  const auto main = folder.write("a.e", "load foundations/Root.e\nload foundations/EC.e\nsort a\n");
  const Loaded loaded({main});
  REQUIRE_MESSAGE(loaded.model, loaded.text());
  Strings files;
  for (const auto& file : loaded.model->files) {
    const auto name = fs::path(loaded.files[file.ast.file()].name()).filename().string();
    files.push_back(name + (file.built_in ? " built in" : file.repeats_foundation ? " copy" : ""));
  }
  std::sort(files.begin(), files.end());
  CHECK(files == Strings{"EC.e built in", "EC.e copy", "Root.e built in", "Root.e copy", "a.e"});
  // The built-in declarations come first, so the copies repeat them.
  CHECK(loaded.order().find("AntiTrajectory") < loaded.order().find("sort a\n"));
}

TEST_CASE("foundations: with encoding 3 EC means DEC, and trajectories come with it") {
  CHECK(first_built_in("option encoding 3\nload foundations/EC.e\n") == "DEC.e EC.e Root.e ");
  CHECK(first_built_in("option encoding 3\noption trajectory on\nload foundations/EC.e\n") ==
        "ECTraj.e DEC.e EC.e Root.e ");
  CHECK(first_built_in("load foundations/EC.e\noption encoding 3\n") == "EC.e Root.e ");
  CHECK(first_built_in("option encoding 3\n") == "DEC.e EC.e Root.e ");
}

}  // namespace
}  // namespace parallax::test
