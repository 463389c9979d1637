"""What a push feels like: the response of the admittance to a standard push, and its checks."""
