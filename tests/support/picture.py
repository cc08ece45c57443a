# SPDX-License-Identifier: MIT
"""Images that the program wrote."""
import struct
import zlib


class Picture:
    """A PNG of 8-bit RGB, decoded by hand: what the program writes has to be right by the standard."""

    def __init__(self, data):
        assert data[:8] == b"\x89PNG\r\n\x1a\n", data[:8]
        at, packed, self.kinds = 8, b"", []
        while at < len(data):
            size, kind = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + size]
            crc, = struct.unpack(">I", data[at + 8 + size:at + 12 + size])
            assert crc == zlib.crc32(kind + body)
            self.kinds.append(kind)
            if kind == b"IHDR":
                self.width, self.height, *rest = struct.unpack(">IIBBBBB", body)
                assert rest == [8, 2, 0, 0, 0], rest
            if kind == b"IDAT":
                packed += body
            at += 12 + size
        assert self.kinds[-1] == b"IEND"
        self.rows = self.unfilter(zlib.decompress(packed))

    def unfilter(self, raw):
        stride, rows, above = self.width * 3, [], bytes(self.width * 3)
        for y in range(self.height):
            kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
            for i in range(stride):
                left = line[i - 3] if i >= 3 else 0
                corner = above[i - 3] if i >= 3 else 0
                if kind == 1:
                    line[i] = (line[i] + left) & 255
                elif kind == 2:
                    line[i] = (line[i] + above[i]) & 255
                elif kind == 3:
                    line[i] = (line[i] + (left + above[i]) // 2) & 255
                elif kind == 4:
                    p = left + above[i] - corner
                    best = min((abs(p - left), 0, left), (abs(p - above[i]), 1, above[i]),
                               (abs(p - corner), 2, corner))
                    line[i] = (line[i] + best[2]) & 255
            rows.append(bytes(line))
            above = line
        return rows

    def at(self, x, y):
        return tuple(self.rows[y][3 * x:3 * x + 3])

    def part(self, x, y, w, h):
        return [row[3 * x:3 * (x + w)] for row in self.rows[y:y + h]]
