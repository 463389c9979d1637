"""Tools for drawing figures: style, panels, scenes, and the outlines of vehicle, floor and walls."""
