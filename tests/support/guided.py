"""Interactive guidance of a mission, apart from its pilot."""

from tandemlift.missions.facts import Facts


def hand_guidance(mission):
    """The guidance of a mission before its first sample, and its memory."""
    parameters, memory = Facts(mission).started("pilot")
    return parameters["guidance"], memory["guidance"]
