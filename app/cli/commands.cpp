#include "app/cli/commands.hpp"

namespace understudy::app {

Action declare_retarget(CLI::App& command);
Action declare_export(CLI::App& command);
Action declare_import_worker(CLI::App& command);
Action declare_cases(CLI::App& command);
Action declare_eval(CLI::App& command);
Action declare_measure(CLI::App& command);
Action declare_report(CLI::App& command);
Action declare_train(CLI::App& command);
Action declare_sample(CLI::App& command);
Action declare_doctor(CLI::App& command);
Action declare_bench(CLI::App& command);
Action declare_demo(CLI::App& command);
Action declare_studio(CLI::App& command);
Action declare_play(CLI::App& command);

const std::vector<Subcommand>& subcommands() {
  static const std::vector<Subcommand> table = {
      {"studio", "opens the window", declare_studio},
      {"play", "plays a script of the studio without a window", declare_play},
      {"retarget", "lets a target perform what a source does", declare_retarget},
      {"export", "a character performs motions, as an animated GLB or glTF", declare_export},
      {"cases", "makes suites of test cases from people and motions", declare_cases},
      {"eval", "evaluates the method on a folder of cases", declare_eval},
      {"measure", "tells what can be told of a source without knowing the truth", declare_measure},
      {"report", "compares ways to do the job: a page of tables and plots", declare_report},
      {"train", "trains a network", declare_train},
      {"sample", "writes the bundled samples as files", declare_sample},
      {"doctor", "tells what this machine has: BLAS, threads, OpenGL, weights", declare_doctor},
      {"bench", "measures time, memory and work of a frame", declare_bench},
      {"demo", "the bundled scan onto the bundled targets", declare_demo},
      {"import-worker", "reads a file in a process of its own", declare_import_worker},
  };
  return table;
}

}  // namespace understudy::app
