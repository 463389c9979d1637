"""Gazebo 11 as an engine: its server, the wire to its plugin (UDP or topics of ROS 1), and ROS 1's Python client."""
