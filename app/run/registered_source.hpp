// Captures whose frames share one topology: a truth to judge by, that the method must not see.
#pragma once

#include <memory>

#include "app/run/source.hpp"

namespace understudy::app {

enum class Registered { Auto, Yes, No };  ///< Auto: where the first two usable frames have the same faces
constexpr Names<3> kRegisteredNames{"auto", "yes", "no"};

/// The same surface with vertices and faces in a random order: what knows a vertex by its number is lost.
Mesh shuffled(const Mesh& mesh, Rng& rng);

/// The source itself where its frames share no topology (sources that bring a skeleton never do, nor does
/// what is still being written). Otherwise the same frames, shuffled, and the vertices in their own order in
/// SourceFrame::registered; a frame of another topology than the first, of which one warning tells, has none
/// there. Throws Error naming the source where frames are to share one (Yes) and have no or another number
/// of vertices.
std::unique_ptr<Source> hide_topology(std::unique_ptr<Source> source, const SourceOptions& options,
                                      Registered registered);

}  // namespace understudy::app
