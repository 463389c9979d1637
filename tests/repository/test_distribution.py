"""What the distributions say of the package, and which extra has which package."""

import re
import tomllib

from hatchling.metadata.core import ProjectMetadata
from hatchling.plugin.manager import PluginManager
from repository import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


def test_the_description_has_no_picture_no_relative_link_and_no_target_of_the_makefile():
    text = ProjectMetadata(str(ROOT), PluginManager()).core.readme
    assert len(text) > 1000
    assert re.findall(r"!\[|<img|<picture", text) == []
    assert [link for link in re.findall(r"\]\(([^)]*)\)", text) if not link.startswith("https://")] == []
    assert re.findall(r"^make .*", text, flags=re.M) == []
