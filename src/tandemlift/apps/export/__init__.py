"""A flight as a file of other tools and back: ROS bags and tables."""
