#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools {

// Families of models whose size is a parameter and whose number of traces is known. Each function
// returns a complete text in the language of `docs/reference/model_language.md`; the same
// parameters give the same text. Parameters are positive unless said otherwise and at most
// kMaxFamilyParameter.

inline constexpr int kMaxFamilyParameter = 1'000'000;

/// `lamps` switches of which any may be toggled at each of `horizon` steps; all lamps are dark at
/// first and lit at the end. 2^(lamps*(horizon-1)) traces.
std::string lamps_model(int lamps, int horizon);

/// The same lamps, but none is flipped both in the first and in the last of at least 3 steps: a
/// text that ties distant timepoints together. (3*2^(horizon-3))^lamps traces.
std::string distant_model(int lamps, int horizon);

/// A robot carries `things` things between the ends of a row of `rooms` rooms, one at a time: the
/// first thing from the first room to the last, the second the other way, and so on. The horizon
/// is that of the shortest plan, things*(rooms+1), and `slack` steps, which may be negative.
std::string robot_model(int rooms, int things, int slack);

/// The same world without a goal: everything that the robot can do in `horizon` steps.
std::string roaming_model(int rooms, int things, int horizon);

/// `pigeons` land at once, each in one of `holes` holes, no two in one.
/// holes!/(holes-pigeons)! traces.
std::string pigeon_model(int pigeons, int holes);

/// The same of pigeons that wear a ring of their own each, in holes that have a door each.
std::string ringed_model(int pigeons, int holes);

/// A tick lights the next of `stages` stages; does the last one stay dark? No trace.
std::string chain_model(int stages);

/// Transfers between accounts that are written in the account's book as integers.
struct BankSize {
  int accounts = 0;
  int max_balance = 0;  // of any account; each starts with its share, max_balance / accounts
  int max_amount = 0;   // of one transfer
  int horizon = 0;      // one transfer a step
};

/// By numbers of accounts, from 1.
struct Transfer {
  int from = 0;
  int to = 0;
  int amount = 0;
};

/// One legal transfer for each step, drawn by a generator of our own.
std::vector<Transfer> told_transfers(const BankSize& size);

/// All transfers are given. One trace.
std::string bank_projection_model(const BankSize& size);

/// At most one transfer a step, none of them given; at the end the first account has everything.
std::string bank_planning_model(const BankSize& size);

/// A thing is dropped `horizon` - 2 units above the ground, falls one unit a step by a trajectory,
/// and hitting the ground is an event that this triggers. One trace. `horizon` is 3 or more.
std::string falling_model(int horizon);

/// A world without a goal, the goal as a formula over `time`, and the world with the goal at its
/// last timepoint.
struct FamilyTask {
  std::string world, goal, model;
};

/// `robots` robots on a square grid of `width` times `width` cells, each to go to the opposite
/// cell. All move at once; no two meet. At most as many robots as cells.
FamilyTask grid_task(int width, int robots, int horizon);

/// The towers of Hanoi; the shortest way takes 2^discs - 1 steps.
FamilyTask hanoi_task(int discs, int horizon);

/// `packages` packages, each to be brought from one place to another by one of `trucks` trucks
/// that drive between any two of `places` (at least 2) and carry one package each.
FamilyTask logistics_task(int packages, int trucks, int places, int horizon);

/// The task of a name of these three families, `grid_6_5_10`; nullopt for other names.
std::optional<FamilyTask> family_task(std::string_view name);

/// The model of a name such as `robot_4_2_8`, `robot_6_4_m1` (slack -1), `lamps_4_6`,
/// `roaming_6_4_30`, `distant_4_6`, `pigeon_9_8`, `chain_200`, `bankproj_4_100_5_20`,
/// `bankplan_3_12_4_5`, `falling_40`, `grid_6_5_10`, `hanoi_5_31`, `logistics_5_2_4_9`; nullopt if
/// there is no such family or a parameter is out of range.
std::optional<std::string> family_model(std::string_view name);

/// The same model as a clingo user would write it by hand (tuned.h).
std::optional<std::string> family_program(std::string_view name);

}  // namespace parallax::tools
