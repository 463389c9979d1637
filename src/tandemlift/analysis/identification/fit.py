"""The search: Gauss-Newton steps over the windows of logs, with noise levels and weights that follow the residuals.

A window that no vehicle explains, as under a push, is left out.
"""

from __future__ import annotations

import numpy as np

from tandemlift.analysis.identification.equations import (
    CAREFUL,
    ROBUST,
    ROUGH,
    Equations,
    Linearisation,
    NormalEquations,
)
from tandemlift.analysis.identification.prediction import moved_starts
from tandemlift.analysis.identification.windows import FEWEST
from tandemlift.core.types import Array, Progress

ROUGH_STEPS, FAR_STEPS, MOST_STEPS = 3, 7, 20  # of beginnings; the most with every window; the most of all
LAST_BACK = 14  # the step from which on windows that were left out stay so
NEAR, ENOUGH = 20.0, 0.25  # standard deviations: a step below the first is near the end, below the second is it
MOST_LATE = 0.015  # s of a clock in the search: a stream that is later is refused before
UNEXPLAINED = 0.15  # of the mean square of a stream's residuals in the median window, as much more, is no vehicle's
CHANCE = 5.0  # standard deviations of such a mean square that chance may add


class VehicleSearch(Linearisation):
    """The search for a vehicle's numbers."""

    lost = False  # whether the search left all finite numbers
    settled = False  # whether it came to an end before its last step

    @np.errstate(over="ignore", invalid="ignore")
    def run(self, progress: Progress | None = None, *, follow: bool = True) -> tuple[list[Equations], NormalEquations]:
        """Search to the end; the equations there.

        At first only the beginning of each window counts, because a wrong vehicle soon tumbles. Noise is what the
        samples' second differences show, and residuals far off the others count less. Then all that are large do. Near
        the end, unexplained windows are left out and the residuals' own noise counts.

        Args:
            progress: called with (steps done, steps in all).
            follow: whether windows may be left out and noise levels change.
        """
        chosen = MOST_STEPS  # the step before which windows were left out
        for number in range(MOST_STEPS):
            robust = ROUGH if number < ROUGH_STEPS else CAREFUL if number > chosen else ROBUST
            equations, normal = self.linearised(robust)
            self.lost = not np.isfinite(normal.information).all()
            if self.lost:
                return equations, normal
            shared = len(self.unknowns) + self.priors.count
            sides = np.eye(len(normal.side), shared + 1, 1)  # rows of the covariance beside the step
            sides[:, 0] = normal.side
            step, *rows = np.linalg.solve(normal.information, sides).T
            self._move(step, normal)
            self.steps = number + 1
            sd = np.sqrt([row[i] for i, row in enumerate(rows)])
            size = np.abs(step[:shared] / sd).max(initial=0.0)
            if progress:
                progress(number + 1, MOST_STEPS)
            self.settled = number > chosen + 1 and size < ENOUGH
            if self.settled:
                break
            if number > chosen and follow:
                self._follow_noise(equations)
            elif chosen == MOST_STEPS and number >= ROUGH_STEPS and (size < NEAR or number == FAR_STEPS):
                chosen = number
            if number >= chosen and follow:
                self._leave_out(equations, back=number < LAST_BACK)
        if progress:
            progress(MOST_STEPS, MOST_STEPS)
        return self.linearised(CAREFUL)

    def _move(self, step: Array, normal: NormalEquations) -> None:
        P, K = len(self.unknowns), self.priors.count
        e = self.estimate
        e.q = e.q + np.clip(step[:P], -1.0, 1.0)
        e.fixed = e.fixed + step[P : P + K]
        e.biases = e.biases + step[P + K :].reshape(e.biases.shape)
        clocks = [*dict.fromkeys(self.priors.clocks.values())]  # far off, a window's motion tells nothing of its clock
        e.biases[:, clocks] = np.clip(e.biases[:, clocks], -MOST_LATE, MOST_LATE)
        for part, (offset, matrix) in zip(self.parts, normal.back, strict=True):  # the starts, which were eliminated
            own = step[self.places(part)]
            part.starts = moved_starts(part.starts, offset - (matrix @ own[..., None])[..., 0])

    def _follow_noise(self, equations: list[Equations]) -> None:
        for name in self.estimate.noise:
            own = [eq.spread[name] for eq in equations if name in eq.spread] or [self.estimate.noise[name]]
            self.estimate.noise[name] = max(float(np.median(own)), 1e-12)

    def _leave_out(self, equations: list[Equations], *, back: bool = True) -> None:
        """Leave out the windows that no vehicle explains and those beside them.

        If these are more than half of a log, the worst go first, and `FEWEST` stay. Windows that the present vehicle
        explains come back, but not in the last steps, so that two sets of windows do not take turns.
        """
        for part, own in zip(self.parts, equations, strict=True):
            worst = np.zeros(len(part.used))
            for name, size in own.misfit.items():
                samples = part.windows.samples[name]
                count = np.bincount(samples.window, minlength=len(size)) * samples.values.shape[1]
                allowed = np.maximum(UNEXPLAINED, CHANCE * np.sqrt(2.0 / np.maximum(count, 1)))
                worst = np.fmax(worst, (size / np.nanmedian(size) - 1.0) / allowed)
            out = worst > 1.0
            near = np.abs(part.windows.first[:, None] - part.windows.first[out]) <= part.windows.length
            beside = near.any(axis=1)
            count, gone = len(out), int(beside.sum())
            part.crowded = gone > count // 2
            order = np.lexsort((-worst, ~beside, ~out))[: min(gone, count - FEWEST) if part.crowded else gone]
            used = np.ones_like(out)
            used[order] = False
            if back or (used & part.used).sum() < FEWEST:
                part.used = used
            else:
                part.used &= used
