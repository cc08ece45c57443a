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

    def luma(self, shrink=1):
        """Rows of brightness, 0..255, with blocks of `shrink` x `shrink` pixels averaged."""
        rows = []
        for y in range(0, self.height - shrink + 1, shrink):
            sums = [0.0] * (self.width // shrink)
            for row in self.rows[y:y + shrink]:
                for x in range(len(sums) * shrink):
                    sums[x // shrink] += 0.299 * row[3 * x] + 0.587 * row[3 * x + 1] + 0.114 * row[3 * x + 2]
            rows.append([s / (shrink * shrink) for s in sums])
        return rows


def similarity(one, two, window=8):
    """Mean structural similarity of two lists of rows: 1 for equal ones (Wang et al. 2004, "Image quality
    assessment: from error visibility to structural similarity", equation 13, over windows side by side)."""
    assert len(one) == len(two) and len(one[0]) == len(two[0])
    c1, c2, n = (0.01 * 255) ** 2, (0.03 * 255) ** 2, window * window
    values = []
    for top in range(0, len(one) - window + 1, window):
        for left in range(0, len(one[0]) - window + 1, window):
            a = [v for row in one[top:top + window] for v in row[left:left + window]]
            b = [v for row in two[top:top + window] for v in row[left:left + window]]
            mean_a, mean_b = sum(a) / n, sum(b) / n
            square_a = sum((v - mean_a) ** 2 for v in a) / (n - 1)
            square_b = sum((v - mean_b) ** 2 for v in b) / (n - 1)
            both = sum((v - mean_a) * (w - mean_b) for v, w in zip(a, b)) / (n - 1)
            values.append((2 * mean_a * mean_b + c1) * (2 * both + c2) /
                          ((mean_a ** 2 + mean_b ** 2 + c1) * (square_a + square_b + c2)))
    return sum(values) / len(values)
