"""latency_plot.py LIVE.csv OUT.png: the CSV of live_soak.py as a picture. Needs Debian's python3-matplotlib."""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

with open(sys.argv[1]) as file:
    rows = list(csv.DictReader(file))
came = [(float(row["seconds"]) / 60, float(row["latency_ms"])) for row in rows if row["latency_ms"]]
lost = [float(row["seconds"]) / 60 for row in rows if row["tracked"] == "0"]
values = sorted(ms for _, ms in came)
median, p95 = values[len(values) // 2], values[int(0.95 * len(values))]

figure, axes = plt.subplots(figsize=(9, 3.6), dpi=100)
axes.plot(*zip(*came), ".", markersize=2, color="#2a6fb0", label="a frame")
axes.plot(lost, [1] * len(lost), "|", markersize=6, color="#c0392b", label="no frame came in its time")
axes.axhline(median, color="#222222", linewidth=1, label=f"median {median:.0f} ms")
axes.axhline(p95, color="#222222", linewidth=1, linestyle="--", label=f"95 % below {p95:.0f} ms")
axes.set(xlabel="minutes", ylabel="capture to wire, ms", ylim=(0, max(4 * p95, 100)), xlim=(0, None))
axes.set_title(f"{len(came)} frames of a live camera; most {values[-1]:.0f} ms", fontsize=10)
axes.legend(loc="upper right", fontsize=8, ncol=2)
figure.tight_layout()
figure.savefig(sys.argv[2])
