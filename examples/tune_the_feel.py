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
reports = {"firm": tl.feel(firm), "light": tl.feel(light)}
print(reports["firm"])

figure, axes = plt.subplots(figsize=(7, 2.6), layout="constrained")
for (name, report), color in zip(reports.items(), ("C0", "C1"), strict=True):
    x = report.study.pushed[0]
    axes.plot(x.time, x.closed, "--", color=color, lw=1)
    axes.plot(x.time, x.flown, color=color, label=f"{name}: {x.feel.push:g} N")
axes.set(xlabel="time since the push began [s]", ylabel="speed along x [m/s]")
axes.legend(title="dashed: closed form")
figure.savefig("tune_the_feel.png", dpi=150)

led = [tl.load_mission("zigzag", {"admittance.feel.preset": name}) for name in reports]
effort = tl.fly_many(led, keep="metrics")
assert np.allclose([e["human_force_mean_n"] for e in effort], [2.2, 1.55], atol=0.05)  # N
assert min(e["clearance_min_m"] for e in effort) > 0.4  # m

mine = {"force": 1.0, "speed": 0.4, "time": 2.0}  # N, m/s, s
own = tl.load_mission("iris", {"admittance.feel": mine})
assert np.allclose([own.admittance.damping[0], own.admittance.mass[0]], [1.75, 1.17], atol=0.005)
