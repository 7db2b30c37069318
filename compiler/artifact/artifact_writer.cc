#include "compiler/artifact/artifact_writer.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "compiler/artifact/artifact_text.h"
#include "compiler/artifact/clause_runs.h"

namespace parallax::compiler {
namespace {

class ArtifactWriter {
 public:
  using Take = std::function<void(std::string_view)>;
  ArtifactWriter(const CompiledModel& model, const Take& take) : model_(model), take_(take) {}

  void run(const ArtifactOptions& options) && {
    check_names();
    write_frame();
    write_names();
    write_other_slots();
    write_fixed();
    write_objectives();
    write_axioms();
    write_sections();
    write_plan();
    const auto header =
        fmt::format("p cnf {} {}\n", model_.variable_count(), model_.clause_count());
    LineHash hash;
    add_lines(out_ + header, hash);
    const auto entries = std::exchange(out_, {});
    write_clauses([&](std::string_view lines) { add_lines(lines, hash); });

    take_(entries);
    print("{}fnv1a64 {:016x}\n", kHashEntry, hash.value());
    if (options.projection_line) out_ += "c t pmc\n";
    out_ += header;
    if (options.projection_line) write_projection();
    hand_over(take_);
    write_clauses(take_);
  }

 private:
  template <typename... Args>
  void print(fmt::format_string<const Args&...> format, const Args&... args) {
    fmt::format_to(std::back_inserter(out_), format, args...);
  }
  void word(std::string_view text) { append_word(out_, text); }
  void number(std::int64_t value) {
    const fmt::format_int digits(value);
    out_ += ' ';
    out_.append(digits.data(), digits.size());
  }

  void check_names() {
    named_.resize(model_.slots.size(), false);
    PARALLAX_REQUIRE(model_.release_slots.size() == model_.fluents.size(),
                     "release slots by fluent");
    for (std::size_t i = 0; i < model_.fluents.size(); ++i) {
      const auto& fluent = model_.fluents[i];
      if (fluent.slot) claim(*fluent.slot, {AtomKind::kHoldsAt, fluent.name});
      if (!model_.release_slots[i]) continue;
      claim(*model_.release_slots[i], {AtomKind::kReleasedAt, fluent.name});
    }
    for (const auto& event : model_.events) {
      if (event.slot) claim(*event.slot, {AtomKind::kHappens, event.name});
    }
  }
  void claim(std::uint32_t slot, const Slot& meaning) {
    PARALLAX_REQUIRE(slot < model_.slots.size() && model_.slots[slot] == meaning && !named_[slot],
                     "a slot of its own for every name");
    named_[slot] = true;
  }

  void write_frame() {
    // A model without objectives keeps minor version 0, so that readers of the first version accept
    // it.
    print("c dec format {}.{}\n", kFormatMajor, model_.objectives.empty() ? 0 : kFormatMinor);
    if (!model_.producer.empty()) line("producer", model_.producer);
    for (const auto& [name, value] : model_.options) {
      out_ += "c dec option";
      word(name);
      word(value);
      out_ += '\n';
    }
    for (const auto& source : model_.sources) {
      out_ += "c dec source";
      word(source.name);
      print(" fnv1a64 {:016x}\n", source.hash);
    }
    print("c dec horizon {}\nc dec base {}\nc dec stride {}\nc dec state-slots {}\n",
          model_.horizon, model_.base(), model_.stride(), model_.state_slots);
    print("c dec state-constraints {}\n", model_.has_constraints ? "yes" : "no");
  }
  void line(std::string_view key, std::string_view value) {
    print("c dec {}", key);
    word(value);
    out_ += '\n';
  }

  void write_names() {
    for (std::size_t i = 0; i < model_.fluents.size(); ++i) {
      write_name("fluent", model_.fluents[i]);
      if (model_.release_slots[i]) print(" released {}", *model_.release_slots[i]);
      out_ += '\n';
    }
    for (const auto& event : model_.events) {
      write_name("event", event);
      out_ += '\n';
    }
  }
  void write_name(std::string_view key, const GroundName& ground) {
    print("c dec {}", key);
    word(ground.name);
    if (ground.slot) {
      number(*ground.slot);
    } else {
      out_ += " never";
    }
  }

  void write_other_slots() {
    const auto occurring = occurrences(model_);
    for (std::size_t i = 0; i < model_.slots.size(); ++i) {
      const auto& slot = model_.slots[i];
      const auto usual = occurring.slots[i] ? AtomKind::kAuxiliary : AtomKind::kUnused;
      if (named_[i] || slot == Slot{usual, {}}) continue;
      print("c dec slot {} {}", i, to_string(slot.kind));
      word(slot.name);
      out_ += '\n';
    }
    fixed_occur_ = occurring.fixed;
  }

  void write_fixed() {
    for (std::size_t i = 0; i < model_.fixed.size(); ++i) {
      const auto& atom = model_.fixed[i];
      const auto usual = fixed_occur_[i] ? AtomKind::kAuxiliary : AtomKind::kUnused;
      if (atom == Atom{usual, {}, std::nullopt, {}}) continue;
      print("c dec atom {} {}", i + 1, to_string(atom.kind));
      word(printed(atom));
      if (atom.time) number(*atom.time);
      out_ += '\n';
    }
  }

  void write_objectives() {
    for (const auto& objective : model_.objectives) {
      line("objective", objective.text);
      for (const auto& term : objective.terms) {
        print("c dec term {} at {}", term.weight, term.needed);
        if (term.literal) number(term.literal->dimacs());
        out_ += '\n';
      }
    }
  }

