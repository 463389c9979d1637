"""The environments by Stable-Baselines3: its checker, and a policy that learns to carry the load to a goal."""

import gymnasium as gym
import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.learning.gymnasium_tasks import TASKS

pytestmark = [pytest.mark.learning, pytest.mark.filterwarnings("ignore")]


@pytest.mark.parametrize("name", sorted(TASKS))
def test_the_checker_of_stable_baselines_accepts_every_environment(name):
    from stable_baselines3.common.env_checker import check_env

    tl.register_environments()
    check_env(gym.make(f"tandemlift/{name}-v0").unwrapped, skip_render_check=True)


def test_a_policy_learns_to_carry_the_load_nearer_to_a_goal():
    import torch
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env

    torch.set_num_threads(1)  # of a network so small; more would only wait for each other
    tl.register_environments()
    env = make_vec_env("tandemlift/Transport-v0", 8, seed=0, env_kwargs={"interval": 0.1})
    policy = PPO("MlpPolicy", env, n_steps=150, batch_size=300, gamma=0.97, learning_rate=1e-3, seed=0)

    def carried():
        seen, total = env.reset(), np.zeros(8)
        for _ in range(149):
            seen, reward, _, _ = env.step(policy.predict(seen, deterministic=True)[0])
            total += reward
        return total.mean()

    before = carried()
    policy.learn(30_000)
    assert carried() > before + 0.5
