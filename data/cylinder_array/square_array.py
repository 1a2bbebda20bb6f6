#!/usr/bin/python3
"""Drag of a square array of cylinders in slow flow along a side, F = K mu U per length.

usage: square_array.py           prints the rows of square_array.csv

The stream function is a sum over odd n of sin(n a) times r^n, r^-n, r^(n+2), r^(2-n) (n = 1: r, 1/r,
r^3, r ln r), without slip on r = R; the coefficients are those of least squares for the symmetries
of a quarter of the cell: psi = U L/2 and no vorticity on y = L/2; v = 0 and d(vorticity)/dx = 0 on
x = L/2. The pressure drop along y = L/2 times L is the force. `left` is the largest residual of
psi, U = L = 1.
"""
import numpy as np


def terms(n, r, R):
    """radial functions f with f(R) = f'(R) = 0, and of g, with lap(f sin) = g sin; two of each"""
    if n == 1:
        base = [(r, 0 * r, 1.0, R), (1 / r, 0 * r, -1 / R**2, 1 / R), (r**3, 8 * r, 3 * R**2, R**3),
                (r * np.log(r / R), 2 / r, 1.0, 0.0)]
    else:
        s = r / R  # scaled, lest powers overflow
        base = [(s**n, 0 * r, n / R, 1.0), (s**-n, 0 * r, -n / R, 1.0),
                (s**(n + 2), 4 * (n + 1) * s**n / R**2, (n + 2) / R, 1.0),
                (s**(2 - n), 4 * (1 - n) * s**-n / R**2, (2 - n) / R, 1.0)]
    M = np.array([[base[0][3], base[1][3]], [base[0][2], base[1][2]]])
    out = []
    for b in base[2:]:
        c = np.linalg.solve(M, [b[3], b[2]])
        out.append((b[0] - c[0] * base[0][0] - c[1] * base[1][0], b[1]))
    return out


def columns(x, y, R, N):
    """psi and lap psi of each term at points"""
    r, a = np.hypot(x, y), np.arctan2(y, x)
    psi, lap = [], []
    for n in range(1, 2 * N, 2):
        for f, g in terms(n, r, R):
            psi.append(f * np.sin(n * a))
            lap.append(g * np.sin(n * a))
    return np.array(psi).T, np.array(lap).T


def drag(c, N=24, points=200):
    R, d = np.sqrt(c / np.pi), 1e-4
    t = 0.5 * (1.0 - np.cos(np.pi * (np.arange(points) + 0.5) / points)) * 0.5
    half = 0.5 * np.ones(points)
    top, top_lap = columns(t, half, R, N)
    right = [columns(half + q * d, t, R, N) for q in (1, -1)]
    rows = [top, top_lap * 0.02] + [(right[0][k] - right[1][k]) / (2 * d) * w for k, w in ((0, 1.0), (1, 0.02))]
    A = np.concatenate(rows)
    b = np.concatenate([half, 0 * half, 0 * half, 0 * half])
    scale = np.abs(A).max(0)
    x = np.linalg.lstsq(A / scale, b, rcond=1e-14)[0] / scale
    # dp/dx = mu d(lap psi)/dy along y = 1/2
    s, w = np.polynomial.legendre.leggauss(64)
    s, w = 0.25 * (s + 1.0), 0.25 * w
    up, down = (columns(s, half[:64] + q * d, R, N)[1] @ x for q in (1, -1))
    return -2.0 * (w * (up - down) / (2 * d)).sum(), np.abs(top @ x - 0.5).max()


if __name__ == "__main__":
    print("c,K,left")
    for c in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6):
        K, left = drag(c)
        print("%g,%.3f,%.1e" % (c, K, left))
