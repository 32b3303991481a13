#include "retarget/nn/weights_file.hpp"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/networks/weights_layout.hpp"

namespace understudy::nn {
namespace {

using nlohmann::json;

template <class Visit>
void each_tensor(const torch::nn::Module& module, Visit visit) {
  for (const auto& item : module.named_parameters()) visit(item.key(), item.value());
  for (const auto& item : module.named_buffers()) visit(item.key(), item.value());
}

WeightsHeader header_of(const StoredWeights& stored) {
  return {stored.kind, stored.version, stored.numbers, stored.texts, {}};
}

torch::Tensor filled_tensor(const StoredTensor& stored) {
  const auto options = torch::TensorOptions().dtype(stored.half ? torch::kFloat16 : torch::kFloat32);
  auto tensor = torch::empty(stored.shape, options);
  if (!stored.bytes.empty()) std::memcpy(tensor.data_ptr(), stored.bytes.data(), stored.bytes.size());
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
      {"texts", header.texts},
      {"tensors", tensors}}.dump();
  const auto length = static_cast<uint32_t>(description.size());
  PartFile out(path);
  out.write(kWeightsMagic, 8);
  out.write(&length, 4);
  out.write(description);
  out.write(bytes);
  out.finish();
}

WeightsHeader read_weights_header(const std::string& path) {
  const std::string bytes = read_file(path);
  return header_of(parse_weights(bytes, path));
}

int64_t header_size(const std::string& path, const WeightsHeader& header, const char* key, int64_t usual,
                    int64_t most) {
  const auto found = header.numbers.find(key);
  if (found == header.numbers.end()) return usual;
  const double size = found->second;
  US_CHECK(size >= 1 && size <= static_cast<double>(most) && size == std::floor(size), path,
           ": the network's \"", key, "\" cannot be ", size);
  return static_cast<int64_t>(size);
}

WeightsHeader load_weights(const std::string& path, const std::string& kind, int version,
                           torch::nn::Module& module, const TensorCheck& may_lack) {
  const std::string bytes = read_file(path);
  const StoredWeights stored = parse_weights(bytes, path);
  US_CHECK(stored.kind == kind, path, ": holds weights for '", stored.kind, "', not for '", kind, "'");
  US_CHECK(stored.version == version, path, ": weights of version ", stored.version,
           ", this program needs version ", version);
  WeightsHeader header = header_of(stored);
  const torch::NoGradGuard no_grad;
  each_tensor(module, [&](const std::string& name, torch::Tensor tensor) {
    const auto found = stored.tensors.find(name);
    if (found == stored.tensors.end() && may_lack && may_lack(name)) {
      header.lacking.push_back(name);
      return;
    }
    US_CHECK(found != stored.tensors.end(), path, ": has no '", name, "'");
    US_CHECK(tensor.sizes() == c10::IntArrayRef(found->second.shape), path, ": '", name,
             "' has another shape");
    tensor.copy_(filled_tensor(found->second));
  });
  return header;
}

}  // namespace understudy::nn
