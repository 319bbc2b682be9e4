"""Recursive estimators on data/elevator.csv by numpy and scipy alone, for the reference numbers of tests/numbers/recursive/independent.rs. Nothing
here is recursive but the filter: least squares are solved anew from all rows and their weights. Run from the top of the repository."""

import csv

import numpy as np
from scipy.linalg import lstsq
from scipy.signal import savgol_filter

rows = list(csv.reader(open("data/elevator.csv")))
data = np.array([[float(x) for x in row] for row in rows[1:]])
deg, h = np.pi / 180, 0.04
t, de, alpha, q = data[:, 0], data[:, 1] * deg, data[:, 2] * deg, data[:, 3] * deg
names = ["Za", "Zq", "Zde", "Ma", "Mq", "Mde"]


def show(title, values, errors):
    print(title)
    for row in (values, errors):
        print("    [" + ", ".join(f"{x:.12e}" for x in row) + "],")


# least squares: scipy's Savitzky-Golay filter, which at both ends leans on the first and last window
half = 4
smooth = lambda x, d=0: savgol_filter(x, 2 * half + 1, 3, deriv=d, delta=h, mode="interp")


def weighted(forgetting, upto=None):
    count = len(t) if upto is None else upto
    age = np.arange(count)[::-1]
    w = forgetting**age
    values, errors = [], []
    numbers = 2 * w.sum() ** 2 / (w**2).sum()
    for y in (smooth(alpha, 1), smooth(q, 1)):
        X = np.column_stack([smooth(alpha), smooth(q), smooth(de), np.ones(len(t))])[:count]
        y = y[:count]
        theta = lstsq(X * np.sqrt(w)[:, None], y * np.sqrt(w))[0]
        e = y - X @ theta
        lags = 2 * (2 * half + 1)
        middle = np.zeros((4, 4))
        for lag in range(lags + 1):
            ww = (w[lag:] * w[: count - lag])[:, None]
            S = (X[lag:] * ww).T @ X[: count - lag]
            r = (ww[:, 0] * e[lag:] * e[: count - lag]).sum() / (w**2).sum()
            middle += r * (S if lag == 0 else (1 - lag / (lags + 1)) * (S + S.T))
        inverse = np.linalg.inv((X * w[:, None]).T @ X)
        cov = inverse @ middle @ inverse * numbers / (numbers - 8)
        values += list(theta[:3])
        errors += list(np.sqrt(np.diag(cov))[:3])
    return values, errors


show("rls, 1", *weighted(1.0))
show("rls, 0.99", *weighted(0.99))
# after 400 samples the last middle is the 396th; the smoothed values before it do not change any more
show("rls, 0.99, after 400", *weighted(0.99, 396))

# Fourier regression: Gauss-Legendre quadrature of the interpolated signals, each instant with the weight that is left of it
gx, gw = np.polynomial.legendre.leggauss(12)
gx, gw = (gx + 1) / 2, gw / 2
f = 0.1 + 0.04 * np.arange(36)
om = 2 * np.pi * f


def lagrange(nodes, x):
    return np.array(
        [np.prod([(x - nodes[m]) / (nodes[j] - nodes[m]) for m in range(4) if m != j], axis=0) for j in range(4)]
    )


def transform(x, kind, a):
    N = len(x)
    T = (N - 1) * h
    out = np.zeros(len(om), complex)
    for j in range(N - 1):
        if kind == "cubic":
            s = min(max(j - 1, 0), N - 4)
            v = lagrange(np.arange(4.0), gx + (j - s)).T @ x[s : s + 4]
        else:
            v = x[j] * (1 - gx) + x[j + 1] * gx
        tt = (j + gx) * h
        out += (np.exp(-1j * np.outer(om, tt)) * (np.exp(-a * (T - tt)) * v * gw * h)).sum(1)
    return out


def fourier(forgetting):
    a = -np.log(forgetting) / h
    T = t[-1]
    w = forgetting ** np.arange(len(t))
    duration = (w.sum() ** 2 / (w**2).sum() - 1) * h
    share = min(1.0, 0.04 * duration)
    states = [transform(x - x[0], "cubic", a) for x in (alpha, q)]
    U = transform(de - de[0], "line", a)
    one, line = transform(np.ones(len(t)), "line", a), transform(t - t[0], "line", a)
    end = np.exp(-1j * om * T)
    first = np.full(len(om), np.exp(-a * T), complex)
    values, errors = [], []
    for X in states:
        y = (1j * om - a) * X
        A = np.array(states + [U, first, end, one, line]).T
        A, y = np.vstack([A.real, A.imag]), np.concatenate([y.real, y.imag])
        # with 0.04 Hz and 25 s both ends are the same but for the sign
        scale = np.linalg.norm(A, axis=0)
        theta = lstsq(A / scale, y, cond=1e-10)[0]
        e = y - A / scale @ theta
        s2 = e @ e / len(y)
        numbers = 2 * len(y) * share
        used = 2 * np.linalg.matrix_rank(A / scale, tol=1e-8)
        cov = np.linalg.pinv((A / scale).T @ (A / scale), rcond=1e-13) * s2 / share * numbers / (numbers - used)
        values += list((theta / scale)[:3])
        errors += list((np.sqrt(np.diag(cov)) / scale)[:3])
    return values, errors


show("rft, 1", *fourier(1.0))
show("rft, 0.998", *fourier(0.998))


# extended Kalman filter: all of it dense, the step's derivative by complex steps through the integrator
def f_of(z, u):
    al, qq, Za, Zq, Zde, Ma, Mq, Mde, a_eq, d_eq, _ = z
    return np.array(
        [Za * (al - a_eq) + Zq * qq + Zde * (u - d_eq), Ma * (al - a_eq) + Mq * qq + Mde * (u - d_eq)] + [0 * al] * 9
    )


def step(z, u0, u1):
    um = (u0 + u1) / 2
    k1 = f_of(z, u0)
    k2 = f_of(z + h / 2 * k1, um)
    k3 = f_of(z + h / 2 * k2, um)
    k4 = f_of(z + h * k3, u1)
    return z + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def kalman(forgetting, drift):
    z = np.array([0.06, 0, -1.0, 1.0, -0.1, -1.0, -1.0, -1.0, 0.06, -0.02, 0.0])
    sd = np.array([0, 0, 1.0, 1.0, 0.1, 1.0, 1.0, 1.0, 0.06, 0.02, 0.005])
    P = np.diag(sd**2)
    H = np.zeros((2, 11))
    H[0, 0] = H[1, 1] = H[1, 10] = 1
    R = np.diag([(0.05 * deg) ** 2, (0.08 * deg) ** 2])
    Q = np.zeros((11, 11))
    Q[5, 5] = drift**2 * h
    for k in range(len(t)):
        if k > 0:
            Phi = np.zeros((11, 11))
            for i in range(11):
                zc = z.astype(complex)
                zc[i] += 1e-30j
                Phi[:, i] = step(zc, de[k - 1], de[k]).imag / 1e-30
            z = step(z, de[k - 1], de[k])
            P = Phi @ P @ Phi.T / forgetting + Q
        S = H @ P @ H.T + R
        K = P @ H.T @ np.linalg.inv(S)
        z = z + K @ (np.array([alpha[k], q[k]]) - H @ z)
        I = np.eye(11) - K @ H
        P = I @ P @ I.T + K @ R @ K.T
    return z[2:8], np.sqrt(np.diag(P))[2:8]


show("ekf", *kalman(1.0, 0.0))
show("ekf, 0.998, drift of Ma 0.1", *kalman(0.998, 0.1))
