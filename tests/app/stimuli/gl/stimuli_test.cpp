// Clips of a small study: what is in them, what makes them again, what goes wrong.
#include <algorithm>
#include <csignal>

#include "app/run/interrupt.hpp"
#include "app/stimuli/stimuli_manifest.hpp"
#include "app/study/trial_exports.hpp"
#include "render/video_reader.hpp"
#include "retarget/base/checksum.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"
#include "tests/app/stimuli/gl/small_study.hpp"
#include "tests/support/full_disk.hpp"

namespace understudy::app {
namespace {

using Stimuli = SmallStudy;

struct Film {
  int width = 0, height = 0;
  double fps = 0;
  std::vector<render::Image> pictures;
};

Film film_at(const std::string& path) {
  render::VideoReader reader(path);
  Film film{reader.width(), reader.height(), reader.fps(), {}};
  while (reader.next()) film.pictures.push_back(reader.picture());
  return film;
}

/// Mean difference of two pictures, 0..255.
double difference(const render::Image& a, const render::Image& b) {
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(int{a.pixels[i]} - int{b.pixels[i]});
  return sum / static_cast<double>(a.pixels.size());
}

std::vector<ClipRecord> clips_of(const std::string& manifest) {
  std::vector<ClipRecord> clips;
  const Json json = read_json(manifest);
  for (const Json& one : json.at("clips")) {
    FieldsReader reader(one, "", manifest + ": ", UnknownMembers::Refused);
    fields(reader, clips.emplace_back());
    reader.finish();
  }
  return clips;
}

const ClipRecord& clip_of(const std::vector<ClipRecord>& clips, const std::string& condition,
                          const std::string& motion) {
  return *std::find_if(clips.begin(), clips.end(), [&](const ClipRecord& clip) {
    return clip.condition == condition && clip.motion == motion;
  });
}

TEST_F(Stimuli, EachClipIsMadeOnceAndListedWithItsFactors) {
  const StimuliReport report = make("out");
  EXPECT_EQ(report.clips, 6);
  EXPECT_EQ(report.made, 6);
  const std::vector<ClipRecord> clips = clips_of(path("out/manifest.json"));
  ASSERT_EQ(clips.size(), 6u);
  std::set<std::string> files;
  for (const ClipRecord& clip : clips) {
    files.insert(clip.file);
    const Film film = film_at(path("out/" + clip.file));
    EXPECT_EQ(film.width, 160);
    EXPECT_EQ(film.height, 90);
    EXPECT_EQ(film.fps, 10);
    EXPECT_EQ(film.pictures.size(), 13u);
    EXPECT_EQ(clip.frames, 13);
    EXPECT_EQ(clip.checksum, checksum_of_file(path("out/" + clip.file)));
    EXPECT_EQ(clip.bytes, static_cast<int64_t>(fs::file_size(path("out/" + clip.file))));
    EXPECT_EQ(clip.target, "doll");
    ASSERT_EQ(clip.panes.size(), 3u);
    EXPECT_EQ(clip.panes[0].distance_m, clip.panes[2].distance_m);
    for (const char* word : {"copy", "long", "truth", "start", "doll"})
      EXPECT_EQ(clip.file.find(word), std::string::npos) << clip.file << " tells " << word;
  }
  EXPECT_EQ(files.size(), 6u);
  for (const Trial& trial : all_trials(study_)) EXPECT_EQ(files.count(clip_path(study_, trial)), 1u);
  EXPECT_EQ(clip_of(clips, "copy", "start").runs, 3);
  EXPECT_EQ(clip_of(clips, "truth", "rest").runs, 2);
  const std::string csv = read_file(path("out/manifest.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  EXPECT_NE(csv.find(",long steps,,rest,rest,doll,clips/"), std::string::npos) << csv;
}

TEST_F(Stimuli, ConditionsDifferInTheResultAlone) {
  make("out", true);
  const std::vector<ClipRecord> clips = clips_of(path("out/manifest.json"));
  const ClipRecord &copy = clip_of(clips, "copy", "rest"), &truth = clip_of(clips, "truth", "rest");
  EXPECT_EQ(copy.panes[0].checksum, truth.panes[0].checksum);
  EXPECT_EQ(copy.panes[1].checksum, truth.panes[1].checksum);
  EXPECT_NE(copy.panes[2].checksum, truth.panes[2].checksum);
  const Film source = film_at(path("out/" + copy.panes[0].file)),
             target = film_at(path("out/" + copy.panes[1].file));
  const double moves = difference(source.pictures[0], source.pictures[3]),
               stands = difference(target.pictures[0], target.pictures[3]);  // what encoding leaves
  EXPECT_GT(moves, 1.5 * stands);
}

TEST_F(Stimuli, ACardIsBetweenTwoRuns) {
  make("out");
  const std::vector<ClipRecord> clips = clips_of(path("out/manifest.json"));
  const Film film = film_at(path("out/" + clip_of(clips, "copy", "start").file));
  const auto ink = [&](size_t frame, int first, int last) {  // dark pixels in these rows
    int dark = 0;
    for (int y = first; y < last; ++y)
      for (int x = 0; x < 160; ++x) dark += film.pictures[frame].at(x, y)[1] < 120 ? 1 : 0;
    return dark;
  };
  for (const size_t card : {3u, 4u, 8u, 9u}) {
    EXPECT_GT(ink(card, 38, 52), 10) << card;
    EXPECT_EQ(ink(card, 0, 35) + ink(card, 56, 90), 0) << card;
  }
  EXPECT_LT(difference(film.pictures[0], film.pictures[5]), 1);
  EXPECT_GT(difference(film.pictures[0], film.pictures[3]), 2);
}

TEST_F(Stimuli, TheSameStudyGivesTheSameBytes) {
  make("a", true);
  make("b", true);
  const auto a = files_in("a"), b = files_in("b");
  EXPECT_EQ(a.size(), 6u * 4 + 2);
  EXPECT_TRUE(a == b);
}

TEST_F(Stimuli, PanesAreFilmsOfTheirOwnWhereAsked) {
  make("out");
  EXPECT_FALSE(fs::exists(path("out/panes")));
  EXPECT_EQ(make("out", true).made, 6) << "the panes were missing";
  const std::vector<ClipRecord> clips = clips_of(path("out/manifest.json"));
  const ClipRecord& clip = clips[0];
  for (const PaneRecord& pane : clip.panes) {
    const Film film = film_at(path("out/" + pane.file));
    EXPECT_EQ(film.width, pane.width);
    EXPECT_EQ(film.height, pane.height + pane.height % 2);
    EXPECT_EQ(film.pictures.size(), 13u);
    EXPECT_EQ(pane.checksum, checksum_of_file(path("out/" + pane.file)));
  }
  EXPECT_EQ(make("out").made, 0) << "nobody minds what is there besides";
}

TEST_F(Stimuli, OnlyWhatIsMissingIsMade) {
  make("out");
  const auto before = files_in("out");
  extractions_->store(0);
  EXPECT_EQ(make("out").made, 0);
  EXPECT_EQ(extractions_->load(), 0);
  EXPECT_TRUE(files_in("out") == before);

  const std::string gone = clips_of(path("out/manifest.json"))[1].file;
  fs::remove(path("out/" + gone));
  EXPECT_EQ(make("out").made, 1);
  std::ofstream(path("out/" + gone)) << "damaged";
  EXPECT_EQ(make("out").made, 1);
  EXPECT_TRUE(files_in("out") == before);
}

TEST_F(Stimuli, AClipIsMadeAgainWhereTheStudyShowsSomethingElse) {
  make("out");
  study_.questions[0].text = "Why?";
  study_.name = "other";
  EXPECT_EQ(make("out").made, 0);
  study_.picture.yaw_deg += 20;
  EXPECT_EQ(make("out").made, 6);
  study_.motions[1].seconds = 0.2f;
  EXPECT_EQ(make("out").made, 3) << "those of the motion";
  study_.conditions[1].method.stride = 1.5f;
  EXPECT_EQ(make("out").made, 6) << "they are framed together";
  fs::last_write_time(path("truth.npz"), fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(make("out").made, 6);
  EXPECT_EQ(make("out").made, 0);
}

TEST_F(Stimuli, PairsAreShownBothWaysRound) {
  study_.layout.results = TrialResults::Pair;
  study_.layout.panes = {StudyPane::Result};
  study_.motions.resize(1);
  EXPECT_EQ(make("out").made, 6);
  std::set<std::string> names;
  for (const ClipRecord& clip : clips_of(path("out/manifest.json"))) {
    names.insert(clip.clip);
    EXPECT_FALSE(clip.other.empty());
    ASSERT_EQ(clip.panes.size(), 2u);
    EXPECT_EQ(clip.panes[0].pane, "result A");
    EXPECT_EQ(clip.panes[1].pane, "result B");
  }
  for (const char* participant : {"P1", "P2"})
    for (const Trial& trial : trials_of(study_, participant))
      EXPECT_EQ(names.count(clip_name(study_, trial)), 1u);
}

TEST_F(Stimuli, AnInterruptionLeavesWholeClipsAndTheNextRunGoesOn) {
  make("whole");
  int frames = 0;
  progress_ = [&](const std::string& what, int64_t, int64_t) {
    if (what.rfind("clip", 0) == 0 && ++frames == 30) throw Error("stop");
  };
  EXPECT_EQ(failure_of([&] { make("out"); }), "stop");
  EXPECT_EQ(files_in("out").size(), 2u) << "two clips were finished, the third is no file, nor is a manifest";
  progress_ = nullptr;
  EXPECT_EQ(make("out").made, 4);
  const auto resumed = files_in("out"), whole = files_in("whole");
  EXPECT_EQ(resumed.size(), whole.size());
  for (const auto& [file, bytes] : whole) EXPECT_TRUE(resumed.at(file) == bytes) << file;
}

TEST_F(Stimuli, SaysInASentenceWhatIsWrong) {
  std::ofstream(path("taken")) << "a file";
  EXPECT_NE(failure_of([&] { make("taken"); }).find("taken: cannot be made a folder"), std::string::npos);

  const std::string full = failure_of([&] {
    const test::FullDisk disk(1500);
    make("full");
  });
  EXPECT_NE(full.find("/full/"), std::string::npos) << full;
  EXPECT_NE(full.find("cannot be written"), std::string::npos) << full;
  EXPECT_TRUE(files_in("full").empty());

  study_.conditions[2].files[0].path = path("none.npz");
  const std::string gone = failure_of([&] { make("gone"); });
  EXPECT_EQ(gone.rfind("condition 'truth', motion 'start', target 'doll': ", 0), 0u) << gone;
  EXPECT_NE(gone.find("none.npz"), std::string::npos) << gone;

  study_.motions[1].from_s = 60;
  study_.conditions.pop_back();
  const std::string late = failure_of([&] { make("late"); });
  EXPECT_NE(late.find("motion 'rest': it starts at 60 s, its source lasts 0.80 s"), std::string::npos)
      << late;
}

}  // namespace
}  // namespace understudy::app
