#!/usr/bin/env python3
"""Fails unless a screenshot (8-bit RGB or RGBA PNG) shows charts and heat maps: many colours."""
import struct
import sys
import zlib

LEAST_COLOURS = 100


def chunks(data):
    at = 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        yield kind, data[at + 8:at + 8 + size]
        at += 12 + size


def paeth(a, b, c):
    guess = a + b - c
    return min((a, b, c), key=lambda p: abs(guess - p))  # the first of equals


def rows(data):
    """Unfiltered rows, and the bytes of a pixel."""
    parts = list(chunks(data))
    width, height, depth, colour = struct.unpack(">IIBB", parts[0][1][:10])
    assert depth == 8 and colour in (2, 6), "unexpected kind of PNG"
    step = 3 if colour == 2 else 4
    raw = zlib.decompress(b"".join(body for kind, body in parts if kind == b"IDAT"))
    above = bytearray(width * step)
    for y in range(height):
        start = y * (width * step + 1)
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + width * step])
        for i in range(len(row)) if kind else ():
            left = row[i - step] if i >= step else 0
            corner = above[i - step] if i >= step else 0
            guess = (0, left, above[i], (left + above[i]) // 2, paeth(left, above[i], corner))[kind]
            row[i] = (row[i] + guess) & 255
        yield row, step
        above = row


def main():
    with open(sys.argv[1], "rb") as file:
        data = file.read()
    seen = set()
    for row, step in rows(data):
        seen.update(bytes(row[i:i + 3]) for i in range(0, len(row), step))
    coloured = sum(1 for r, g, b in seen if max(r, g, b) - min(r, g, b) > 32)
    if coloured < LEAST_COLOURS:
        sys.exit(f"page: only {coloured} colours in the screenshot")


main()
