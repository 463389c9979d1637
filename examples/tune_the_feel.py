"""What a push feels like: from words to virtual mass and damping, computed and flown."""

import math

import matplotlib.pyplot as plt
import numpy as np

import tandemlift as tl

firm = tl.load_mission("iris", {"admittance.feel.preset": "firm"})
damping = (2.0 - 0.3) / 0.6  # N s/m: (force - threshold) / speed
mass = damping * 1.5 / math.log(20.0)  # kg: 95 % of the speed after 1.5 s
assert np.allclose([firm.admittance.damping[0], firm.admittance.mass[0]], [damping, mass])
assert np.allclose([damping, mass], [2.83, 1.42], atol=0.005)

light = tl.load_mission("iris", {"admittance.feel.preset": "light"})
feels = {"firm": tl.feel(firm), "light": tl.feel(light)}
print(feels["firm"])

time = 0.02 * np.arange(1, 201)  # s since the push began
figure, axes = plt.subplots(figsize=(7, 2.6), layout="constrained")
for (name, feel), color in zip(feels.items(), ("C0", "C1"), strict=True):
    x, simulation = feel.axes[0], tl.Simulation(feel.mission)
    simulation.step(steps=14_000)  # it lifts off and tares its force sensors
    flown = [simulation.step([x.push, 0.0, 0.0], steps=20)[3] for _ in time]
    closed = x.final_speed * (1.0 - np.exp(-time / x.time_constant))
    axes.plot(time, closed, "--", color=color, lw=1)
    axes.plot(time, flown, color=color, label=f"{name}: {x.push:g} N")
axes.set(xlabel="time since the push began [s]", ylabel="speed along x [m/s]")
axes.legend(title="dashed: closed form")
figure.savefig("tune_the_feel.png", dpi=150)

led = [tl.load_mission("zigzag", {"admittance.feel.preset": name}) for name in feels]
effort = tl.fly_many(led, keep="metrics")
assert np.allclose([e["human_force_mean_n"] for e in effort], [2.33, 1.56], atol=0.05)  # N
assert min(e["clearance_min_m"] for e in effort) > 0.35  # m

mine = {"force": 1.0, "speed": 0.4, "time": 2.0}  # N, m/s, s
own = tl.load_mission("iris", {"admittance.feel": mine})
assert np.allclose([own.admittance.damping[0], own.admittance.mass[0]], [1.75, 1.17], atol=0.005)
