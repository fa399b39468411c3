#!/usr/bin/env python3
"""Prints the figures in tests/unit/flip_test.cpp, from the authors' own program.

    python3 -m venv venv && venv/bin/pip install flip-evaluator==1.7 numpy
    venv/bin/python tests/golden/flip_reference.py

The pictures are integer formulas, written a second time in the test: no file is shared.
"""
import numpy
import flip_evaluator

PIXELS = [(0, 0), (0.5, 0.5), (0.3, 0.7), (0.9, 0.1), (0.999, 0.999)]  # printed pixels, as fractions of the picture's size


def scramble(x, y, c, seed):
    """32-bit integer hash of a texel, 0..255."""
    h = (x * 374761393 + y * 668265263 + c * 974634777 + seed * 2246822519) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return (h ^ (h >> 16)) & 255


def constant(x, y, c, b):
    return ([190, 80, 40] if b else [200, 60, 30])[c]


def edges(x, y, c, b):
    return 40 if x + y // 2 < (25 if b else 22) else 220


def points(x, y, c, b):
    return 255 if x % 8 == 4 and y % 8 == 4 and not b else 128


def noise(x, y, c, b):
    return scramble(x, y, c, 2 if b else 1)


def natural(x, y, c, b):
    """A lit wall with a ball on it, grain everywhere; b moves the ball and takes out some blue."""
    ball = (x - (32 if b else 30)) ** 2 + (y - 20) ** 2 < 144
    value = 30 + 2 * x + 10 * c + (70 - 30 * c if ball else 0) + scramble(x, y, c, 3) % 16
    return min(255, value - (8 if b and c == 2 else 0))


def primaries(x, y, c, b):
    return 255 if c == (2 if b else 1) else 0


def between_steps(x, y, c, b):
    """Linear light that no 8 bits hold."""
    return (20 + 3 * x + 2 * y + 5 * c + ((x * y) % 7 / 16 if b else 0)) / 255


def shown(linear, stops):
    """sRGB curve of the exposed light."""
    value = min(max(linear * 2 ** stops, 0), 1)
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


CASES = [(constant, 24, 16, 67), (edges, 40, 30, 67), (points, 32, 24, 67), (noise, 33, 21, 67),
         (natural, 64, 48, 67), (primaries, 9, 7, 67), (natural, 50, 1, 67), (natural, 1, 1, 67),
         (natural, 64, 48, 20), (natural, 64, 48, 150)]


def main():
    for formula, width, height, ppd in CASES:
        a, b = (numpy.array([[[formula(x, y, c, second) / 255 for c in range(3)]
                              for x in range(width)] for y in range(height)], dtype=numpy.float32)
                for second in (False, True))
        error, _, _ = flip_evaluator.evaluate(a, b, "LDR", applyMagma=False,
                                              parameters={"ppd": ppd})
        values = [error[int(v * height), int(u * width)].max() for u, v in PIXELS]
        print(f'    {{{formula.__name__}, {width}, {height}, {ppd}, {error.mean(dtype=float):.7f},'
              f' {{{", ".join(f"{v:.7f}" for v in values)}}}}},')
    for is_rounded in (False, True):
        for stops in (-.5, .5):
            a, b = (numpy.array([[[round(v * 255) / 255 if is_rounded else v for v in
                                   (shown(between_steps(x, y, c, second), stops) for c in range(3))]
                                  for x in range(40)] for y in range(24)], dtype=numpy.float32)
                    for second in (False, True))
            error, _, _ = flip_evaluator.evaluate(a, b, "LDR", applyMagma=False,
                                                  parameters={"ppd": 67})
            print(f'    between steps, {"8 bits" if is_rounded else "floats"}, {stops} stops:'
                  f' {error.mean(dtype=float):.7f}')


main()
