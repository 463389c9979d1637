"""Messages that reach the page late, as on a busy machine: the page and the server agree on who holds the beam."""

import numpy as np
import pytest
from chromium import middle_of_the_beam, opened, rests, with_still_camera
from patience import until

pytestmark = pytest.mark.thorough

LATE = """() => {
  // while `late` is a list, texts of the kind `kept` are kept in it; frames come on time
  window.late = null;
  window.kept = "status";
  const onmessage = Object.getOwnPropertyDescriptor(WebSocket.prototype, "onmessage");
  Object.defineProperty(WebSocket.prototype, "onmessage", {
    set(hear) {
      onmessage.set.call(this, (event) => {
        const text = typeof event.data === "string";
        if (window.late && text && JSON.parse(event.data).type === window.kept) window.late.push(() => hear(event));
        else hear(event);
      });
    },
  });
}"""
ALL_COME = "() => { const all = window.late; window.late = null; all.forEach((one) => one()); return all.length; }"


@pytest.fixture
def late(browser, live):
    live.wait_status(lambda s: s["phase"] in ("guided", "hold"), "hover")
    one = opened(browser, live.address, lambda page: page.add_init_script(f"({LATE})()"))
    until(lambda: one.text_content("#mode") in ("follows pushes", "holding"), "a status on the page")
    yield one
    assert one.wrong == []
    one.context.close()


def test_statuses_from_before_a_grab_that_come_after_it_do_not_end_it(late, live):
    live.wait(rests, "rest")
    with_still_camera(late)
    x, y = middle_of_the_beam(late)
    late.evaluate("() => (window.late = [])")
    until(lambda: late.evaluate("window.late.length") > 12, "statuses that wait")
    late.mouse.move(x, y)
    late.mouse.down()
    before = live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")["hand_target"]
    assert late.evaluate(ALL_COME) > 12
    assert late.locator("#surface.pulling").count() == 1
    late.mouse.move(x + 100, y, steps=5)
    live.wait(lambda seen: np.linalg.norm(seen["hand_target"] - before) > 0.2, "a target that moved")
    until(lambda: "you" in late.text_content("#meters"), "the holder told")
    late.mouse.up()
    live.wait(lambda seen: seen["held"] == 0.0, "release")
    live.wait(rests, "rest")


def test_a_refusal_of_an_earlier_grab_lets_go_of_the_next_one_on_both_sides(late, live, browser):
    live.wait(rests, "rest")
    other = opened(browser, live.address)
    late.evaluate("() => { window.kept = 'refused'; window.late = []; }")
    for page in (other, late):
        page.mouse.move(*middle_of_the_beam(page))
        page.mouse.down()
        live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    until(lambda: late.evaluate("window.late.length") > 0, "a refusal that waits")
    late.mouse.up()
    other.mouse.up()
    live.wait(lambda seen: seen["held"] == 0.0, "release")
    late.mouse.move(*middle_of_the_beam(late))  # the camera follows the beam, which was held
    late.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    late.evaluate(ALL_COME)
    live.wait(lambda seen: seen["held"] == 0.0, "release")
    late.mouse.up()
    other.context.close()
    live.wait(rests, "rest")


def test_a_change_of_the_controller_lets_go_on_both_sides(late, live, browser):
    live.wait(rests, "rest")
    late.mouse.move(*middle_of_the_beam(late))
    late.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    now = next(p["value"] for p in live.scene["parameters"] if p["key"] == "controller.name")
    other = opened(browser, live.address)
    other.evaluate(
        """(name) => {
          const socket = new WebSocket(`ws://${location.host}/ws`);
          socket.onopen = () =>
            socket.send(JSON.stringify({ type: "set", seq: 1, key: "controller.name", value: name }));
        }""",
        now,
    )
    live.wait(lambda seen: seen["held"] == 0.0, "release")
    late.mouse.up()
    other.context.close()
    live.wait(rests, "rest")
