"""A vehicle from the log of one flight: identified, compared with the truth, and flown."""

import matplotlib.pyplot as plt

import tandemlift as tl

sines = [
    {"axis": axis, "frequency": f, "amplitude": size, "phase": 0.7 * k * k}
    for axis, size in (("thrust", 0.5), ("roll", 0.3), ("pitch", 0.03), ("yaw", 0.06))
    for k, f in enumerate((0.35, 0.6, 1.0, 1.7, 2.9, 4.9, 8.0))
]
flown = {
    "mission.duration": 34.0,
    "mission.log_interval": 0.001,
    "phases.land_start": 90.0,
    "pushes": [],
    "excitation.model": "multisine",
    "excitation.begin": 13.0,
    "excitation.duration": 21.0,
    "excitation.lines": sines,
}
real = {"vehicle.payload.mass": 0.62, "vehicle.payload.center_of_mass": [0.0, 0.05, 0.0]}
real |= {"actuators.delay": 0.013, "vehicle.quadrotors.0.mass": 1.6}
truth = tl.load_mission("iris", real | flown)
log = tl.fly(truth)

found = tl.identify(log, "iris", weighed={"vehicle.payload.mass": 0.62})
assert abs(found["mass"].value - 3.72) < 0.01  # kg
assert abs(found["actuators.delay"].value - 0.013) < 1e-4  # s
assert max(found.details["held_back"]["ratio"].values()) < 1.3

figure, axes = plt.subplots(figsize=(7, 3.2), layout="constrained")
rows = [row for row in found.rows if row.high - row.low < 0.4 * abs(row.start)]
for place, row in enumerate(reversed(rows)):
    axes.plot([100 * (x / row.start - 1) for x in (row.low, row.high)], [place, place], "C0", lw=3)
axes.set(xlabel="change from mission and scale [%]", xlim=(-40, 40))
names = [row.key.removeprefix("vehicle.") for row in reversed(rows)]
axes.set_yticks(range(len(rows)), names, fontsize=6)
figure.savefig("identify_your_vehicle.png", dpi=150)
