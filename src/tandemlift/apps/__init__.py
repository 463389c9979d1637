"""Applications: the command line, the live page, ROS, exports, Gazebo."""
