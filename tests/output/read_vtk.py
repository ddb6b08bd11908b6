# SPDX-License-Identifier: BSD-3-Clause
"""read_vtk.py FOLDER: reads the VTK files of write_frames with VTK itself."""

import json
import os
import sys
import xml.etree.ElementTree as xml

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader


def read(path, reader=vtkXMLPolyDataReader):
    source = reader()
    failures = []
    source.AddObserver("ErrorEvent", lambda *_: failures.append(path))
    source.SetFileName(path)
    source.Update()
    assert not failures, path
    return source.GetOutput()


def tuples(array):
    assert array is not None
    return [list(array.GetTuple(k)) for k in range(array.GetNumberOfTuples())]


def corners(cell):
    return [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]


def three(v):
    return [0.0, 0.0] + v if len(v) == 1 else (v + [0.0])[:3]


def check_particles(path, expected):
    data = read(path)
    assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == len(expected)
    fields = {name: tuples(data.GetPointData().GetArray(name))
              for name in ("radius", "material", "mass", "velocity", "spin", "orientation")}
    for k, particle in enumerate(expected):
        assert list(data.GetPoint(k)) == three(particle["position"])
        for name in ("radius", "material", "mass"):
            assert fields[name][k] == [particle[name]], name
        assert fields["velocity"][k] == three(particle["velocity"])
        assert fields["spin"][k] == three(particle["spin"])
        assert abs(sum(q * q for q in fields["orientation"][k]) - 1) < 1e-12
        if len(particle["orientation"]) == 4:
            w, x, y, z = particle["orientation"]
            assert fields["orientation"][k] == [x, y, z, w]


def check_pores(data, expected):
    assert data.GetNumberOfCells() == len(expected) > 0
    pressure, volume = (tuples(data.GetCellData().GetArray(name)) for name in ("pressure", "volume"))
    for k, (who, p, v) in enumerate(expected):
        assert corners(data.GetCell(k)) == who and pressure[k] == [p] and volume[k] == [v]
    assert any(p[0] != 0 for p in pressure)


folder = sys.argv[1]
with open(os.path.join(folder, "expected.json"), encoding="ascii") as file:
    expected = json.load(file)
sheet = expected["sheet"]
last = sheet["names"][-1]
sizes = {}
for storage in ("raw", "packed"):
    prefix = os.path.join(folder, storage)
    check_particles(f"{prefix}-particles-{last}.vtp", sheet["particles"])

    bonds = read(f"{prefix}-bonds-{last}.vtp")
    assert bonds.GetNumberOfLines() == len(sheet["bonds"])
    mode = tuples(bonds.GetCellData().GetArray("mode"))
    for k, (first, second, state) in enumerate(sheet["bonds"]):
        assert corners(bonds.GetCell(k)) == [first, second] and mode[k] == [state]
    assert any(m == [1] for m in mode) and any(m == [0] for m in mode)

    check_pores(read(f"{prefix}-pores-{last}.vtp"), sheet["pores"])

    for what in ("particles", "bonds", "pores"):
        frames = xml.parse(f"{prefix}-{what}.pvd").getroot().find("Collection").findall("DataSet")
        assert [float(f.get("timestep")) for f in frames] == sheet["times"]
        assert [f.get("file") for f in frames] == [f"{storage}-{what}-{name}.vtp" for name in sheet["names"]]
        assert all(read(os.path.join(folder, f.get("file"))).GetNumberOfPoints() == len(sheet["particles"]) for f in frames)
    sizes[storage] = sum(os.path.getsize(os.path.join(folder, f)) for f in os.listdir(folder) if f.startswith(storage))
assert sizes["packed"] < sizes["raw"]

space = expected["space"]
check_particles(os.path.join(folder, f"space-particles-{space['step']:012d}.vtp"), space["particles"])
assert len(space["pores"]) == 2
solid_pores = read(os.path.join(folder, f"space-pores-{space['step']:012d}.vtu"), vtkXMLUnstructuredGridReader)
assert all(solid_pores.GetCellType(k) == 10 for k in range(2))
check_pores(solid_pores, space["pores"])

odd = sorted(f for f in os.listdir(folder) if f.startswith("points-"))
assert len(odd) == 4
for name in odd:
    count = int(name[7:-4])
    data = read(os.path.join(folder, name))
    assert data.GetNumberOfPoints() == count
    array = data.GetPointData().GetArray("number")
    for k in {0, count // 3, count - 1} if count else ():
        assert data.GetPoint(k) == (k, 0.5 * k, -1.0) and array.GetValue(k) == k * k

solid = read(os.path.join(folder, "solid.vtu"), vtkXMLUnstructuredGridReader)
assert solid.GetNumberOfCells() == 1 and solid.GetCellType(0) == 10 and corners(solid.GetCell(0)) == [0, 1, 2, 3]
assert solid.GetCellData().GetArray("pressure").GetValue(0) == 7
print("all files agree; bytes:", sizes)
