"""A flight in real time as a ROS node: samples are published as topics, pushes and requests come as messages.

`node` puts it together and knows no middleware; `ros1` (rospy), `rclpy_node` (an installed ROS 2) and `ros2` (DDS,
without an installed ROS) are the three that there are. Topics of samples are those of exported bags, made by the
same recipes.
"""
