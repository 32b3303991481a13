// The subcommands: one file each, and one row of the table in app/main.cpp.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace understudy::app {

/// Does the work after the command line is parsed; gives the exit code, throws Error.
using Action = std::function<int()>;

/// Each adds its options to the command and gives the action that reads them.
Action declare_retarget(CLI::App& command);
Action declare_export(CLI::App& command);
Action declare_batch(CLI::App& command);
Action declare_discover(CLI::App& command);
Action declare_generate(CLI::App& command);
Action declare_fill(CLI::App& command);
Action declare_blend(CLI::App& command);
Action declare_style(CLI::App& command);
Action declare_sheet(CLI::App& command);
Action declare_import_worker(CLI::App& command);
Action declare_cases(CLI::App& command);
Action declare_eval(CLI::App& command);
Action declare_measure(CLI::App& command);
Action declare_report(CLI::App& command);
Action declare_steps(CLI::App& command);
Action declare_train(CLI::App& command);
Action declare_sample(CLI::App& command);
Action declare_doctor(CLI::App& command);
Action declare_bench(CLI::App& command);
Action declare_demo(CLI::App& command);
Action declare_studio(CLI::App& command);
Action declare_play(CLI::App& command);
Action declare_study(CLI::App& command);
Action declare_map(CLI::App& command);

}  // namespace understudy::app
