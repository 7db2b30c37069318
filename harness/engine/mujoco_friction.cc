#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "harness/engine/mujoco_engine.h"
#include "harness/engine/mujoco_errors.h"

// MuJoCo finds the forces of a step as the minimum of a convex function. This treats friction as a
// law of the same kind as pressure: a sliding contact comes apart, by friction times the speed of
// its sliding (Anitescu, Mathematical Programming 105, 2006), and a load that slips in a grip
// pushes the pads away until they have lost it. The acceleration asked of pressure is therefore
// lowered by just that (de Saxce and Feng, Mathematical and Computer Modelling 28, 1998). The
// correction depends on the resulting sliding, so the step is solved again until both agree (Acary,
// Cadoux, Lemarechal and Malick, ZAMM 91, 2011), three times as a rule. Where they do not agree, as
// in some steps in which sliding ends, the last solution counts.

namespace parallax::harness {
namespace {

constexpr int kMostRounds = 20;
constexpr int kWholeRounds = 5;            // from here on half of a change is made
constexpr double kSameRate_m_s2 = 1e-3;    // a smaller change counts as none
constexpr double kSameShareOfRate = 1e-3;  // likewise, relative to the current rate

/// The acceleration that the sliding at a contact must lose [m/s^2], including the contact's
/// compliance.
double sliding(const mjData& data, int row, const double* lost) {
  double square = 0.0;
  for (int i = row + 1; i <= row + 2; ++i) {
    const double left = lost[i] - data.efc_aref[i] + data.efc_R[i] * data.efc_force[i];
    square += left * left;
  }
  return std::sqrt(square);
}

bool slides(const mjData& data, const mjContact& contact) {
  const int row = contact.efc_address;
  return contact.dim == 3 && row >= 0 && data.efc_force[row] > 0.0;
}

/// Does any contact have all the friction that its pressure allows?
bool anything_slides(const mjData& data) {
  return std::any_of(data.contact, data.contact + data.ncon, [&](const mjContact& contact) {
    return slides(data, contact) && data.efc_state[contact.efc_address] == mjCNSTRSTATE_CONE;
  });
}

}  // namespace

void solve_friction(MujocoWorld::Engine& engine) {
  const mjModel* const model = engine.model.get();
  mjData& data = *engine.data;
  ask_engine([&] { mj_fwdConstraint(model, &data); });
  if (!anything_slides(data)) return;
  std::vector<double>& asked = engine.asked_m_s2;
  std::vector<double>& lost = engine.lost_m_s2;
  asked.assign(data.efc_aref, data.efc_aref + data.nefc);
  lost.resize(asked.size());
  for (int round = 0; round < kMostRounds; ++round) {
    const double share = round < kWholeRounds ? 1.0 : 0.5;
    ask_engine([&] { mj_mulJacVec(model, &data, lost.data(), data.qacc); });
    bool changed = false;
    for (int i = 0; i < data.ncon; ++i) {
      const mjContact& contact = data.contact[i];
      const int row = contact.efc_address;
      if (contact.dim != 3 || row < 0) continue;
      const double apart =
          slides(data, contact) ? contact.friction[0] * sliding(data, row, lost.data()) : 0.0;
      const double before = asked[static_cast<std::size_t>(row)] - data.efc_aref[row];
      const double change = apart - before;
      data.efc_aref[row] -= share * change;
      changed = changed || std::abs(change) > kSameRate_m_s2 + kSameShareOfRate * apart;
    }
    if (!changed) return;
    ask_engine([&] { mj_fwdConstraint(model, &data); });
  }
}

}  // namespace parallax::harness
