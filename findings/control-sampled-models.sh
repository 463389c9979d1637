#!/bin/sh
# python-control 0.10.2 takes a sampled model for a continuous one in `h2syn`, `hinfsyn` and `balred`: no error, no
# warning. Guess: they refuse it, or use the sampled Riccati and Lyapunov equations, as `dlqr` and `lqr` tell them apart.
# Seen: the controller and the reduced model have dt = 0, and the reduced model another gain at rest. Fails if that changes.
set -eu
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
python3 -m venv "$place/venv"
"$place/venv/bin/pip" install -qq --disable-pip-version-check control==0.10.2 slycot==0.7.1 numpy==2.4.6 scipy==1.17.1
"$place/venv/bin/python" -W error::UserWarning - <<'EOF'
import control as ct
import numpy as np

print("control", ct.__version__)
# a state with gain 0.9 a sample; w: noise of the process and of the reading, u; z: the state and u, y: the state, read
plant = ct.ss([[0.9]], [[1, 0, 1]], [[1], [0], [1]], [[0, 0, 0], [0, 0, 1], [0, 1, 0]], 0.1)
same = ct.ss(plant.A, plant.B, plant.C, plant.D)  # the same matrices, said to be continuous
for name, of in (("h2syn", ct.h2syn), ("hinfsyn", lambda p, *n: ct.hinfsyn(p, *n)[0])):
    sampled, continuous = of(plant, 1, 1), of(same, 1, 1)
    assert sampled.dt == 0.0 and np.allclose(sampled.A, continuous.A), f"changed: {name}"
    print(f"{name}: dt = {sampled.dt:g} for a plant sampled every {plant.dt:g} s; matrices as of a continuous plant")
chain = ct.ss(np.diag([0.95, 0.5, 0.1]), np.ones((3, 1)), np.array([[0.05, 0.1, 0.2]]), 0.0, 0.1)
reduced = ct.balred(chain, 1, method="truncate")
assert reduced.dt == 0.0, "changed: balred"
print(f"balred: dt = {reduced.dt:g}; gain at rest {ct.dcgain(reduced):.3f} for {ct.dcgain(chain):.3f}")
EOF
# Seen: control 0.10.2
#       h2syn: dt = 0 for a plant sampled every 0.1 s; matrices as of a continuous plant
#       hinfsyn: dt = 0 for a plant sampled every 0.1 s; matrices as of a continuous plant
#       balred: dt = 0; gain at rest -2.253 for 1.422
