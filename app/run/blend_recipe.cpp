#include "app/run/blend_recipe.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

bool exists(const std::string& path) {
  std::error_code failed;
  return std::filesystem::exists(path, failed);
}

std::optional<int> whole_frame(const std::string& text) {
  int64_t number = 0;
  if (!parse_integer(text, number) || number < 0 || number > kFrameNumbers.high) return std::nullopt;
  return static_cast<int>(number);
}

float sum_of_weights(const BlendRecipe& blend) {
  float sum = 0;
  for (const BlendPart& part : blend.parts) sum += part.weight;
  return sum;
}

}  // namespace

BlendPart blend_part(const std::string& text) {
  BlendPart part;
  part.path = text;
  const size_t at = exists(text) ? std::string::npos : text.rfind('@');
  if (at != std::string::npos) {
    const std::string range = text.substr(at + 1);
    const size_t colon = range.find(':');
    const auto first = whole_frame(range.substr(0, colon));
    const auto last = colon == std::string::npos ? std::nullopt : whole_frame(range.substr(colon + 1));
    US_CHECK(first && last && *first < *last, text,
             ": is not FILE@FIRST:LAST, a file and the numbers of two frames, the later one last");
    part.path = text.substr(0, at);
    part.range = BlendRange{*first, *last};
  }
  US_CHECK(exists(part.path), part.path, ": there is no such file");
  part.checksum = checksum_of_file(part.path);
  return part;
}

std::string in_words(const BlendPart& part) {
  if (!part.range) return part.path;
  return part.path + '@' + std::to_string(part.range->first) + ':' + std::to_string(part.range->last);
}

std::string name_of(const BlendRecipe& blend) {
  std::string name;
  for (const BlendPart& part : blend.parts)
    append_item(name, std::filesystem::path(file_name(part.path)).stem().string(), " - ");
  return name;
}

std::vector<float> blend_weights(const std::string& text) {
  std::vector<float> weights;
  float sum = 0;
  for (const std::string& word : split(text, ',')) {
    double weight = 0;
    US_CHECK(parse_number(word, weight) && weight >= 0 && weight <= 1e6, text,
             ": is no list of weights such as 0.3,0.7");
    sum += weights.emplace_back(static_cast<float>(weight));
  }
  US_CHECK(sum > 0, text, ": weights of a blend cannot all be 0");
  return weights;
}

bool are_same_parts(const BlendRecipe& a, const BlendRecipe& b) {
  return std::equal(a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(),
                    [](const BlendPart& x, const BlendPart& y) { return in_words(x) == in_words(y); });
}

void set_weights(const std::vector<float>& weights, BlendRecipe& blend) {
  US_CHECK(weights.size() == blend.parts.size(), "a blend of ", blend.parts.size(), " movements has as many ",
           "weights, not ", weights.size());
  for (size_t i = 0; i < weights.size(); ++i) blend.parts[i].weight = weights[i];
  const float sum = sum_of_weights(blend);
  for (BlendPart& part : blend.parts) part.weight /= sum;
}

void set_share(size_t part, float share, BlendRecipe& blend) {
  US_CHECK(part < blend.parts.size(), "the blend has no part ", part);
  const float rest = sum_of_weights(blend) - blend.parts[part].weight;
  for (size_t i = 0; i < blend.parts.size(); ++i) {
    float& weight = blend.parts[i].weight;
    const float even = 1 / static_cast<float>(blend.parts.size() - 1);
    weight = i == part ? share : (1 - share) * (rest > 1e-6f ? weight / rest : even);
  }
}

}  // namespace understudy::app
