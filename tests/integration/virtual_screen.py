"""An X display without a screen (Xvfb), and what is on it."""

import mmap
import os
import struct
import subprocess
import zlib


class VirtualScreen:
    """@param folder is where Xvfb keeps the picture"""

    def __init__(self, folder, width=1024, height=768):
        reading, writing = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writing), "-screen", "0", f"{width}x{height}x24",
             "-fbdir", folder, "-nolisten", "tcp"],
            pass_fds=[writing], stderr=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(writing)
        with os.fdopen(reading) as ready:
            self.environment = {**os.environ, "DISPLAY": ":" + ready.readline().strip()}
        self.file = os.path.join(folder, "Xvfb_screen0")

    def stop(self):
        self.server.terminate()
        self.server.wait()

    def rows(self):
        """The picture, each row as bytes blue, green, red, unused of its pixels (XWD, X11/XWDFile.h)."""
        with open(self.file, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            header = struct.unpack_from(">25I", data)
            size, width, height, stride, colours = (header[i] for i in (0, 4, 5, 12, 19))
            begin = size + 12 * colours
            return [data[begin + y * stride :][: 4 * width] for y in range(height)]

    def middle_of(self, colour, least=40):
        """Mean x and y of all pixels of that colour (red, green, blue); None of fewer."""
        wanted = bytes(reversed(colour))
        found = [
            (x, y)
            for y, row in enumerate(self.rows())
            if wanted in row
            for x in range(len(row) // 4)
            if row[4 * x : 4 * x + 3] == wanted
        ]
        if len(found) < least:
            return None
        return sum(x for x, _ in found) / len(found), sum(y for _, y in found) / len(found)

    def save(self, path):
        """As PNG."""
        rows = self.rows()
        lines = []
        for row in rows:
            line = bytearray(len(row) // 4 * 3)
            line[0::3], line[1::3], line[2::3] = row[2::4], row[1::4], row[0::4]
            lines.append(b"\0" + line)

        def chunk(kind, data):
            check = zlib.crc32(kind + data)
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", check)

        header = struct.pack(">IIBBBBB", len(rows[0]) // 4, len(rows), 8, 2, 0, 0, 0)
        with open(path, "wb") as file:
            file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header))
            file.write(chunk(b"IDAT", zlib.compress(b"".join(lines))) + chunk(b"IEND", b""))
