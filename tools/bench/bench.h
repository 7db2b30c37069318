#pragma once

#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/bench/contestants.h"
#include "tools/bench/measure.h"

namespace parallax::tools {

/// A run of the benchmark: its files, settings and results. Rows are printed as they are measured.
class Bench {
 public:
  /// Makes a folder below the one for temporary files; it is removed at the end.
  explicit Bench(const MeasureOptions& options);
  ~Bench();
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  /// Finishes the current section and begins `section`.
  void begin(std::string section);
  /// Prints the cost of the peers in the section relative to ours, in the mean and where they did
  /// best.
  void sum_up();
  /// Measures the contestants and adds the row.
  const Row& compare(std::string name, const std::vector<Contestant>& contestants,
                     std::optional<std::string> expected = std::nullopt);
  /// Measures one program without adding a row.
  Side measured(const Contestant& contestant);
  /// Adds a row that was measured in another way; its section is filled in.
  void add(Row row);
  const std::vector<Row>& rows() const { return rows_; }

  /// A file in the run's folder.
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// `NAME.e` with the text of the family's model; the name must exist.
  std::string model_file(const std::string& name);
  /// `NAME.lp` or `NAME.tuned.lp`, for clingo.
  std::string program_file(const std::string& name, Encoding encoding);
  /// `NAME.shown.lp`: the exported program without a line.
  std::string program_without(const std::string& name, const std::string& line);
  /// `NAME.dec.cnf`: the model compiled by `parallax compile`.
  std::string artifact_file(const std::string& name);

 private:
  std::string compiled_file(const std::string& name, const std::string& suffix,
                            const std::vector<std::string>& options);

  MeasureOptions options_;
  std::filesystem::path folder_;
  std::string section_;
  std::vector<Row> rows_;
};

/// The program under test, and this one.
std::string parallax_program();
std::string bench_program();

struct Section {
  const char* name;
  const char* what;
  void (*measure)(Bench&);
  bool only_by_name = false;  // too long to be measured with the others
};

/// In the order in which they are measured and printed.
const std::vector<Section>& sections();

void measure_start(Bench& bench);
void measure_compilation(Bench& bench);
void measure_horizons(Bench& bench);
void measure_growth(Bench& bench);
void measure_examples(Bench& bench);
void measure_counting(Bench& bench);
void measure_listing(Bench& bench);
void measure_first_trace(Bench& bench);
void measure_large_first_trace(Bench& bench);
void measure_consequences(Bench& bench);
void measure_optimum(Bench& bench);
void measure_strategies(Bench& bench);
void measure_difference(Bench& bench);
void measure_proofs(Bench& bench);
void measure_plan(Bench& bench);
void measure_plan_folder(Bench& bench);
void measure_world(Bench& bench);
void measure_loop(Bench& bench);
void measure_demo(Bench& bench);
void measure_monitor(Bench& bench);
void measure_starts(Bench& bench);
void measure_build(Bench& bench);
void measure_repair(Bench& bench);
void measure_rival(Bench& bench);

/// A model file, and a plan with its binding table or none.
struct StagesInput {
  std::string model, plan, binding;
};

/// Compiles in this process and prints one line: processor time of reading and checking the model,
/// of grounding it, of the plan and making clauses, of writing them as text; numbers of clauses and
/// bytes. 3 if there is an error.
int print_stages(const StagesInput& input);

/// CaDiCaL and nothing else: reads a DIMACS file with the solver's own reader and solves it once.
/// The exit code of a SAT competition program: 10 satisfiable, 20 unsatisfiable; 1 if the file
/// cannot be read.
int solve_plainly(const std::string& file);

/// Processor time of this process: other work on the machine does not count.
class Stopwatch {
 public:
  /// Since the last call, or since it was made [ms].
  double lap_ms() {
    const auto now = std::clock();
    const auto lap = now - begin_;
    begin_ = now;
    return 1e3 * static_cast<double>(lap) / CLOCKS_PER_SEC;
  }

 private:
  std::clock_t begin_ = std::clock();
};

}  // namespace parallax::tools
