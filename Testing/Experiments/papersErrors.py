# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What Documentation/papers.md says of the papers' errors, each computed from what is printed there.

Needs nothing but Python: `python3 Testing/Experiments/papersErrors.py`. Stops at the first figure that is not so.
"""
import glob
import itertools
import math
import os
import random
import re


def check(what, condition, figure=""):
    print(("%s: %s" % (what, figure)).rstrip(": "))
    if not condition:
        raise SystemExit("not so: " + what)


def quintic(t):
    t = min(abs(t), 1.0)
    return 1.0 - ((6.0 * t - 15.0) * t + 10.0) * t * t * t


def cubic(t):
    t = min(abs(t), 1.0)
    return 1.0 - (3.0 - 2.0 * t) * t * t


# ---- Rice ----------------------------------------------------------------------------------------
def text_range(quality):
    return -(quality - 1), quality


def code_range(quality):
    return -quality, quality + 1


check("Rice: the text's loop at Quality 0 has no corner", len(range(text_range(0)[0], text_range(0)[1] + 1)) == 0)
check("Rice: the text's Quality q is the code's q - 1",
      all(text_range(q + 1) == code_range(q) for q in range(9)))


def unit(angle):
    return math.cos(angle), math.sin(angle)


def rice_metric(angle, k=0.5, trace=4.0):
    ux, uy = unit(angle)
    b = trace - k - 1e-4
    return b + (k - b) * ux * ux, (k - b) * ux * uy, b + (k - b) * uy * uy


def form(G, x, y):
    return G[0] * x * x + 2.0 * G[1] * x * y + G[2] * y * y


# Listing 5.2 with its return where it is printed: after the inner loop.
def listing(p, G, returns_early):
    base = math.floor(p[0]), math.floor(p[1])
    f = p[0] - base[0], p[1] - base[1]
    total = 0.0
    for i in (0, 1):
        for j in (0, 1):
            angle = random.Random(1000 * (base[0] + i) + base[1] + j).uniform(0.0, 2.0 * math.pi)
            r = unit(angle)
            v = i - f[0], j - f[1]
            Gv = G[0] * v[0] + G[1] * v[1], G[1] * v[0] + G[2] * v[1]
            total += (r[0] * Gv[0] + r[1] * Gv[1]) * quintic(v[0]) * quintic(v[1]) * quintic(form(G, *v))
        if returns_early:
            return total
    return total


G = rice_metric(0.4)
steps = [abs(listing((1.0 - 1e-9, 0.3 + 0.01 * n), G, early) - listing((1.0 + 1e-9, 0.3 + 0.01 * n), G, early))
         for early in (True, False) for n in range(20)]
check("Rice: 5.2 as printed jumps where cells meet", max(steps[:20]) > 0.1 and max(steps[20:]) < 1e-6,
      "by %.2f, with the return behind both loops by %.0e" % (max(steps[:20]), max(steps[20:])))

# Algorithm 1: corners count from the origin, the place from its cell.
lowest = min(math.hypot(X + i - 0.5, Y + j - 0.5) for X in (5, 9) for Y in (3, 7) for i in (0, 1) for j in (0, 1))
check("Rice: Algorithm 1's offsets away from the first cell are longer than a cell", lowest > 1.0,
      "at least %.1f cells in cells 5 and 9 of row 3 and 7, so all weights are 0" % lowest)

# The proof takes Q(+-.5, +-.5) for (+-.5, +-.5).
turned = [form(rice_metric(0.25 * math.pi), 0.5 * a, 0.5 * b) for a in (-1, 1) for b in (-1, 1)]
check("Rice: x'Gx at the middle is not tr/4 for each corner", max(turned) > 1.5 and min(turned) < 0.3,
      "%.2f and %.2f of a metric with trace 4, along the diagonal" % (min(turned), max(turned)))
worst = 0.0
mean_error = 0.0
for a in range(60):
    G = rice_metric(math.pi * a / 60)
    for x, y in itertools.product([n / 30.0 for n in range(1, 30)], repeat=2):
        forms = [(wx * wy, form(G, x - i, y - j)) for i, wx in ((0, 1 - x), (1, x)) for j, wy in ((0, 1 - y), (1, y))]
        worst = max(worst, min(q for _, q in forms))
        mean_error = max(mean_error, abs(sum(w * q for w, q in forms) - (G[0] * x * (1 - x) + G[2] * y * (1 - y))))
check("Rice: what it proves is true all the same", worst < 1.0 and mean_error < 1e-12,
      "the least x'Gx of the corners is at most %.3f; their bilinear mean is sum G_ii p_i (1 - p_i) <= tr/4" % worst)

# ---- Kensler -------------------------------------------------------------------------------------
perm = list(range(256))
random.Random(1).shuffle(perm)
for columns, rows in ((4, 8), (8, 4), (16, 16)):
    hashes = {perm[(perm[(x % columns + columns) % columns] + (y % rows + rows)) % rows]
              for x in range(-50, 50) for y in range(-50, 50)}
    if (columns, rows) == (4, 8):
        check("Kensler: a tile of 4 x 8 has few gradients", len(hashes) <= 8, "%d of 256" % len(hashes))
check("Kensler: the quintic line as printed is 0 at the middle and 1 at the border",
      [((6 * t - 15) * t + 10) * t ** 3 for t in (0.0, 1.0)] == [0.0, 1.0])
tables = [(random.Random(3).random(), n) for n in range(256)]  # jitter, gradient, by one hash
check("Kensler: with one hash a jitter tells the gradient", len(set(tables)) == 256, "256 pairs of 65536")
# The simplicial loop looks at 9 corners of the rounded cell.
missed = 0.0
for n in range(200):
    for m in range(200):
        x, y = n / 100.0, m / 100.0
        cx, cy = round(x * 2.0 / math.sqrt(3.0)), round(y + x / math.sqrt(3.0))
        for gx in range(cx - 3, cx + 4):
            for gy in range(cy - 3, cy + 4):
                if abs(gx - cx) > 1 or abs(gy - cy) > 1:
                    dx, dy = x - gx * math.sqrt(3.0) * 0.5, y - (gy - gx * 0.5)
                    missed = max(missed, cubic(dx) * cubic(dy) * math.hypot(dx, dy))
check("Kensler: the simplicial loop misses corners of a separable surflet", missed > 5e-5, "up to %.5f" % missed)


# ---- Goldberg, Zwicker, Durand ---------------------------------------------------------------------
def alpha(K, exponent):
    return 2.0 ** exponent * math.factorial(K - 1) / math.sqrt(K * math.factorial(2 * (K - 1)))


def angular(i, K, theta):
    return alpha(K, K - 1) ** 2 * math.cos(theta - math.pi * i / K) ** (2 * (K - 1))


def solve(A, b):
    n = len(b)
    rows = [list(A[i]) + [b[i]] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(n):
            if r != i:
                factor = rows[r][i] / rows[i][i]
                rows[r] = [a - factor * c for a, c in zip(rows[r], rows[i])]
    return [rows[i][n] / rows[i][i] for i in range(n)]


thetas = [2.0 * math.pi * n / 360 for n in range(360)]
for K, printed in ((3, 0.328), (4, 0.29), (6, 0.16), (8, 0.09)):
    check("Goldberg: with 2^(K-1) the %d filters add up to 1" % K,
          max(abs(sum(angular(i, K, t) for i in range(K)) - 1.0) for t in thetas) < 1e-12)
    check("Goldberg: with 2^(i-1) they don't",
          max(abs(sum((alpha(K, i - 1) / alpha(K, K - 1)) ** 2 * angular(i, K, t) for i in range(K)) - 1.0)
              for t in thetas) > 0.5)
    basis = [[angular(i, K, t) for t in thetas] for i in range(K)]
    midway = [angular(0.5, K, t) for t in thetas]
    gram = [[sum(a * b for a, b in zip(p, q)) for q in basis] for p in basis]
    weights = solve(gram, [sum(a * b for a, b in zip(p, midway)) for p in basis])
    residual = [m - sum(w * p[n] for w, p in zip(weights, basis)) for n, m in enumerate(midway)]
    error = math.sqrt(sum(r * r for r in residual) / sum(m * m for m in midway))
    check("Goldberg: the squared filters are not steerable, K = %d" % K, abs(error - printed) < 0.005,
          "midway error %.3f" % error)

for sigma in (0.5, 1.0, 2.0):
    step = 0.05 * sigma
    grid = [step * n for n in range(-160, 161)]
    one = sum(math.exp(-x * x / (2 * sigma * sigma)) for x in grid) * step
    check("Goldberg: integral of the Gaussian as printed, sigma %.1f" % sigma,
          abs(one * one / (math.sqrt(2 * math.pi) * sigma) - math.sqrt(2 * math.pi) * sigma) < 1e-9,
          "%.3f, where equation 4 at frequency 0 is 1" % (one * one / (math.sqrt(2 * math.pi) * sigma)))


def ring(r):  # a target spectrum around radius 1
    return math.exp(-8.0 * math.log(r) ** 2) if r > 0.0 else 0.0


def power(scale, factor):  # of factor * E(T^T k), T = scale I
    rs = [0.002 * n for n in range(1, 4000)]
    return sum(2 * math.pi * r * (factor * ring(scale * r)) ** 2 * 0.002 for r in rs)


det = 2.0 ** 2
check("Goldberg: with sqrt|T^-1| the variance at T = 2I is 1/16",
      abs(power(2.0, det ** -0.5) / power(1.0, 1.0) - 1.0 / 16.0) < 1e-3)
check("Goldberg: with sqrt|T| it stays", abs(power(2.0, det ** 0.5) / power(1.0, 1.0) - 1.0) < 1e-2)
# H(2^j r): larger j is coarser, so an octave finer takes the weights of j + 1; and white noise's power in a ring
# grows with its area.
check("Goldberg: H(2^j r) has its centre at r0 2^-j",
      max(range(1, 400), key=lambda n: math.cos(math.pi / 2 * math.log2(2 * (0.01 * n) * 2 / math.pi)) ** 2
          if math.pi / 4 < 0.01 * n * 2 < math.pi else 0.0) in (78, 79), "j = 1: pi/4")
check("Goldberg: the same weights an octave finer have 4 times the variance",
      abs(power(0.5, 1.0) / power(1.0, 1.0) - 4.0) < 0.05)

# ---- the lecture -----------------------------------------------------------------------------------
p, base = 255.25, 255
apex = (base + 1) % 256
check("Lecture: in the last cell the offset from the apex", p - apex == 255.25 and p - (base + 1) == -0.75,
      "%.2f cells instead of %.2f" % (p - apex, p - (base + 1)))
check("Lecture: and base is not wrapped at all", math.floor(256.5) == 256, "row 256 of a table of 256")

# ---- the page itself -------------------------------------------------------------------------------
project = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
with open(os.path.join(project, "Documentation", "papers.md")) as page:
    named = set(re.findall(r"`([A-Z][A-Za-z]+\.[A-Z][A-Za-z]+)`", page.read())) - {"Experiments.PapersErrors", "Plugin.Recipes"}
tests = set()
for path in glob.glob(os.path.join(project, "Testing", "*", "Test*.cxx")):
    with open(path) as source:
        tests |= {"%s.%s" % pair for pair in re.findall(r"^TEST(?:_[FP])?\((\w+), (\w+)\)", source.read(), re.M)}
check("papers.md: tests that it names exist", len(named) > 30 and named <= tests, "%d; missing: %s" % (len(named), sorted(named - tests)))
