#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "compiler/base/codes/files.h"
#include "compiler/base/descriptor.h"
#include "compiler/base/file_io.h"
#include "harness/conformance/adapter_recording.h"
#include "tools/cli/command.h"

namespace parallax::tools {
namespace {

struct RecordOptions {
  std::vector<std::string> command;
  std::string output;
};

/// The file, new, empty or a recording already: only such a one is appended to.
base::Result<base::Descriptor> open_recording(const std::string& path, base::DiagnosticSink& sink) {
  const auto head = std::string(harness::kAdapterRecordingHead) + '\n';
  constexpr int kFlags = O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  base::Descriptor file(::open(path.c_str(), kFlags, 0666));
  struct stat about {};
  // Locked, as another process may just be writing its first line.
  if (!file.valid() || ::fstat(file.get(), &about) != 0 ||
      (S_ISREG(about.st_mode) && ::flock(file.get(), LOCK_EX) != 0)) {
    return sink.error_about(codes::kFileNotWritable, path, std::strerror(errno));
  }
  std::string begin(head.size(), '\0');
  const auto count =
      S_ISREG(about.st_mode) ? ::pread(file.get(), begin.data(), begin.size(), 0) : -1;
  if (count == 0 && !base::write_all(file.get(), head)) {
    return sink.error_about(codes::kFileNotWritable, path, std::strerror(errno));
  }
  if (count != 0 && (count != static_cast<ssize_t>(head.size()) || begin != head)) {
    return sink.error_about(codes::kFileNotWritable, path,
                            "it is there already and is no recording of an adapter");
  }
  ::flock(file.get(), LOCK_UN);
  return file;
}

int run_record(const RecordOptions& options, Invocation& invocation) {
  const auto file = open_recording(options.output, invocation.sink());
  if (!file) return 0;
  ::signal(SIGPIPE, SIG_IGN);
  return harness::record_adapter(options.command, STDIN_FILENO, STDOUT_FILENO, file->get());
}

int run_replay_adapter(const std::string& path, Invocation& invocation) {
  auto adapter = harness::RecordedAdapter::read(path, invocation.sink());
  if (!adapter) return 0;
  ::signal(SIGPIPE, SIG_IGN);
  return harness::serve_recording(*adapter, STDIN_FILENO, STDOUT_FILENO);
}

}  // namespace

Command record_command() {
  auto options = std::make_shared<RecordOptions>();
  OptionTable command("record",
                      "Stand before a simulator and write down what it is asked and says");
  command.footer(
      "Examples:\n"
      "  simulator: {command: [parallax, record, -o, runs.ndjson, --, python3, my_adapter.py]}\n"
      "  parallax replay-adapter runs.ndjson     answers as it did, without the simulator\n"
      "A file that is a recording already is appended to.\n"
      "Exit codes: those of the command; 2 for a file that cannot be written.");
  command
      .option("command", options->command, "The simulator: a program and its arguments, behind --")
      .required()
      .program();
  command.option("-o,--output", options->output, "File to write").required().file();
  return command_of(std::move(command), options, run_record);
}

Command replay_adapter_command() {
  auto path = std::make_shared<std::string>();
  OptionTable command("replay-adapter", "Be a simulator that was recorded, for tests without it");
  command.footer(
      "Examples:\n"
      "  simulator: {command: [parallax, replay-adapter, runs.ndjson]}\n"
      "A request is answered as it was after the same reset and actions; one that was never made "
      "is a\n"
      "loss (`not_recorded`). `parallax run` with the same seed asks the same.\n"
      "Exit codes: 0, 1 where the recorded simulator ended, 2 and 3 for a file that is no "
      "recording.");
  command.option("file", *path, "What `parallax record` has written").required().file();
  return {std::move(command),
          [path](Invocation& invocation) { return run_replay_adapter(*path, invocation); }};
}

}  // namespace parallax::tools
