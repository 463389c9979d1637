"""The closed loop as a linear model: its poles, its margins, and flights beyond the limit."""

import matplotlib.pyplot as plt
import numpy as np

import tandemlift as tl

mission = tl.load_mission("iris")
model = tl.linearize(mission)
z = np.linalg.eigvals(model.A)
poles = np.log(z[abs(z) > 1e-3]) / model.step  # 1/s
assert (len(model.states), model.step) == (402, 0.005)
assert abs(z).max() < 1.0 + 1e-9

checks = {(check.check, check.subject): check for check in tl.check(mission)}
margins = [180.0 - checks["loop phase", axis].value for axis in ("z", "roll", "pitch", "yaw")]
assert np.allclose(margins, [60, 47, 48, 56], atol=0.5)  # deg
longest = checks["loop delay", ""].limit
assert 55.5 < longest < 57.5  # ms

figure, (plane, rates) = plt.subplots(1, 2, figsize=(7, 2.8), layout="constrained")
plane.plot(poles.real, poles.imag, "x", ms=4)
plane.set(xlabel="Re s [1/s]", ylabel="Im s [rad/s]", xlim=(-30, 2), ylim=(-40, 40))
for delay in (0.045, 0.060):
    flight = tl.fly(tl.load_mission("iris", {"actuators.delay": delay, "mission.duration": 20.0}))
    kinds = {finding.kind for finding in flight.findings}
    assert ("oscillating" in kinds) == (1e3 * delay > longest)
    rates.plot(flight.time, flight["rates"][:, 1], label=f"{1e3 * delay:g} ms", zorder=-delay)
rates.set(xlabel="time [s]", ylabel="pitch rate [rad/s]")
rates.legend(title="delay")
figure.savefig("linearize_and_read_margins.png", dpi=150)
