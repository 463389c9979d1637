"""Turns at a flight that several pages show: one page has the hand, the next ones wait in a queue.

While nobody has the hand, each page may use the flight. A page that has it and does nothing passes it on.
"""

from __future__ import annotations

from typing import Literal, Protocol

IDLE = 30.0  # s without a message, after which the hand goes on to a page that waits


class Player(Protocol):
    """A page that takes turns: its number, and the time of its last message [s]."""

    number: int
    last_message: float


class Turns:
    """The queue of players, of whom the first has the hand since a time [s]."""

    def __init__(self) -> None:
        self._queue: list[Player] = []
        self._since = 0.0

    @property
    def player(self) -> Player | None:
        """Who has the hand."""
        return self._queue[0] if self._queue else None

    @property
    def numbers(self) -> list[int]:
        """The numbers of the players, in the order of their turns."""
        return [player.number for player in self._queue]

    def take(self, player: Player, what: Literal["ask", "give"], now: float) -> None:
        """Let a player queue up (at most once), or give the hand or the place in the queue away."""
        before = self.player
        if what == "give":
            self._queue = [other for other in self._queue if other is not player]
        elif player not in self._queue:
            self._queue.append(player)
        if self.player is not before:
            self._since = now

    def pass_on(self, now: float) -> None:
        """Pass the hand on if its player does nothing while others wait."""
        if len(self._queue) > 1 and now - max(self._since, self._queue[0].last_message) > IDLE:
            self.take(self._queue[0], "give", now)
