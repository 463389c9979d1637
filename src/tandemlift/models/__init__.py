"""A mission's vehicle and surroundings as models of simulators: floor and walls, MuJoCo (MJCF), Gazebo (SDF)."""
