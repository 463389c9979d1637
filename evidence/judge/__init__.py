"""A judge of flights that shares no code with the package: MuJoCo, with models and definitions of its own."""
