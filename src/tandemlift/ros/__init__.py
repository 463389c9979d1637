"""A flight in real time that speaks ROS: its samples are topics, pushes and requests come as messages.

`front` puts it together and knows no middleware; `ros1` (rospy) and `ros2` (DDS, without an installed ROS) are two of
them. Topics of samples are those of exported bags, by the same recipes.
"""
