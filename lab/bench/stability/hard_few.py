"""Hard cases that have closed forms."""

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from lab.bench.stability.beds import ACETATE, G, tank
from lab.bench.stability.case import Case, Check, Measure
from lab.bench.stability.trial import Course, Trial
from solvers.materials import hertz_stiffness
from solvers.scene import Scene

R = 1.5e-3  # m


def one_grain(fast):
    outline = tank(0.02, 0.08)
    return Trial(Scene([R], outline, ACETATE, ACETATE), np.array([[0.0, R + 0.05]]), 0.16, looks=400)


def corner(fast):
    a = np.radians(15.0)
    h = 0.03
    outline = np.array([[0, 0], [h * np.tan(a), h], [-h * np.tan(a), h]])
    z = R / np.sin(a)
    return Trial(Scene([R], outline, ACETATE, ACETATE), np.array([[0.0, z + 0.5 * R]]), 0.1)


def wedged(fast):
    outline = tank(2 * R * 0.999, 0.05)
    return Trial(Scene([R], outline, ACETATE, ACETATE), np.array([[0.0, 0.03]]), 0.05)


def column(fast):
    r = 15e-3
    n = 100
    outline = tank(2 * r * 1.0001, 3.2)
    return Trial(
        Scene(np.full(n, r), outline, ACETATE, ACETATE),
        np.column_stack([np.zeros(n), r * (1 + 2 * np.arange(n))]),
        60.0,
    )


def gas(fast, n=400, v=5.0, phi=0.1, seed=1, e=0.9):
    random = np.random.default_rng(seed)
    L = np.sqrt(n * np.pi * R * R / phi)
    k = int(np.ceil(np.sqrt(n)))
    x = (np.arange(k) + 0.5) / k * (L - 2 * R) + R
    y, z = (a.ravel()[:n] for a in np.meshgrid(x - L / 2, x))
    vel = random.normal(0, v, (1, n, 2))
    vel -= vel.mean(axis=1, keepdims=True)
    g = replace(ACETATE, restitution=e, friction=0.0)
    w = replace(ACETATE, restitution=1.0, friction=0.0)
    fast_ = float(np.linalg.norm(vel, axis=2).max())
    sc = Scene(
        np.full(n, R),
        tank(L, L),
        g,
        w,
        normal="linear",
        tangential="none",
        gravity=0.0,
        velocity=vel,
        spin=np.zeros((1, n)),
        start_speed=fast_,
    )
    area = (L - 2 * R) ** 2
    nd = n / area
    ph = nd * np.pi * R * R
    g0 = (1 - 7 / 16 * ph) / (1 - ph) ** 2
    T = 0.5 * (vel**2).sum() / n
    omega = 2 * np.sqrt(np.pi) * nd * 2 * R * g0 * np.sqrt(T)
    tau = 4 / ((1 - e * e) * omega)
    t = Trial(sc, np.column_stack([y, z]), 5 * tau)
    t.__dict__["tau"] = tau
    return t


def rolling(fast):
    r, big = 0.3e-3, 3e-3
    rough = replace(ACETATE, friction=1.0)
    dome = [[-0.03, 0.004, big]]
    t0 = np.radians(20.0)
    small = [-0.03 + (big + r) * np.sin(t0), 0.004 + (big + r) * np.cos(t0)]
    half = np.arcsin(r / (big + r))
    rows, larges = [], []
    for y, slope in ((-0.005, 4.0), (0.02, 7.0)):
        s = np.radians(slope)
        down = np.array([np.cos(s), -np.sin(s)])
        up = np.array([np.sin(s), np.cos(s)])
        base = np.array([y, 0.006])
        for k in range(25):
            rows.append([*(base + 2 * r * k * down), r])
        larges.append(base + r * down * 9 + (big + r) * np.cos(half) * up)
    outline = tank(0.1, 0.02)
    fixed = np.array(dome + rows)
    return Trial(Scene([r, big, big], outline, rough, rough, fixed=fixed), np.array([small, *larges]), 0.1)


def overlapping(fast):
    random = np.random.default_rng(1)
    n = 100
    w = np.sqrt(n * np.pi * R * R / 1.5)
    return Trial(
        Scene(np.full(n, R), tank(w, 2 * w), ACETATE, ACETATE),
        np.column_stack([random.uniform(-w / 2 + R, w / 2 - R, n), random.uniform(R, w - R, n)]),
        0.1,
    )


def million(fast):
    n = 100000 if fast else 1_000_000
    k = int(np.sqrt(n))
    k = k if k * k == n else 316
    p = 2 * R * (1 - 1e-4)
    c, r_ = (a.ravel() for a in np.meshgrid(np.arange(k), np.arange(k), indexing="ij"))
    w = p * k
    return Trial(
        Scene(np.full(k * k, R), tank(w, w), ACETATE, ACETATE),
        np.column_stack([p * (c + 0.5) - w / 2, p * (r_ + 0.5)]),
        10 * 1.76e-7,
        looks=2,
    )
