"""The closed loop: one step, its log sample, running metrics, perception, wind loads and delays."""
