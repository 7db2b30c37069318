#include "harness/recording/recording_file.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "harness/recording/recording_format.h"
#include "tests/harness/recording/sample_recording.h"

namespace parallax::harness {
namespace {

namespace fs = std::filesystem;

struct TemporaryFolder {
  fs::path path = fs::temp_directory_path() / ("recording_" + std::to_string(::getpid()));
  TemporaryFolder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~TemporaryFolder() { fs::remove_all(path); }
};

TEST_CASE("recording files: names are those of simulations, and nothing else is one") {
  CHECK(recording_name(1, 4) == "recordings/1.4.rec");
  CHECK(recording_id("12.345.rec") == std::pair<std::int64_t, std::int64_t>(12, 345));
  for (const auto* name : {"1.4", "1.rec", ".rec", "1.4.rec.7.tmp", "0.1.rec", "01.4.rec",
                           "1.-4.rec", "1.4.5.rec", "99999999999999999999.1.rec", "1.4.REC"}) {
    CHECK_FALSE(recording_id(name));
  }
}

TEST_CASE("recording files: written, found, replaced") {
  const TemporaryFolder folder;
  auto recording = sample_recording();
  std::string why;
  CHECK_FALSE(find_recording(folder.path, 2, 4, why));
  CHECK(why == "there is none");
  REQUIRE(write_recording(folder.path, recording) == "");
  CHECK(find_recording(folder.path, 2, 4, why) == recording);
  recording.status = "lost";
  REQUIRE(write_recording(folder.path, recording) == "");
  CHECK(find_recording(folder.path, 2, 4, why) == recording);
  CHECK(std::distance(fs::directory_iterator(folder.path / "recordings"), {}) == 1);
}

TEST_CASE("recording files: what is missing or broken is told with the command that makes it") {
  const TemporaryFolder folder;
  base::DiagnosticSink sink;
  CHECK_FALSE(read_recording(folder.path, 2, 4, "parallax replay run --record", sink));
  std::ofstream(
      (fs::create_directory(folder.path / "recordings"), folder.path / "recordings/2.4.rec"))
      << "PLXREC";
  CHECK_FALSE(read_recording(folder.path, 2, 4, "parallax replay run --record", sink));
  auto other = sample_recording();
  other.sample = 5;
  REQUIRE(write_recording(folder.path, other) == "");
  fs::rename(folder.path / "recordings/2.5.rec", folder.path / "recordings/2.4.rec");
  CHECK_FALSE(read_recording(folder.path, 2, 4, "parallax replay run --record", sink));
  std::string all;
  for (const auto& diagnostic : sink.sorted()) {
    all += diagnostic.message + "\n";
    all += diagnostic.help + "\n";
  }
  CHECK(all.find("simulation 2.4 left no recording") != std::string::npos);
  CHECK(all.find("Make it: `parallax replay run --record`") != std::string::npos);
  CHECK(all.find("byte 0: the file does not begin as a recording does") != std::string::npos);
  CHECK(all.find("it is that of simulation 2.5") != std::string::npos);
}

TEST_CASE("recording files: nothing is written or read through a link that leads out") {
  const TemporaryFolder folder;
  const auto run = folder.path / "run", elsewhere = folder.path / "elsewhere";
  fs::create_directories(run);
  fs::create_directories(elsewhere);
  fs::create_directory_symlink(elsewhere, run / "recordings");
  CHECK(write_recording(run, sample_recording()) == "it is no folder");
  CHECK(fs::is_empty(elsewhere));
  std::ofstream(elsewhere / "2.4.rec", std::ios::binary) << encode(sample_recording());
  std::string why;
  CHECK_FALSE(find_recording(run, 2, 4, why));
}

}  // namespace
}  // namespace parallax::harness
