"""MuJoCo: the beam and the two quadrotors as three welded bodies on a free joint, open loop under a constant force.

Contacts and constraints are switched off, as there are none. Many simulations run in whichever is faster,
`mujoco.batch` or `mujoco.rollout`, both of which thread by themselves.
"""

from __future__ import annotations

from typing import Any

from simulators import Advance, Row, fastest

STEP = "plant only: three welded bodies, {integrator}; float64, 1 ms"
ROWS = {
    "Euler": Row("MuJoCo, Euler", STEP.format(integrator="semi-implicit Euler"), ("mujoco",)),
    "RK4": Row("MuJoCo, RK4", STEP.format(integrator="RK4"), ("mujoco",)),
}
MODEL = """
<mujoco>
  <option timestep="0.001" integrator="{integrator}"><flag contact="disable" constraint="disable"/></option>
  <worldbody>
    <body name="beam" pos="0 0 1">
      <freejoint/>
      <inertial pos="0 0 0" mass="0.5" diaginertia="0.166667 0.000625 0.166667"/>
      <body pos="0 1 0.075"><inertial pos="0 0 0" mass="1.5" diaginertia="0.029125 0.029125 0.055225"/></body>
      <body pos="0 -1 0.075"><inertial pos="0 0 0" mass="1.5" diaginertia="0.029125 0.029125 0.055225"/></body>
    </body>
  </worldbody>
</mujoco>
"""
THRUST = 3.5 * 9.81  # N, along world z
COUNT, STEPS = 256, 200


def one(row: str) -> Advance:
    import mujoco

    model = model_of(row)
    data = mujoco.MjData(model)
    data.xfrc_applied[1, 2] = THRUST
    data.qvel[3:] = 0.1, 0.2, 0.3

    def advance() -> int:
        mujoco.mj_step(model, data, nstep=20_000)
        return 20_000

    return advance


def many(row: str, cores: int) -> Advance:
    model = model_of(row)
    return fastest([_batch(model, cores), _rollout(model, cores)])


def model_of(integrator: str) -> Any:
    import mujoco

    return mujoco.MjModel.from_xml_string(MODEL.format(integrator=integrator))


def _batch(model: Any, cores: int) -> Advance:
    from mujoco.batch import Batch

    batch = Batch(model, COUNT, cores)
    batch.bind("xfrc_applied")[:, 1, 2] = THRUST
    batch.bind("qvel")[:, 3:] = 0.1, 0.2, 0.3

    def advance() -> int:
        batch.step(nstep=STEPS)
        return COUNT * STEPS

    return advance


def _rollout(model: Any, cores: int) -> Advance:
    import mujoco
    import numpy as np
    from mujoco.rollout import Rollout

    force = int(mujoco.mjtState.mjSTATE_XFRC_APPLIED)
    control = np.zeros((1, 1, 6 * model.nbody))
    control[..., 6 + 2] = THRUST
    workers = [mujoco.MjData(model) for _ in range(cores)]
    state = int(mujoco.mjtState.mjSTATE_FULLPHYSICS)
    start = np.zeros((COUNT, mujoco.mj_stateSize(model, state)))
    mujoco.mj_getState(model, workers[0], start[0], state)
    start[:] = start[0]
    pool = Rollout(nthread=cores if cores > 1 else 0)

    def advance() -> int:
        pool.rollout(model, workers, start, control, control_spec=force, nstep=STEPS)
        return COUNT * STEPS

    return advance
