"""Fits the samples of shaders/rough/fast.comp: radii, weights and box-filtered levels of a lobe seen along its normal.

fit_rings.py [--tries N] [--seed S]

A picture of 256x256 texels stands for a part of a cube face. For a small alpha, the GGX lobe is a kernel with the
density 1 / (1 + (x / alpha)^2 / 4)^2 at the distance x, in texels. The script filters six pictures (edges, lamps 17
times as bright as white, noise of 8x8 texels) by this kernel, and by a few bilinear samples of box-filtered levels. The
result is read with bilinear interpolation from a level whose texels are alpha wide. Its error is the root of the mean
of ((filtered - exact) / (exact + .2))^2 over all texels of level 0, for an alpha of 4 and 8 texels.

Printed: the error of `prefilter` with 8, 16 and 32 samples, and of the best fit found with one, two and three rings of
four samples around a middle sample. Radii are in alphas, levels are 0 for texels of the width alpha. Needs numpy.
"""
import argparse

import numpy as np

kEdge = 256
kLevels = (1, 2)  # a level m of `prefilter` stands for alpha = 2^(m + 1) texels


def make_pictures(chance):
    """Returns the six pictures, of kEdge x kEdge texels each."""
    pictures = []
    for kind in ("edges", "edges", "lamp", "lamp", "lamp", "noise"):
        if kind == "noise":
            pictures.append(chance.uniform(0, 1, (kEdge // 8, kEdge // 8)).repeat(8, 0).repeat(8, 1))
            continue
        picture = np.full((kEdge, kEdge), .3 if kind == "edges" else .2)
        for _ in range(6 if kind == "edges" else 1):
            x, y = chance.integers(0, kEdge - 40, 2)
            width, height = chance.integers(10, 90, 2) if kind == "edges" else chance.integers(6, 20, 2)
            picture[y:y + height, x:x + width] = chance.uniform(0, 1) if kind == "edges" else 17
        pictures.append(picture)
    return pictures


def filter_exactly(picture, alpha):
    """Returns the picture filtered by the lobe. Pictures repeat beyond their edges."""
    at = np.arange(-kEdge // 2, kEdge // 2)
    x, y = np.meshgrid(at, at)
    kernel = 1 / (1 + (x ** 2 + y ** 2) / alpha ** 2 / 4) ** 2
    spectrum = np.fft.fft2(picture) * np.fft.fft2(np.fft.ifftshift(kernel / kernel.sum()))
    return np.real(np.fft.ifft2(spectrum))


def make_levels(picture):
    """Returns the box-filtered levels of the picture, from the picture itself."""
    levels = [picture]
    while levels[-1].shape[0] > 4:
        a = levels[-1]
        levels.append((a[::2, ::2] + a[1::2, ::2] + a[::2, 1::2] + a[1::2, 1::2]) / 4)
    return levels


def sample(level, width, x, y):
    """Returns bilinear samples of a level with texels of this width, at positions in texels of level 0."""
    x, y, edge = x / width - .5, y / width - .5, level.shape[0]
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    right_share, lower_share = x - left, y - top

    def texel(row, column):
        return level[row % edge, column % edge]
    return ((1 - lower_share) * ((1 - right_share) * texel(top, left) + right_share * texel(top, left + 1)) +
            lower_share * ((1 - right_share) * texel(top + 1, left) + right_share * texel(top + 1, left + 1)))


def rings_of_prefilter(samples):
    """Returns the rings of rough/prefilter.comp: Hammersley points of the lobe, level .5 log2(4 w_s / w_p)."""
    rings = []
    for i in range(samples // 4):
        share = (i + .5) / (samples // 4)
        turn = int(f"{i:032b}"[::-1], 2) / 2 ** 32
        radius = 2 * np.sqrt(share / (1 - share))
        density = 1 / (4 * np.pi) / (1 + radius ** 2 / 4) ** 2  # per alpha^2
        rings.append((radius, 2 * np.pi * turn / 4, round(.5 * np.log2(2 / (samples * density))), 4))
    return rings


class Cases:
    """Pictures with their levels and exact results."""

    def __init__(self, chance):
        pictures = make_pictures(chance)
        self.levels = [make_levels(picture) for picture in pictures]
        self.exact = {m: [filter_exactly(picture, 2.0 ** (m + 1)) for picture in pictures] for m in kLevels}
        at = np.arange(kEdge) + .5
        self.texels = np.meshgrid(at, at)

    def error(self, middle, rings):
        """Returns the error of a middle sample (level, weight) and rings (radius, angle, level, weight)."""
        squares = []
        for m in kLevels:
            alpha, width = 2.0 ** (m + 1), 2 ** (m + 1)
            at = (np.arange(kEdge // width) + .5) * width
            x, y = np.meshgrid(at, at)
            total = middle[1] + sum(ring[3] for ring in rings)
            for levels, exact in zip(self.levels, self.exact[m]):
                def read(offset, px, py, levels=levels, alpha=alpha):
                    number = int(np.clip(round(np.log2(alpha) + offset), 1, len(levels) - 1))
                    return sample(levels[number], 2.0 ** number, px, py)
                filtered = middle[1] * read(middle[0], x, y)
                for radius, angle, offset, weight in rings:
                    for turn in angle + np.arange(4) * np.pi / 2:
                        filtered = filtered + weight / 4 * read(offset, x + radius * alpha * np.cos(turn),
                                                                y + radius * alpha * np.sin(turn))
                shown = sample(filtered / total, width, *self.texels)
                squares.append(np.mean(((shown - exact) / (exact + .2)) ** 2))
        return np.sqrt(np.mean(squares))


def fit(cases, chance, level_sets, radii, tries):
    """Searches at random for radii and weights with the smallest error, and prints the best for each set of levels."""
    angles = (np.pi / 4, 0, np.pi / 4)
    for levels in level_sets:
        best, weights, error = np.array(radii), np.full(len(radii) + 1, 1 / (len(radii) + 1)), np.inf
        for number in range(tries):
            step = 0 if number == 0 else .25 if number < tries // 2 else .07
            r = np.abs(best * (1 + step * chance.normal(size=len(best))))
            w = np.abs(weights * (1 + step * chance.normal(size=len(weights))))
            now = cases.error((levels[0], w[0]), list(zip(r, angles, levels[1:], w[1:])))
            if now < error:
                best, weights, error = r, w / w.sum(), now
        print(f"| {1 + 4 * len(best)} | {error:.4f} | {levels} | {best.round(3)} | {weights.round(3)} |", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tries", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    chance = np.random.default_rng(chosen.seed)
    cases = Cases(chance)
    for samples in (8, 16, 32):
        print(f"prefilter, {samples} samples: {cases.error((0, 0), rings_of_prefilter(samples)):.4f}")
    print("| samples | error | levels, middle first | radii | weights, middle first |\n|--:|--:|---|---|---|")
    fit(cases, chance, [(0, 1), (1, 2)], [2.5], chosen.tries)
    fit(cases, chance, [(0, 1, 2)], [1.4, 4.0], chosen.tries)
    fit(cases, chance, [(0, 1, 2, 3), (0, 1, 2, 2)], [1.3, 3.5, 7.5], chosen.tries)


if __name__ == "__main__":
    main()
