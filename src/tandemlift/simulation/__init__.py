"""Flying a mission: what it is assembled from, whole flights, flights step by step, and changes in flight."""
