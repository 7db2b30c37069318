// Commands as a shell takes them apart, files of hosts, and the name that a worker gives itself.

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>

#include "compiler/base/codes/campaigns.h"
#include "harness/cluster/program_identity.h"
#include "harness/cluster/shell_words.h"
#include "harness/cluster/worker_place.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace parallax::harness {
namespace {

using Words = std::vector<std::string>;

TEST_CASE("words are those that a shell makes of the text") {
  const std::string texts[] = {
      "srun -n1 -c1",
      "  ssh   lab3\t",
      "a 'b c' d",
      R"(a "b c"d 'e'"f"g)",
      R"(a\ b c\\d \'e\' \$x)",
      R"("a\"b" "c\$d" "e\`f" "g\\h" "i\jk")",
      "'' \"\" a''",
      "'$x|&;<>' \"*?[~#\" a#b a~b x=y {} !",
      "docker exec -i 'my sim' nice -n 5",
      "tab\tnew\nline",
  };
  for (const auto& text : texts) {
    CAPTURE(text);
    // The words that the shell itself hands to a program, each ended by a byte that occurs in no
    // word.
    auto line = text;
    std::replace(line.begin(), line.end(), '\n', ' ');
    const auto shell = test::run_process({"sh", "-c", "printf '%s\\001' " + line});
    Words expected;
    for (std::size_t at = 0; at < shell.out.size();) {
      const auto end = shell.out.find('\001', at);
      expected.push_back(shell.out.substr(at, end - at));
      at = end + 1;
    }
    const auto split = split_shell_words(text);
    CHECK(split.fault.empty());
    CHECK(split.words == expected);
  }
  CHECK(split_shell_words("").words.empty());
}

TEST_CASE("what only a shell does is refused where it stands") {
  const std::pair<std::string, std::size_t> texts[] = {
      {"ssh $HOST", 4}, {"a | b", 2},    {"a && b", 2},   {"a; b", 1}, {"a > f", 2}, {"a < f", 2},
      {"(a)", 0},       {"a `b`", 2},    {"a *.e", 2},    {"a f?", 3}, {"a [b]", 2}, {"~/bin/x", 0},
      {"a # b", 2},     {"a \"$b\"", 3}, {"a \"`b\"", 3}, {"a 'b", 2}, {"a \"b", 2}, {"a \\", 2},
  };
  for (const auto& [text, at] : texts) {
    CAPTURE(text);
    const auto split = split_shell_words(text);
    CHECK_FALSE(split.fault.empty());
    CHECK(split.fault_at == at);
  }
}

struct Hosts {
  test::TemporaryFolder folder;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  base::Result<std::vector<WorkerPlace>> read(const std::string& text) {
    const auto file = folder.path() / "hosts";
    std::ofstream(file) << text;
    return read_hosts(file, files, sink);
  }
};

TEST_CASE("a file of hosts: slots, commands, comments") {
  Hosts hosts;
  const auto places =
      hosts.read("# the lab\n\n4 ssh lab3\r\n  2\tdocker exec -i 'my sim'  \n   # none\n1 env");
  REQUIRE(places.has_value());
  REQUIRE(places->size() == 3);
  CHECK((*places)[0].slots == 4);
  CHECK((*places)[0].prefix == Words{"ssh", "lab3"});
  CHECK((*places)[0].text == "ssh lab3");
  CHECK((*places)[1].slots == 2);
  CHECK((*places)[1].prefix == Words{"docker", "exec", "-i", "my sim"});
  CHECK((*places)[2].prefix == Words{"env"});
}

TEST_CASE("wrong lines are reported where they are, all of them") {
  Hosts hosts;
  CHECK_FALSE(hosts.read("ssh lab3\n0 ssh a\n1025 ssh a\n3\n2 ssh $a\n1 ssh 'b\n-1 x\n2x y\n"));
  const auto found = hosts.sink.sorted();
  REQUIRE(found.size() == 8);
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].code == codes::kBadHostLine);
    REQUIRE(found[i].range);
    CHECK(hosts.files[found[i].range->file].position(found[i].range->begin).line == i + 1);
  }
  CHECK(hosts.files[found[4].range->file].position(found[4].range->begin).column == 7);
}

TEST_CASE("no place, too many slots, no file") {
  Hosts none;
  CHECK_FALSE(none.read("# nothing\n"));
  CHECK(none.sink.error_count() == 1);
  Hosts many;
  CHECK_FALSE(many.read("1000 ssh a\n25 ssh b\n"));
  CHECK(many.sink.error_count() == 1);
  Hosts missing;
  CHECK_FALSE(read_hosts(missing.folder.path() / "no", missing.files, missing.sink));
  CHECK(missing.sink.error_count() == 1);
}

TEST_CASE("a launcher that is no command is refused") {
  base::DiagnosticSink sink;
  CHECK_FALSE(launcher_place("ssh $HOST", 1, sink));
  CHECK_FALSE(launcher_place("  ", 1, sink));
  CHECK(sink.error_count() == 2);
  const auto place = launcher_place("srun -n1", 3, sink);
  REQUIRE(place.has_value());
  CHECK(place->slots == 3);
}

TEST_CASE("who a worker says it is") {
  const auto self = this_program("1.2.3", "0123456789abcdef");
  CHECK(self.build.size() == 16);
  CHECK(self.kind() == self.build + "/0123456789abcdef");
  CHECK(this_program("1.2.3", "0123456789abcdef") == self);
  const auto read = parse_greeting(greeting_line(self));
  REQUIRE(read);
  CHECK(*read == self);
  CHECK(read->objects == self.objects);
  CHECK(self.objects.size() > 3);  // the program, C, C++, and more
  CHECK(differing_objects(*read, self).empty());
  for (const auto* other : {"", "{}", "Welcome to parallax_worker", R"({"parallax_worker":1})",
                            R"({"parallax_worker":1,"version":3,"build":"x"})"}) {
    CHECK_FALSE(parse_greeting(other));
  }
}

TEST_CASE("builds that differ are told by the files that make them differ") {
  ProgramIdentity here{"1", "a", "x", {{"", "11"}, {"libode.so.8", "22"}, {"libm.so.6", "33"}}};
  ProgramIdentity there{"1", "b", "x", {{"", "11"}, {"libode.so.8", "23"}, {"libsdf.so", "44"}}};
  CHECK(differing_objects(there, here) ==
        std::vector<std::string>{"libode.so.8", "libsdf.so (there only)", "libm.so.6 (here only)"});
  there.objects[""] = "12";
  CHECK(differing_objects(there, here).front() == "parallax");
  there.objects.clear();  // an older worker
  CHECK(differing_objects(there, here).empty());
}

}  // namespace
}  // namespace parallax::harness
