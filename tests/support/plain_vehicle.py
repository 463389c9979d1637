"""A vehicle under logged rotor speeds in plain NumPy, to identify it by `scipy.optimize`: no law of the package."""

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

GRAVITY = np.array([0.0, 0.0, -9.81])


def squares(time, speeds, times, step, delay, up, down):
    """Mean squares of rotor speeds over steps that begin at `times`: a first-order lag behind delayed commands."""
    held = speeds[np.maximum(np.searchsorted(time, times - delay + 1e-9, side="right") - 1, 0)]
    speed, found = held[0].copy(), []
    for command in held:
        tau, off = np.where(command > speed, up, down), speed - command
        one, two = (tau / (n * step) * (1.0 - np.exp(-n * step / tau)) for n in (1.0, 2.0))
        found.append(command**2 + 2.0 * command * off * one + off**2 * two)
        speed = command + off * np.exp(-step / tau)
    return np.array(found)


def rates_of_change(x, thrust, moment, mass, J, inverse):
    """Of position, velocity, attitude (w, x, y, z) and rates (…, 13), with the acceleration and that of the rates."""
    w, q, rates = x[..., 6:7], x[..., 7:10], x[..., 10:]
    axis = np.stack(
        [2 * (q[..., 0] * q[..., 2] + w[..., 0] * q[..., 1]), 2 * (q[..., 1] * q[..., 2] - w[..., 0] * q[..., 0])], -1
    )
    up = np.concatenate([axis, 1.0 - 2.0 * np.sum(q[..., :2] ** 2, -1, keepdims=True)], -1)
    pull = up * (thrust / mass)[..., None]
    turning = (moment - np.cross(rates, rates @ J)) @ inverse
    spin = np.concatenate([-np.sum(q * rates, -1, keepdims=True), w * rates + np.cross(q, rates)], -1)
    return np.concatenate([x[..., 3:6], pull + GRAVITY, 0.5 * spin, turning], -1), turning


class PlainVehicle:
    """A rigid body with rotors; `vehicle` gives masses and places, drag is left out."""

    def __init__(self, vehicle, step):
        self.mass, self.J, self.step = vehicle.mass, np.array(vehicle.inertia), step
        self.inverse = np.linalg.inv(self.J)
        self.origin = -np.array(vehicle.center_of_mass)
        arms = zip(vehicle.quadrotors, vehicle.lever_arms, strict=True)
        places = [(d[0] + x, d[1] + y, s) for q, d in arms for (x, y), s in zip(q.rotors, q.spins, strict=True)]
        self.x, self.y, self.spins = np.array(places).T

    def readings(self, start, squares_, constants, per_thrust):
        """States and specific forces (…, steps, 16) from starts (…, 13): constants and yaw per thrust (…, rotors)."""
        x, found, h = start, [], self.step
        for k in range(squares_.shape[-2]):
            f = squares_[..., k, :] * constants
            moment = np.stack([f @ self.y, -(f @ self.x), (f * per_thrust) @ self.spins], -1)
            thrust = f.sum(-1)

            def motion(s, thrust=thrust, moment=moment):
                return rates_of_change(s, thrust, moment, self.mass, self.J, self.inverse)

            one, turning = motion(x)
            rates = x[..., 10:]
            lever = np.cross(turning, self.origin) + np.cross(rates, np.cross(rates, self.origin))
            lifted = np.zeros_like(lever)
            lifted[..., 2] = thrust / self.mass
            found.append(np.concatenate([x, lifted + lever], -1))
            two = motion(x + 0.5 * h * one)[0]
            three = motion(x + 0.5 * h * two)[0]
            four = motion(x + h * three)[0]
            x = x + h / 6.0 * (one + 2.0 * two + 2.0 * three + four)
            x[..., 6:10] /= np.linalg.norm(x[..., 6:10], axis=-1, keepdims=True)
        return np.stack(found, -2)


def turned(q, turn):
    """Attitudes (w, x, y, z) after small rotations about body axes."""
    own = Rotation.from_quat(np.roll(q, -1, -1).reshape(-1, 4)) * Rotation.from_rotvec(turn.reshape(-1, 3))
    return np.roll(own.as_quat(), 1, -1).reshape(q.shape)


