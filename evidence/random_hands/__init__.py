"""Hands drawn at random, how the vehicle answers them, and the largest shake, predicted and flown."""
