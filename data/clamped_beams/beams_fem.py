#!/usr/bin/python3
"""Clamped beams in the plane by finite elements: the references of tools/trade.py.

Eight-node quadrilaterals, 3 x 3 Gauss points, small strains, plane stress with nu = 1/3 (the ratio of
bonds). Three meshes; the corners of the clamp leave an order of 1.2, which extrapolates to 0.02300 m and
3.588 Hz, each to 2e-4:
  cantilever  L = 1, H = 0.2, E = 22e9, shear traction 5e6 on its end: displacement across of the part
              0.98 < x < 1, mean over it [m]
  swing       L = 0.2, H = 0.02, E = 2e6, density 1000: lowest frequency [Hz]
"""
import numpy as np

NODE = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)], float)


def shape(x, y):
    """Functions of the eight nodes and their derivatives at a place of the reference square."""
    n, d = np.empty(8), np.empty((8, 2))
    for q, (a, b) in enumerate(NODE):
        if a and b:
            n[q] = (1 + a * x) * (1 + b * y) * (a * x + b * y - 1) / 4
            d[q] = (a * (1 + b * y) * (2 * a * x + b * y) / 4, b * (1 + a * x) * (2 * b * y + a * x) / 4)
        elif a == 0:
            n[q] = (1 - x * x) * (1 + b * y) / 2
            d[q] = (-x * (1 + b * y), b * (1 - x * x) / 2)
        else:
            n[q] = (1 + a * x) * (1 - y * y) / 2
            d[q] = (a * (1 - y * y) / 2, -y * (1 + a * x))
    return n, d


def matrices(L, H, nx, ny, E, nu, rho):
    """Stiffness and mass without the clamped nodes, the places of all nodes, and who is free."""
    hx, hy, number, place, elements = L / nx, H / ny, {}, [], []

    def node(i, j):
        if (i, j) not in number:
            number[i, j] = len(place)
            place.append((i * hx / 2, j * hy / 2))
        return number[i, j]

    for j in range(ny):
        for i in range(nx):
            elements.append([node(2 * i + 1 + int(a), 2 * j + 1 + int(b)) for a, b in NODE])
    C = E / (1 - nu * nu) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    k, m = np.zeros((16, 16)), np.zeros((16, 16))
    g, w = np.polynomial.legendre.leggauss(3)
    for x, wx in zip(g, w):
        for y, wy in zip(g, w):
            n, d = shape(x, y)
            d = d * (2 / hx, 2 / hy)
            B, N = np.zeros((3, 16)), np.zeros((2, 16))
            B[0, 0::2], B[1, 1::2], B[2, 0::2], B[2, 1::2] = d[:, 0], d[:, 1], d[:, 1], d[:, 0]
            N[0, 0::2] = N[1, 1::2] = n
            k += B.T @ C @ B * wx * wy * hx * hy / 4
            m += rho * N.T @ N * wx * wy * hx * hy / 4
    place = np.array(place)
    K, M = np.zeros((2 * len(place),) * 2), np.zeros((2 * len(place),) * 2)
    for e in elements:
        dof = np.array([(2 * q, 2 * q + 1) for q in e]).ravel()
        K[np.ix_(dof, dof)] += k
        M[np.ix_(dof, dof)] += m
    free = np.repeat(place[:, 0] > 1e-12, 2)
    return K[np.ix_(free, free)], M[np.ix_(free, free)], place, free


def cantilever(nx, ny, L=1.0, H=0.2):
    K, _, place, free = matrices(L, H, nx, ny, 22e9, 1 / 3, 1.0)
    load = np.zeros(2 * len(place))
    weight = H / ny / 6 * np.array([1, 4, 1])  # of a side's three nodes
    for q in np.nonzero(place[:, 0] > L - 1e-9)[0]:
        j = round(place[q, 1] / (H / ny / 2))
        parts = weight[1] if j % 2 else weight[0] * (1 if j in (0, 2 * ny) else 2)
        load[2 * q + 1] = 5e6 * parts
    u = np.zeros_like(load)
    u[free] = np.linalg.solve(K, load[free])
    middle = np.abs(place[:, 1] - H / 2) < 1e-9
    at, v = place[middle, 0], u[1::2][middle]
    order = np.argsort(at)
    return np.interp(0.99, at[order], v[order])  # nearly straight there: the mean of the part


def swing(nx, ny):
    K, M, _, _ = matrices(0.2, 0.02, nx, ny, 2e6, 1 / 3, 1000.0)
    lower = np.linalg.inv(np.linalg.cholesky(M))
    return np.sqrt(np.linalg.eigvalsh(lower @ K @ lower.T)[0]) / (2 * np.pi)


if __name__ == "__main__":
    for nx, ny in ((20, 4), (30, 6), (40, 8)):
        print(f"{nx:3} x {ny} elements: cantilever {cantilever(nx, ny):.6f} m, swing {swing(nx, ny):.5f} Hz")
