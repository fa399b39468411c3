"""Draws costs against sizes as SVG, with logarithmic axes: measured points and the fitted power laws."""
import math
from html import escape

COLOURS = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#8c564b", "#e377c2"]
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 420, 300, 60, 15, 30, 45


def short(value):
    for limit, unit in ((1e6, "M"), (1e3, "k")):
        if value >= limit:
            return f"{value / limit:.3g}{unit}"
    return f"{value:.3g}"


def panel(x_shift, title, x_label, series):
    """Returns the SVG elements of a diagram. Each element of `series` has sizes and costs. An element with a factor and
    an exponent also gets the line of its power law."""
    sizes = [n for s in series for n in s["sizes"]]
    costs = [c for s in series for c in s["costs"]]
    ranges = []
    for values in (sizes, costs):
        low, high = math.log10(min(values)), math.log10(max(values))
        margin = max(.05 * (high - low), .05)
        ranges.append((low - margin, high + margin))
    (x0, x1), (y0, y1) = ranges

    def at(n, c):
        return (x_shift + LEFT + (math.log10(n) - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT),
                HEIGHT - BOTTOM - (math.log10(c) - y0) / (y1 - y0) * (HEIGHT - TOP - BOTTOM))

    out = [f'<text x="{x_shift + LEFT}" y="18" font-weight="bold">{escape(title)}</text>',
           f'<text x="{x_shift + WIDTH / 2:.0f}" y="{HEIGHT - 8}" text-anchor="middle">{escape(x_label)}</text>',
           f'<rect x="{x_shift + LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" height="{HEIGHT - TOP - BOTTOM}" '
           'fill="none" stroke="#999"/>']
    for n in sorted(set(sizes)):
        x, _ = at(n, costs[0])
        out.append(f'<path d="M{x:.1f} {HEIGHT - BOTTOM}v4" stroke="#999"/>'
                   f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{short(n)}</text>')
    for power in range(math.floor(y0), math.ceil(y1) + 1):
        for digit in (1, 2, 5) if y1 - y0 > 1.2 else (1, 1.5, 2, 3, 5, 7):
            value = digit * 10 ** power
            if y0 <= math.log10(value) <= y1:
                _, y = at(sizes[0], value)
                out.append(f'<path d="M{x_shift + LEFT} {y:.1f}H{x_shift + WIDTH - RIGHT}" stroke="#eee"/>'
                           f'<text x="{x_shift + LEFT - 5}" y="{y + 4:.1f}" text-anchor="end">{short(value)}</text>')
    for k, s in enumerate(series):
        colour = COLOURS[k % len(COLOURS)]
        if s.get("factor"):
            ends = [at(n, s["factor"] * n ** s["exponent"]) for n in (s["sizes"][0], s["sizes"][-1])]
            out.append("<path d=\"M{0[0]:.1f} {0[1]:.1f}L{1[0]:.1f} {1[1]:.1f}\"".format(*ends) +
                       f' stroke="{colour}" stroke-dasharray="4 3" fill="none"/>')
        for n, c in zip(s["sizes"], s["costs"]):
            out.append('<circle cx="{:.1f}" cy="{:.1f}" r="3" '.format(*at(n, c)) + f'fill="{colour}"/>')
    return out


def write(path, variable, unit, series):
    """Writes an SVG file with processor time on the left and peak memory on the right. Each series has one colour. The
    legend below the diagrams names the series."""
    time = [dict(s, costs=s["ms"]) for s in series]
    memory = [{"sizes": s["sizes"], "costs": s["megabytes"]} if s.get("megabytes") else None for s in series]
    out = panel(0, f"Processor time against {variable}, ms", unit, time)
    if any(memory):
        out += panel(WIDTH, f"Peak memory against {variable}, MB", unit, [m for m in memory if m])
    height = HEIGHT + 18 * len(series) + 8
    for k, s in enumerate(series):
        y = HEIGHT + 18 * k + 8
        out.append(f'<circle cx="{LEFT}" cy="{y}" r="4" fill="{COLOURS[k % len(COLOURS)]}"/>'
                   f'<text x="{LEFT + 10}" y="{y + 4}">{escape(s["name"])}: n^{s["exponent"]:.2f}</text>')
    width = WIDTH * (2 if any(memory) else 1)
    with open(path, "w", encoding="utf-8") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
                   'font-family="sans-serif" font-size="11">\n<rect width="100%" height="100%" fill="white"/>\n' +
                   "\n".join(out) + "\n</svg>\n")
