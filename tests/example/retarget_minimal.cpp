// The engine as a library: scans of one person in, another body's motion out, frame by frame.
//   retarget_minimal SCANS TARGET
#include <cstdio>

#include "retarget/base/error.hpp"
#include "retarget/formats/import.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/scan_source.hpp"
#include "retarget/networks/networks.hpp"
#include "retarget/pipeline/retargeter.hpp"

int main(int argc, char** argv) {
  using namespace understudy;
  nn::prepare_environment();
  try {
    if (argc != 3) throw Error("usage: retarget_minimal SCANS TARGET");
    Retargeter retargeter(nn::load_networks({}));
    retargeter.set_target(read_mesh(argv[2]));

    ScanSource scans(argv[1]);
    std::optional<ImportDecision> import;  // units, axes and floor: as the first frame of somebody says
    while (auto scan = scans.next()) {
      if (scan->usable && !import) import = decide_scan_import(scan->mesh, {});
      if (!import) continue;
      if (scan->usable) import->apply(scan->mesh);
      const PerformedFrame frame = retargeter.push(scan->mesh, /*dt=*/1.0f / 30);
      const auto head = frame.joints.row(Head);
      std::printf("frame %lld: %lld vertices, head at %.3f %.3f %.3f\n", static_cast<long long>(scan->number),
                  static_cast<long long>(frame.vertices.rows()), head.x(), head.y(), head.z());
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
