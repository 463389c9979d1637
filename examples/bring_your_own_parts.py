"""Fly my_gate.py, my_observer.py and my_engine.py, and check each without them."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tandemlift as tl

tl.load_plugin(str(Path(__file__).with_name("my_gate.py")))
hard = tl.fly("one-push")
smooth = tl.fly(tl.load_mission("one-push", {"admittance.gate": "smooth"}))
t = np.arange(0.0, 8.0, 1e-4)  # s
push = 3.0 * np.exp(-0.5 * ((t - 4.0) / 0.6) ** 2)  # N
predicted = 1e-4 * sum(push**3 / (push**2 + 0.3**2)) / 1.6
assert abs(smooth["reference_position"][-1, 0] - predicted) < 1e-4  # m
assert smooth.mission["plugins"][0]["name"] == "my_gate.py"

study = {"study": {"name": "gates", "missions": ["one-push"]}}
study["grid"] = {"admittance.gate": ["hard", "smooth"]}
table = tl.study(study).to_pandas()
assert list(table["final_position_m.0"]) == [flight["position"][-1, 0] for flight in (hard, smooth)]

tl.load_plugin(str(Path(__file__).with_name("my_observer.py")))
errors = {"estimator.error_metrics": True, "mission.duration": 30.0}
slow = tl.fly(tl.load_mission("iris", {"estimator.wrench": "slow", **errors})).metrics()
assert abs(slow["push_delay_s"] - 1.0 / 12.0) < 0.005  # s

tl.load_plugin(str(Path(__file__).with_name("my_engine.py")))
euler = tl.fly(tl.load_mission("one-push", {"mission.duration": 8.0}), engine="euler")
apart = np.abs(euler["position"] - hard["position"][: len(euler.time)]).max()
assert 1e-4 < apart < 3e-4  # m

figure, axes = plt.subplots(figsize=(7, 2.6), layout="constrained")
for name, flight in {"hard": hard, "smooth": smooth}.items():
    axes.plot(flight.time, flight["position"][:, 0], label=f"gate: {name}")
axes.set(xlim=(0.0, 12.0), xlabel="time [s]", ylabel="position x [m]")
axes.legend()
figure.savefig("bring_your_own_parts.png", dpi=150)
