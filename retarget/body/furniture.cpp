#include "retarget/body/furniture.hpp"

namespace understudy {
namespace {

void add_block(Furniture& thing, const Vec3& centre, const Vec3& size) {
  thing.push_back({centre, 0.5f * size, Mat3::Identity()});
}

/// Four legs below a top.
void add_legs(Furniture& thing, float width, float height, float depth) {
  for (const float x : {-0.46f, 0.46f})
    for (const float z : {-0.46f, 0.46f})
      add_block(thing, Vec3(x * width, 0.5f * height, z * depth), Vec3(0.05f, height, 0.05f));
}

}  // namespace

Furniture table(float size, Rng& rng) {
  const float width = rng.uniform(0.6f, 1.6f), depth = rng.uniform(0.5f, 0.9f),
              height = size * rng.uniform(0.6f, 0.85f);
  Furniture made;
  add_block(made, Vec3(0, height, 0), Vec3(width, 0.04f, depth));
  add_legs(made, width, height, depth);
  return made;
}

Furniture chair(float seat, Rng& rng) {
  const float width = rng.uniform(0.38f, 0.55f), back = rng.uniform(0.3f, 0.55f);
  Furniture made;
  add_block(made, Vec3(0, seat, 0), Vec3(width, rng.uniform(0.03f, 0.12f), width));
  if (rng.chance(0.8f))
    add_block(made, Vec3(0, seat + 0.5f * back + 0.05f, -0.5f * width), Vec3(width, back, 0.05f));
  add_legs(made, width, seat, width);
  return made;
}

Furniture cabinet(Rng& rng) {
  const float height = rng.uniform(0.5f, 1.9f);
  Furniture made;
  add_block(made, Vec3(0, 0.5f * height, 0), Vec3(rng.uniform(0.35f, 1.2f), height, rng.uniform(0.3f, 0.6f)));
  return made;
}

Furniture any_furniture(float size, Rng& rng) {
  const float kind = rng.uniform();
  if (kind < 0.4f) return table(size, rng);
  if (kind < 0.7f) return chair(size * rng.uniform(0.38f, 0.55f), rng);
  return cabinet(rng);
}

void place(Furniture& thing, const Vec3& foot, const Mat3& turn) {
  for (Block& block : thing) {
    block.centre = foot + turn * block.centre;
    block.axes = turn;
  }
}

float surface_of(const Furniture& thing) {
  float surface = 0;
  for (const Block& block : thing) surface += block.surface();
  return surface;
}

Vec3 sample_of(const Furniture& thing, float surface, Rng& rng) {
  float pick = rng.uniform() * surface;
  size_t b = 0;
  while (b + 1 < thing.size() && pick >= thing[b].surface()) pick -= thing[b++].surface();
  return thing[b].sample(rng);
}

}  // namespace understudy
