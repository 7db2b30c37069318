#include "tools/cli/launcher_options.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "compiler/base/codes/files.h"
#include "tools/cli/limits.h"

namespace parallax::tools {
namespace {

constexpr double kBeatsInSilence = 5.0;  // all but one of these may be lost on the way

/// A worker takes three pipes, and the usual limit of open files is 1,024. If it cannot be raised,
/// workers beyond it do not start, which is told.
void allow_files_for(std::int64_t workers) {
  constexpr rlim_t kPerWorker = 4, kOthers = 256;
  const auto needed = kPerWorker * static_cast<rlim_t>(workers) + kOthers;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= needed) return;
  limit.rlim_cur = std::min(needed, limit.rlim_max);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

void add_launcher_options(OptionTable& command, LauncherOptions& options) {
  const UnderHeading heading(command, "Workers on other machines");
  command
      .option("--launcher", options.launcher,
              "Prefix for worker commands: 'srun -n1 -c1', 'ssh lab3' (docs/guide/clusters.md)")
      .details("--jobs says how many workers are started.")
      .named_value("COMMAND");
  command
      .option("--hosts", options.hosts,
              "File with one prefix command a line and its number of workers")
      .details("--jobs, if given, says how many of all of them are used at a time.")
      .named_value("FILE")
      .file();
  command
      .option("--first-slot", options.first_slot,
              "Begin with this place of --hosts, counted from 0")
      .details("For several campaigns at the same time.")
      .check(WholeNumber{0, harness::kMostSlots - 1})
      .needs("--hosts");
  command
      .option("--worker-start", options.start_s,
              "Seconds until a worker has to be there; one that comes later is ignored")
      .check(FiniteNumber{0.01, 86'400.0})
      .show_default();
  command
      .option("--worker-silence", options.silence_s,
              "A worker at work that gives no sign of life for so many seconds is lost")
      .check(FiniteNumber{0.05, 86'400.0})
      .show_default();
}

void add_mixed_option(OptionTable& command, LauncherOptions& options) {
  const UnderHeading heading(command, "Workers on other machines");
  command
      .flag("--mixed", options.mixed,
            "Let workers of another build, or on other processors, take part")
      .details(
          "Their results may differ in last digits, so that nothing is repeated bit for bit. The "
          "journal names the kind of each simulation, and the report counts them.");
}

base::Result<std::shared_ptr<harness::Fleet>> fleet_of(const LauncherOptions& options,
                                                       std::int64_t& jobs, Invocation& invocation) {
  auto& sink = invocation.sink();
  if (options.launcher.empty() && options.hosts.empty()) {
    if (options.mixed) {
      return sink.error_about(codes::kUsage, "--mixed",
                              "it is about workers of --launcher or --hosts");
    }
    return std::shared_ptr<harness::Fleet>();
  }
  if (!options.launcher.empty() && !options.hosts.empty()) {
    return sink.error_about(codes::kUsage, "--hosts",
                            "it excludes --launcher, which a line of the file can hold");
  }
  std::vector<harness::WorkerPlace> places;
  if (!options.launcher.empty()) {
    auto place = harness::launcher_place(options.launcher, jobs, sink);
    if (!place) return sink.already_reported();
    places.push_back(*std::move(place));
  } else {
    auto read = harness::read_hosts(options.hosts, invocation.files(), sink);
    if (!read) return sink.already_reported();
    places = *std::move(read);
  }
  std::int64_t slots = 0;
  for (const auto& place : places) slots += place.slots;
  allow_files_for(slots);
  harness::FleetOptions fleet;
  fleet.limits = {options.start_s, options.silence_s};
  fleet.first_slot = static_cast<std::size_t>(options.first_slot);
  fleet.stop = &stop_flag();
  fleet.mixed = options.mixed;
  auto made = std::make_shared<harness::Fleet>(std::move(places), std::move(fleet));
  jobs = options.jobs_given ? std::min(jobs, made->slots()) : made->slots();
  return made;
}

std::vector<std::string> fleet_worker(const ScenarioModel& loaded, const harness::Fleet& fleet,
                                      const Invocation& invocation) {
  std::error_code error;
  // /proc/self/exe is another program there.
  auto program = std::filesystem::read_symlink("/proc/self/exe", error).string();
  std::vector<std::string> words = {std::move(program), "worker", "--elsewhere"};
  words.insert(words.end(), {"--folder", std::filesystem::current_path(error).string()});
  words.insert(words.end(), {"--scenario-hash", loaded.scenario_hash});
  if (!loaded.world_hash.empty()) {
    words.insert(words.end(), {"--world-hash", loaded.world_hash, "--world-horizon",
                               std::to_string(loaded.scenario.horizon)});
  }
  words.insert(words.end(),
               {"--beat", fmt::format("{}", fleet.options().limits.silence_s / kBeatsInSilence)});
  if (!loaded.scenario.simulator.command.empty()) words.emplace_back("--allow-commands");
  if (invocation.form().allow_outside) words.emplace_back("--allow-outside");
  words.insert(words.end(), {"--", loaded.scenario.file.string()});
  return words;
}

std::vector<std::string> launcher_words(const LauncherOptions& options) {
  if (options.launcher.empty() && options.hosts.empty()) return {};
  const bool hosts = options.launcher.empty();
  std::vector<std::string> words = {hosts ? "--hosts" : "--launcher",
                                    hosts ? options.hosts : options.launcher,
                                    "--worker-start",
                                    fmt::format("{}", options.start_s),
                                    "--worker-silence",
                                    fmt::format("{}", options.silence_s),
                                    "--jobs",
                                    "1"};
  if (options.mixed) words.emplace_back("--mixed");
  return words;
}

bool report_fleet(const std::shared_ptr<harness::Fleet>& fleet, Invocation& invocation) {
  if (!fleet) return true;
  return fleet->report(invocation.sink(),
                       [&](const std::string& text) { invocation.remark(text); });
}

}  // namespace parallax::tools
