# SPDX-License-Identifier: BSD-3-Clause
"""read_dump.py FOLDER: reads the LAMMPS dump files of write_frames, following the format's documentation."""

import json
import math
import os
import sys


def read(path):
    """Items of one frame: their words, and the rows of ATOMS by column."""
    items, rows = {}, None
    with open(path, encoding="ascii") as file:
        for line in file:
            if line.startswith("ITEM: "):
                words = line[6:].split()
                name = " ".join(w for w in words if w.isupper())
                rows = items.setdefault(name, {"words": [w for w in words if not w.isupper()], "rows": []})["rows"]
            else:
                rows.append(line.split())
    return items


def rotated(quaternion, vector):
    """The vector rotated by a quaternion x, y, z, w."""
    x, y, z, w = quaternion
    u, v = (x, y, z), vector
    cross = lambda a, b: (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    t = [2 * c for c in cross(u, v)]
    s = cross(u, t)
    return [v[k] + w * t[k] + s[k] for k in range(3)]


def check(folder, prefix, expected):
    frame = read(os.path.join(folder, "%s-%012d.dump" % (prefix, expected["step"])))
    assert frame["UNITS"]["rows"] == [["si"]]
    assert int(frame["TIMESTEP"]["rows"][0][0]) == expected["step"]
    assert float(frame["TIME"]["rows"][0][0]) == expected["time"]
    assert int(frame["NUMBER OF ATOMS"]["rows"][0][0]) == len(expected["particles"])
    assert frame["BOX BOUNDS"]["words"] == ["ss", "ss", "ss"]
    columns, rows = frame["ATOMS"]["words"], frame["ATOMS"]["rows"]
    assert len(rows) == len(expected["particles"])
    three = lambda v: ([0.0, 0.0] + v if len(v) == 1 else (v + [0.0])[:3])
    for number, (row, particle) in enumerate(zip(rows, expected["particles"])):
        value = {name: float(word) for name, word in zip(columns, row, strict=True)}
        assert value["id"] == number + 1 and value["type"] == particle["material"] + 1
        assert value["radius"] == particle["radius"] and value["mass"] == particle["mass"]
        assert [value[c] for c in ("x", "y", "z")] == three(particle["position"])
        assert [value[c] for c in ("vx", "vy", "vz")] == three(particle["velocity"])
        assert [value[c] for c in ("omegax", "omegay", "omegaz")] == three(particle["spin"])
        axis_now = rotated([value[c] for c in ("quati", "quatj", "quatk", "quatw")], (1.0, 0.0, 0.0))
        own = particle["orientation"]
        if len(own) == 2:
            wanted = own + [0.0]
        else:
            w, x, y, z = own
            wanted = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
        assert all(math.isclose(a, b, abs_tol=1e-14) for a, b in zip(axis_now, wanted)), (axis_now, wanted)
        for axis in range(3):
            low, high = map(float, frame["BOX BOUNDS"]["rows"][axis])
            assert low <= three(particle["position"])[axis] <= high
    return len(rows)


folder = sys.argv[1]
with open(os.path.join(folder, "expected.json"), encoding="ascii") as file:
    expected = json.load(file)
assert any(p["spin"][0] != 0 for p in expected["sheet"]["particles"])
print(check(folder, "sheet", expected["sheet"]), check(folder, "space", expected["space"]), "particles agree")
