#include "retarget/networks/weights_layout.hpp"

#include <cstring>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"

namespace understudy::nn {
namespace {

using nlohmann::json;

constexpr size_t kHead = 12, kMostDimensions = 8;

uint64_t whole_number(const json& value, const std::string& path) {
  US_CHECK(value.is_number_unsigned(), path, ": the weights file is damaged");
  return value.get<uint64_t>();
}

StoredTensor tensor_of(const json& entry, std::string_view bytes, const std::string& path) {
  StoredTensor tensor;
  tensor.half = entry.at("half").get<bool>();
  const json& shape = entry.at("shape");
  US_CHECK(shape.is_array() && shape.size() <= kMostDimensions, path, ": the weights file is damaged");
  constexpr uint64_t kMost = uint64_t{1} << 31;
  uint64_t count = 1;
  for (const json& extent : shape) {
    const uint64_t length = whole_number(extent, path);
    US_CHECK(length < kMost, path, ": the weights file is damaged");
    count *= length;  // both below 2^31
    US_CHECK(count < kMost, path, ": the weights file is damaged");
    tensor.shape.push_back(static_cast<int64_t>(length));
  }
  const uint64_t offset = whole_number(entry.at("offset"), path), size = count * (tensor.half ? 2 : 4);
  US_CHECK(offset <= bytes.size() && size <= bytes.size() - offset, path, ": the weights file is cut off");
  tensor.bytes = bytes.substr(offset, size);
  return tensor;
}

StoredWeights described(const json& d, std::string_view bytes, const std::string& path) {
  StoredWeights out;
  out.kind = d.value("kind", "");
  out.version = d.value("version", 0);
  out.numbers = d.value("numbers", std::map<std::string, double>());
  out.texts = d.value("texts", std::map<std::string, std::string>());
  for (const auto& [name, entry] : d.at("tensors").items()) out.tensors[name] = tensor_of(entry, bytes, path);
  return out;
}

}  // namespace

StoredWeights parse_weights(std::string_view file, const std::string& path) {
  US_CHECK(file.size() > kHead && file.substr(0, 8) == kWeightsMagic, path, ": not a weights file");
  uint32_t length = 0;
  std::memcpy(&length, file.data() + 8, 4);
  US_CHECK(length <= file.size() - kHead, path, ": the weights file is cut off");
  const std::string_view text = file.substr(kHead, length);
  const json description = json::parse(text.begin(), text.end(), nullptr, false);
  US_CHECK(description.is_object() && description.contains("tensors"), path, ": the weights file is damaged");
  try {
    return described(description, file.substr(kHead + length), path);
  } catch (const json::exception&) {  // members that are missing or of another kind
    throw Error(path + ": the weights file is damaged");
  }
}

}  // namespace understudy::nn
