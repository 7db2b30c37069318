#include "tools/bench/bench.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "tools/bench/families/families.h"

namespace parallax::tools {

namespace fs = std::filesystem;

Bench::Bench(const MeasureOptions& options)
    : options_(options),
      folder_(fs::temp_directory_path() / fmt::format("parallax_bench_{}", ::getpid())) {
  fs::create_directory(folder_);
}

Bench::~Bench() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void Bench::begin(std::string section) {
  section_ = std::move(section);
  fmt::print("\n{}\n  {:<43}{:>8} {:>8} {:>11}\n", section_, "", "wall", "cpu", "memory");
}

void Bench::sum_up() {
  const auto first = std::find_if(rows_.begin(), rows_.end(),
                                  [&](const Row& row) { return row.section == section_; });
  fmt::print("{}", summary_text({first, rows_.end()}));
}

const Row& Bench::compare(std::string name, const std::vector<Contestant>& contestants,
                          std::optional<std::string> expected) {
  Row row;
  row.name = std::move(name);
  row.expected = std::move(expected);
  row.sides = measure(contestants, path("output"), options_);
  add(std::move(row));
  return rows_.back();
}

Side Bench::measured(const Contestant& contestant) {
  return measure({contestant}, path("output"), options_).front();
}

void Bench::add(Row row) {
  row.section = section_;
  fmt::print("{}", to_text(row));
  std::fflush(stdout);
  rows_.push_back(std::move(row));
}

std::string Bench::model_file(const std::string& name) {
  const auto file = path(name + ".e");
  if (!fs::exists(file)) std::ofstream(file) << family_model(name).value();
  return file;
}

std::string Bench::compiled_file(const std::string& name, const std::string& suffix,
                                 const std::vector<std::string>& options) {
  auto file = path(name + suffix);
  if (fs::exists(file)) return file;
  std::vector<std::string> command = {parallax_program(), "compile", model_file(name), "-o", file};
  command.insert(command.end(), options.begin(), options.end());
  (void)run_child(command, {path("output"), "", options_.time_limit_s});
  return file;
}

std::string Bench::program_file(const std::string& name, Encoding encoding) {
  if (encoding == Encoding::kExported) return compiled_file(name, ".lp", {"--emit=lp"});
  const auto file = path(name + ".tuned.lp");
  if (!fs::exists(file)) std::ofstream(file) << family_program(name).value();
  return file;
}

std::string Bench::program_without(const std::string& name, const std::string& line) {
  const auto file = path(name + ".shown.lp");
  if (fs::exists(file)) return file;
  std::ifstream in(program_file(name, Encoding::kExported));
  std::ofstream out(file);
  for (std::string text; std::getline(in, text);) {
    if (text != line) out << text << '\n';
  }
  return file;
}

std::string Bench::artifact_file(const std::string& name) {
  return compiled_file(name, ".dec.cnf", {});
}

std::string parallax_program() { return PARALLAX_BINARY_DIR "/parallax"; }

std::string bench_program() { return fs::read_symlink("/proc/self/exe").string(); }

}  // namespace parallax::tools
