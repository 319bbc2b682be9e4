"""Cramér-Rao bounds, orthogonality and peak factors by numpy alone, for the reference numbers of tests/numbers/design.rs: the short period of
data/design/short-period.toml with a 3-2-1-1, its sensitivities by central differences of a fine Runge-Kutta integration.
Run from the top of the repository."""
import numpy as np

STEP, DURATION, FINE = 0.04, 20.0, 40
TRUTH = dict(Za=-0.85, Zq=0.97, Zde=-0.08, Ma=-3.4, Mq=-1.6, Mde=-4.8, alpha_eq=0.06, de_eq=-0.02, q_bias=0.0, alpha_0=0.06)
NOISE = np.radians([0.05, 0.08])
UNIT, AMPLITUDE, START = 0.8, np.radians(2.0), 1.0


def elevator(t):
    edges = START + UNIT * np.cumsum([0, 3, 2, 1, 1])
    for level, first, last in zip([1, -1, 1, -1], edges, edges[1:]):
        if first <= t + 1e-9 < last:
            return level * AMPLITUDE
    return 0.0


samples = int(round(DURATION / STEP)) + 1
de = np.array([elevator(k * STEP) for k in range(samples)]) - 0.02


def outputs(p):
    a = np.array([[p["Za"], p["Zq"]], [p["Ma"], p["Mq"]]])
    b = np.array([p["Zde"], p["Mde"]])
    slope = lambda x, u: a @ (x - [p["alpha_eq"], 0.0]) + b * (u - p["de_eq"])
    x, h, y = np.array([p["alpha_0"], 0.0]), STEP / FINE, []
    for k in range(samples):
        y.append([x[0], x[1] + p["q_bias"]])
        if k + 1 == samples:
            break
        for i in range(FINE):
            u0, u1 = (de[k] + (de[k + 1] - de[k]) * (i + s) / FINE for s in (0, 1))
            um = 0.5 * (u0 + u1)
            k1 = slope(x, u0)
            k2 = slope(x + h / 2 * k1, um)
            k3 = slope(x + h / 2 * k2, um)
            k4 = slope(x + h * k3, u1)
            x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.array(y)


# the model holds the initial angle of attack
FREE = [name for name in TRUTH if name != "alpha_0"]
columns = []
for name in FREE:
    value = TRUTH[name]
    step = 1e-5 * max(abs(value), 0.01)
    above, below = (outputs({**TRUTH, name: value + s * step}) for s in (1, -1))
    columns.append(((above - below) / (2 * step) / NOISE).ravel())
information = np.array(columns) @ np.array(columns).T
size = np.sqrt(np.diag(information))
covariance = np.linalg.inv(information / np.outer(size, size)) / np.outer(size, size)
for name, error in zip(FREE, np.sqrt(np.diag(covariance))):
    print(f'("{name}", {error:.6e}),')
