"""Messages that no page sends, from a seed, so that a failure can be repeated."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator

from tandemlift.apps.live.session.page_messages import PAGE_MESSAGES

GOOD = [
    {"type": "grab", "seq": 1, "point": [0.0, 1.0, 0.0], "target": [1.0, 2.0, 3.0], "at": "point"},
    {"type": "move", "seq": 2, "target": [1.0, 2.0, 3.0]},
    {"type": "release", "seq": 3},
    {"type": "force", "seq": 4, "force": [0.0, 1.0, 0.0], "point": [0.0, 0.0, 0.0], "frequency": 4.0, "duration": 0.05},
    {"type": "set", "seq": 5, "key": "admittance.mass", "value": [1.0, 2.0, 3.0]},
    {"type": "set", "seq": 6, "key": "controller.name", "value": "pid"},
    {"type": "set", "seq": 7, "key": "admittance.hold_after_release", "value": True},
    {"type": "set", "seq": 8, "key": "wind.turbulence", "value": 3},
    {"type": "restore", "seq": 9, "key": "admittance.mass"},
    {"type": "restore", "seq": 10},
    {"type": "ask", "seq": 11, "what": "land"},
    {"type": "enable", "seq": 12, "on": False},
    {"type": "kill", "seq": 13, "rotor": 7},
    {"type": "tare", "seq": 12},
    {"type": "pause", "seq": 14, "on": True},
    {"type": "speed", "seq": 15, "factor": 0.5},
    {"type": "reset", "seq": 16},
    {"type": "rewind", "seq": 16, "time": 12.5},
    {"type": "compare", "seq": 12, "what": "keep"},
    {"type": "save", "seq": 17, "name": "mine-1.0"},
    {"type": "ping", "seq": 18, "t": 1.5},
    {"type": "fly", "seq": 19, "mission": "mine.toml", "toml": "x = 1"},
    {"type": "turn", "seq": 20, "what": "give"},
]
LITERALS = [
    *("NaN", "Infinity", "-Infinity", "1e999", "-1e999", "1e308", "-1e5", "9" * 400, "-" + "9" * 3000, "1e-400", "0.5"),
    *("null", "true", "false", "[]", "{}", '""', '"NaN"', '"1"', '"\\u0000"', '"\\ud800"', "[1,2]", "[1,2,3,4]"),
    *("[NaN,0,0]", "[[1,2,3]]", '["1",2,3]', "[null,null,null]", "[1e4,1e4,1.0001e4]", "{}", '{"x":1}', "-1", "1.5"),
    *('"../../etc/passwd"', '".."', '"a/b"', '"a\\u0000"', '"' + "a" * 3000 + '"', "[" * 90 + "]" * 90, "2" * 17),
    *("[" + ",".join("1" * 500) + "]", "[" + ",".join(['"a"'] * 500) + "]", '"\\u202e\\ufeff"', '"é́💥"', "1_0", "0x10"),
]


def random_text(r: random.Random) -> str:
    return "".join(
        chr(r.choice((r.randrange(32, 127), r.randrange(0xD800), 0, 0x1F4A5))) for _ in range(r.randrange(40))
    )


def random_json(r: random.Random) -> str:
    return "".join(r.choice('{}[]:,"\\ -.019eEnulltruefals') for _ in range(r.randrange(60)))


def cut_short(r: random.Random) -> str:
    text = json.dumps(r.choice(GOOD))
    return text[: r.randrange(len(text))]


def one_character_wrong(r: random.Random) -> str:
    text = list(json.dumps(r.choice(GOOD)))
    text[r.randrange(len(text))] = chr(r.randrange(1, 0x2000))
    return "".join(text)


def one_value_wrong(r: random.Random) -> str:
    message = dict(r.choice(GOOD))
    message[r.choice(list(message))] = "@"
    return json.dumps(message).replace('"@"', r.choice(LITERALS))


def one_key_more(r: random.Random) -> str:
    message = {**r.choice(GOOD), r.choice(["__proto__", "__class__", "x" * 200, "", "Seq", "at", "key"]): "@"}
    return json.dumps(message).replace('"@"', r.choice(LITERALS))


def one_key_less(r: random.Random) -> str:
    message = dict(r.choice(GOOD))
    message.pop(r.choice(list(message)))
    return json.dumps(message)


def another_type(r: random.Random) -> str:
    return json.dumps(
        {**r.choice(GOOD), "type": r.choice([*PAGE_MESSAGES, "Grab", "status", "scene", "eval", 7, None])}
    )


def deep(r: random.Random) -> str:
    return r.choice('[{"') * r.randrange(1, 4000) if r.random() < 0.5 else '{"a":' * 300 + "1" + "}" * 300


def long(r: random.Random) -> str:
    return json.dumps({**r.choice(GOOD), "pad": "x" * r.randrange(3000, 60_000)})


WAYS: list[tuple[Callable[[random.Random], str], int]] = [
    *((random_text, 10), (random_json, 20), (cut_short, 10), (one_character_wrong, 15), (one_value_wrong, 25)),
    *((one_key_more, 8), (one_key_less, 5), (another_type, 5), (deep, 1), (long, 1)),
]


def hostile(count: int, seed: int) -> Iterator[str]:
    """A number of random messages; a few are valid."""
    r = random.Random(seed)
    ways, weights = zip(*WAYS, strict=True)
    for way in r.choices(ways, weights, k=count):
        yield way(r)
