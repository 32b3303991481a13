#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "app/cli/commands.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"

namespace understudy::app {

// What the program calls on itself, so that a file that crashes the reader does not take the window along.
Action declare_import_worker(CLI::App& command) {
  command.group("");  // not in the help
  const auto in = std::make_shared<std::string>(), out = std::make_shared<std::string>();
  command.add_option("IN", *in)->required();
  command.add_option("OUT", *out)->required();
  return [in, out] {
    try {
      write_gltf_character(*out, import_by_assimp(*in));
      return 0;
    } catch (const std::bad_alloc&) {
      std::fprintf(stderr, "it needs more memory than its reader may use\n");
      return 1;
    } catch (const std::exception& error) {  // assimp's own too
      std::fprintf(stderr, "%s\n", error.what());
      return 1;
    }
  };
}

}  // namespace understudy::app
