"""Sessions that tests advance, instead of the clock."""

import tandemlift as tl
from tandemlift.apps.live.session.frames import read_frames
from tandemlift.apps.live.session.page_messages import PAGE_MESSAGES
from tandemlift.apps.live.session.session import Session

GUIDED = {
    "pilot.guidance": "interactive",
    "phases.rotors": "flight",
    "ground.model": "floor",
    "compliance.yaw.model": "compliant",
}
CORRIDOR = GUIDED | {  # one for all that fly it in a page: to compile its module takes long
    "corridor.centreline": [[-1.0, 0.0], [0.4, 0.0], [1.0, 0.3]],
    "corridor.width": 3.4,
    "corridor.height": 1.2,
}
STIFFNESS, THRESHOLD = 6.0, 0.3  # N/m, N


def say(session, kind, **what):
    return session.apply(PAGE_MESSAGES[kind](seq=1, **what))


def fly(session, seconds):
    for _ in range(round(seconds / session.flight.dt)):
        if session.flight.over:
            return
        session._hand.expire_requests()
        session.flight.advance()


def seen(session):
    fields = tuple((name, count) for name, count in session.scene["fields"])
    return {name: value[0] for name, value in read_frames(fields, session.frame()).items()}


def up(session):
    fly(session, 8.0)
    assert session.status()["phase"] in ("guided", "hold")
    return seen(session)["position"]


def unprepared(tmp_path, **settings):
    return Session(tl.load_mission("hover", GUIDED | settings), out=tmp_path)
