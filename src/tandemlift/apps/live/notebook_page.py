"""A page that flies within a notebook."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tandemlift.core.errors import extra

_SHOW = """
export default {
  render({ model, el }) {
    const frame = document.createElement("iframe")
    const address = URL.createObjectURL(new Blob([model.get("html")], { type: "text/html" }))
    Object.assign(frame, { src: address, title: "tandemlift", allow: "fullscreen; gamepad" })
    frame.style.cssText = `border: 0; width: 100%; height: ${model.get("height")}px`
    el.append(frame)
    return () => URL.revokeObjectURL(address)
  },
}
"""


def page(*missions: str, controller: str | Path | None = None, height: int = 640) -> Any:
    """A page that flies in a notebook, and is pushed by hand; it is that of `tandemlift page`, and needs no server.

    Args:
        missions: of its menu: built-in missions, or the paths of .toml files. The default is "hover".
        controller: flies all of them: a registered one, or a .py file.
        height: of the page [px].

    Returns:
        A widget, which shows itself as the last value of a cell.

    Raises:
        InputError: a mission cannot be loaded or compiled, or anywidget is not installed.
    """
    with extra("notebook", "a page in a notebook"):
        import anywidget
        import traitlets
    from tandemlift.apps.live.page_files import page_files
    from tandemlift.apps.live.page_modules import packed_flights
    from tandemlift.apps.live.pages import offline_html

    class Page(anywidget.AnyWidget):
        _esm = _SHOW
        html = traitlets.Unicode().tag(sync=True)
        height = traitlets.Int().tag(sync=True)

    flights = packed_flights(missions or ("hover",), str(controller) if controller else None)
    return Page(html=offline_html(flights, page_files()), height=height)
