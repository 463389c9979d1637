"""Readings of many flights that step together: time, channels, state, outcome, metrics."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.learning.lanes import Lanes, lane_numbers
from tandemlift.core.findings import Finding
from tandemlift.core.types import Array, leaves, unflat
from tandemlift.missions import Mission
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import LeafSpan, leaf_offset
from tandemlift.simulation.preparation.block_memory import BlockOfFlights, EndedFlights
from tandemlift.simulation.results import RawResult, SampleChannels, findings_from, metrics_of


class BlockReadings:
    """The readings of a `Block`, one for each lane."""

    mission: Mission
    lanes: int
    dt: float
    _p: FlightPlan
    _k: int
    _flights: Lanes
    _memory: BlockOfFlights
    _ended: EndedFlights
    _sample: SampleChannels
    _tallies: slice
    _early: Array
    _late: NDArray[np.int64]

    @property
    def _steps_taken(self) -> NDArray[np.int64]:
        """The steps that each flight has taken (lanes,)."""
        begun = self._memory.begun.reshape(-1)[: self.lanes]
        return np.where(self._ended.over, self._ended.steps, self._k - begun)

    @property
    def time(self) -> Array:
        """The time that each flight has reached [s], (lanes,)."""
        return np.multiply(self._steps_taken, self.dt, dtype=np.float64)

    @property
    def ended(self) -> NDArray[np.bool_]:
        """Whether each flight is over (lanes,)."""
        return self._ended.over.copy()

    @property
    def outcome(self) -> NDArray[np.str_]:
        """The outcome of each flight that is over, as in a flight's metrics; "" for the others (lanes,)."""
        known = self._ended.outcomes
        for lane in self._ended.unknown:
            known[lane] = self.metrics(lane)["outcome"]
        return np.where(self._ended.over, known, "")

    @property
    def state(self) -> Array:
        """The true states (lanes, 13), as `Simulation.state`: a copy."""
        return self._memory.numbers_of(leaf_offset(self._p.model, "flight_state", "state"))[: self.lanes].copy()

    def sums(self, name: str) -> Array:
        """Sums over all steps so far, from which metrics are formed (lanes, n): `simulation.loop.running_metrics`.

        Args:
            name: of a sum, such as "position_squares" [m²], "power_sum" [W], or "effort.force_sum" [N].

        Raises:
            KeyError: the flights have no such sum.
        """
        metrics = self._p.model.flight_state.metrics
        at, size = leaf_offset(metrics, *name.split("."))
        if not size:
            raise KeyError(f"no sum {name!r} in {', '.join(metrics._fields)}")
        span = LeafSpan(self._tallies.start + at, size)
        before: Array = self._early[:, at : at + size] * (self._steps_taken >= self._late)[:, None]
        return before + self._memory.numbers_of(span)[: self.lanes]

    def __getitem__(self, name: str) -> Array:
        """A channel of the sample of the last step: (lanes, n), or (lanes,) where it has one column; read only.

        It is a view where the numbers of the channel stand together, and changes with the next step. A lane that has
        not stepped since its reset has nan.

        Raises:
            KeyError: there is no such channel.
        """
        if name == "time":
            return np.where(self._steps_taken > 0, (self._steps_taken - 1) * self.dt, np.nan)
        found: Array = self._sample.of(self._memory.sample, name)[..., : self.lanes].T
        found.flags.writeable = False
        return found

    def __contains__(self, name: object) -> bool:
        return name in self._sample

    def __repr__(self) -> str:
        return f"<Block {self.mission.mission.name}: {self.lanes} flights, {int(self._ended.over.sum())} over>"

    def metrics(self, lane: int) -> dict[str, Any]:
        """The metrics of one flight so far, as `Flight.metrics`; `command_at_start` is None.

        Raises:
            InputError: there is no such lane.
        """
        return metrics_of(*self._flown(lane))

    def findings(self, lane: int) -> tuple[Finding, ...]:
        """The findings of one flight so far.

        Raises:
            InputError: there is no such lane.
        """
        plan, flown = self._flown(lane)
        return findings_from(plan, flown)

    def _flown(self, lane: int) -> tuple[FlightPlan, RawResult]:
        (lane,) = lane_numbers(int(lane), self.lanes)
        plan, memory, b, place = self._flights.plans[lane], self._memory, *divmod(lane, self._memory.width)
        over, like = self._ended.over[lane], self._p.model.flight_state
        state = unflat(memory.flights[b, : leaves(like), place], like)
        last = self._ended.last[:, lane] if over else memory.sample_here(b)[:, place]
        return plan, RawResult(
            flight_state=state,
            early=unflat(self._early[lane], like.metrics),
            step=int(self._steps_taken[lane]),
            log=np.full((1, last.size), np.nan),
            last=np.full(last.size, np.nan) if state.ended else last,
            wall=0.0,
        )
