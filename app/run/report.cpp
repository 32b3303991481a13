#include "app/run/report.hpp"

#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "app/run/version.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace fs = std::filesystem;

std::string checksum(const fs::path& path) {
  const std::string bytes = read_file(path.string());
  return printed("%08lx", crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

Json report_header(const std::string& weights_folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(weights_folder))
    for (const auto& entry : fs::directory_iterator(weights_folder))
      if (file_suffix(entry.path().string()) == ".weights") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string weights;
  for (const fs::path& file : files)
    weights += (weights.empty() ? "" : " ") + file.filename().string() + ":" + checksum(file);
  return {{"program", kProgram}, {"weights", weights}};
}

Json to_json(const Metrics& metrics) {
  Json json = Json::object();
  for (const auto& [key, value] : metrics) json[key] = value;
  return json;
}

Json to_json(const Latency& latency, double quantile) {
  Json json = Json::object();
  for (int i = 0; i < ssize(Latency::kStages); ++i) json[Latency::kStages[i]] = latency.quantile(i, quantile);
  return json;
}

Json to_json(const std::vector<MadeFrames>& made) {
  Json json = Json::array();
  for (const MadeFrames& one : made)
    json.push_back({{"first", one.first}, {"last", one.last}, {"doubt_m", one.doubt_m}});
  return json;
}

void write_json(const std::string& path, const Json& json) {
  write_file(path, json.dump(1) + '\n');
}

}  // namespace understudy::app
