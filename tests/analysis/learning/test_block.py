"""Many flights stepped together: each equals a `Simulation` alone to the last bit, whatever its neighbours do."""

import _thread
import itertools
import time

import numpy as np
import pytest

import tandemlift as tl

DURATION = 12.0
CASES = [
    *[("paper", kind) for kind in ("push", "thrusts")],
    *[("iris", "velocity"), ("zigzag", "push"), ("rotor-loss", "thrusts")],
]


def mission(name, seed=0, **keys):
    return tl.load_mission(name, {"mission.duration": DURATION, "mission.seed": seed, **keys})


def given(rng, kind, shape):
    return rng.uniform(-0.5, 0.5, shape) if kind == "velocity" else rng.uniform(0.0, 8.0, shape)


def assert_same(block, sims):
    np.testing.assert_array_equal(block.time, [s.time for s in sims])
    np.testing.assert_array_equal(block.ended, [s.over for s in sims])
    np.testing.assert_array_equal(block.state, [s.state for s in sims])
    stepped = [i for i, s in enumerate(sims) if s.k]
    for name in block.channels:
        np.testing.assert_array_equal(block[name][stepped], [sims[i][name] for i in stepped], err_msg=name)


def assert_same_metrics(block, lane, sim):
    mine, theirs = block.metrics(lane), sim.flight().metrics()
    for name in ("wall_s", "command_at_start"):
        mine.pop(name), theirs.pop(name)
    assert repr(mine) == repr(theirs)


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "kind"), CASES)
def test_every_lane_equals_a_simulation_to_the_last_bit_through_resets_and_ends(name, kind):
    lanes, rng = 11, np.random.default_rng(1)
    block = tl.Block(mission(name), lanes, actions=kind)
    sims = [tl.Simulation(mission(name, seed)) for seed in range(lanes)]
    ended = 0
    for _ in range(40):
        steps, actions = int(rng.integers(1, 900)), given(rng, kind, block.actions.shape)
        actions = None if rng.random() < 0.2 else actions
        if not block.ended.all():
            block.step(actions, steps=steps)
        for lane, sim in enumerate(sims):
            if not sim.over:
                sim.step(steps=steps, **({} if actions is None else {kind: actions[lane]}))
        assert_same(block, sims)
        assert_same_metrics(block, lane := int(rng.integers(lanes)), sims[lane])
        for lane in np.flatnonzero((rng.random(lanes) < 0.015) | (block.ended & (rng.random(lanes) < 0.3))).tolist():
            assert not block.ended[lane] or block.outcome[lane] == sims[lane].flight().outcome
            ended += block.ended[lane]
            block.reset(lane)
            sims[lane].reset()
    assert ended


@pytest.mark.thorough
def test_a_lane_begins_anew_with_another_seed_and_with_other_keys_beside_others_that_go_on():
    block = tl.Block(mission("gusts"), 9)
    sims = [tl.Simulation(mission("gusts", seed)) for seed in range(9)]

    def step(steps):
        block.step(steps=steps)
        for sim in sims:
            sim.step(steps=steps)
        assert_same(block, sims)

    step(37)
    heavy = {"plant.mass_scale": 1.2, "pushes": [{"force": [1.0, 0.0, 0.0], "time": 0.5, "sigma": 0.1}] * 3}
    block.reset([2, 8], seed=[71, 72], keys=[heavy, {}])
    sims[2], sims[8] = tl.Simulation(mission("gusts", 71, **heavy)), tl.Simulation(mission("gusts", 72))
    step(900)
    block.reset([2, 3], seed=100)
    sims[2], sims[3] = tl.Simulation(mission("gusts", 100, **heavy)), tl.Simulation(mission("gusts", 101))
    step(700)
    block.reset(2, keys={"mission.duration": 1.0})
    sims[2] = tl.Simulation(mission("gusts", 100, **{"mission.duration": 1.0}))
    for _ in range(5):
        block.step(steps=300)
        for sim in sims:
            if not sim.over:
                sim.step(steps=300)
        assert_same(block, sims)
    assert block.ended.tolist() == [False, False, True, *[False] * 6]
    assert_same_metrics(block, 2, sims[2])


