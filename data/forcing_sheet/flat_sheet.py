#!/usr/bin/python3
"""How far outside itself a sheet of markers stops the fluid: the retraction of bw_ibm_mdf.

usage: flat_sheet.py             prints sheet_displacement.csv

Two parallel flat sheets of markers in a periodic box of cells (spacing and viscosity 1), half a
period D/2 apart, move along themselves with velocities +1 and -1: plane Couette flow on either side.
Markers stand one to a cell's area, on an irrational lattice, spread and interpolate with the kernel;
the fluid is Stokes flow of the staggered second-order operators, solved by FFT. A sharp sheet with
the force F per area moves at F D/8; what is missing, D/8 - 1/F, is the displacement: by so much the
fluid stops outside the sheet.
  uniform   the same force on all markers (mean velocity of the markers: 1)
  slip 1 %  forces by conjugate gradients until the rms slip is below 1 %
  slip .3 % the same below 0.3 %: forces that hardly move the fluid grow, and with them, on turned
            sheets and at random, the displacement
`n4` is n_x^4 + n_y^4 + n_z^4 of the normal. Places of the sheet on the grid are averaged over. The
last rows are the straight line through the uniform values of a kernel at n4 = 3/4, the mean over the
normals of a cylinder along the grid, and 3/5, that over those of a sphere.
"""
import numpy as np

GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0


def roma3(r):
    r = abs(r)
    inner = (1.0 + np.sqrt(np.maximum(1.0 - 3.0 * r * r, 0.0))) / 3.0
    outer = (5.0 - 3.0 * r - np.sqrt(np.maximum(1.0 - 3.0 * (1.0 - r) ** 2, 0.0))) / 6.0
    return np.where(r <= 0.5, inner, np.where(r < 1.5, outer, 0.0))


def peskin4(r):
    r = abs(r)
    inner = (3.0 - 2.0 * r + np.sqrt(np.maximum(1.0 + 4.0 * r - 4.0 * r * r, 0.0))) / 8.0
    outer = (5.0 - 2.0 * r - np.sqrt(np.maximum(-7.0 + 12.0 * r - 4.0 * r * r, 0.0))) / 8.0
    return np.where(r <= 1.0, inner, np.where(r < 2.0, outer, 0.0))


def hat2(r):
    return np.maximum(1.0 - abs(r), 0.0)


class Box:
    """Stokes flow in a periodic box of L cells a side, markers at X (n,3)."""

    def __init__(self, phi, X, L):
        self.L, wave = L, 2.0 * np.pi * np.arange(L) / L
        s = 2.0 - 2.0 * np.cos(wave)
        self.lap = s[:, None, None] + s[None, :, None] + s[None, None, :]
        self.lap[0, 0, 0] = 1.0
        self.div = [(np.exp(1j * wave) - 1.0).reshape([-1 if e == d else 1 for e in range(3)])
                    for d in range(3)]
        self.node, self.weight = zip(*(self.stencil(phi, X, d) for d in range(3)))

    def stencil(self, phi, X, d):
        """64 nodes and weights of each marker, for the velocity component d on its faces."""
        off = np.array([0.0 if e == d else 0.5 for e in range(3)])
        index = np.floor(X - off).astype(int)[:, :, None] + np.arange(-1, 3)
        w = phi(index + off[:, None] - X[:, :, None])
        i = index % self.L
        node = (i[:, 0, :, None, None] * self.L + i[:, 1, None, :, None]) * self.L
        node = node + i[:, 2, None, None, :]
        weight = w[:, 0, :, None, None] * w[:, 1, None, :, None] * w[:, 2, None, None, :]
        return node.reshape(len(X), -1), weight.reshape(len(X), -1)

    def velocity(self, f):
        """Steady velocity (n,3) at the markers of forces f (n,3) there."""
        F = [np.fft.fftn(np.bincount(self.node[d].ravel(), (self.weight[d] * f[:, d:d + 1]).ravel(),
                                     self.L ** 3).reshape(3 * [self.L])) for d in range(3)]
        p = sum(self.div[d] * F[d] for d in range(3)) / self.lap
        U = np.empty_like(f)
        for d in range(3):
            u = (F[d] - np.conj(self.div[d]) * p) / self.lap
            u[0, 0, 0] = 0.0  # the two sheets have no force together
            u = np.real(np.fft.ifftn(u)).ravel()
            U[:, d] = (self.weight[d] * u[self.node[d]]).sum(1)
        return U


def displacement(phi, sheet, L, place):
    """(uniform, slip 1 %, slip 0.3 %); NaN where 120 iterations do not get there."""
    normal, side1, side2, along = (np.array(v, float) for v in sheet)
    D, n = L / np.linalg.norm(normal), normal / np.linalg.norm(normal)
    along /= np.linalg.norm(along)
    area = L * L * np.linalg.norm(np.cross(side1, side2))
    count = int(round(area))
    q = np.arange(count)
    at = ((q + 0.5) / count)[:, None] * L * side1 + ((q * GOLDEN) % 1.0)[:, None] * L * side2
    X = np.concatenate([(place + at + side * n * D / 2.0) % L for side in (0, 1)])
    V = np.outer(np.repeat([1.0, -1.0], count), along)
    box = Box(phi, X, L)

    def missing(U, f):
        mean_U, mean_f = (U * V).sum() / len(V), (f * V).sum() / len(V) * count / area
        return D / 8.0 - mean_U / mean_f

    out = [missing(box.velocity(V), V), np.nan, np.nan]
    f = np.zeros_like(V)
    r = V.copy()
    step, rr = r.copy(), (r * r).sum()
    for _ in range(120):
        answer = box.velocity(step)
        alpha = rr / (step * answer).sum()
        f, r = f + alpha * step, r - alpha * answer
        new = (r * r).sum()
        for column, slip in ((1, 0.01), (2, 0.003)):
            if np.isnan(out[column]) and np.sqrt(new / len(V)) < slip:
                out[column] = missing(V, f)
        if not np.isnan(out[2]):
            break
        step, rr = r + new / rr * step, new
    return out


# normal, two sides of the sheet's own period, direction of motion; cells a side
SHEETS = ((((1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 1, 0)), 16),
          (((2, 1, 0), (1, -2, 0), (0, 0, 1), (1, -2, 0)), 24),
          (((1, 1, 0), (1, -1, 0), (0, 0, 1), (1, -1, 0)), 16),
          (((1, 1, 1), (1, -1, 0), (0, 1, -1), (1, -1, 0)), 24))

if __name__ == "__main__":
    np.seterr(all="raise", under="ignore")
    print("kernel,normal,n4,uniform,slip 1 %,slip 0.3 %")
    for kernel in (roma3, peskin4, hat2):
        points = []
        for sheet, L in SHEETS:
            n = np.array(sheet[0], float)
            n4 = (n ** 4).sum() / (n ** 2).sum() ** 2
            places = 10 if n4 == 1.0 else 2  # along the grid the place matters, evenly taken
            rows = [displacement(kernel, sheet, L, np.array([(q + 0.5) / places, 0.3, 0.7 * q]))
                    for q in range(places)]
            mean = np.mean(rows, 0)
            points.append((n4, mean[0]))
            print("%s,%d %d %d,%.4f,%.3f,%.3f,%.3f" % (kernel.__name__, *sheet[0], n4, *mean),
                  flush=True)
        line = np.polyfit(*zip(*points), 1)
        for name, n4 in (("cylinder", 0.75), ("sphere", 0.6)):
            print("%s,%s,%.4f,%.3f,," % (kernel.__name__, name, n4, np.polyval(line, n4)))
