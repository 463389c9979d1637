"""What loading a mission warns of."""

import warnings

from tandemlift.missions import load_mission


def warnings_of(name, changes, controller=None):
    """The warnings of a mission, in one text."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        load_mission(name, changes, controller=controller)
    return "\n".join(str(one.message) for one in found)
