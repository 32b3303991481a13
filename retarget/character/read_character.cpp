#include "retarget/character/read_character.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "retarget/base/error.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/vertex_colors.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/mesh_reader.hpp"

namespace understudy {
namespace {

/// A folder that goes away.
struct WorkFolder {
  WorkFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "understudy_import_XXXXXX").string();
    US_CHECK(::mkdtemp(name.data()) != nullptr, name, ": cannot be made (", std::strerror(errno), ")");
    path = name;
  }
  ~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  std::string path;
};

void limit(int resource, rlim_t most) {
  const struct rlimit value = {most, most};
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &value);
}

/// Between fork and exec: only what may be called there.
[[noreturn]] void become_worker(const char* const arguments[], int errors, rlim_t seconds, rlim_t bytes) {
  ::dup2(errors, 2);
  ::close_range(3, ~0u, 0);  // windows, sockets and files of the program are none of a broken file's business
  limit(RLIMIT_CPU, seconds);
  limit(RLIMIT_AS, bytes);
  limit(RLIMIT_FSIZE, bytes);
  limit(RLIMIT_CORE, 0);
  ::execv(arguments[0], const_cast<char* const*>(arguments));
  ::_exit(127);
}

/// The exit status, or none when patience ended; the process is gone either way.
bool wait_for(pid_t pid, double patience_s, int& status) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (true) {
    const pid_t done = ::waitpid(pid, &status, WNOHANG);
    if (done == pid) return true;
    if (done < 0 && errno != EINTR) return false;
    if (std::chrono::steady_clock::now() > end) {
      ::kill(pid, SIGKILL);
      ::waitpid(pid, &status, 0);
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// What the worker made, which is to be trusted no more than the file it was made of.
Character answer(const std::string& made, const std::string& path) {
  try {
    return parse_gltf_character(read_file(made), made);
  } catch (const Error&) {
    throw Error(path + ": the reader of this format found nothing usable in it");
  }
}

/// Runs the worker on the file and reads what it made. Throws Error naming the file: what the worker wrote,
/// that it crashed, or that it took too long or too much memory.
Character read_in_process(const std::string& path, const ReadCharacterOptions& options) {
  const WorkFolder folder;
  const std::string out = folder.path + "/character.glb", messages = folder.path + "/said.txt";
  const std::string worker =
      options.worker.empty() ? std::filesystem::read_symlink("/proc/self/exe").string() : options.worker;
  const std::string input = std::filesystem::absolute(path).string();
  const char* const arguments[] = {worker.c_str(), "import-worker", input.c_str(), out.c_str(), nullptr};
  const int errors = ::open(messages.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
  US_CHECK(errors >= 0, messages, ": cannot be written (", std::strerror(errno), ")");
  const auto seconds = static_cast<rlim_t>(options.patience_s + 1);
  const auto bytes = static_cast<rlim_t>(options.memory_bytes);  // of memory, and of what it writes
  const pid_t pid = ::fork();
  if (pid == 0) become_worker(arguments, errors, seconds, bytes);
  ::close(errors);
  US_CHECK(pid > 0, path, ": no process could be started to read it (", std::strerror(errno), ")");
  int status = 0;
  US_CHECK(wait_for(pid, options.patience_s, status), path, ": reading it took longer than ",
           options.patience_s, " s and was given up");
  US_CHECK(WIFEXITED(status), path, ": the reader of this format crashed on it; the file may be damaged");
  US_CHECK(WEXITSTATUS(status) != 127, worker, ": cannot be started to read ", path);
  if (WEXITSTATUS(status) != 0) {
    const std::string why = last_words(read_file(messages));
    throw Error(path + ": " + (why.empty() ? "could not be read" : why));
  }
  Character character = answer(out, path);
  character.name = std::filesystem::path(path).stem().string();
  return character;
}

/// Formats of which more than a mesh is read.
struct Reader {
  std::string_view format;
  Character (*parse)(std::string_view bytes, const std::string& path);
};
constexpr Reader kReaders[] = {{"glTF", parse_gltf_character}, {"OBJ", parse_obj_character}};

/// Of these an outside library reads all.
bool needs_process(const FileFormat* format) {
  return format && !format->parse && !format->open;
}

Character read_any(const std::string& path, const ReadCharacterOptions& options) {
  const std::string bytes = read_file(path), stem = std::filesystem::path(path).stem().string();
  US_CHECK(!bytes.empty(), path, ": is empty");
  const FileFormat* const suffix = format_of_suffix(path, kTarget);
  US_CHECK(suffix || !can_be(path, kMotion), path, ": is a motion, not a character");
  const FileFormat* const content = format_of_content(bytes, kTarget);
  if (needs_process(suffix) || needs_process(content)) return read_in_process(path, options);
  const FileFormat* const format = content ? content : suffix;
  for (const Reader& reader : kReaders)
    if (format && reader.format == format->name) return reader.parse(bytes, path);
  const Mesh mesh = parse_mesh(bytes, path);
  Character out = character_of_mesh(mesh, stem);
  check_character(out, path);
  return out;
}

}  // namespace

std::string last_words(std::string_view messages) {
  constexpr size_t kMost = 200;
  const size_t end = messages.find_last_not_of("\n\r ");
  if (end == messages.npos) return {};
  messages = messages.substr(0, end + 1);
  const size_t begin = messages.find_last_of('\n');
  if (begin != messages.npos) messages.remove_prefix(begin + 1);
  std::string out(messages.substr(0, kMost));
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return out;
}

Character character_of_mesh(const Mesh& mesh, const std::string& name) {
  Character out;
  out.name = name;
  CharacterNode node;
  node.name = name;
  out.nodes.push_back(node);
  CharacterPart part;
  part.name = name;
  part.node = 0;
  part.vertices = mesh.vertices;
  part.faces = mesh.faces;
  if (mesh.faces.rows() > 0) part.normals = vertex_normals(mesh.vertices, mesh.faces);
  if (mesh.colors.rows() == mesh.vertices.rows() && mesh.colors.rows() > 0) {
    part.colors = RowMatrix::Ones(mesh.vertices.rows(), 4);
    part.colors.leftCols<3>() = mesh.colors.unaryExpr(&to_linear);
  }
  const std::string color = part.colors.rows() > 0 ? "1.0,1.0,1.0,1.0" : "0.8,0.76,0.72,1.0";
  out.materials.push_back(R"({"name":"body","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[)" +
                          color + R"(],"metallicFactor":0.0,"roughnessFactor":0.8}})");
  part.material = 0;
  out.parts.push_back(std::move(part));
  return out;
}

Character read_character(const std::string& path, const ReadCharacterOptions& options) {
  Character character = read_any(path, options);
  character.file = path;
  return character;
}

}  // namespace understudy
