"""blender -b --factory-startup --python-exit-code 3 --python blender_cache.py -- JOBS

Has Blender's Mesh Cache modifier move a mesh by a point cache. JOBS is a JSON list of {"file", "fps", "times", "out"}: the
file is a .pc2, the mesh that it moves lies beside it as .pc2.obj. Writes OUT: where every vertex is at every time,
float32 [T, V, 3] in the file's axes.
"""
import array
import json
import sys

import bpy


def moved_mesh(cache):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.obj_import(filepath=cache + ".obj", forward_axis="Y", up_axis="Z")
    (thing,) = [thing for thing in bpy.data.objects if thing.type == "MESH"]
    modifier = thing.modifiers.new("cache", "MESH_CACHE")
    modifier.cache_format = "PC2"
    modifier.filepath = cache
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"
    modifier.frame_start = 0
    return thing


def play(job):
    thing = moved_mesh(job["file"])
    with open(job["out"], "wb") as out:
        for seconds in job["times"]:
            frame = seconds * job["fps"]
            bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
            seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
            numbers = array.array("f", [0]) * (3 * len(seen.data.vertices))
            seen.data.vertices.foreach_get("co", numbers)
            numbers.tofile(out)


for each in json.load(open(sys.argv[sys.argv.index("--") + 1])):
    play(each)
