"""Bounds for a certificate: what a certificate is made of, all parameters at once, thrust limits and switching."""
