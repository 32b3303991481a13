#include "retarget/nn/weights_file.hpp"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "retarget/base/error.hpp"

namespace understudy::nn {
namespace {

// Layout: "USWEIGHT", uint32 length of the JSON, the JSON (kind, version, numbers, tensors: name, shape,
// half, offset), then the tensors' bytes, little-endian.
constexpr char kMagic[9] = "USWEIGHT";
using nlohmann::json;

template <class Visit>
void each_tensor(const torch::nn::Module& module, Visit visit) {
  for (const auto& item : module.named_parameters()) visit(item.key(), item.value());
  for (const auto& item : module.named_buffers()) visit(item.key(), item.value());
}

struct Opened {
  json description;
  std::string bytes;  // the tensors
};

Opened open(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  US_CHECK(in, path, ": the weights are missing or cannot be opened");
  std::ostringstream all;
  all << in.rdbuf();
  const std::string file = all.str();
  US_CHECK(file.size() > 12 && file.compare(0, 8, kMagic) == 0, path, ": not a weights file");
  uint32_t length;
  std::memcpy(&length, file.data() + 8, 4);
  US_CHECK(uint64_t{12} + length <= file.size(), path, ": the weights file is cut off");
  Opened opened{json::parse(file.substr(12, length), nullptr, false), file.substr(12 + size_t{length})};
  US_CHECK(opened.description.is_object() && opened.description.contains("tensors"), path,
           ": the weights file is damaged");
  return opened;
}

/// What `read` makes of the description; members that are missing or of another kind are damage.
template <class Read>
auto described(const std::string& path, Read read) {
  try {
    return read();
  } catch (const json::exception&) {
    throw Error(path + ": the weights file is damaged");
  }
}

WeightsHeader header_of(const json& d) {
  return {d.value("kind", ""), d.value("version", 0), d.value("numbers", std::map<std::string, double>())};
}

torch::Tensor tensor_of(const json& entry, const std::string& bytes, const std::string& path) {
  const auto shape = entry.at("shape").get<std::vector<int64_t>>();
  const bool half = entry.at("half");
  const uint64_t offset = entry.at("offset");
  uint64_t count = 1;
  for (int64_t extent : shape) {
    US_CHECK(extent >= 0 && extent < (int64_t{1} << 31) && count < (uint64_t{1} << 31), path,
             ": the weights file is damaged");
    count *= static_cast<uint64_t>(extent);
  }
  US_CHECK(count < (uint64_t{1} << 31), path, ": the weights file is damaged");
  US_CHECK(offset <= bytes.size() && count * (half ? 2 : 4) <= bytes.size() - offset, path,
           ": the weights file is cut off");
  const auto options = torch::TensorOptions().dtype(half ? torch::kFloat16 : torch::kFloat32);
  auto tensor = torch::empty(shape, options);
  std::memcpy(tensor.data_ptr(), bytes.data() + offset, count * (half ? 2 : 4));
  return tensor.to(torch::kFloat32);
}

}  // namespace

void save_weights(const std::string& path, const WeightsHeader& header, const torch::nn::Module& module,
                  bool half) {
  json tensors = json::object();
  std::string bytes;
  each_tensor(module, [&](const std::string& name, const torch::Tensor& tensor) {
    const auto stored = tensor.detach().cpu().to(half ? torch::kFloat16 : torch::kFloat32).contiguous();
    tensors[name] = {{"shape", tensor.sizes().vec()}, {"half", half}, {"offset", bytes.size()}};
    bytes.append(static_cast<const char*>(stored.data_ptr()), stored.nbytes());
  });
  const std::string description = json{
      {"kind", header.kind},
      {"version", header.version},
      {"numbers", header.numbers},
      {"tensors", tensors}}.dump();
  const auto length = static_cast<uint32_t>(description.size());
  const std::string part = path + ".part";
  std::ofstream out(part, std::ios::binary);
  out.write(kMagic, 8).write(reinterpret_cast<const char*>(&length), 4) << description << bytes;
  out.close();
  US_CHECK(out, path, ": cannot be written");
  US_CHECK(std::rename(part.c_str(), path.c_str()) == 0, path, ": cannot be written");
}

WeightsHeader read_weights_header(const std::string& path) {
  const Opened opened = open(path);
  return described(path, [&] { return header_of(opened.description); });
}

WeightsHeader load_weights(const std::string& path, const std::string& kind, int version,
                           torch::nn::Module& module) {
  const Opened opened = open(path);
  const WeightsHeader header = described(path, [&] { return header_of(opened.description); });
  US_CHECK(header.kind == kind, path, ": holds weights for '", header.kind, "', not for '", kind, "'");
  US_CHECK(header.version == version, path, ": weights of version ", header.version,
           ", this program wants version ", version);
  const torch::NoGradGuard no_grad;
  const json& tensors = opened.description.at("tensors");
  each_tensor(module, [&](const std::string& name, torch::Tensor tensor) {
    US_CHECK(tensors.contains(name), path, ": has no '", name, "'");
    const auto stored = described(path, [&] { return tensor_of(tensors.at(name), opened.bytes, path); });
    US_CHECK(stored.sizes() == tensor.sizes(), path, ": '", name, "' has another shape");
    tensor.copy_(stored);
  });
  return header;
}

}  // namespace understudy::nn