def test_a_flight_that_crashes_within_a_call_shows_its_last_step_and_stays():
    block = tl.Block("paper", 4, actions="thrusts")
    sim = tl.Simulation("paper")
    falls, stays = np.zeros((4, 8)), np.full((4, 8), 5.0)
    actions = np.where(np.arange(4)[:, None] == 2, falls + np.r_[9.0, [0.0] * 7], stays)
    block.step(actions, steps=5000)
    while not sim.over:
        sim.step(thrusts=actions[2])
    assert block.ended.tolist() == [False, False, True, False]
    assert block.outcome.tolist() == ["", "", "crashed", ""]
    assert block.time[2] == sim.time < 5.0 == block.time[0]
    block.step(actions, steps=500)
    block.state[:] = 0.0  # a copy
    np.testing.assert_array_equal(block.state[2], sim.state)
    np.testing.assert_array_equal(block["position"][2], sim["position"])
    assert block.findings(2) == sim.flight().findings


def test_threads_change_no_bit():
    blocks = [tl.Block(mission("iris"), 40, threads) for threads in (1, 3)]
    for block in blocks:
        for _ in range(6):
            block.step(np.full((40, 3), 0.3), steps=100)
    for name in blocks[0].channels:
        np.testing.assert_array_equal(blocks[0][name], blocks[1][name], err_msg=name)


@pytest.mark.parametrize("threads", [1, 2])
def test_flights_go_on_together_after_ctrl_c(threads, monkeypatch):
    """It comes when one of two parts has flown and the other has not begun."""
    block, whole = (tl.Block(mission("one-push"), 16, threads=n) for n in (threads, 1))
    for each in (block, whole):
        each.step(steps=9000)
    fly, calls = block._memory.code.free["fly_blocks"], itertools.count()

    def interrupted(call):
        part = next(calls)
        time.sleep(0.2 * (part == 1))
        fly(call)
        if part == 0:
            _thread.interrupt_main()

    monkeypatch.setitem(block._memory.code.free, "fly_blocks", interrupted)
    block._memory._pace = 1.0  # s: worth a thread
    with pytest.raises(KeyboardInterrupt):
        block.step(steps=500)
    assert (block.time == block.time[0]).all()
    for each in (block, whole):
        while not each.ended.all():
            each.step(steps=500)
    np.testing.assert_array_equal(block.state, whole.state)
    assert set(block.outcome) == {"flying"}


def test_channels_and_actions_are_views_of_what_the_flights_read_and_write():
    block = tl.Block("paper", 16)
    position = block["position"]
    assert position.shape == (16, 3)
    assert np.isnan(position).all()
    block.actions[:] = [0.0, 0.0, 4.0]
    block.step(block.actions, steps=50)
    assert np.shares_memory(position, block["position"])
    np.testing.assert_array_equal(position, block.state[:, :3] * 0.0 + block["position"])
    assert block["position"][5, 2] != 0.0
    assert block["thrust"].shape == (16,)
    np.testing.assert_array_equal(block["position_error"], block["reference_position"] - position)
    assert "position_error" in block
    with pytest.raises(ValueError, match="read-only"):
        block["position"][0] = 0.0
    block.reset(3)
    assert np.isnan(block["position"][3]).all()
    assert not np.isnan(block["position"][2]).any()


ONE = {"lanes": 1}
REFUSED = [
    (lambda b: b.step(np.zeros((2, 3))), r"actions are float64 \(2, 3\): must be numbers \(3, 3\) \(N, in world"),
    (lambda b: b.step([["a"] * 3] * 3), r"actions are <U1 \(3, 3\): must be numbers"),
    (lambda b: b.step([[0, 0, 0], [0, np.nan, 0], [0, 0, np.inf]]), r"actions of lane 1 = \[0.0, nan, 0.0\]: must be"),
    (lambda b: b.step(steps=0), "steps = 0: must be a whole number of at least 1"),
    (lambda b: b.reset(3), "lanes: there is no lane 3; they go from 0 to 2"),
    (lambda b: b.reset([0.5]), r"lanes = \[0.5\]: must be numbers of lanes, or 3 truths"),
    (lambda b: b.reset([0, 1], seed=[1]), "seed: 1 given, but 2 lanes are reset"),
    (lambda b: b.reset(seed=-1), "seed = -1: must be a whole number from 0"),
    (lambda b: b.reset(keys={"mission.step": 0.002}), "mission.step = 0.002: must be the same in all lanes, because"),
    (
        lambda b: b.reset(keys={"plant.mass_scale": 1.1, "mission.step": 0.002, "plant.inertia_scale": [1, 1, 1]}),
        "mission.step = 0.002",
    ),
    (
        lambda b: b.reset(keys={"plant.mass_scale": 1.1, "mission.seed": 3}),
        "mission.seed = 3: a lane's seed is given by",
    ),
    (lambda b: b.reset(keys=3), "keys = 3: must be a dictionary, such"),
    (lambda b: b.reset([0, 1], keys=[{}, "plant.mass_scale"]), 'keys = "plant.mass_scale": must be a dictionary, such'),
    (lambda b: b.reset([0, 0], seed=[1, 2]), r"lanes = \[0, 0\]: must be given once each"),
    (lambda b: b.reset(keys={"controller.name": "pid"}), 'controller.name = "pid": .* picks the laws of their steps'),
    (lambda b: b.reset(keys={"vehicle.payload.mass": -1.0}), "vehicle.payload.mass"),
    (lambda b: b.reset(keys={"vehicle.payload.mas": 1.0}), "mass"),
    (lambda b: b.metrics(7), "there is no lane 7"),
]


