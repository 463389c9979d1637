"""Engines, which simulate the vehicle: compiled, MuJoCo, Gazebo; `registry` lists them."""
