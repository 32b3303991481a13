#include "retarget/metrics/hand_contact.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/support/hand_poses.hpp"

namespace understudy {
namespace {

/// A person who can be looked at in poses.
struct Person {
  static const ShapedBody& made() {
    static const ShapedBody person = builtin_person();
    return person;
  }
  const ShapedBody& body = made();
  HandContact contact{body.vertices, body.faces, body.joints};
  HandGaps gaps(const Pose& pose) const { return contact.gaps(posed_vertices(body, pose)); }
  double buried(const Pose& pose) const { return contact.buried(posed_vertices(body, pose)); }
};

TEST(HandContact, ArmsHeldOutTouchNothing) {
  const Person person;
  for (const auto& hand : person.gaps(Pose{}))
    for (const float gap : hand) EXPECT_FLOAT_EQ(gap, kFarGap);
  EXPECT_EQ(person.buried(Pose{}), 0);
}

TEST(HandContact, TellsWhichHandTouchesWhat) {
  const Person person;
  Pose pose;
  const Vec3 chest = fixtures::place_hand(person.body, 0, fixtures::front_of(person.body, 0.25f), pose);
  const HandGaps gaps = person.gaps(pose);
  EXPECT_LT(gaps[0][TouchTorso], 0.02f) << chest.transpose();
  EXPECT_GT(gaps[0][TouchHead], 0.1f);
  EXPECT_GT(gaps[1][TouchTorso], 0.2f);
}

TEST(HandContact, AHandPushedIntoTheBellyIsBuriedAndOneOnItIsNot) {
  const Person person;
  Pose on, in;
  fixtures::place_hand(person.body, 1, fixtures::front_of(person.body, 0.15f) + Vec3(0, 0, 0.02f), on);
  fixtures::place_hand(person.body, 1, fixtures::front_of(person.body, 0.15f) - Vec3(0, 0, 0.12f), in);
  EXPECT_GT(person.buried(in), person.buried(on) + 0.1);
}

TEST(HandContact, WantsASurface) {
  const ShapedBody& body = Person::made();
  EXPECT_THROW(HandContact(body.vertices, Faces(0, 3), body.joints), Error);
}

TEST(ContactsKept, CountsEachHandAndPartOfTheSource) {
  HandGaps source, target;
  for (auto* gaps : {&source, &target})
    for (auto& hand : *gaps) hand.fill(kFarGap);
  source[0][TouchTorso] = 0.01f, target[0][TouchTorso] = 0.015f;
  source[0][TouchOtherHand] = 0.005f, target[0][TouchOtherHand] = 0.05f;
  target[1][TouchHead] = 0.001f;  // only the target touches: no contact to keep
  ContactsKept kept;
  EXPECT_TRUE(std::isnan(kept.kept()));
  kept.add(source, target);
  EXPECT_EQ(kept.count(), 2);
  EXPECT_DOUBLE_EQ(kept.kept(), 0.5);
  EXPECT_NEAR(kept.gap_m(), 0.0325, 1e-6);
}

}  // namespace
}  // namespace understudy
