"""Charts of the report, as SVG that stands in the page: no file, no script."""
import html
import math

W, H, LEFT, TOP, RIGHT, BOTTOM = 460, 284, 62, 40, 12, 40
COLOURS = ["#1f5fa8", "#c0392b", "#2e8b57", "#8e44ad", "#d68910", "#16a085"]


def finite(x):
    return isinstance(x, (int, float)) and not isinstance(x, bool) and math.isfinite(x)


class Axis:
    """Values to pixels; logarithmic when asked for."""

    def __init__(self, values, low, high, log=False):
        self.log = log
        v = [math.log10(x) if log else x for x in values]
        # A margin on both sides; a single value gets an axis of some width.
        self.a, self.b = min(v), max(v)
        pad = 0.06 * (self.b - self.a) or 0.1 * abs(self.a) or 1.0
        self.a, self.b, self.low, self.high = self.a - pad, self.b + pad, low, high

    def __call__(self, x):
        v = math.log10(x) if self.log else x
        return self.low + (v - self.a) / (self.b - self.a) * (self.high - self.low)

    def ticks(self):
        # Decades, thinned out when there are many, filled with 2 and 5 when there are few.
        if self.log:
            decades = range(math.floor(self.a), math.ceil(self.b) + 1)
            thin = max(1, len(decades) // 6)
            factors = (1, 2, 5) if self.b - self.a < 2 else (1,)
            every = [m * 10.0 ** d for d in decades if d % thin == 0 for m in factors]
            return [t for t in every if self.a <= math.log10(t) <= self.b]
        # Steps of 1, 2 or 5 times a power of ten, about five of them.
        raw = (self.b - self.a) / 5
        step = 10 ** math.floor(math.log10(raw))
        step *= next(m for m in (1, 2, 5, 10) if m * step >= raw)
        return [i * step for i in range(math.ceil(self.a / step),
                                        math.floor(self.b / step) + 1)]


def chart(title, x_label, curves, log_x=False, log_y=False):
    """curves: [(name, [(x, y)], dashed)]. Nothing when nothing can be drawn."""
    # What a logarithm cannot take is left out, as is what is not finite.
    curves = [(n, [(x, y) for x, y in p if finite(x) and finite(y) and (x > 0 or not log_x)
                   and (y > 0 or not log_y)], d) for n, p, d in curves]
    every = [q for _, p, _ in curves for q in p]
    if len(every) < 2:
        return ""
    ax = Axis([x for x, _ in every], LEFT, W - RIGHT, log_x)
    ay = Axis([y for _, y in every], H - BOTTOM, TOP, log_y)
    out = [f'<svg role="img" aria-label="{html.escape(title, quote=True)}" width="{W}" height="{H}" '
           f'viewBox="0 0 {W} {H}"><text x="{LEFT}" y="16" class="t">{html.escape(title)}</text>']
    for t in ax.ticks():
        out.append(f'<line x1="{ax(t):.1f}" x2="{ax(t):.1f}" y1="{TOP}" y2="{H - BOTTOM}" class="g"/>'
                   f'<text x="{ax(t):.1f}" y="{H - BOTTOM + 14}" text-anchor="middle">{t:g}</text>')
    for t in ay.ticks():
        out.append(f'<line y1="{ay(t):.1f}" y2="{ay(t):.1f}" x1="{LEFT}" x2="{W - RIGHT}" class="g"/>'
                   f'<text y="{ay(t) + 4:.1f}" x="{LEFT - 5}" text-anchor="end">{t:g}</text>')
    # References are dashed and grey; few points are marked one by one.
    for q, (name, points, dashed) in enumerate(curves):
        colour = "#333333" if dashed else COLOURS[q % len(COLOURS)]
        path = " ".join(f"{ax(x):.1f},{ay(y):.1f}" for x, y in points)
        style = ' stroke-dasharray="5 4"' if dashed else ""
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" '
                   f'stroke-width="1.8"{style}/>')
        if len(points) <= 40:
            out += [f'<circle cx="{ax(x):.1f}" cy="{ay(y):.1f}" r="3" fill="{colour}"/>'
                    for x, y in points]
        out.append(f'<text x="{LEFT + 110 * q}" y="{TOP - 9}" style="fill:{colour}">'
                   f'{"- - " if dashed else "&#8212; "}{html.escape(name)}</text>')
    out.append(f'<text x="{(LEFT + W - RIGHT) / 2}" y="{H - 6}" text-anchor="middle">'
               f'{html.escape(x_label)}</text></svg>')
    return "".join(out)
