"""A depth camera that is none: sends the PLY frames of a folder over TCP as LiveScan3D's stream, again and again.

    fake_camera.py FOLDER PORT [--seconds 10] [--fps 30] [--points 20000] [--form livescan|ply|float32]

Standard library only. A walk comes and goes: its frames are played to and fro, so that it does not jump.
"""
import argparse
import glob
import random
import socket
import struct
import time

SIZES = {"char": 1, "uchar": 1, "int8": 1, "uint8": 1, "short": 2, "ushort": 2, "int": 4, "uint": 4, "int32": 4,
         "float": 4, "float32": 4, "double": 8}


def read_points(path):
    """x, y, z of each vertex of a binary little-endian PLY whose first properties these are, as float32."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + 11
    count, size, in_vertices = 0, 0, False
    for line in data[:end].decode().splitlines():
        words = line.split()
        if words[0] == "element":
            in_vertices = words[1] == "vertex"
            count = int(words[2]) if in_vertices else count
        elif words[0] == "property" and in_vertices:
            size += SIZES[words[1]]
    return [struct.unpack_from("<3f", data, end + i * size) for i in range(count)]


def thickened(points, count, rng):
    """As many points as a camera sees: each again with a millimetre of noise."""
    return [tuple(c + rng.gauss(0, 0.002) for c in points[i % len(points)]) for i in range(count)]


def encoded(points, form="livescan"):
    n = len(points)
    if form == "livescan":
        millimetres = [round(1000 * c) for p in points for c in p]
        return struct.pack(f"<i{3 * n}h", n, *millimetres) + bytes(3 * n)
    numbers = struct.pack(f"<{3 * n}f", *[c for p in points for c in p])
    if form == "ply":
        head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {n}\nproperty float x\nproperty float y\n"
                "property float z\nend_header\n").encode()
        numbers = head + numbers
    return struct.pack("<I", len(numbers)) + numbers


def frames_of(folder, count=0, form="livescan", seed=1):
    rng = random.Random(seed)
    clouds = [read_points(path) for path in sorted(glob.glob(folder + "/*.ply"))]
    if count:
        clouds = [thickened(cloud, count, rng) for cloud in clouds]
    return [encoded(cloud, form) for cloud in clouds]


def to_and_fro(i, count):
    i %= max(1, 2 * count - 2)
    return i if i < count else 2 * count - 2 - i


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("port", type=int)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--fps", type=float, default=30)
    parser.add_argument("--points", type=int, default=0)
    parser.add_argument("--form", default="livescan")
    options = parser.parse_args()
    frames = frames_of(options.folder, options.points, options.form)
    with socket.create_connection(("127.0.0.1", options.port)) as camera:
        start = time.monotonic()
        for i in range(round(options.seconds * options.fps)):
            time.sleep(max(0.0, start + i / options.fps - time.monotonic()))
            camera.sendall(frames[to_and_fro(i, len(frames))])


if __name__ == "__main__":
    main()
