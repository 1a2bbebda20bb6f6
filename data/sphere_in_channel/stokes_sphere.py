#!/usr/bin/python3
"""Drag of a sphere on the axis of a square channel (or a circular tube) in Stokes flow.

usage: stokes_sphere.py          prints square_channel.csv; on stderr a check: a sphere in a tube
Fundamental solutions: Stokeslets on a sphere inside the sphere and on a closed surface around the
channel (ends ENDS half heights off, where the disturbance of the sphere has died) are fitted, by
least squares, to the disturbance u' = -u_Poiseuille on the sphere and u' = 0 on walls and ends.
The drag is the sum of the Stokeslets inside the sphere. Sources and points come in orbits of the
16 symmetries that the flow has: y -> -y, z -> -z, y <-> z, and x -> -x together with u -> -u.
Half height (or radius of the tube), viscosity and mean velocity are 1.
"""
import sys

import numpy as np

OFF, ENDS = 0.5, 3.5


def orbit():
    """The symmetries as (matrix, sign of the force)."""
    swap = np.array([[1.0, 0, 0], [0, 0, 1], [0, 1, 0]])
    for x in (1, -1):
        for y in (1, -1):
            for z in (1, -1):
                for last in (np.eye(3), swap):
                    yield np.diag([x, y, z]) @ last, x


def stokeslets(point, source):
    """(3 points, 3 sources): velocity from the orbits of forces at `source`, over 1/(8 pi)."""
    rows = np.zeros((len(point), 3, len(source), 3))
    for R, sign in orbit():
        d = point[:, None] - source @ R.T
        r = np.sqrt((d**2).sum(-1))
        G = np.eye(3) / r[..., None, None] + d[..., :, None] * d[..., None, :] / r[..., None, None]**3
        rows += sign * np.einsum("psij,jk->pisk", G, R)
    return rows.reshape(3 * len(point), 3 * len(source))


def sphere(a, n):
    """About n points of the sixteenth x > 0, y > z > 0 of a sphere, from a spiral."""
    q = np.arange(16 * n) + 0.5
    x, t = 1 - 2 * q / (16 * n), np.pi * (1 + 5**0.5) * q
    r = np.sqrt(1 - x * x)
    X = a * np.c_[x, r * np.cos(t), r * np.sin(t)]
    return X[(X[:, 0] > 0) & (X[:, 1] > X[:, 2]) & (X[:, 2] > 0)]


def duct(half, end, n):
    """The sixteenth of a box: wall y = half and end x = end; n points per half height."""
    s = (np.arange(round(n * half)) + 0.5) / round(n * half)
    x = end * (np.arange(round(n * end)) + 0.5) / round(n * end)
    wall = [(a, half, half * b) for a in x for b in s]
    return np.array(wall + [(end, half * a, half * b) for a in s for b in s if a >= b])


def tube(radius, end, n):
    """The same of a tube with its end."""
    m = max(round(n * radius * np.pi / 4), 1)
    t = np.pi / 4 * (np.arange(m) + 0.5) / m
    x = end * (np.arange(round(n * end)) + 0.5) / round(n * end)
    wall = [(a, radius * np.cos(b), radius * np.sin(b)) for a in x for b in t]
    r = radius * (np.arange(round(n * radius)) + 0.5) / round(n * radius)
    return np.array(wall + [(end, a * np.cos(b), a * np.sin(b)) for a in r for b in t])


def duct_flow(y, z):
    """Laminar flow of mean 1 between y, z = -1 and 1, a series of 60 terms."""
    k = np.pi / 2 * (2 * np.arange(60) + 1)
    sign = (-1.0)**np.arange(60)
    far = np.exp(-k * (1 - np.abs(z)[:, None])) * (1 + np.exp(-2 * k * np.abs(z)[:, None]))
    u = 2 * (sign / k**3 * np.cos(k * y[:, None]) * (1 - far / (1 + np.exp(-2 * k)))).sum(1)
    return u / (2 * (1 / k**4 * (1 - np.tanh(k) / k)).sum())


def still(y, z):
    """Seen from a sphere that is moved through fluid at rest."""
    return 0 * y + 1


def drag(a, wall, flow, inner, per_height, ends=ENDS, off=OFF):
    """F/(6 pi mu a U) with the mean velocity U, and the largest slip that is left."""
    depth = 0.5 * a
    source = np.vstack([sphere(depth, inner), wall(1 + off, ends + off, per_height)])
    on, off_body = sphere(a, 4 * inner), wall(1.0, ends, 2 * per_height)
    rows = stokeslets(np.vstack([on, off_body]), source)
    right = np.zeros((len(on) + len(off_body), 3))
    right[:len(on), 0] = -flow(on[:, 1], on[:, 2])
    right = right.ravel()
    s = np.linalg.lstsq(rows, right, rcond=1e-14)[0]
    count = len(sphere(depth, inner))
    force = 16 * 8 * np.pi * s[:3 * count:3].sum()
    return -force / (6 * np.pi * a), np.abs(rows @ s - right).max()


if __name__ == "__main__":
    series = lambda k: 1 / (1 - 2.10444 * k + 2.08877 * k**3 - 0.94813 * k**5 - 1.372 * k**6)
    for k in (0.1, 0.2):
        K, slip = drag(k, tube, still, 40, 6)
        print(f"moved along a tube, {k}: {K:.6f}, series {series(k):.6f}", file=sys.stderr)
    print("blockage,K,slip")
    for k in (0.2, 0.25, 1 / 3, 0.4, 0.5, 0.6):
        K, slip = drag(k, duct, duct_flow, 40, 6)
        print(f"{k:.6g},{K:.6g},{slip:.1e}", flush=True)
