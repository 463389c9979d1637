"""Who holds the beam, and when it is let go."""

import numpy as np
from patience import PATIENCE, until

from tandemlift.apps.live import viewers
from tandemlift.apps.live.session.frames import read_frames


def at_target(viewer, server, target):
    """Wait for a frame in which the body is where it is pulled."""
    until(lambda: np.allclose(read_frames(server.flight.fields, viewer.frame())["position"], target, atol=0.01))


def test_who_moves_the_beam_is_shown_what_came_of_it_before_the_next_frame_for_all(live, monkeypatch):
    monkeypatch.setattr("tandemlift.apps.live.server.RATE", 0.5 / PATIENCE)
    with live.viewer() as viewer:
        assert viewer.frame()
        viewer.grab(1.0, 0.0, 0.0)
        viewer.say(type="move", target=[2.0, 0.0, 0.0])
        assert read_frames(live.flight.fields, viewer.frame())["hand_target"].tolist() == [[2.0, 0.0, 0.0]]


def test_the_body_follows_the_hand_and_the_frame_tells_the_message_that_it_follows(live):
    with live.viewer() as viewer:
        viewer.grab(1.0, 0.0, 0.0)
        at_target(viewer, live, [1.0, 0.0, 0.0])
        viewer.say(type="move", target=[1.0, 0.5, 0.0])
        at_target(viewer, live, [1.0, 0.5, 0.0])
        frame = read_frames(live.flight.fields, viewer.frame())
        assert (frame["seq"].item(), frame["held"].item()) == (viewer.seq, 1.0)
        viewer.say(type="release")
        until(lambda: not live.flight.held)
        viewer.text("status", holder="none")


def test_of_two_viewers_one_holds(live):
    with live.viewer() as one, live.viewer() as two:
        one.grab(1.0, 0.0, 0.0)
        one.text("status", holder="you")
        two.text("status", holder="other")
        for _ in range(2):
            two.grab(-1.0, 0.0, 0.0)
            assert two.text("refused") == {
                "type": "refused",
                "what": "grab",
                "reason": "another page holds the beam: wait until it is released",
            }
        two.say(type="force", force=[1.0, 0.0, 0.0], point=[0.0, 0.0, 0.0])
        assert two.text("refused")["what"] == "force"
        two.say(type="move", target=[-1.0, 0.0, 0.0])
        two.say(type="release")
        two.say(type="force", force=[0.0, 0.0, 0.0], point=[0.0, 0.0, 0.0])
        at_target(one, live, [1.0, 0.0, 0.0])
        assert [m.type for m in live.flight.heard] == ["grab"]
        one.say(type="release")
        two.text("status", holder="none")
        two.grab(-1.0, 0.0, 0.0)
        two.text("status", holder="you")
        at_target(one, live, [-1.0, 0.0, 0.0])


def test_a_force_holds_until_it_is_zero(live):
    with live.viewer() as one, live.viewer() as two:
        one.say(type="force", force=[0.0, 0.0, 2.0], point=[0.0, 1.0, 0.0])
        two.text("status", holder="other")
        one.say(type="force", force=[0.0, 0.0, 0.0], point=[0.0, 1.0, 0.0])
        two.text("status", holder="none")
        assert not live.flight.held


def test_a_status_names_the_last_grab_of_its_page_that_came_before_it_also_a_refused_one(live):
    with live.viewer() as one, live.viewer() as two:
        assert one.text("status")["last_grab"] == 0
        for _ in range(2):
            one.grab(1.0, 0.0, 0.0)
            assert one.text("status", last_grab=one.seq)["holder"] == "you"
            one.say(type="move", target=[0.0, 0.0, 0.0])
        two.say(type="ping", t=1.0)
        two.text("pong", t=1.0)
        assert two.text("status")["last_grab"] == 0
        two.grab(0.0, 0.0, 0.0)
        assert two.text("status", last_grab=two.seq)["holder"] == "other"
        assert one.text("status")["last_grab"] == one.seq - 1


def test_a_push_that_ends_while_the_beam_is_pulled_does_not_let_go_of_it(live):
    with live.viewer() as one:
        one.say(type="force", force=[1.0, 0.0, 0.0], point=[0.0, 0.0, 0.0])
        one.grab(1.0, 0.0, 0.0)
        one.say(type="force", force=[0.0, 0.0, 0.0], point=[0.0, 0.0, 0.0])
        one.say(type="ping", t=1.0)
        one.text("pong", t=1.0)
        assert live.flight.held
        one.say(type="release")
        until(lambda: not live.flight.held)


