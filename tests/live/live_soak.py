"""Ten live minutes: a camera at 30 frames/s that stops, comes back and sends rubbish; poses that go out as OSC.

    live_soak.py PROGRAM [--minutes 10] [--points 20000] [--scans assets/samples/walk]
                 [--target assets/samples/target_adult.glb] [--out live.csv]

Writes a line a frame: seconds since the start, latency from capture to wire in milliseconds, 1 where the source was
tracked. At the end prints median, p95 and most, how many frames were dropped, and the machine's load. Traffic stays on
127.0.0.1. Standard library only.
"""
import argparse
import os
import random
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import fake_camera


def padded_end(data, at):
    return (data.index(b"\0", at) // 4 + 1) * 4


def frame_message(packet):
    """number, seconds, age in ms, tracked: the first message of a bundle, where it is /understudy/frame."""
    if not packet.startswith(b"#bundle\0") or packet[20:37] != b"/understudy/frame":
        return None
    return struct.unpack_from(">iffi", packet, padded_end(packet, padded_end(packet, 20)))


class Camera(threading.Thread):
    """Each minute: it sends for 40 s, is silent for 5 s, goes for 5 s, comes back with rubbish, goes on."""

    def __init__(self, port, frames, end):
        super().__init__(daemon=True)
        self.port, self.frames, self.end = port, frames, end
        self.sent, self.late_ms, self.rubbish, self.cut_off = 0, 0.0, 0, 0

    def connect(self):
        while time.monotonic() < self.end:
            try:
                return socket.create_connection(("127.0.0.1", self.port))
            except OSError:
                time.sleep(0.1)
        return None

    def play(self, camera, seconds):
        start = time.monotonic()
        i = 0
        while time.monotonic() < min(start + seconds, self.end):
            due = start + i / 30
            time.sleep(max(0.0, due - time.monotonic()))
            self.late_ms = max(self.late_ms, 1000 * (time.monotonic() - due))
            camera.sendall(self.frames[fake_camera.to_and_fro(self.sent, len(self.frames))])
            self.sent += 1
            i += 1

    def misbehave(self, kind):
        """A length that lies, a flood of noise, half a frame, a second of nothing."""
        rng = random.Random(kind)
        camera = self.connect()
        if camera is None:
            return
        with camera:
            try:
                if kind % 3 == 0:
                    camera.sendall(struct.pack("<i", 10_000_000) + rng.randbytes(90_000))
                elif kind % 3 == 1:
                    camera.sendall(b"\xff" * 4 + rng.randbytes(200_000))
                else:
                    camera.sendall(self.frames[0][:5000])
                time.sleep(1)
            except OSError:
                self.cut_off += 1
        self.rubbish += 1

    def run(self):
        minute = 0
        while time.monotonic() < self.end:
            camera = self.connect()
            if camera is None:
                return
            with camera:
                self.play(camera, 40)
                time.sleep(min(5, max(0, self.end - time.monotonic())))
                self.play(camera, 3)
            time.sleep(min(5, max(0, self.end - time.monotonic())))
            self.misbehave(minute)
            minute += 1


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def receive(program, engine, start, path):
    """Until the program ends; the latencies."""
    ages = []
    with open(path + ".part", "w") as out:
        out.write("seconds,latency_ms,tracked\n")
        while program.poll() is None:
            try:
                message = frame_message(engine.recv(65536))
            except socket.timeout:
                continue
            if message is None:
                continue
            _, _, age, tracked = message
            if age > 0:
                ages.append(age)
            out.write(f"{time.monotonic() - start:.3f},{age if age > 0 else ''},{tracked}\n")
    os.replace(path + ".part", path)
    return sorted(ages)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--points", type=int, default=20000)
    parser.add_argument("--scans", default="assets/samples/walk")
    parser.add_argument("--target", default="assets/samples/target_adult.glb")
    parser.add_argument("--out", default="live.csv")
    options = parser.parse_args()
    frames = fake_camera.frames_of(options.scans, options.points)
    engine = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    engine.bind(("127.0.0.1", 0))
    engine.settimeout(0.5)
    port = free_port(socket.SOCK_STREAM)
    start = time.monotonic()
    with open(options.out + ".log", "w") as log:
        program = subprocess.Popen(
            [options.program, "retarget", "--listen", f"tcp://127.0.0.1:{port}", "--target", options.target, "--send",
             f"osc://127.0.0.1:{engine.getsockname()[1]}"], stdout=subprocess.DEVNULL, stderr=log)
    end = start + 60 * options.minutes
    camera = Camera(port, frames, end)
    camera.start()
    threading.Timer(end + 2 - time.monotonic(), lambda: program.send_signal(signal.SIGINT)).start()
    ages = receive(program, engine, start, options.out)
    if not ages:
        sys.exit(f"no frame came out, see {options.out}.log")
    load = " ".join(f"{x:.1f}" for x in os.getloadavg())
    print(f"{camera.sent} frames sent, {len(ages)} came out; capture to wire {ages[len(ages) // 2]:.1f} ms median, "
          f"{ages[int(0.95 * len(ages))]:.1f} p95, {ages[-1]:.1f} most; {camera.rubbish} times rubbish; the camera was "
          f"up to {camera.late_ms:.0f} ms late itself; load {load} on {os.cpu_count()} processors; "
          f"exit code {program.returncode}")
    sys.exit(program.returncode)


if __name__ == "__main__":
    main()
