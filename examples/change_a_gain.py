"""Change one gain of the controller: less offset, until the attitude loop cannot follow."""

import matplotlib.pyplot as plt
import numpy as np

import tandemlift as tl

hover = tl.load_mission("hover")
gains, layer = hover.controller.gains, hover.controller.boundary_layer[0]
mass = tl.Vehicle.from_settings(hover.vehicle).mass
force = 0.5  # N, steady, along x

S = np.linspace(0.0, 1.0, 10_001)
S = np.interp(force / mass, gains.lambda_1[0] * S + gains.lambda_2[0] * np.tanh(S / layer), S)
assert 0.0793 < S < 0.0795  # m/s

xi = np.array([0.6, 1.2, 2.4, 4.8, 9.6, 19.2])  # 1/s; the mission has 1.2
real = {
    "actuators.model": "rotors",
    "actuators.delay": 0.01,
    "disturbance.force": [force, 0.0, 0.0],
}
missions = [tl.load_mission("hover", {**real, "controller.gains.xi.0": float(x)}) for x in xi]
flights = tl.fly_many(missions)
offset = [-flight["position_error"][-1, 0] for flight in flights]
assert [flight.outcome for flight in flights] == ["flying"] * 5 + ["crashed"]
assert np.allclose(offset[1:5], S / xi[1:5], rtol=0.01)
assert np.allclose(offset[1:5:3], [0.066, 0.008], atol=5e-4)  # m

figure, (over_gain, over_time) = plt.subplots(1, 2, figsize=(7, 2.6), layout="constrained")
over_gain.loglog(xi, 1e3 * S / xi, "--", label="predicted: S/ξ")
over_gain.loglog(xi[:5], 1e3 * np.array(offset[:5]), "o", label="flown")
over_gain.set(xlabel="ξ [1/s]", ylabel="offset [mm]")
over_gain.legend()
for i in (1, 4, 5):
    over_time.plot(flights[i].time, 1e3 * flights[i]["position"][:, 0], label=f"ξ = {xi[i]:g}/s")
over_time.set(xlabel="time [s]", ylabel="x [mm]", ylim=(-120, 120))
over_time.legend()
figure.savefig("change_a_gain.png", dpi=150)