def test_what_cannot_be_is_refused_by_name_and_nothing_changes():
    block = tl.Block("paper", 3)
    block.step(steps=10)
    before = block.state
    for act, words in REFUSED:
        with pytest.raises(tl.InputError, match=words):
            act(block)
        np.testing.assert_array_equal(block.state, before)
        np.testing.assert_array_equal(block.time, 0.01)


def test_a_delay_is_the_same_in_all_lanes():
    block = tl.Block("zigzag", 2)
    with pytest.raises(tl.InputError, match=r"person.delay = 0.1: .* sets the delay of their readings"):
        block.reset(1, keys={"person.delay": 0.1})


@pytest.mark.parametrize(
    ("keys", "arguments", "words"),
    [
        ({}, {"lanes": 0}, "lanes = 0: must be a whole number of at least 1"),
        ({}, {**ONE, "threads": 0}, "threads = 0: must be"),
        ({}, {**ONE, "actions": "force"}, "actions = 'force': must be one of 'push', 'thrusts', 'velocity'"),
        ({"changes": [{"time": 1.0, "key": "admittance.threshold", "value": 0.5}]}, ONE, "changes: 1 given"),
    ],
)
def test_a_block_that_cannot_be_is_refused(keys, arguments, words):
    with pytest.raises(tl.InputError, match=words):
        tl.Block(tl.load_mission("paper", keys), **arguments)


def test_an_unknown_channel_names_the_nearest():
    with pytest.raises(KeyError, match="Did you mean 'position'"):
        tl.Block("paper", 1)["positon"]


def test_all_flights_over_is_said():
    block = tl.Block(tl.load_mission("paper", {"mission.duration": 0.05}), 2)
    block.step(steps=80)
    assert block.ended.all()
    assert block.outcome.tolist() == ["flying", "flying"] or block.outcome.tolist() == ["not-lifted"] * 2
    with pytest.raises(tl.InputError, match="all flights are over; reset"):
        block.step()
    block.reset(1)
    block.step(steps=3)
    assert block.time.tolist() == pytest.approx([0.05, 0.003])


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "begin"), [("iris", 13.0), ("zigzag", 5.007)])
def test_flights_that_are_handed_over_later_equal_those_that_were_flown_there(name, begin):
    keys = {"mission.duration": begin + 2.0}
    block = tl.Block(tl.load_mission(name, keys), 10, begin=begin, actions="velocity")
    sims = [tl.Simulation(tl.load_mission(name, {**keys, "mission.seed": seed})) for seed in range(10)]
    for sim in sims:
        sim.step(steps=round(begin / sim.dt))
    rng = np.random.default_rng(0)
    assert_same(block, sims)
    for again in range(2):
        for _ in range(4):
            actions, steps = rng.uniform(-0.4, 0.4, (10, 3)), int(rng.integers(1, 60))
            block.step(actions, steps=steps)
            for lane, sim in enumerate(sims):
                sim.step(velocity=actions[lane], steps=steps)
        assert_same(block, sims)
        assert_same_metrics(block, 7, sims[7])
        block.reset([1, 7], seed=100 + again)
        for lane, seed in ((1, 100 + again), (7, 101 + again)):
            sims[lane].reset(seed)
            sims[lane].step(steps=round(begin / sims[lane].dt))


def test_a_flight_that_is_over_before_it_is_handed_over_is_refused():
    with pytest.raises(tl.InputError, match=r"begin = 99: must be from 0 to below mission.duration = 90 s"):
        tl.Block("paper", 2, begin=99)
    falls = tl.load_mission("paper", {"crash.tilt": 1.0, "pushes": [{"force": [20.0] * 3, "time": 1.0, "sigma": 0.3}]})
    with pytest.raises(tl.InputError, match=r"begin = 5 s: the flight of lane 0 is over at \S+ s: crashed"):
        tl.Block(falls, 2, begin=5.0)
