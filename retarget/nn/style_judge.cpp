#include "retarget/style/style_judge.hpp"

#include <torch/torch.h>

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/judge_net.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/style/judged_channels.hpp"
#include "retarget/style/motion_words.hpp"

namespace understudy::nn {
namespace {

const std::string& most_likely(const torch::Tensor& votes, const std::vector<std::string>& names) {
  return names[static_cast<size_t>(votes.argmax().item<int64_t>())];
}

class NetworkJudge final : public StyleJudge {
 public:
  NetworkJudge(JudgeNet net, JudgeForm form) : net_(std::move(net)), form_(std::move(form)) { net_->eval(); }

  Verdict judge(const std::vector<Rotations>& local, double fps) override {
    for (const Rotations& pose : local)
      for (const Mat3& turn : pose)
        US_CHECK(turn.allFinite(), "a motion that is to be judged has rotations that are not finite");
    const std::vector<Rotations> frames = at_word_rate(local, fps, kJudgedSmooth);
    const JudgedClip clip = judged_clip(judged_channels(frames, form_.legs), form_);
    const JudgeVotes votes = votes_of(net_, form_, clip);
    return {most_likely(votes.look, form_.styles), most_likely(votes.coordination, form_.styles),
            most_likely(votes.content, form_.contents)};
  }

  const std::vector<std::string>& styles() const override { return form_.styles; }
  const std::vector<std::string>& contents() const override { return form_.contents; }

 private:
  JudgeNet net_;
  JudgeForm form_;
};

std::vector<std::string> names_of(const std::string& path, const WeightsHeader& header, const char* key,
                                  size_t fewest) {
  const auto found = header.texts.find(key);
  US_CHECK(found != header.texts.end(), path, ": has no ", key);
  std::vector<std::string> names = split(found->second, '\n');
  US_CHECK(names.size() >= fewest, path, ": judges fewer than ", fewest, " ", key);
  return names;
}

JudgeForm form_of(const std::string& path, const WeightsHeader& header) {
  JudgeForm form;
  form.styles = names_of(path, header, "styles", 2);
  form.contents = names_of(path, header, "contents", 1);
  const auto flag = [&](const char* key) {
    const auto found = header.numbers.find(key);
    return found != header.numbers.end() && found->second != 0;
  };
  form.legs = flag("legs");
  form.sides_matter = flag("sides_matter");
  const auto channels = header.texts.find("channels");
  US_CHECK(channels != header.texts.end() && channels->second.size() == 3 * judged_joints(form.legs).size() &&
               channels->second.find_first_not_of("01") == std::string::npos,
           path, ": does not say which channels it sees");
  for (size_t c = 0; c < channels->second.size(); ++c)
    if (channels->second[c] == '1') form.channels.push_back(static_cast<int>(c));
  US_CHECK(!form.channels.empty(), path, ": sees no channel");
  return form;
}

}  // namespace

std::unique_ptr<StyleJudge> style_judge(JudgeNet net, const JudgeForm& form) {
  return std::make_unique<NetworkJudge>(std::move(net), form);
}

std::unique_ptr<StyleJudge> load_judges(const std::string& path) {
  const WeightsHeader header = read_weights_header(path);
  US_CHECK(header.kind == "style-judge", path, ": holds weights for '", header.kind,
           "', not for 'style-judge'");
  US_CHECK(header.version == kJudgeVersion, path, ": weights of version ", header.version,
           ", this program needs version ", kJudgeVersion);
  const JudgeForm form = form_of(path, header);
  JudgeNet net(form);
  load_weights(path, "style-judge", kJudgeVersion, *net);
  return style_judge(std::move(net), form);
}

}  // namespace understudy::nn
