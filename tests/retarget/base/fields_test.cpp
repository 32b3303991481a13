#include "retarget/base/fields.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <map>
#include <set>

namespace understudy::fields_test {

enum class Colour { Red, Green };

struct Inner {
  float x = 0.1f;
  int frame = 3;
};
template <class V, class S>
FieldsOf<S, Inner> fields(V& visit, S& inner) {
  visit("x", inner.x);
  visit("frame", inner.frame, kFrameNumbers);
}

struct Outer {
  bool on = false;
  double rate = 30;
  std::string name = "a";
  Colour colour = Colour::Red;
  std::optional<Inner> inner;
  std::vector<Inner> list{{}, {}};
  std::vector<std::string> words{"ab", "c"};
  std::set<int> numbers{1, 2};
  std::map<std::string, std::string> pairs{{"k", "v"}};
  std::variant<Inner, int> either;
  std::shared_ptr<const Inner> shared;
  Eigen::MatrixXf matrix = Eigen::MatrixXf::Zero(2, 3);
  Eigen::Vector3f vector = Eigen::Vector3f::Zero();
  int not_listed = 0;
};
template <class V, class S>
FieldsOf<S, Outer> fields(V& visit, S& outer) {
  visit("on", outer.on);
  visit("rate", outer.rate, Within<double>{0, 100});
  visit("name", outer.name);
  visit("colour", outer.colour, Names<2>{"red", "green"});
  visit("inner", outer.inner);
  visit("list", outer.list);
  visit("words", outer.words);
  visit("numbers", outer.numbers);
  visit("pairs", outer.pairs);
  visit("either", outer.either);
  visit("shared", outer.shared);
  visit("matrix", outer.matrix);
  visit("vector", outer.vector);
}

const std::vector<std::function<void(Outer&)>> kChanges = {
    [](Outer& o) { o.on = true; },
    [](Outer& o) { o.rate = std::nextafter(30.0, 31.0); },
    [](Outer& o) { o.name = "b"; },
    [](Outer& o) { o.name.clear(); },
    [](Outer& o) { o.colour = Colour::Green; },
    [](Outer& o) { o.inner.emplace(); },
    [](Outer& o) { o.inner.emplace().x = 0; },
    [](Outer& o) { o.list.pop_back(); },
    [](Outer& o) { o.list[1].x = std::nextafter(0.1f, 1.f); },
    [](Outer& o) { o.list[1].frame = 4; },
    [](Outer& o) {
      o.words = {"a", "bc"};
    },
    [](Outer& o) { o.words = {"abc"}; },
    [](Outer& o) {
      o.words = {"ab", "c", ""};
    },
    [](Outer& o) { o.numbers = {12}; },
    [](Outer& o) {
      o.pairs = {{"kv", ""}};
    },
    [](Outer& o) { o.pairs["k"] = "w"; },
    [](Outer& o) { o.either = 0; },
    [](Outer& o) { o.either = 3; },
    [](Outer& o) { std::get<Inner>(o.either).frame = 0; },
    [](Outer& o) {
      o.shared = std::make_shared<const Inner>(Inner{1, 2});
    },
    [](Outer& o) { o.matrix(1, 2) = 1e-30f; },
    [](Outer& o) { o.matrix = Eigen::MatrixXf::Zero(3, 2); },
    [](Outer& o) { o.matrix = Eigen::MatrixXf::Zero(0, 3); },
    [](Outer& o) { o.vector.z() = 1; },
};

TEST(Fields, EachChangeIsSeenByEqualityAndKey) {
  std::set<std::string> keys{key_of(Outer{})};
  for (size_t i = 0; i < kChanges.size(); ++i) {
    Outer changed;
    kChanges[i](changed);
    EXPECT_FALSE(same(changed, Outer{})) << i;
    EXPECT_FALSE(same(Outer{}, changed)) << i;
    EXPECT_TRUE(same(changed, Outer(changed))) << i;
    EXPECT_TRUE(keys.insert(key_of(changed)).second) << i;
    EXPECT_EQ(key_of(changed), key_of(Outer(changed))) << i;
  }
}

TEST(Fields, WhatIsNotListedDoesNotCount) {
  Outer a, b;
  b.not_listed = 1;
  b.shared = std::make_shared<const Inner>();  // like none
  EXPECT_TRUE(same(a, b));
  EXPECT_EQ(key_of(a), key_of(b));
}

TEST(Fields, AKeyOfSeveralKeepsThemApart) {
  EXPECT_NE(key_of(std::string("a"), std::string("bc")), key_of(std::string("ab"), std::string("c")));
  EXPECT_NE(key_of(1, 23), key_of(12, 3));
  EXPECT_EQ(key_of(std::nanf("")), key_of(std::nanf("")));
}

/// Halves every float it is shown.
struct Halving {
  void operator()(const char*, float& value) const { value /= 2; }
  template <class... A>
  void operator()(const char*, A&...) const {}
};

TEST(Fields, AVisitorCanChangeMembers) {
  Inner inner;
  const Halving halve;
  fields(halve, inner);
  EXPECT_EQ(inner.x, 0.05f);
  EXPECT_EQ(inner.frame, 3);
}

}  // namespace understudy::fields_test
