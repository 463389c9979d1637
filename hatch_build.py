"""The build of the distributions.

A wheel has what takes long to form: the compiled flights that the page carries, and the words that shells complete.
The description is README.md without what leads nowhere outside the repository.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

FLIGHTS, WORDS = "build/flights", "build/words.json"
REPOSITORY_ONLY = r"<!-- begin: only in the repository -->.*?<!-- end: only in the repository -->\n*"
PICTURE, RELATIVE_LINK = r"!\[[^\]]*\]\([^)]*\)\s*", r"\[([^\]]*)\]\((?!https?:)[^)]*\)"


class Description(MetadataHookInterface):
    """Gives the distributions README.md as their description."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Leave out pictures and what is marked; relative links become plain text, and the folder the package."""
        text = (Path(self.root) / "README.md").read_text("utf-8")
        text = re.sub(PICTURE, "", re.sub(REPOSITORY_ONLY, "", text, flags=re.S))
        metadata["readme"] = {"content-type": "text/markdown", "text": re.sub(RELATIVE_LINK, r"\1", text)}


class ShippedData(BuildHookInterface):  # type: ignore[type-arg]
    """Adds words and flights to a wheel; an editable install compiles flights when they are asked for."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Form the words, and compile the flights on all cores, where the package looks for them."""
        root = Path(self.root)
        sys.path.insert(0, str(root / "src"))
        from tandemlift.apps.cli.completion import formed_words

        (root / WORDS).parent.mkdir(exist_ok=True)
        (root / WORDS).write_text(json.dumps(formed_words(), ensure_ascii=False), "utf-8")
        build_data["extra_metadata"][WORDS] = "words.json"
        if version == "editable":
            return
        from tandemlift.apps.live.page_modules import MISSIONS, build_modules

        self.app.display_info("Compiling the flights of the page: about a minute on one core …")
        shutil.rmtree(root / FLIGHTS, ignore_errors=True)  # an older build may have had others
        with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:  # LLVM compiles once at a time in a process
            list(pool.map(build_modules, repeat(root / FLIGHTS), [[name] for name in MISSIONS]))
        build_data["force_include"][FLIGHTS] = "tandemlift/data/flights"
        if site := os.environ.get("TANDEMLIFT_SITE"):  # of a release: for `tandemlift docs`
            build_data["force_include"][site] = "tandemlift/data/site"
