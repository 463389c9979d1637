"""Fly the same mission in two engines that share no equation of motion, and compare."""

import matplotlib.pyplot as plt
import numpy as np

import tandemlift as tl

push = tl.load_mission("one-push")
ours, theirs = tl.fly(push), tl.fly(push, engine="mujoco")
assert np.abs(ours["position"] - theirs["position"]).max() < 1e-7  # m

iris = tl.load_mission("iris", {"mission.duration": 30.0})
flights = {engine: tl.fly(iris, engine=engine) for engine in ("compiled", "mujoco")}
compiled, mujoco = flights.values()
distance = np.linalg.norm(compiled["position"] - mujoco["position"], axis=1)
assert distance.max() < 2e-3  # m
assert compiled.outcome == mujoco.outcome == "flying"

figure, (forces, apart) = plt.subplots(1, 2, figsize=(7, 2.6), layout="constrained")
for (name, flight), style in zip(flights.items(), ("-", "--"), strict=True):
    forces.plot(flight.time, flight["joint_force"][:, 2], style, label=name, lw=1)
forces.set(xlabel="time [s]", ylabel="force at joint 1, body z [N]")
forces.legend()
apart.plot(compiled.time, 1e3 * distance)
apart.set(xlabel="time [s]", ylabel="distance of the two [mm]")
figure.savefig("fly_in_mujoco.png", dpi=150)

for name, flight in flights.items():
    metrics = flight.metrics()
    print(f"{name}: {metrics['wall_s'] / metrics['steps'] * 1e6:.1f} µs a step")
