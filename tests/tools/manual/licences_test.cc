// The list of licences: is everything on it that the program links and carries?

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "tests/tools/manual/help_text.h"

namespace parallax::test {
namespace {

using Names = std::set<std::string>;

std::string text_of(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

nlohmann::json document() {
  return nlohmann::json::parse(
      text_of(std::string(PARALLAX_BINARY_DIR) + "/generated/parallax.spdx.json"));
}

/// Debian's source packages on the list.
Names listed_sources() {
  static const std::regex reference("pkg:deb/debian/([^@]+)@([^?]+)\\?arch=source");
  Names names;
  const auto list = document();
  for (const auto& package : list.at("packages")) {
    if (!package.contains("externalRefs")) continue;
    const auto text = package.at("externalRefs").at(0).at("referenceLocator").get<std::string>();
    std::smatch found;
    REQUIRE_MESSAGE(std::regex_match(text, found, reference), text);
    names.insert(found[1]);
  }
  return names;
}

/// The source package of a file of the system.
std::string source_of(const std::string& file) {
  // Packages know some files below /lib, which is /usr/lib.
  for (const auto& path : {file, std::filesystem::canonical(file).string(), "/usr" + file}) {
    const auto owner = run_process({"dpkg", "-S", path});
    if (owner.code != 0) continue;
    const auto name = owner.out.substr(0, owner.out.find(": "));
    return run_process({"dpkg-query", "-W", "-f=${source:Package}", name}).out;
  }
  FAIL("no package has " << file);
  return {};
}

/// The libraries that a program or module brings along, those of its libraries too.
std::set<std::filesystem::path> loaded_by(const std::string& binary) {
  static const std::regex place("=> (/[^ ]+) ");
  const auto found = run_process({"ldd", binary});
  REQUIRE(found.code == 0);
  std::set<std::filesystem::path> files;
  for (std::sregex_iterator at(found.out.begin(), found.out.end(), place), end; at != end; ++at) {
    files.insert((*at)[1].str());
  }
  REQUIRE(files.size() >= 4);
  return files;
}

TEST_CASE("the list is a document of SPDX 2.3") {
  const auto list = document();
  CHECK(list.at("spdxVersion") == "SPDX-2.3");
  CHECK(list.at("dataLicense") == "CC0-1.0");
  CHECK(list.at("SPDXID") == "SPDXRef-DOCUMENT");
  CHECK(list.at("documentNamespace").get<std::string>().starts_with("urn:uuid:"));
  Names ids{"SPDXRef-DOCUMENT"};
  static const std::regex id("SPDXRef-[A-Za-z0-9.-]+");
  for (const auto& package : list.at("packages")) {
    CAPTURE(package.dump());
    CHECK(std::regex_match(package.at("SPDXID").get<std::string>(), id));
    CHECK(ids.insert(package.at("SPDXID")).second);
    CHECK(package.contains("downloadLocation"));
    CHECK_FALSE(package.at("licenseDeclared").get<std::string>().empty());
    CHECK(package.at("versionInfo").get<std::string>().find_first_of("0123456789") !=
          std::string::npos);
  }
  Names related;
  for (const auto& relation : list.at("relationships")) {
    CHECK(ids.contains(relation.at("spdxElementId")));
    CHECK(ids.contains(relation.at("relatedSpdxElement")));
    related.insert(relation.at("relatedSpdxElement"));
  }
  CHECK(related.size() + 1 == ids.size());
}

TEST_CASE("every library that the program and its modules load is listed") {
  if (!is_installed("dpkg-query")) {
    MESSAGE("no Debian system: who owns a library is not known");
    return;
  }
  const auto listed = listed_sources();
  const std::string build = PARALLAX_BINARY_DIR;
  std::vector<std::string> binaries{build + "/parallax"};
  if (std::filesystem::exists(build + "/modules")) {
    for (const auto& module : std::filesystem::directory_iterator(build + "/modules")) {
      binaries.push_back(module.path().string());
    }
  }
  for (const auto& binary : binaries) {
    CAPTURE(binary);
    for (const auto& library : loaded_by(binary)) {
      CHECK_MESSAGE(listed.contains(source_of(library.string())), library.string());
    }
  }
}

TEST_CASE("every archive that is linked, and every library that is built with, is listed") {
  if (!is_installed("dpkg-query") || !is_installed("ninja")) {
    MESSAGE("no Debian system, or no ninja: what is linked is not known");
    return;
  }
  const auto listed = listed_sources();
  const std::string build = PARALLAX_BINARY_DIR;
  const auto commands = run_process({"ninja", "-C", build, "-t", "commands", "-s", "parallax"}).out;
  static const std::regex archive("(/usr/[^ ]+\\.a)( |\n|$)");
  std::size_t archives = 0;
  for (std::sregex_iterator it(commands.begin(), commands.end(), archive), end; it != end; ++it) {
    CHECK_MESSAGE(listed.contains(source_of((*it)[1])), (*it)[1].str());
    ++archives;
  }
  CHECK(archives >= 1);  // CaDiCaL
  // The packages that a build installs, without those for tests alone.
  std::istringstream packages(text_of(std::string(PARALLAX_SOURCE_DIR) + "/tools/packages"));
  const Names no_part{"build-essential", "cmake",  "ninja-build", "pkg-config",
                      "doctest-dev",     "gringo", "minisat"};
  std::size_t parts = 0;
  for (std::string name; std::getline(packages, name);) {
    if (name.empty() || name.starts_with('#') || no_part.contains(name)) continue;
    const auto source = run_process({"dpkg-query", "-W", "-f=${source:Package}", name});
    if (source.code != 0) continue;  // optional, and not there
    CHECK_MESSAGE(listed.contains(source.out), name);
    ++parts;
  }
  CHECK(parts >= 8);
}

TEST_CASE("notices of what the program carries are in its copyright file") {
  const auto notices = text_of(std::string(PARALLAX_BINARY_DIR) + "/generated/copyright");
  for (const auto* who : {"The parallax authors", "Armin Biere", "Niels Lohmann",
                          "three.js authors", "University of Cincinnati", "Victor Zverovich"}) {
    CHECK_MESSAGE(notices.find(who) != std::string::npos, who);
  }
}

TEST_CASE("where it was built is not in the program: the same bytes come of any folder") {
  const CliFixture cli;
  const auto doctor = nlohmann::json::parse(cli.parallax({"doctor", "--json"}).out);
  if (doctor.at("build").at("type") != "Release") {
    MESSAGE("no release: what debuggers read names folders");
    return;
  }
  const std::string build = PARALLAX_BINARY_DIR;
  for (const auto& binary : {build + "/parallax", build + "/modules/parallax_sdf.so"}) {
    if (!std::filesystem::exists(binary)) continue;
    const auto bytes = text_of(binary);
    CHECK(bytes.size() > 100000);
    CHECK_MESSAGE(bytes.find(PARALLAX_SOURCE_DIR) == std::string::npos, binary);
    CHECK_MESSAGE(bytes.find(build) == std::string::npos, binary);
  }
}

}  // namespace
}  // namespace parallax::test
