#pragma once

#include <string>
#include <vector>

namespace parallax::tools {

/// One picture of a simulation.
struct PictureStep {
  std::string file;     // "05.svg"
  std::string title;    // "event 4: Go(bTable) (drive)"
  std::string place;    // "plan2.lisp:22"; may be empty
  std::string outcome;  // how the action ended
  bool warns = false;   // it failed, or model and simulation part there
  bool parts = false;   // they part there
  std::string svg;      // without a style of its own
};

struct PictureIndex {
  std::string scenario, simulation;  // "plan2.yaml", "2.7, seed 123"
  std::string words;                 // what parted model and world; empty: nothing did
  bool is_clean = false;             // it is known that they do not part
  std::string style;                 // of the pictures
  std::vector<PictureStep> steps;
};

/// A page with the pictures of one simulation: a sentence on the outcome, the picture of where
/// model and simulation part, the list of events, then all pictures. Self-contained, like pages of
/// `parallax report`.
std::string picture_index(const PictureIndex& index);

}  // namespace parallax::tools
