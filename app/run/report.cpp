#include "app/run/report.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "app/run/version.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy::app {
namespace fs = std::filesystem;

std::string checksum(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  US_CHECK(file, path.string(), ": cannot be read");
  std::vector<char> block(1 << 16);
  uLong crc = crc32(0, nullptr, 0);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0)
    crc = crc32(crc, reinterpret_cast<const Bytef*>(block.data()), static_cast<uInt>(file.gcount()));
  char text[16];
  std::snprintf(text, sizeof text, "%08lx", crc);
  return text;
}

Json report_header(const std::string& weights_folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(weights_folder))
    for (const auto& entry : fs::directory_iterator(weights_folder))
      if (entry.path().extension() == ".weights") files.push_back(entry.path());
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

void write_json(const std::string& path, const Json& json) {
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary);
  file << json.dump(1) << '\n';
  file.close();
  if (!file || std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    throw Error(path + ": cannot be written");
  }
}

void check_writable(const std::string& path) {
  if (path.empty()) return;
  US_CHECK(!fs::is_directory(path), path, ": is a folder, not a file");
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary);
  US_CHECK(file, path, ": cannot be written");
  file.close();
  std::remove(part.c_str());
}

}  // namespace understudy::app
