"""One flight in real time: its thread, the virtual hand, parameter changes in flight, and the recording."""
