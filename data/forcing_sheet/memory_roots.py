#!/usr/bin/python3
"""What a step of the forcing with memory does to what is not steady: the roots of its cubic.

usage: memory_roots.py           prints a table: largest |mu| over all modes whose a is at most a_max

One mode: a is its eigenvalue of A = interpolate(spread(. dV)), p a that with the projection between
spreading and interpolating, N the iterations of a step, k = 1 - (1 - a)^N; pressure of the step
before is in u*. With q, m, u the force of the step, the memory, the velocity, times a, and V = 0,
  q_n = (1 - k) m_n + k (-u_n + (1 - p) q_{n-1}),  m_{n+1} = (1 - beta) m_n + beta q_n,
  u_{n+1} = u_n + p q_n.
A solution ~ mu^n needs
  mu^3 - (2 - k p (1 + beta) + y) mu^2 + (1 - k p + 2 y) mu - y = 0,  y = (1 - beta) k (1 - p).
The step is taken as one sub-step. beta = 0 has the root 1 (the slip that stays) and, where the other
two are complex, |mu| = sqrt(k (1 - p)). The check below runs the recursion itself.
"""
import numpy as np


def roots(a, p, beta, iterations):
    k = 1.0 - (1.0 - a) ** iterations
    y = (1.0 - beta) * k * (1.0 - p)
    return np.roots([1.0, -(2.0 - k * p * (1.0 + beta) + y), 1.0 - k * p + 2.0 * y, -y])


def growth_of_recursion(a, p, beta, iterations, steps=4000):
    k, last, m, u = 1.0 - (1.0 - a) ** iterations, 0.3, -0.2, 0.7
    log = 0.0
    for n in range(steps):
        q = (1.0 - k) * m + k * (-u + (1.0 - p) * last)
        m, u, last = (1.0 - beta) * m + beta * q, u + p * q, q
        size = np.sqrt(m * m + u * u + last * last)
        if n >= steps // 2:  # by then the largest root is alone
            log += np.log(size)
        m, u, last = m / size, u / size, last / size
    return np.exp(log / (steps - steps // 2))


def largest(a_max, beta, iterations):
    return max(abs(roots(a, p, beta, iterations)).max()
               for a in np.linspace(0.02, a_max, 50) for p in np.linspace(0.02, 1.0, 50))


for a, p, beta in ((0.5, 0.3, 0.2), (0.9, 0.1, 0.2), (1.4, 0.2, 0.3), (0.3, 0.8, 0.0)):
    want = abs(roots(a, p, beta, 1)).max()
    assert abs(growth_of_recursion(a, p, beta, 1) - want) < 1e-3, (a, p, beta)

limits = (0.5, 1.0, 1.2, 1.5, 2.0)
print("iterations,beta," + ",".join("a_max %g" % a for a in limits))
for iterations in (1, 2, 3):
    for beta in (0.0, 0.05, 0.2, 0.3, 0.5, 1.0):
        row = ["%.4f" % largest(a, beta, iterations) for a in limits]
        print("%d,%g," % (iterations, beta) + ",".join(row))
