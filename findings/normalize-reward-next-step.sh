#!/bin/sh
# Gymnasium 1.4.0: the vector wrapper `NormalizeReward` gives rewards of another scale with NEXT_STEP, the default, than
# with SAME_STEP, where episodes end by truncation. Guess: it divides by the same deviation of discounted returns in both.
# Cause: with NEXT_STEP a return goes on over the end of a truncated episode, since only `terminated` resets it; with
# SAME_STEP both do.
# Fails if that changes.
set -eu
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
python3 -m venv "$place/venv"
"$place/venv/bin/pip" install -qq --disable-pip-version-check gymnasium==1.4.0 numpy==2.4.6
"$place/venv/bin/python" - <<'EOF'
import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.wrappers.vector import NormalizeReward


class Ones(gym.Env):
    """A reward of 1 in each of 50 steps, then truncated."""

    observation_space, action_space = gym.spaces.Box(-1, 1, (1,)), gym.spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.k = 0
        return np.zeros(1, np.float32), {}

    def step(self, action):
        self.k += 1
        return np.zeros(1, np.float32), 1.0, False, self.k == 50, {}


print("gymnasium", gym.__version__)
found = {}
for mode in (AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP):
    env = NormalizeReward(SyncVectorEnv([Ones] * 4, autoreset_mode=mode), gamma=0.99)
    env.reset(seed=0)
    for _ in range(5000):
        env.step(np.zeros(4, int))
    found[mode.name] = float(np.sqrt(env.return_rms.var))
    print(f"{mode.name}: deviation of the return {found[mode.name]:.2f}")
returns = np.array([(1 - 0.99**k) / 0.01 for k in range(1, 51)])
print(f"of episodes of 50 steps: {returns.std():.2f}")
assert abs(found["NEXT_STEP"] / returns.std() - 1) > 0.1, "changed"
EOF
# Seen: gymnasium 1.4.0
#       NEXT_STEP: deviation of the return 9.82
#       SAME_STEP: deviation of the return 11.32
#       of episodes of 50 steps: 11.32