  void write_axioms() {
    for (const auto& origin : model_.origins) {
      places_.write_file(origin.place, out_);
      PARALLAX_REQUIRE(!origin.id.empty(), "every origin has an id");
      out_ += "c dec axiom";
      word(origin.id);
      word(to_string(origin.kind));
      places_.write_place(origin.place, out_);
      word(origin.text);
      out_ += '\n';
    }
  }

  void write_sections() {
    std::size_t begin = 0;
    for (const auto& section : model_.sections) {
      PARALLAX_REQUIRE(section.begin == begin, "sections cover the clauses, in order");
      if (section.copies == 0) continue;  // it says nothing at this horizon
      begin += section.clauses * static_cast<std::size_t>(model_.stored_copies(section));
      PARALLAX_REQUIRE(begin <= model_.clauses.size(), "sections cover the clauses, in order");
      if (section.repeated) {
        require_copies(section);
        print("c dec section repeated {}\n", section.width);
      } else {
        PARALLAX_REQUIRE(section.copies == 1, "only repeated sections have copies");
        out_ += "c dec section fixed\n";
      }
      for (const auto& run : clause_runs(model_, section)) {
        out_ += "c dec clauses";
        word(model_.origins[run.origin].id);
        append_counts(run.groups, out_);
        if (run.timepoint) print(" at {}", *run.timepoint);
        out_ += '\n';
      }
    }
    PARALLAX_REQUIRE(begin == model_.clauses.size(), "sections cover the clauses, in order");
  }
  void require_copies(const Section& section) const {
    PARALLAX_REQUIRE(section.copies == model_.horizon - section.width + 1,
                     "one copy for every timepoint");
    for (std::int64_t copy = 1; copy < model_.stored_copies(section); ++copy) {
      for (std::size_t i = section.begin; i < section.begin + section.clauses; ++i) {
        const auto j = i + section.clauses * static_cast<std::size_t>(copy);
        PARALLAX_REQUIRE(is_shifted(model_, model_.clauses[i], model_.clauses[j], copy) &&
                             model_.clause_origins[i] == model_.clause_origins[j] &&
                             model_.clause_is_definition[i] == model_.clause_is_definition[j] &&
                             model_.clause_timepoints[i] + copy == model_.clause_timepoints[j],
                         "copies are the first block, moved");
      }
    }
  }

  void write_plan() {
    for (const auto& step : model_.plan) {
      places_.write_file(step.place, out_);
      out_ += "c dec step";
      word(step.event);
      word(step.failure_class);
      places_.write_place(step.place, out_);
      out_ += '\n';
      for (const auto& [name, value] : step.arguments) write_argument(name, value);
    }
    for (const auto& cut : model_.plan_cuts) {
      places_.write_file(cut.place, out_);
      out_ += "c dec cut";
      word(cut.form);
      places_.write_place(cut.place, out_);
      out_ += '\n';
    }
  }
  void write_argument(std::string_view name, const PlanValue& value) {
    out_ += "c dec argument";
    word(name);
    if (const auto* text = std::get_if<std::string>(&value)) {
      out_ += " text";
      word(*text);
    } else if (const auto* integer = std::get_if<std::int64_t>(&value)) {
      print(" integer {}", *integer);
    } else {
      print(" real {}", std::get<double>(value));
    }
    out_ += '\n';
  }

  void write_projection() {
    out_ += "c p show";
    for_each_observable(model_, [&](std::int32_t v) {
      number(v);
      if (out_.size() >= kPiece) hand_over(take_);
    });
    out_ += " 0\n";
  }

  /// In pieces of whole lines.
  void write_clauses(const Take& take) {
    for (const auto& section : model_.sections) {
      for (std::int64_t copy = 0; copy < section.copies; ++copy) {
        const auto stored = model_.folded ? 0 : copy;
        const auto begin = section.begin + section.clauses * static_cast<std::size_t>(stored);
        for (auto i = begin; i < begin + section.clauses; ++i) {
          write_clause(model_.clauses[i], copy - stored);
          if (out_.size() >= kPiece) hand_over(take);
        }
      }
    }
    hand_over(take);
  }
  void write_clause(std::span<const Literal> clause, std::int64_t steps) {
    for (const auto literal : clause) {
      const fmt::format_int digits(model_.moved(literal, steps).dimacs());
      out_.append(digits.data(), digits.size());
      out_ += ' ';
    }
    out_ += "0\n";
  }

  void hand_over(const Take& take) {
    take(out_);
    out_.clear();
  }
  static void add_lines(std::string_view lines, LineHash& hash) {
    while (!lines.empty()) {
      const auto end = lines.find('\n');
      hash.add(lines.substr(0, end));
      lines.remove_prefix(end + 1);
    }
  }

  static constexpr std::size_t kPiece = std::size_t{1} << 16U;  // bytes, or one clause more

  const CompiledModel& model_;
  const Take& take_;
  std::string out_;          // text that is not yet handed over
  std::vector<bool> named_;  // slots of fluents, releases and events
  std::vector<bool> fixed_occur_;
  PlaceWriter places_;
};

}  // namespace

std::string to_artifact(const CompiledModel& model, const ArtifactOptions& options) {
  std::string text;
  write_artifact(model, options, [&](std::string_view piece) { text += piece; });
  return text;
}

void write_artifact(const CompiledModel& model, const ArtifactOptions& options,
                    const std::function<void(std::string_view)>& take) {
  ArtifactWriter(model, take).run(options);
}

bool is_artifact_name(std::string_view name) { return name.ends_with(".cnf"); }

}  // namespace parallax::compiler
