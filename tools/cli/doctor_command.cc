#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/doctor/doctor.h"

namespace parallax::tools {

Command doctor_command() {
  OptionTable command("doctor", "Does everything that the program stands on work on this machine?");
  command.footer(
      "Tries a model in the solver, a scenario in the simulator, worlds of other formats, and the\n"
      "programs that some commands call, and says what is missing and how to get it.\n"
      "Exit codes: 0 all that is needed works, 1 something does not.");
  return {std::move(command), [](Invocation& invocation) {
            const auto diagnosis = diagnose(stop_flag());
            // A limit or a signal came before the last answer: nothing is known of the rest.
            if (!stop_flag().load()) invocation.answered();
            if (invocation.options().json) {
              invocation.document(diagnosis_json(diagnosis));
            } else {
              invocation.result(diagnosis_text(diagnosis));
            }
            if (stop_flag().load()) return 4;
            return diagnosis.failures() == 0 ? 0 : 1;
          }};
}

}  // namespace parallax::tools
