"""blender -b --factory-startup --python-exit-code 3 --python blender_live.py -- PORT MOTION.npz

Blender as an engine: hears the VMC protocol at 127.0.0.1:PORT, turns the bones of an armature by it, and compares how
they are turned in the world with the exported MOTION.npz, in degrees. Start it first, then

    understudy retarget --source SCANS --target TARGET --send vmc://127.0.0.1:PORT --out MOTION.npz
"""
import os
import socket
import struct
import sys
import time

import bpy
import numpy
from mathutils import Matrix, Quaternion

BONES = ["Hips", "LeftUpperLeg", "RightUpperLeg", "Spine", "LeftLowerLeg", "RightLowerLeg", "Chest", "LeftFoot",
         "RightFoot", "UpperChest", "LeftToes", "RightToes", "Neck", "LeftShoulder", "RightShoulder", "Head",
         "LeftUpperArm", "RightUpperArm", "LeftLowerArm", "RightLowerArm", "LeftHand", "RightHand"]
PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19]


def text_at(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), (end // 4 + 1) * 4


def messages_of(packet):
    at = 16
    while at < len(packet):
        size = struct.unpack_from(">i", packet, at)[0]
        path, values = text_at(packet, at + 4)
        types, values = text_at(packet, values)
        yield path, types, packet[values:at + 4 + size]
        at += 4 + size


def bones_heard(port):
    """A list of {bone: (position, quaternion)} a frame, turned back from Unity's axes."""
    frames = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as engine:
        engine.bind(("127.0.0.1", port))
        engine.settimeout(120)
        while True:
            try:
                packet = engine.recv(65536)
            except socket.timeout:
                return frames
            engine.settimeout(3)
            for path, types, data in messages_of(packet):
                if path == "/VMC/Ext/OK":
                    frames.append({})
                elif path == "/VMC/Ext/Bone/Pos":
                    name, at = text_at(data, 0)
                    x, y, z, qx, qy, qz, qw = struct.unpack_from(">7f", data, at)
                    frames[-1][name] = ((-x, y, z), Quaternion((qw, qx, -qy, -qz)))


def armature_of(frame):
    """Bones whose own axes are the world's at rest."""
    bpy.ops.object.armature_add()
    thing = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    edit = thing.data.edit_bones
    edit.remove(edit[0])
    for name, parent in zip(BONES, PARENTS):
        bone = edit.new(name)
        above = edit[BONES[parent]] if parent >= 0 else None
        at = numpy.array(frame[name][0]) + (numpy.array(above.head) if above else 0)
        bone.head, bone.tail, bone.parent = at, at + (0, 0.1, 0), above
    bpy.ops.object.mode_set(mode="POSE")
    return thing


def turned_in_blender(thing, frame):
    for name, (_, turn) in frame.items():
        thing.pose.bones[name].rotation_quaternion = turn
    bpy.context.view_layer.update()
    return [thing.pose.bones[name].matrix.to_3x3() for name in BONES]


def turned_in_file(rotations):
    turns = []
    for local, parent in zip(rotations, PARENTS):
        turns.append(Matrix(local.tolist()) if parent < 0 else turns[parent] @ Matrix(local.tolist()))
    return turns


def main():
    port, motion = sys.argv[sys.argv.index("--") + 1:]
    frames = bones_heard(int(port))
    for _ in range(300):
        if os.path.exists(motion):
            break
        time.sleep(0.1)
    rotations = numpy.load(motion)["rotations"]
    assert len(frames) == len(rotations), f"{len(frames)} frames heard, {len(rotations)} written"
    thing = armature_of(frames[0])
    worst = 0
    for frame, local in zip(frames, rotations):
        for ours, theirs in zip(turned_in_file(local), turned_in_blender(thing, frame)):
            off = (ours.to_quaternion().rotation_difference(theirs.to_quaternion())).angle
            worst = max(worst, numpy.degrees(min(off, 2 * numpy.pi - off)))
    print(f"{len(frames)} frames, {len(BONES)} bones: Blender differs by at most {worst:.4f} degrees")
    assert worst < 0.1


main()
