#!/usr/bin/python3
"""Free cylinder on the centre line of a plane channel in Stokes flow, by fundamental solutions.

usage: stokes_cylinder.py          prints free_cylinder.csv
Stokeslets on a ring inside the cylinder and on a box around the channel (closed ends, 5 heights
apart) are fitted, by least squares, to no slip on cylinder and walls; force and torque on the
cylinder are those of the ring. Unknown with them: speed and spin of the cylinder.
"""
import numpy as np

INNER, PER_HEIGHT, LENGTH, OFF = 80, 14, 5.0, 0.35


def box(half_x, half_y, per_height):
    x = np.linspace(-half_x, half_x, int(2 * half_x * per_height))
    y = np.linspace(-half_y, half_y, int(2 * half_y * per_height) + 2)[1:-1]
    return np.vstack([np.c_[x, 0 * x - half_y], np.c_[x, 0 * x + half_y],
                      np.c_[0 * y - half_x, y], np.c_[0 * y + half_x, y]])


def ring(radius, n, phase):
    t = 2 * np.pi * (np.arange(n) + phase) / n
    return radius * np.c_[np.cos(t), np.sin(t)]


def solve(blockage, far, force):
    """Speed, spin, largest slip; channel height, viscosity 1; `far` the undisturbed u(y)."""
    a = blockage / 2
    source = np.vstack([ring(0.62 * a, INNER, 0.5),
                        box(LENGTH / 2 + OFF, 0.5 + OFF, PER_HEIGHT)])
    inner = ring(a, 3 * INNER, 0.25)
    point = np.vstack([inner, box(LENGTH / 2, 0.5, 2.3 * PER_HEIGHT)])
    d = point[:, None] - source[None]
    r2 = (d**2).sum(-1)

    def stokeslet(i, j):
        return (-0.5 * np.log(r2) * (i == j) + d[..., i] * d[..., j] / r2) / (4 * np.pi)

    n, m = len(point), len(source)
    on = np.r_[np.ones(len(inner)), np.zeros(n - len(inner))]
    x, y = point.T
    rows = np.hstack([np.block([[stokeslet(0, 0), stokeslet(0, 1)],
                                [stokeslet(1, 0), stokeslet(1, 1)]]), np.zeros((2 * n, 2))])
    rows[:n, -2], rows[:n, -1], rows[n:, -1] = -on, on * y, -on * x
    balance = np.zeros((2, 2 * m + 2))
    balance[0, :INNER] = 1
    balance[1, :INNER], balance[1, m:m + INNER] = -source[:INNER, 1], source[:INNER, 0]
    weight = 1e3
    right = np.r_[-on * far(y), np.zeros(n), weight * force, 0]
    rows = np.vstack([rows, weight * balance])
    s = np.linalg.lstsq(rows, right, rcond=1e-13)[0]
    return s[-2], s[-1], np.abs(rows @ s - right)[:2 * n].max()


FLOWS = {"fall": (lambda y: 0 * y, 1.0), "couette": (lambda y: y, 0.0),
         "poiseuille": (lambda y: 1.5 * (1 - 4 * y * y), 0.0)}
NUMBER = {"fall": 0, "couette": 1, "poiseuille": 2}
if __name__ == "__main__":
    for k in (0.05, 0.1, 0.25, 0.5):
        for name, (far, force) in FLOWS.items():
            speed, spin, slip = solve(k, far, force)
            value = -spin if name == "couette" else speed
            print(f"{k},{NUMBER[name]},{value:.6g},{slip:.1e}")
