"""Conversion of a flight to files of other tools and back: ROS bags and tables; new mission files."""