def test_a_page_that_is_killed_lets_go(live):
    with live.viewer() as other:
        raw = live.raw()
        raw.send(b'{"type":"grab","seq":1,"point":[0,0,0],"target":[1,0,0],"at":"centre"}')
        other.text("status", holder="other", viewers=2)
        assert live.flight.held
        raw.kill()
        other.text("status", holder="none", viewers=1)
        assert not live.flight.held
        assert live.flight.released == 1


def test_a_page_that_is_closed_lets_go(live):
    with live.viewer() as viewer:
        viewer.grab(1.0, 0.0, 0.0)
        until(lambda: live.flight.held)
    until(lambda: not live.flight.held)


def test_a_page_that_hangs_lets_go_and_one_that_pings_does_not(live, clock):
    with live.viewer() as one:
        one.grab(1.0, 0.0, 0.0)
        one.text("status", holder="you")
        for t in (1.0, 2.0, 3.0):
            clock[0] += 0.9 * viewers.SILENT
            one.say(type="ping", t=t)
            one.text("pong", t=t)
            assert one.text("status")["holder"] == "you"
        assert live.flight.held
        clock[0] += 1.1 * viewers.SILENT
        one.text("status", holder="none")
        assert not live.flight.held
        one.say(type="ping", t=4.0)  # its socket lives on
        assert one.text("pong", t=4.0)


def test_a_viewer_who_does_not_hold_may_go_without_letting_go(live):
    with live.viewer() as holder:
        holder.grab(1.0, 0.0, 0.0)
        holder.text("status", holder="you")
        other = live.raw()
        holder.text("status", viewers=2)
        other.kill()
        holder.text("status", viewers=1)
        at_target(holder, live, [1.0, 0.0, 0.0])
        assert live.flight.released == 0


def told(viewer, number, *queue):
    """Wait until a viewer of this number is told that these take turns."""
    viewer.text("status", turns={"number": number, "queue": list(queue)})


def test_viewers_take_turns_and_the_others_wait(live):
    with live.viewer() as one, live.viewer() as two, live.viewer() as three:
        for number, viewer in enumerate((one, two, three), 1):
            told(viewer, number)
        one.grab(1.0, 0.0, 0.0)
        one.text("status", holder="you")
        two.say(type="turn", what="ask")  # takes the beam from a page that has no turn
        told(one, 1, 2)
        until(lambda: not live.flight.held)
        for number, viewer, queue in ((1, one, (2, 1)), (3, three, (2, 1, 3)), (1, one, (2, 1, 3))):
            viewer.say(type="turn", what="ask")
            told(viewer, number, *queue)
        for message in ({"type": "reset"}, {"type": "ask", "what": "lift"}):
            one.say(**message)
            assert one.text("refused")["reason"] == "page 2 has the hand: ask for it, and wait for your turn"
        one.grab(1.0, 0.0, 0.0)
        assert one.text("refused")["what"] == "grab"
        two.grab(-1.0, 0.0, 0.0)
        two.text("status", holder="you")
        two.say(type="turn", what="give")  # lets go, too
        told(three, 3, 1, 3)
        until(lambda: not live.flight.held)
        one.grab(1.0, 0.0, 0.0)
        one.text("status", holder="you")
        three.say(type="turn", what="give")
        told(two, 2, 1)
    with live.viewer() as four:  # who leaves gives the hand away
        told(four, 4)


def test_a_viewer_that_does_nothing_passes_the_hand_on_if_another_waits(live, clock):
    with live.viewer() as one, live.viewer() as two:
        told(one, 1)
        told(two, 2)
        one.say(type="turn", what="ask")
        told(two, 2, 1)
        two.say(type="turn", what="ask")
        told(one, 1, 1, 2)
        clock[0] += viewers.HAND_TIMEOUT + 1.0
        told(one, 1, 2)
        clock[0] += viewers.HAND_TIMEOUT + 1.0  # nobody waits
        two.say(type="ping", t=0.0)
        two.text("pong")
        told(one, 1, 2)
