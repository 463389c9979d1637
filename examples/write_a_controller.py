"""Fly my_controller.py, check it against a closed form, and compare it in a study."""

from pathlib import Path

import matplotlib.pyplot as plt

import tandemlift as tl

mine = str(Path(__file__).with_name("my_controller.py"))
my_pd = tl.load_controller(mine)
flight = tl.fly(tl.load_mission("one-push", controller=my_pd))
assert 0.039 < abs(flight["position_error"]).max() < 0.040  # m

heavier = tl.load_mission("one-push", {"plant.mass_scale": 1.05}, controller=my_pd)
sag = tl.fly(heavier)["position_error"][-1, 2]
predicted = 0.05 * 9.81 / heavier.controller.bandwidth[2] ** 2
assert abs(sag - predicted) < 1e-4
assert 0.122 < sag < 0.123  # m

task = {
    "study": {
        "name": "masses",
        "missions": ["one-push"],
        "controllers": [mine, "nftsmc"],
        "draws": 16,
    },
    "draw": {"plant.mass_scale": {"distribution": "uniform", "low": 0.9, "high": 1.1}},
}
table = tl.study(task).to_pandas()
figure, axes = plt.subplots(figsize=(7, 2.6), layout="constrained")
for name, rows in table.groupby("controller"):
    error = 1e3 * rows["position_rmse_after_10s_m.2"]
    axes.semilogy(rows["plant.mass_scale"], error, "o", label=name)
axes.set(xlabel="real mass over that of the pilot's model", ylabel="RMS error of z [mm]")
axes.legend()
figure.savefig("write_a_controller.png", dpi=150)

worst = table.groupby("controller")["position_rmse_after_10s_m.2"].max()
assert 0.2 < worst["my-pd"] < 0.25  # m
assert worst["nftsmc"] < 1e-4  # m
