"""The closed loop: one step, what it logs, running metrics, perception, wind loads and delays."""
