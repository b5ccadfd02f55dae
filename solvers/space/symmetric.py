"""Symmetric matrices of lanes of numbers, as lists of their entries on and above the diagonal, row by row."""

import taichi as ti

STEPS = 5  # of Newton's method for an eigenvalue in space
FAINT = 1e-12  # of squares of eigenvalues near 1: below, all are the same, in 32 bits, too


@ti.func
def least_eigenvalue(m: ti.template()):
    """The smallest eigenvalue: in the plane by the quadratic formula, in space by Newton's method.

    With q = tr/3 and p² = tr (M − q)²/6 the eigenvalues are q + p x, where x³ − 3 x = det((M − q)/p) (Smith 1961,
    Commun. ACM 4, 168). The smallest has x from −2 to −1. From −2 on Newton's method comes nearer from below alone; its
    error is at most 0.04 p, where the two smallest are the same, and elsewhere far less (own trial, STEPS 5).
    """
    if ti.static(len(m) == 3):
        middle, apart = 0.5 * (m[0] + m[2]), 0.5 * (m[0] - m[2])
        return middle - ti.sqrt(apart * apart + m[1] * m[1])
    else:
        q = (m[0] + m[3] + m[5]) * (1.0 / 3.0)
        a, b, c = m[0] - q, m[3] - q, m[5] - q
        aside = m[1] * m[1] + m[2] * m[2] + m[4] * m[4]
        p = ti.sqrt((a * a + b * b + c * c + 2.0 * aside) * (1.0 / 6.0) + FAINT)
        determinant = a * (b * c - m[4] * m[4]) - m[1] * (m[1] * c - m[4] * m[2]) + m[2] * (m[1] * m[4] - b * m[2])
        sought = ti.max(ti.min(determinant / (p * p * p), 2.0), -2.0)
        x = 0.0 * q - 2.0
        for _ in ti.static(range(STEPS)):
            x = x - (x * x * x - 3.0 * x - sought) / ti.max(3.0 * x * x - 3.0, 1e-3)
        return q + p * x


@ti.func
def solved(m: ti.template(), right: ti.template()):
    """The determinant D, and D M⁻¹ times a vector (a list), by cofactors."""
    if ti.static(len(m) == 3):
        return [m[2] * right[0] - m[1] * right[1], m[0] * right[1] - m[1] * right[0]], m[0] * m[2] - m[1] * m[1]
    else:
        xx, xy, xz = m[3] * m[5] - m[4] * m[4], m[2] * m[4] - m[1] * m[5], m[1] * m[4] - m[2] * m[3]
        yy, yz, zz = m[0] * m[5] - m[2] * m[2], m[1] * m[2] - m[0] * m[4], m[0] * m[3] - m[1] * m[1]
        found = [
            xx * right[0] + xy * right[1] + xz * right[2],
            xy * right[0] + yy * right[1] + yz * right[2],
            xz * right[0] + yz * right[1] + zz * right[2],
        ]
        return found, m[0] * xx + m[1] * xy + m[2] * xz
