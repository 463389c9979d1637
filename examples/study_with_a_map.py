"""How much wind may a push threshold bear? A grid of two keys, flown in several winds of each kind, as a map."""

import matplotlib.pyplot as plt

import tandemlift as tl

study = tl.study(
    {
        "study": {"name": "false-pushes", "missions": ["gusts"], "draws": 6},
        "set": {"mission.duration": 22.0, "pushes": [], "wind.gusts": []},
        "grid": {
            "wind.turbulence": [0.5, 1.0, 2.0, 3.0, 4.0],
            "admittance.threshold": [0.3, 0.6, 0.9, 1.2, 1.5],
        },
    },
    out="out/false-pushes",
)
data = study.to_xarray(["push_triggers_after_10s", "outcome"])
assert data["outcome"].size == 150
assert (data["outcome"] == "flying").all()

share = (data["push_triggers_after_10s"] > 0).mean("draw")
figure, axes = plt.subplots(figsize=(7, 3.2), layout="constrained")
shown = axes.pcolormesh(*(share[key] for key in reversed(share.dims)), 100.0 * share, cmap="viridis", vmin=0, vmax=100)
axes.set(xlabel="push threshold [N]", ylabel="wind with turbulence [m/s]")
figure.colorbar(shown, label="flights with a false push [%]")
figure.savefig("study_with_a_map.png", dpi=150)

assert share.sel({"wind.turbulence": 0.5}).max() == 0.0
assert share.sel({"wind.turbulence": 4.0, "admittance.threshold": 0.3}) == 1.0
assert share.sel({"wind.turbulence": 2.0, "admittance.threshold": 0.9}) == 0.0

row = int(study.to_pandas()["push_triggers_after_10s"].idxmax())
flight = tl.fly(study.mission(row))
assert flight.metrics()["push_triggers_after_10s"] == study.values("push_triggers_after_10s")[row]
