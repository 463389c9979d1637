"""The figures of a flight: `registry` lists them, each other file draws one."""
