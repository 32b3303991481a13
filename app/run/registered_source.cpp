#include "app/run/registered_source.hpp"

#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy::app {
namespace {

/// The next frame that can be used; none at the end.
std::optional<SourceFrame> next_usable(Source& source) {
  std::optional<SourceFrame> frame = source.next();
  while (frame && !frame->usable) frame = source.next();
  return frame;
}

bool same_topology(const Mesh& a, const Mesh& b) {
  return a.vertices.rows() == b.vertices.rows() && a.faces.rows() == b.faces.rows() && a.faces == b.faces;
}

/// Looks at the first two usable frames and goes back.
bool starts_with_one_topology(Source& source) {
  const auto first = next_usable(source), second = first ? next_usable(source) : std::nullopt;
  if (first || source.count().value_or(0) > 0) source.seek(0);  // frames that cannot be used count, too
  return second && !first->skeleton && !first->mesh.is_cloud() && same_topology(first->mesh, second->mesh);
}

class RegisteredSource final : public Source {
 public:
  RegisteredSource(std::unique_ptr<Source> source, std::string path, bool certain)
      : Source(source->fps()), source_(std::move(source)), path_(std::move(path)), certain_(certain) {}

  std::optional<SourceFrame> next() override {
    std::optional<SourceFrame> frame = source_->next();
    set_decision(source_->decision(), source_->to_file());
    if (!frame || !frame->usable) return frame;
    if (!first_) first_ = Mesh{frame->mesh.vertices, frame->mesh.faces, {}};
    Rng rng(static_cast<uint64_t>(frame->number) + 1);
    Mesh mixed = shuffled(frame->mesh, rng);
    if (is_registered(*frame)) frame->registered = std::move(frame->mesh.vertices);
    frame->mesh = std::move(mixed);
    return frame;
  }
  void seek(int64_t frame) override { source_->seek(frame); }
  std::optional<int64_t> count() const override { return source_->count(); }

 private:
  /// What is said to share its vertices may come as points alone.
  bool is_registered(const SourceFrame& frame) {
    const Mesh& mesh = frame.mesh;
    if (certain_ && mesh.vertices.rows() != first_->vertices.rows())
      throw Error(path_ + ": is to be registered, but frame " + std::to_string(frame.number) + " has " +
                  std::to_string(mesh.vertices.rows()) + " vertices and the first has " +
                  std::to_string(first_->vertices.rows()));
    const bool same = certain_ || same_topology(mesh, *first_);
    if (!same && !std::exchange(warned_, true))
      log::warn(path_ + ": from frame " + std::to_string(frame.number) +
                " on some frames have another topology than the first and are not judged by it");
    return same && mesh.vertices.allFinite();
  }

  std::unique_ptr<Source> source_;
  std::string path_;
  bool certain_, warned_ = false;
  std::optional<Mesh> first_;
};

/// A random order of 0 .. count-1.
Eigen::VectorXi random_order(Eigen::Index count, Rng& rng) {
  Eigen::VectorXi order = Eigen::VectorXi::LinSpaced(count, 0, static_cast<int>(count) - 1);
  for (int i = static_cast<int>(count) - 1; i > 0; --i) std::swap(order[i], order[rng.below(i + 1)]);
  return order;
}

}  // namespace

Mesh shuffled(const Mesh& mesh, Rng& rng) {
  const Eigen::VectorXi vertex = random_order(mesh.vertices.rows(), rng),
                        face = random_order(mesh.faces.rows(), rng);
  Mesh out = mesh;
  for (Eigen::Index v = 0; v < vertex.size(); ++v) {
    out.vertices.row(vertex[v]) = mesh.vertices.row(v);
    if (mesh.colors.rows() > 0) out.colors.row(vertex[v]) = mesh.colors.row(v);
  }
  for (Eigen::Index f = 0; f < face.size(); ++f)
    for (int corner = 0; corner < 3; ++corner) out.faces(face[f], corner) = vertex[mesh.faces(f, corner)];
  return out;
}

std::unique_ptr<Source> hide_topology(std::unique_ptr<Source> source, const SourceOptions& options,
                                      Registered registered) {
  if (options.complete > 0) return source;  // a body's own frames: nothing is extracted from them
  if (registered == Registered::No || (registered == Registered::Auto && options.follow)) return source;
  const bool certain = registered == Registered::Yes;
  if (!certain && !starts_with_one_topology(*source)) return source;
  log::info(options.path +
            ": all frames share one topology: bones are judged by it, the method sees it shuffled");
  return std::make_unique<RegisteredSource>(std::move(source), options.path, certain);
}

}  // namespace understudy::app
