"""Which push threshold does which wind need? A grid of two keys in random winds, as a map."""

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
winds, thresholds = (share[name] for name in share.dims)
shown = axes.pcolormesh(thresholds, winds, 100.0 * share, vmin=0.0, vmax=100.0)
axes.set(xlabel="push threshold [N]", ylabel="turbulence: wind at 20 ft [m/s]")
figure.colorbar(shown, label="flights with a false push [%]")
figure.savefig("study_with_a_map.png", dpi=150)

assert share.sel({"wind.turbulence": 0.5}).max() == 0.0
assert share.sel({"wind.turbulence": 4.0, "admittance.threshold": 0.3}) == 1.0
assert share.sel({"wind.turbulence": 2.0, "admittance.threshold": 0.9}) == 0.0

counts = study.values("push_triggers_after_10s")
flight = tl.fly(study.mission(counts.argmax()))
assert flight.metrics()["push_triggers_after_10s"] == counts.max()
