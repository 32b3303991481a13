#include <torch/torch.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/nn/modules/words_pair.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

class NetworkTranslator final : public WordTranslator {
 public:
  NetworkTranslator(WordsPair net, const WordsForm& form) : net_(std::move(net)), form_(form) {}

  std::array<bool, kJointCount> joints() const override { return form_.joints; }

  WordRows translate(const WordRows& word) override {
    const torch::NoGradGuard no_grad;
    const auto unit = known_joints(tensor_of(form_.from.to_unit(word)).unsqueeze(0), form_.joints);
    const auto made = net_->there(unit).squeeze(0).contiguous();
    WordRows rows = word;
    Eigen::Index column = 0;
    const Eigen::Map<const WordRows> known(made.data_ptr<float>(), made.size(0), made.size(1));
    const WordRows back = form_.to.from_unit(known);
    for (int j = 0; j < kJointCount; ++j) {
      if (!form_.joints[static_cast<size_t>(j)]) continue;
      rows.middleCols(4 * j, 4) = back.middleCols(column, 4);
      column += 4;
    }
    return rows;
  }

 private:
  WordsPair net_;
  WordsForm form_;
};

double number_of(const std::string& path, const WeightsHeader& header, const char* key) {
  const auto found = header.numbers.find(key);
  US_CHECK(found != header.numbers.end() && std::isfinite(found->second), path, ": has no number ", key);
  return found->second;
}

WordsForm form_of(const std::string& path) {
  const WeightsHeader header = read_weights_header(path);
  WordsForm form;
  const auto bits = static_cast<int64_t>(number_of(path, header, "joints"));
  US_CHECK(bits > 0 && bits < (int64_t{1} << kJointCount), path, ": is of another set of joints");
  form.net.joints = 0;
  for (int j = 0; j < kJointCount; ++j)
    if ((form.joints[static_cast<size_t>(j)] = ((bits >> j) & 1) != 0)) ++form.net.joints;
  form.net.width = header_size(path, header, "width", form.net.width, 256);
  form.net.blocks = header_size(path, header, "blocks", form.net.blocks, 64);
  form.net.joint_wise = number_of(path, header, "joint_wise") != 0;
  const auto range = [&](const char* least, const char* most) {
    const WordRange found{static_cast<float>(number_of(path, header, least)),
                          static_cast<float>(number_of(path, header, most))};
    US_CHECK(found.least < found.most, path, ": its numbers have no range");
    return found;
  };
  form.from = range("from_least", "from_most");
  form.to = range("to_least", "to_most");
  return form;
}

}  // namespace

torch::Tensor known_joints(const torch::Tensor& rows, const std::array<bool, kJointCount>& joints) {
  std::vector<int64_t> columns;
  for (int64_t j = 0; j < kJointCount; ++j)
    for (int64_t k = 0; joints[static_cast<size_t>(j)] && k < 4; ++k) columns.push_back(4 * j + k);
  return rows.index_select(rows.dim() - 1, torch::tensor(columns));
}

std::unique_ptr<WordTranslator> word_translator(WordsPair net, const WordsForm& form) {
  return std::make_unique<NetworkTranslator>(std::move(net), form);
}

std::unique_ptr<WordTranslator> load_words(const std::string& path) {
  const WordsForm form = form_of(path);
  WordsPair net(form.net);
  load_weights(path, "style-words", kWordsVersion, *net);
  net->eval();
  return word_translator(std::move(net), form);
}

}  // namespace understudy::nn
