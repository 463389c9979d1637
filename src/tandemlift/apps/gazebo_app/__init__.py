"""The paper's second experiment: a mission flown in Gazebo to be watched, pushed in its window, and photographed."""
