#pragma once

#include <string>
#include <utility>

#include "compiler/artifact/artifact_reader.h"
#include "compiler/artifact/artifact_writer.h"
#include "compiler/artifact/describe.h"
#include "tests/support/text_model.h"

namespace parallax::test {

/// A model text, compiled and ready to be written; `ground` is absent if it was refused.
struct WrittenModel : TextModel {
  explicit WrittenModel(const std::string& text, bool folded = false)
      : TextModel(text, {}, folded) {
    if (ground == nullptr) return;
    compiled.producer = "test 1";
    compiler::describe_sources(compiled, files);
    compiler::sort_clauses(compiled);
  }
  std::string artifact() const { return compiler::to_artifact(compiled); }
};

/// An artifact's text as the reader sees it.
struct ReadText {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  base::Result<compiler::CompiledModel> model;

  explicit ReadText(std::string text)
      : model(compiler::read_artifact(files.add("test.dec.cnf", std::move(text)), files, sink)) {}
  std::string codes() const {
    std::string out;
    for (const auto& diagnostic : sink.sorted()) {
      out += (out.empty() ? "" : " ") + std::string(base::info(diagnostic.code).id);
    }
    return out;
  }
  /// The line of the first message.
  std::size_t line() const {
    const auto first = sink.sorted().front();
    return first.range ? files[first.range->file].position(first.range->begin).line : 0;
  }
};

/// Models that have between them everything that an artifact can hold, but for plans.
inline const std::string kReleases =
    "sort room: integer\nfluent In(room)\nfluent Door()\nfluent Dark()\nnoninertial Dark\n"
    "event Go(room)\nevent Kick()\npredicate Near(room,room)\n"
    "[room1,room2] Near(room1,room2) <-> room1=room2+1 | room2=room1+1.\n"
    "[room,time] Initiates(Go(room),In(room),time).\n"
    "[room1,room2,time] HoldsAt(In(room1),time) & room1!=room2 ->\n"
    "  Terminates(Go(room2),In(room1),time).\n"
    "[room1,room2,time] Happens(Go(room1),time) & HoldsAt(In(room2),time) -> Near(room1,room2).\n"
    "[time] Releases(Kick(),Door(),time).\n"
    "[time] HoldsAt(Dark(),time) <-> !HoldsAt(Door(),time).\n"
    "[room] HoldsAt(In(room),0) <-> room=1.\nHoldsAt(Door(),0).\nHappens(Kick(),1).\n"
    "range time 0 3\nrange room 1 3\n";
inline const std::string kFall =
    "range time 0 4\nrange offset 1 4\nsort height: integer\nrange height 0 3\n"
    "fluent Falling()\nfluent Height(height)\nevent Drop()\nevent Land()\n"
    "[time] Initiates(Drop(),Falling(),time).\n[time,height] "
    "Releases(Drop(),Height(height),time).\n"
    "[time] Terminates(Land(),Falling(),time).\n"
    "[height,time] HoldsAt(Height(height),time) -> Initiates(Land(),Height(height),time).\n"
    "[time,height1,height2] HoldsAt(Height(height1),time) & HoldsAt(Height(height2),time) ->\n"
    "  height1=height2.\n"
    "[time,offset,height1,height2] HoldsAt(Height(height1),time) & height2=height1-offset ->\n"
    "  Trajectory(Falling(),time,Height(height2),offset).\n"
    "Delta: [time] HoldsAt(Falling(),time) & HoldsAt(Height(0),time) -> Happens(Land(),time).\n"
    "Delta: Happens(Drop(),0).\n!HoldsAt(Falling(),0).\nHoldsAt(Height(3),0).\n"
    "completion Delta Happens\n";

}  // namespace parallax::test
