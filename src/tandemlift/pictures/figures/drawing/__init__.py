"""What figures are drawn with: style, panels, scenes, and the outlines of vehicle, floor and walls."""
