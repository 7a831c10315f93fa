#!/usr/bin/env python3
"""Writes map_values.json: what the rules of FLOG.md section 5 make of a cell, in exact fractions.

The formulas stand here once more, each multiplied out by hand for each kind of operators, so that neither the C++ nor
the TypeScript is tested against itself. Run it again after a change of the rules, never to make a test pass.
"""
import json
import pathlib
from fractions import Fraction as F


def algebraic(E, O, K):
    # not(E(1-O) or (1-E)(1-O)) = (1 - E(1-O)) (1 - (1-E)(1-O)), by De Morgan
    M = (1 - E * (1 - O)) * (E + O - E * O) * K
    e, o = E * K, O * K
    # e (1-o) and not I, with not I = e + o - e o
    return M, O * K, 1 - e * (1 - o) * (e + o - e * o)


def minmax(E, O, K):
    M = min(max(1 - E, O), max(E, O), K)
    e, o = E * K, O * K
    return M, min(O, K), max(1 - e, o, 1 - max(e, o))


def lukasiewicz(E, O, K):
    free, unknown = max(F(0), E - O), max(F(0), 1 - E - O)
    M = max(F(0), K - min(F(1), free + unknown))
    e, o = E * K, O * K
    known = 1 - max(F(0), 1 - e - o)
    return M, max(F(0), O + K - 1), 1 - max(F(0), max(F(0), e - o) + known - 1)


steps = [F(0), F(1, 5), F(1, 4), F(1, 2), F(7, 10), F(4, 5), F(1)]
values = []
for name, rule in (("algebraic", algebraic), ("minmax", minmax), ("lukasiewicz", lukasiewicz)):
    for E in steps:
        for O in steps:
            for K in (F(0), F(3, 50), F(1, 5), F(1, 2), F(1)):
                if E + O > 1 or (K == 0 and E + O > 0):  # without rays there is no evidence
                    continue
                M, M_p, M_m = rule(E, O, K)
                row = {"operators": name, "E": E, "O": O, "K": K, "M": M, "M_p": M_p, "M_m": M_m,
                       "conflict": 2 * min(E, O) * K}
                values.append({k: v if isinstance(v, str) else round(float(v), 9) for k, v in row.items()})

text = "[\n" + ",\n".join("  " + json.dumps(row) for row in values) + "\n]\n"
pathlib.Path(__file__).with_name("map_values.json").write_text(text)
