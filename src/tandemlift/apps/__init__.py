"""What people start: the command line, the live page, ROS, exports, Gazebo."""
