"""Opens a run's frames with the programs that people open them with.

    pip install numpy pyarrow MDAnalysis vtk ovito
    python docs/readers.py target/release/carom

Each reader's last frame is compared with the state file.
"""

import csv
import os
import subprocess
import sys
import tempfile
import warnings

import numpy as np

warnings.filterwarnings("ignore")
os.environ["OVITO_GUI_MODE"] = "0"

SCENE = """
duration = 2.0
seed = 3
surface.kind = "rough"
periodic = { lower = [0, 0, 0], upper = [10, 10, 10] }
[[spheres]]
count = 300
arrangement = "random"
radius = 0.4
temperature = 1.0
[[spheres]]
count = 100
arrangement = "random"
radius = 0.3
mass = 2.0
temperature = 1.0
"""


def turns(quaternions):
    """Rotations, row by row, of quaternions w, x, y, z."""
    w, x, y, z = quaternions.T
    rows = [
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
    ]
    return np.stack(rows, axis=1)


def near(what, found, expected, tolerance):
    off = np.abs(np.asarray(found) - expected).max()
    assert off <= tolerance, f"{what} is off by {off}"
    print(f"{what}: {off:.1e}")


def main(program):
    for ending in ["dump", "xyz", "pvd", "npz", "parquet"]:
        frames = ["--record", f"run.{ending}", "--record-every", "0.5", "--state", "end.csv"]
        subprocess.run([program, "run", "scene.toml", *frames], check=True, capture_output=True)
    with open("end.csv") as file:
        rows = list(csv.DictReader(file))
    column = lambda *names: np.array([[float(row[name]) for name in names] for row in rows])
    place, velocity = column("x", "y", "z"), column("vx", "vy", "vz")
    axes = column(*[f"m{i}{j}" for i in range(3) for j in range(3)])

    arrays = np.load("run.npz")
    assert list(arrays["time"]) == [0, 0.5, 1, 1.5, 2]
    last = lambda *names: np.stack([arrays[name][-1] for name in names], axis=1)
    near("NumPy, places", last("x", "y", "z"), place, 0)
    near("NumPy, orientations", turns(last("qw", "qx", "qy", "qz")), axes, 1e-14)
    unwrapped = place + 10 * last("ix", "iy", "iz")

    import pyarrow.parquet

    table = pyarrow.parquet.read_table("run.parquet")
    assert table.column_names[:3] == ["step", "time", "id"] and table.num_rows == 5 * 400
    assert table.schema.metadata[b"upper"] == b"10.0 10.0 10.0"
    for name in table.column_names[3:]:
        column = table[name].to_numpy()
        assert column.dtype == arrays[name].dtype
        near(f"Arrow, {name}", column, arrays[name].ravel(), 0)

    for ending in ["csv", "npz"]:
        events = [program, "run", "scene.toml", "--events", f"events.{ending}"]
        subprocess.run(events, check=True, capture_output=True)
    with open("events.csv") as file:
        collisions = list(csv.DictReader(file))
    events = np.load("events.npz")
    assert set(events) == set(collisions[0])
    for name, array in events.items():
        empty = -1 if array.dtype.kind == "i" else np.nan
        text = [float(row[name]) if row[name] else empty for row in collisions]
        assert np.array_equal(array, text, equal_nan=True), name
    print(f"NumPy, events: {len(collisions)} in {len(events)} arrays")

    import MDAnalysis

    kind = dict(format="LAMMPSDUMP", topology_format="LAMMPSDUMP")
    for name, options, expected in [
        ("run.dump", kind, place),
        ("run.dump", dict(unwrap_images=True, **kind), unwrapped),
        ("run.xyz", {}, place),
    ]:
        world = MDAnalysis.Universe(name, **options)
        assert len(world.trajectory) == 5
        world.trajectory[-1]
        near(f"MDAnalysis, {name}", world.atoms.positions, expected, 1e-5)

    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName("run_000004.vtp")
    reader.Update()
    points = reader.GetOutput()
    assert points.GetNumberOfVerts() == 400
    data = points.GetPointData()
    near("VTK, places", vtk_to_numpy(points.GetPoints().GetData()), place, 0)
    near("VTK, velocities", vtk_to_numpy(data.GetArray("v")), velocity, 0)

    from ovito.io import import_file

    for name in ["run.dump", "run.xyz", "run_*.vtp"]:
        pipeline = import_file(name)
        assert pipeline.source.num_frames == 5
        particles = pipeline.compute(4).particles
        for wanted in ["Particle Type", "Radius", "Mass", "Velocity", "Angular Velocity"]:
            assert wanted in particles, f"{name} has no {wanted}"
        order = np.argsort(particles.identifiers[...])
        near(f"OVITO, {name}", particles.positions[...][order], place, 1e-14)
        turned = particles.orientations[...][order][:, [3, 0, 1, 2]]
        near(f"OVITO, {name}, orientations", turns(turned), axes, 1e-6)


if __name__ == "__main__":
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("scene.toml", "w") as file:
            file.write(SCENE)
        main(program)
    print("all of them agree")