def misfit(plain, squares_, data, starts, nominal, noise, z, own):
    """Whitened residuals (…, W, n) at shared unknowns z (…, S) and moves of the starts `own` (…, 12 W)."""
    W, shared = len(starts), z.shape[-1]
    q, moves = z[..., :shared], own.reshape(*own.shape[:-1], W, 12)
    x = np.broadcast_to(starts, (*moves.shape[:-1], 13)).copy()
    x[..., :6] += moves[..., :6]
    x[..., 10:] += moves[..., 9:]
    x[..., 6:10] = turned(x[..., 6:10], moves[..., 6:9])
    constants = np.repeat(np.exp(q[..., :2]) * nominal[:2], 4, axis=-1)[..., None, :]
    unlike = q[..., 3:4] * np.sqrt(0.5) * [1.0, -1.0]
    yaw = np.repeat(np.exp(q[..., 2:3] + unlike) * nominal[2], 4, axis=-1)[..., None, :]
    y = plain.readings(x, squares_, constants, yaw)
    bias = q[..., None, None, 4:]
    R = 0.0 * y[..., 6:10] + y[..., 6:10]
    lever = _rotated(R, bias[..., 6:9] + 0.0 * y[..., :3])
    swept = _rotated(R, np.cross(y[..., 10:13], bias[..., 6:9]))
    every = {
        "measured_specific_force": y[..., 13:] + bias[..., :3],
        "measured_rates": y[..., 10:13] + bias[..., 3:6],
        "measured_position": y[..., :3] + lever,
        "measured_velocity": y[..., 3:6] + swept,
    }
    parts = []
    for name, (steps, values) in data.items():
        if name == "measured_attitude":
            here = R[..., steps, :]
            seen = np.broadcast_to(values, here.shape)
            r = 2.0 * (
                here[..., :1] * seen[..., 1:] - seen[..., :1] * here[..., 1:] - np.cross(here[..., 1:], seen[..., 1:])
            )
            r = r * np.sign(np.sum(here * seen, -1, keepdims=True))
        else:
            r = values - every[name][..., steps, :]
        parts.append((r / noise[name]).reshape(*r.shape[:-3], W, -1))
    return np.concatenate(parts, -1)


def fitted(plain, squares_, data, starts, nominal, noise, priors):
    """(Logs of two constants, log yaw per thrust, what makes the two yaws unlike, biases, point), and their covariance.

    Args:
        plain: a `PlainVehicle`.
        squares_: of the windows (W, steps, rotors).
        data: samples by stream (W, n, width) with the steps (n,) at which they were taken.
        starts: first guesses (W, 13).
        nominal: thrust constants of both quadrotors, yaw per thrust.
        noise: standard deviations by stream.
        priors: standard deviations of the thirteen shared unknowns.
    """
    W, shared, given = len(starts), len(priors), (plain, squares_, data, starts, nominal, noise)

    def residuals(v):
        return np.concatenate([misfit(*given, v[:shared], v[shared:]).ravel(), v[:shared] / priors])

    def jacobian(v):
        h, n = 1e-6, shared + 12
        z = np.repeat(v[None, :shared], n + 1, 0)
        own = np.repeat(v[None, shared:], n + 1, 0).reshape(n + 1, W, 12)
        z[range(shared), range(shared)] += h
        for i in range(12):
            own[shared + i, :, i] += h
        r = misfit(*given, z, own.reshape(n + 1, -1))
        D = (r[:-1] - r[-1]) / h
        J = np.zeros((W, D.shape[-1], shared + 12 * W))
        J[..., :shared] = np.moveaxis(D[:shared], 0, -1)
        for k in range(W):
            J[k, :, shared + 12 * k : shared + 12 * k + 12] = np.moveaxis(D[shared:, k], 0, -1)
        return np.concatenate([J.reshape(-1, J.shape[-1]), np.eye(shared, J.shape[-1]) / np.array(priors)[:, None]])

    found = least_squares(residuals, np.zeros(shared + 12 * W), jac=jacobian, method="lm", xtol=1e-10)
    covariance = np.linalg.inv(found.jac.T @ found.jac)
    return found.x[:shared], covariance[:shared, :shared]


def _rotated(q, v):
    twice = 2.0 * np.cross(q[..., 1:], v)
    return v + q[..., :1] * twice + np.cross(q[..., 1:], twice)
