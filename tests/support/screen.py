"""A virtual screen and its picture."""

import signal
import subprocess

import numpy as np
from patience import ended, said

HEAD, COLOURS = (0, 19), 12  # of an XWD dump: words for its length and for its colours, of so many bytes each


class Screen:
    """An X server without a display, which writes its picture to a file.

    `folder` is the folder of that file; `name` is the value of DISPLAY.
    """

    def __init__(self, program, folder):
        self._dump = folder / "Xvfb_screen0"
        folder.mkdir(exist_ok=True)
        self._server = subprocess.Popen(
            [program, "-displayfd", "1", "-screen", "0", "1000x640x24", "-fbdir", str(folder), "-nolisten", "tcp"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        self.name = f":{said(self._server, '[0-9]+')[0]}"

    def picture(self):
        """The picture: red, green and blue (height, width, 3), 0 to 255."""
        data = self._dump.read_bytes()
        words = np.frombuffer(data, ">u4", 25)
        head, colours = (int(words[i]) for i in HEAD)
        width, height, line = int(words[4]), int(words[5]), int(words[12])
        pixels = np.frombuffer(data, np.uint8, height * line, head + COLOURS * colours)
        return pixels.reshape(height, -1, 4)[:, :width, 2::-1]

    def close(self):
        ended(self._server, signal.SIGKILL)
