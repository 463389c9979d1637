"""A mission's vehicle, floor and walls as models for other simulators: MuJoCo (MJCF) and Gazebo (SDF)."""
