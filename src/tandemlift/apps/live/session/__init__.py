"""One flight in real time: its thread, the virtual hand, parameters that are changed in flight, and the recording."""
