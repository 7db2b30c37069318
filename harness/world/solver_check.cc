#include <cmath>

#include "harness/world/mobile_check.h"

namespace parallax::harness {
namespace {

constexpr double kMaxGravity_m_s2 = 100.0;  // four times that of the largest planet

class SolverChecker {
 public:
  explicit SolverChecker(std::vector<WorldProblem>& problems) : problems_(problems) {}

  void run(const SolverSpec& s) {
    // Longer steps are no physics, shorter ones no simulation anybody waits for.
    require(s.timestep_s >= 1e-5 && s.timestep_s <= 0.1, "timestep_s",
            "is not within 1e-5 to 0.1 s");
    require_softness("erp", "cfm", s.erp, s.cfm);
    require_softness("contact_erp", "contact_cfm", s.contact_erp.value_or(1.0),
                     s.contact_cfm.value_or(0.0));
    require_not_negative("surface_layer_m", s.surface_layer_m);
    require(s.max_correcting_velocity_m_s > 0.0 && std::isfinite(s.max_correcting_velocity_m_s),
            "max_correcting_velocity_m_s", "is not a positive number");
    require_not_negative("start_penetration_m", s.start_penetration_m);
    require_not_negative("sleep_linear_m_s", s.sleep_linear_m_s);
    require_not_negative("sleep_angular_rad_s", s.sleep_angular_rad_s);
    require_not_negative("sleep_after_s", s.sleep_after_s);
    require(s.gravity_m_s2 <= 0.0, "gravity_m_s2", "does not point down: it is not negative");
    require(s.gravity_m_s2 >= -kMaxGravity_m_s2, "gravity_m_s2", "is stronger than 100 m/s^2");
    require(s.max_contacts_per_pair >= 1 && s.max_contacts_per_pair <= 16, "max_contacts_per_pair",
            "is not within 1 to 16");
  }

 private:
  void require(bool good, const char* key, const char* message) {
    if (!good) problems_.push_back({std::string("solver/") + key, message, {}});
  }
  void require_not_negative(const char* key, double value) {
    require(value >= 0.0 && std::isfinite(value), key, "is negative or not a number");
  }
  /// Share of an error that a step corrects, and how much a constraint gives.
  void require_softness(const char* erp_key, const char* cfm_key, double erp, double cfm) {
    require(erp > 0.0 && erp <= 1.0, erp_key, "is not within (0, 1]");
    require(cfm >= 0.0 && cfm <= 1.0, cfm_key, "is not within 0 to 1");
  }

  std::vector<WorldProblem>& problems_;
};

}  // namespace

void check_solver(const SolverSpec& solver, std::vector<WorldProblem>& problems) {
  SolverChecker(problems).run(solver);
}

}  // namespace parallax::harness
