"""The environments: by Gymnasium's own checker, by a simulation, and through the ends of episodes."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

import tandemlift as tl
from tandemlift.analysis.learning.gymnasium_environments import FlightVectorEnv
from tandemlift.analysis.learning.gymnasium_tasks import TASKS

NAMES = sorted(TASKS)
tl.register_environments()
pytestmark = [
    pytest.mark.filterwarnings("ignore:.*(minimum|maximum) value is -?infinity"),
    pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning"),
]


def short(task, num_envs=1, **kwargs):
    return FlightVectorEnv(task, num_envs, changes={"mission.duration": TASKS[task].begin + 0.5}, **kwargs)


@pytest.mark.thorough
@pytest.mark.parametrize("name", NAMES)
def test_gymnasiums_checker_accepts_every_environment(name):
    env = gym.make(f"tandemlift/{name}-v0")
    check_env(env.unwrapped, skip_render_check=True)
    assert env.spec.id == f"tandemlift/{name}-v0"


@pytest.mark.thorough
@pytest.mark.parametrize("name", NAMES)
def test_an_environment_alone_is_that_of_many_at_once(name):
    many, alone = gym.make_vec(f"tandemlift/{name}-v0", 3), gym.make(f"tandemlift/{name}-v0")
    assert isinstance(many, FlightVectorEnv)
    seen, _ = many.reset(seed=5)
    first, _ = alone.reset(seed=7)
    np.testing.assert_array_equal(seen[2], first)
    rng = np.random.default_rng(0)
    for _ in range(20):
        actions = rng.uniform(-0.2, 0.2, many.action_space.shape).astype(np.float32)
        seen, rewards, *_ = many.step(actions)
        one, reward, *_ = alone.step(actions[2])
        np.testing.assert_array_equal(seen[2], one)
        assert rewards[2] == reward
    np.testing.assert_array_equal(many.block.state[2], alone.unwrapped.flights.block.state[0])


@pytest.mark.thorough
def test_an_episode_is_the_flight_of_a_simulation_and_its_reward_what_a_metric_has_grown_by():
    env = FlightVectorEnv("FollowHand", 2, interval=0.05)
    env.reset(seed=11)
    seed = int(np.random.default_rng(12).integers(2**31))
    sim = tl.Simulation(
        tl.load_mission("iris", {**dict(TASKS["FollowHand"].keys), "mission.duration": 35.0, "mission.seed": seed})
    )
    sim.step(steps=5000)
    total, action = 0.0, np.array([[0.1, 0.0, 0.0], [0.3, -0.1, 0.0]], dtype=np.float32)
    before = sim.flight().metrics()
    for _ in range(200):
        seen, reward, *_ = env.step(action)
        sim.step(velocity=action[1].astype(float), steps=50)
        total += reward[1]
    np.testing.assert_array_equal(seen[1][:3], sim["estimated_velocity"].astype(np.float32))
    after = sim.flight().metrics()
    force = [m["human_force_mean_n"] * m["human_time_s"] if m["human_time_s"] else 0.0 for m in (before, after)]
    assert total == pytest.approx(10.0 - (force[1] - force[0]) / 5.0, abs=1e-9)


def test_keys_in_options_last_for_an_episode_and_drawn_ones_are_drawn_anew():
    draw = {"plant.mass_scale": {"distribution": "uniform", "low": 0.9, "high": 1.1}}
    env = short("Transport", 4, draw=draw, autoreset_mode="Disabled")

    def scales():
        return [plan.mission.plant.mass_scale for plan in env.block._flights.plans]

    env.reset(seed=1)
    drawn = scales()
    assert len(set(drawn)) == 4
    assert all(0.9 <= scale <= 1.1 for scale in drawn)
    env.reset(
        seed=[None, 2, None, None], options={"plant.mass_scale": 1.07, "reset_mask": np.array([1, 0, 0, 1], dtype=bool)}
    )
    assert scales() == [1.07, *drawn[1:3], 1.07]
    env.reset(seed=1)
    assert scales() == drawn


@pytest.mark.thorough
def test_random_persons_differ():
    env = FlightVectorEnv("FollowHand", 3, persons="random")
    env.reset(seed=0)
    assert len({plan.mission.person.gain for plan in env.block._flights.plans}) == 3


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_the_end_of_an_episode_in_each_mode(mode):
    env = FlightVectorEnv("Transport", 2, autoreset_mode=mode)
    assert env.metadata["autoreset_mode"] is AutoresetMode(mode)
    start, _ = env.reset(seed=3, options={"mission.duration": 5.5})
    none = np.zeros((2, 3), dtype=np.float32)
    for k in range(25):
        seen, _, terminated, truncated, info = env.step(none)
        assert truncated.all() == (k == 24)
        assert not terminated.any()
    told = info["final_info"] if mode == "SameStep" else info
    assert told["outcome"].tolist() == ["flying"] * 2
    if mode == "SameStep":
        assert (info["final_obs"][0] != seen[0]).any()
        assert env.block.time.tolist() == pytest.approx([5.0, 5.0])
    elif mode == "NextStep":
        assert env.block.time.tolist() == pytest.approx([5.5, 5.5])
        seen, reward, _, truncated, _ = env.step(none)
        assert not truncated.any()
        assert reward.tolist() == [0.0, 0.0]
        assert env.block.time.tolist() == pytest.approx([5.0, 5.0])
        assert (seen != start).any()
    else:
        with pytest.raises(tl.InputError, match="environment 0 is over: reset it"):
            env.step(none)
        env.reset(options={"reset_mask": np.array([True, True])})
        env.step(none)


def test_a_crash_terminates_and_says_so():
    env = gym.make("tandemlift/RotorLoss-v0")
    env.reset(seed=0)
    terminated = False
    while not terminated:
        _, _, terminated, truncated, info = env.step(np.r_[1.0, -np.ones(7)].astype(np.float32))
        assert not truncated
    assert info["outcome"] == "crashed"
    assert info["findings"]


@pytest.mark.thorough
def test_where_a_rotor_is_lost_staying_in_the_air_pays_more_than_landing():
    env = FlightVectorEnv("RotorLoss", 2)
    keys = {**env.task.keys, "mission.duration": 15.0}
    stays, lands = (  # pilots who do not detect the loss, and who do
        tl.Simulation(tl.load_mission("rotor-loss", {**keys, "detection.model": m})) for m in ("none", "residual")
    )
    env.block.reset([0, 1], seed=[stays.mission.mission.seed] * 2)
    before = env.task.rewarded(env.block, 0.0)
    for k in range(10000):
        for pilot in (stays, lands):
            pilot.step(steps=1 if k else 5001)
        env.block.step(np.array([stays["rotor_commands"], lands["rotor_commands"]]))
    assert env.block.state[1, 2] < 0.1
    assert env.block.state[0, 2] > 1.0
    reward = env.task.rewarded(env.block, 0.0) - before
    assert reward[1] + 2.0 < reward[0] < 10.0


def test_each_level_of_actions_holds_a_hover():
    for level in ("push", "velocity", "admittance", "wrench", "thrusts"):
        env = FlightVectorEnv("Transport", 1, action=level)
        env.reset(seed=0)
        for _ in range(10):
            env.step(np.zeros(env.action_space.shape, dtype=np.float32))
        assert abs(env.block.state[0, :3] - [0.0, 0.0, 1.03]).max() < 0.15, level


def test_an_admittance_of_half_the_damping_follows_a_push_twice_as_fast():
    speeds = []
    for damping in (0.0, -0.5):  # of two octaves
        env = FlightVectorEnv(
            "Transport",
            1,
            action="admittance",
            changes={"pushes": [{"force": [1.2, 0.0, 0.0], "time": 12.0, "sigma": 3.0}]},
        )
        env.reset(seed=0)
        for _ in range(350):
            env.step(np.array([[-1.0, damping]], dtype=np.float32))
        speeds.append(env.block["admittance_velocity"][0, 0])
    assert speeds[1] == pytest.approx(2.0 * speeds[0], rel=0.1)


def test_a_mask_without_a_truth_begins_nothing():
    env = short("Transport", 2)
    env.reset(seed=1)
    env.step(np.zeros((2, 3)))
    before = env.block.state.copy()
    env.reset(options={"reset_mask": np.zeros(2, dtype=bool)})
    np.testing.assert_array_equal(env.block.state, before)


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (lambda: FlightVectorEnv("Hover"), 'task = "Hover": must be one of Transport'),
        (lambda: FlightVectorEnv("Transport", action="torque"), "action = 'torque': must be one of 'push'"),
        (lambda: FlightVectorEnv("Transport", persons="any"), "persons = \"any\": must be 'random'"),
        (
            lambda: FlightVectorEnv("Transport", interval=-1.0),
            "interval = -1.0: must be at least a step, 0.001 s",
        ),
        (lambda: short("Transport", 2).reset(seed=[3]), r"seed = \[3\]: must be from 0, one or as many as .*, 2"),
        (lambda: short("Transport").reset(seed=-3), "seed = -3: must be from 0"),
        (lambda: FlightVectorEnv("Transport", draw={"plant.mass_scale": 1.0}), "must be a table such as"),
        (lambda: short("Transport").step(np.zeros(3)), r"actions are \(3,\): must be \(1, 3\) \(velocity\)"),
        (
            lambda: short("Transport").step([[0.0, 1.5, 0.0]]),
            r"actions\[0, 1\] of environment 0 = 1.5: must be from -1 to 1",
        ),
        (lambda: short("Transport").step([[0.0, np.nan, 0.0]]), r"actions\[0, 1\] of environment 0 = nan"),
        (lambda: short("FollowHand", 2).reset(options={"person.delay": 0.1}), "person.delay = 0.1: must be the same"),
        (lambda: short("Transport").reset(options={"plant.mas": 1.0}), "plant.mas"),
        (lambda: short("Transport").reset(options={"mission.seed": 1}), "mission.seed = 1: a lane's seed is given by"),
        (lambda: short("Transport").reset(seed=1.0), "seed = 1.0: must be from 0"),
        (lambda: short("Transport", 2).reset(options={"reset_mask": [1]}), r"reset_mask = \[1\]: must be 2 truths"),
        (lambda: short("Transport", 2).reset(options={"reset_mask": [1, 0]}), "reset_mask = .*: must be 2 truths"),
        (lambda: FlightVectorEnv("Transport", interval=0.0205), "interval = 0.0205: must be whole steps of 0.001 s"),
        (lambda: FlightVectorEnv("Transport", persons="random"), "persons = 'random': .* task Transport has no person"),
    ],
)
def test_what_cannot_be_is_refused_by_name(act, words):
    with pytest.raises(tl.InputError, match=words):
        act()


@pytest.mark.thorough
def test_an_environment_in_single_precision_is_close_to_that_in_double_and_each_flight_the_same_alone():
    double, single, alone = (
        short("Transport", n, precision=how) for n, how in ((3, None), (3, "single"), (1, "single"))
    )
    start, rng = [envs.reset(seed=5)[0] for envs in (double, single)], np.random.default_rng(0)
    np.testing.assert_array_equal(start[1][:1], alone.reset(seed=5)[0])
    np.testing.assert_allclose(start[1], start[0], atol=2e-3)
    for _ in range(10):
        actions = rng.uniform(-1.0, 1.0, double.action_space.shape)
        (near, *_), (seen, *_), (first, *_) = (
            e.step(a) for e, a in ((double, actions), (single, actions), (alone, actions[:1]))
        )
        np.testing.assert_array_equal(seen[:1], first)
        np.testing.assert_allclose(seen, near, atol=5e-3)
    assert single.block["position"].dtype == np.float32
