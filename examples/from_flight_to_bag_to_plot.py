"""Write a flight as a ROS 2 bag, read it by a library that knows nothing of it, and plot it."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from rosbags.highlevel import AnyReader

import tandemlift as tl
from tandemlift.apps.export.reading import read_bag
from tandemlift.apps.export.write import export

flight = tl.fly(tl.load_mission("iris", {"mission.duration": 30.0}))
export(flight, "iris.mcap")


def series(bag, topic):
    """Times [s] and forces along x [N] of a topic."""
    found = [c for c in bag.connections if c.topic == f"/tandemlift/{topic}"]
    read = [(time, bag.deserialize(raw, c.msgtype)) for c, time, raw in bag.messages(found)]
    return [1e-9 * time for time, _ in read], [message.wrench.force.x for _, message in read]


figure, axes = plt.subplots(figsize=(7, 2.6), layout="constrained")
with AnyReader([Path("iris.mcap")]) as bag:
    for topic, style in (("push/measured", "0.8"), ("push/true", "k"), ("push/gated", "C1")):
        times, forces = series(bag, topic)
        axes.plot(times, forces, style, label=topic)
axes.set(xlabel="time of the message [s]", ylabel="force along x [N]", ylim=(-1, 4))
axes.legend()
figure.savefig("from_flight_to_bag_to_plot.png", dpi=150)
assert len(times) == 3001
assert times[0] == 1.0  # s

again = read_bag("iris.mcap")
assert np.allclose(again["position"], flight["position"], atol=1e-12)
