"""blender -b --factory-startup --python-exit-code 3 --python blender_play.py -- JOBS

Has Blender import glTF files and play them. JOBS is a JSON list of {"file", "clip", "fps", "times", "out"}. Writes OUT:
where every vertex is at every time, float32 [T, V, 3] in the file's axes, meshes in the order of the file's nodes.
"""
import array
import json
import sys

import bpy
import numpy

if "bool" not in numpy.__dict__:
    numpy.bool = bool  # Debian 12 pairs Blender 3.4 with a numpy that has dropped a name which its importer uses


def empty_scene(fps):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    render = bpy.context.scene.render
    render.fps = round(fps)
    render.fps_base = render.fps / fps


def imported(path):
    """The meshes in the order in which the importer made them: that of the nodes that carry them."""
    bpy.ops.import_scene.gltf(filepath=path, bone_heuristic="TEMPERANCE")
    in_skeleton = {bone.custom_shape for thing in bpy.data.objects if thing.pose for bone in thing.pose.bones}
    return [thing for thing in bpy.data.objects if thing.type == "MESH" and thing not in in_skeleton]


def play_clip(name):
    """The importer keeps every clip as tracks of that name, which begin at another frame than the file does: the
    action of this clip's track is played in their place."""
    heard = 0
    for holder in list(bpy.data.objects) + list(bpy.data.shape_keys):
        data = holder.animation_data
        if data is None:
            continue
        data.action = None
        for track in data.nla_tracks:
            track.mute = True
            if track.name == name:
                data.action = track.strips[0].action
                heard += 1
    if heard == 0:
        raise RuntimeError(f"Blender has no clip '{name}'")


def clips_and_order(path):
    """Names of the file's clips, and the place of each thing: a mesh with shapes becomes a child of its node, by the name
    of the mesh."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] == b"glTF":
        length = int.from_bytes(data[12:16], "little")
        data = data[20:20 + length]
    gltf = json.loads(data)
    order = {}
    for place, node in enumerate(gltf["nodes"]):
        if "mesh" in node:
            order[node["name"]] = place
            order.setdefault(gltf["meshes"][node["mesh"]]["name"], place)
    return [animation["name"] for animation in gltf["animations"]], order


def positions(things):
    """World positions of all vertices now; Blender's z is the file's y."""
    out = array.array("f")
    graph = bpy.context.evaluated_depsgraph_get()
    for thing in things:
        seen = thing.evaluated_get(graph)
        mesh = seen.to_mesh()
        for vertex in mesh.vertices:
            x, y, z = seen.matrix_world @ vertex.co
            out.extend((x, z, -y))
        seen.to_mesh_clear()
    return out


def play(job):
    empty_scene(job["fps"])
    clips, order = clips_and_order(job["file"])
    things = sorted(imported(job["file"]), key=lambda thing: order[thing.name])
    play_clip(clips[job["clip"]])
    with open(job["out"], "wb") as out:
        for seconds in job["times"]:
            frame = seconds * job["fps"]
            bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
            positions(things).tofile(out)


for each in json.load(open(sys.argv[sys.argv.index("--") + 1])):
    play(each)
