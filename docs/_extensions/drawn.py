"""The directive `drawn`: a command, and the pictures that it writes.

    ```{drawn} tandemlift run zigzag
    out/zigzag/figures/corridor.png
    out/zigzag/picture.png: The vehicle at its strongest push.
    ```

runs the command when the site is built, and shows it with the pictures. A figure of a flight has its own caption. A
film (.mp4) is loaded when it is played, and shows its middle until then.
With -t quick nothing is run: those pictures are shown that an earlier build has drawn.
"""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import imageio_ffmpeg
from docutils import nodes
from PIL import Image
from sphinx.util.docutils import SphinxDirective

from tandemlift.pictures.figures.registry import captions

FOLDER = Path(__file__).resolve().parents[2] / "out" / "gallery"
WIDTH = 1600  # px, at most


class Drawn(SphinxDirective):
    """Run a command of tandemlift and show pictures that it writes: lines of `PATH` or `PATH: caption`."""

    required_arguments = 1
    final_argument_whitespace = True
    has_content = True

    def run(self) -> list[nodes.Node]:
        """The command as a block of code, and its figures.

        Raises:
            docutils.utils.DirectiveError: the command failed, or did not write a picture.
        """
        command, pictures = self.arguments[0], [line.partition(": ")[::2] for line in self.content if line]
        block = nodes.literal_block(command, command, language="sh")
        if self.env.app.tags.has("quick"):
            pictures = [(name, caption) for name, caption in pictures if (FOLDER / name).is_file()]
        else:
            FOLDER.mkdir(parents=True, exist_ok=True)
            words = [sys.executable, "-m", *shlex.split(command)]
            ended = subprocess.run(words, cwd=FOLDER, capture_output=True, text=True)
            if ended.returncode:
                raise self.error(f"drawn: {command}: exit code {ended.returncode}: {ended.stderr}")
        return [block, *(self._figure(name, caption) for name, caption in pictures)]

    def _film(self, film: Path) -> nodes.raw:
        poster = film.with_name(f"{film.stem}-poster.webp")
        reader = imageio_ffmpeg.read_frames(str(film))
        details = next(reader)
        pictures = list(reader)
        Image.frombytes("RGB", details["size"], pictures[len(pictures) // 2]).save(poster, quality=80)
        up = "../" * self.env.docname.count("/")
        source, still = (
            f"{up}_downloads/{self.env.dlfiles.add_file(self.env.docname, str(f))}" for f in (film, poster)
        )
        look = "controls loop muted playsinline preload='none'"
        width, height = details["size"]
        return nodes.raw(
            "", f"<video {look} width={width} height={height} poster='{still}' src='{source}'></video>", format="html"
        )

    def _figure(self, name: str, caption: str) -> nodes.figure:
        drawn = FOLDER / name
        caption = caption or captions()[drawn.stem].text
        if not drawn.is_file():
            raise self.error(f"drawn: {self.arguments[0]} wrote no {name}")
        if drawn.suffix == ".mp4":
            return nodes.figure("", self._film(drawn), nodes.caption("", "", *self.parse_inline(caption)[0]))
        uri = "/../" + _for_the_page(drawn).relative_to(FOLDER.parents[1]).as_posix()
        image = nodes.image(uri=uri, alt=caption)
        text, _ = self.parse_inline(caption)
        return nodes.figure("", image, nodes.caption("", "", *text))


def _for_the_page(picture: Path) -> Path:
    """The picture as WebP of a page's width; an animation stays as it is."""
    if picture.suffix != ".png":
        return picture
    small = picture.with_name("-".join(picture.relative_to(FOLDER).with_suffix(".webp").parts))
    image = Image.open(picture).convert("RGB")
    image.thumbnail((WIDTH, 4 * WIDTH))
    image.save(small, quality=85, method=6)
    return small


def setup(app: Any) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("drawn", Drawn)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
