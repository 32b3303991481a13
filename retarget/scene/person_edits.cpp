#include "retarget/scene/person_edits.hpp"

#include <algorithm>
#include <map>

namespace understudy {
namespace {

/// The better seen of two who are one.
ScenePerson united_person(const ScenePerson& a, const ScenePerson& b) {
  const bool first = a.unseen_s == b.unseen_s ? a.points >= b.points : a.unseen_s < b.unseen_s;
  ScenePerson one = first ? a : b;
  one.is_sure = a.is_sure || b.is_sure;
  one.points = a.points + b.points;
  one.moved_m = std::max(a.moved_m, b.moved_m);
  return one;
}

}  // namespace

int renamed(const std::vector<PersonEdit>& edits, int id, int frame) {
  if (id <= People::kScenery) return id;
  for (const PersonEdit& edit : edits) {
    if (frame < edit.first || frame > edit.last) continue;
    if (id == edit.other)
      id = edit.person;
    else if (id == edit.person && edit.how == PersonEdit::How::Exchange)
      id = edit.other;
  }
  return id;
}

void apply(const std::vector<PersonEdit>& edits, int frame, SceneFrame& scene) {
  if (edits.empty()) return;
  std::map<int, int> known;
  const auto name_of = [&](int id) {
    const auto [at, is_new] = known.try_emplace(id, id);
    if (is_new) at->second = renamed(edits, id, frame);
    return at->second;
  };
  for (int& owner : scene.owner) owner = name_of(owner);
  scene.alone = name_of(scene.alone);
  std::map<int, ScenePerson> people;
  for (ScenePerson person : scene.people) {
    person.id = name_of(person.id);
    const auto [at, is_new] = people.try_emplace(person.id, person);
    if (!is_new) at->second = united_person(at->second, person);
  }
  scene.people.clear();
  for (const auto& [id, person] : people) scene.people.push_back(person);
}

}  // namespace understudy
