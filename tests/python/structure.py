"""Stepwise regression and orthogonal functions of tests/numbers/structure.rs by numpy alone, for its reference numbers."""

import numpy as np

N = 60
k = np.arange(N, dtype=float)
X = {
    "a": np.sin(0.37 * k),
    "b": np.sin(0.37 * k + 0.4) + 0.1 * np.cos(1.3 * k),
    "c": np.cos(0.11 * k * k),
    "d": (0.05 * k) ** 2 - 3.0,
}
noise = 0.3 * np.fmod(np.sin(k * 12.9898) * 43758.547, 1.0)
z = 2.0 * X["a"] - 0.7 * X["c"] + noise + 0.4
total = ((z - z.mean()) ** 2).sum()


def design(terms):
    return np.column_stack([np.ones(N)] + [X[t] for t in terms])


def squares(terms, rows=slice(None)):
    A = design(terms)[rows]
    return ((z[rows] - A @ np.linalg.lstsq(A, z[rows], rcond=None)[0]) ** 2).sum()


def press(terms):
    A = design(terms)
    out = 0.0
    for i in range(N):
        keep = np.arange(N) != i
        out += (z[i] - A[i] @ np.linalg.lstsq(A[keep], z[keep], rcond=None)[0]) ** 2
    return out


def pse(terms):
    return squares(terms) / N + total / N * (len(terms) + 1) / N


def partial_f(terms, one):
    rest = [t for t in terms if t != one]
    s2 = squares(terms) / (N - len(terms) - 1)
    return (squares(rest) - squares(terms)) / s2


chosen, steps = [], []
while True:
    outside = [t for t in X if t not in chosen]
    if not outside:
        break
    best = max(outside, key=lambda t: partial_f(chosen + [t], t))
    f = partial_f(chosen + [best], best)
    if f < 4.0:
        break
    chosen.append(best)
    steps.append((best, f, 1 - squares(chosen) / total, pse(chosen), press(chosen)))
    while True:
        worst = min(chosen, key=lambda t: partial_f(chosen, t))
        f = partial_f(chosen, worst)
        if f >= 4.0:
            break
        chosen.remove(worst)
        steps.append((worst, f, 1 - squares(chosen) / total, pse(chosen), press(chosen)))

order, pses = [], [pse([])]
while len(order) < len(X):
    best = min((t for t in X if t not in order), key=lambda t: squares(order + [t]))
    order.append(best)
    pses.append(pse(order))

print("// made by tests/python/structure.py")
print(f"const STEPS: [(&str, f64, f64, f64, f64); {len(steps)}] = [")
for s in steps:
    print("    (" + ", ".join([f'"{s[0]}"'] + [repr(float(v)) for v in s[1:]]) + "),")
print("];")
print("const ORDER: [&str; 4] = [" + ", ".join(f'"{t}"' for t in order) + "];")
print("const ORDER_PSE: [f64; 5] = [" + ", ".join(repr(float(v)) for v in pses) + "];")
print(f"const KEPT: usize = {int(np.argmin(pses))};")
