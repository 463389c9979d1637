"""Fly the mission of the paper, read its numbers, and ask whether real rotors could fly it."""

import matplotlib.pyplot as plt
import numpy as np

import tandemlift as tl

mission = tl.load_mission("paper")
flight = tl.fly(mission)
metrics = flight.metrics()
error = metrics["position_rmse_after_10s_m"]  # m, along x, y, z
assert np.allclose(error, [0.0025, 0.0086, 0.0], atol=0.0001)

way = np.ptp(flight["admittance_position"][:, 0])
bound = metrics["human_impulse_n_s"][0] / mission.admittance.damping[0]
assert np.allclose([way, bound], [10.9, 11.3], atol=0.05)  # m

figure, (above, errors) = plt.subplots(1, 2, figsize=(7, 2.6), layout="constrained")
above.plot(*flight["position"][:, :2].T, label="flown")
above.plot(*flight["reference_position"][:, :2].T, "--", label="reference")
above.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
above.legend(loc="lower left", fontsize=7)
errors.plot(flight.time, 1e3 * flight["position_error"], label=["x", "y", "z"])
errors.set(xlabel="time [s]", ylabel="position error [mm]", ylim=(-60, 60))
errors.legend(ncols=3)
figure.savefig("reproduce_the_paper.png", dpi=150)

roll = abs(metrics["command_at_start"][1])
assert 1065 < roll < 1067  # N m
hover = mission.hover
assert np.allclose([hover.largest_moments[0], hover.authority[0]], [23.0, 4.93], atol=0.05)  # N m
real = tl.fly(tl.load_mission("paper", {"actuators.model": "rotors"}))
print(real.failure)
assert 3.0 < real.ending.time < 3.1  # s
ready = tl.fly(tl.load_mission("flight-ready", {"actuators.model": "rotors"}))
assert ready.outcome == "landed"
assert 0.079 < ready.metrics()["position_rmse_after_10s_m"][0] < 0.080  # m
