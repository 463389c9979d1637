"""A lost rotor: its detection from the momentum of the vehicle, and the decision which one it is."""
