"""A spring in finite elements: meshed by gmsh, solved by CalculiX, reduced to a spring file. Used by own_spring.py.

Both are called as programs: gmsh writes the mesh, ccx reads decks and writes tables. The reduced basis is made from the
stiffness and mass matrices that ccx writes, so any program that writes its matrices serves.
"""

import math
import re
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from relay_contact import Array

PROGRAMS = {"gmsh": "gmsh", "ccx": "calculix-ccx"}
"""Programs, and the Debian packages that have them."""
SUPERPOSED = 40  # modes of the harmonic response: the force is then within 1e-4 of that with 90
PRINT = "*NODE PRINT, NSET=shown\nU"
NEGLIGIBLE = 1e-9, 1e-6  # shares of compliance and mass below which contact and base do not excite a shape


def missing() -> str:
    """Say which programs are missing, and how to get them; nothing if none is."""
    lacking = [name for name in PROGRAMS if shutil.which(name) is None]
    packages = " ".join(PROGRAMS[name] for name in lacking)
    return f"{' and '.join(lacking)} not found: apt-get install --no-install-recommends {packages}" if lacking else ""


@dataclass(frozen=True)
class Material:
    """An isotropic material, SI units."""

    youngs_modulus: float
    poissons_ratio: float
    density: float


CUBE = Material(131e9, 0.3, 8250.0)  # beryllium copper, hardened
SILVER = Material(86e9, 0.33, 9900.0)  # AgSnO2


@dataclass(frozen=True)
class Drawing:
    """A flat spring as drawn, clamped at x = 0, symmetric about its axis; lengths in m."""

    length: float
    width: float
    taper_start: float
    """From here on the width falls linearly to that of the end."""
    end_width: float
    thickness: float
    hole: tuple[float, float]
    """Position and diameter; a diameter of 0: none."""
    rivet: tuple[float, float]
    """Position and diameter."""
    head: float
    """Height of the rivet's head on the side of the fixed contact."""
    tail: float
    """Height on the other side."""
    spring_material: Material = CUBE
    rivet_material: Material = SILVER

    def width_at(self, x: float) -> float:
        """Give the width between the edges."""
        return float(np.interp(x, [0, self.taper_start, self.length], [self.width, self.width, self.end_width]))

    @property
    def rivet_load(self) -> tuple[float, float]:
        """Give the mass (kg) that the rivet adds to the spring, and its rotary inertia (kg m2) about the spring."""
        area = math.pi * self.rivet[1] ** 2 / 4
        low, high = -self.thickness / 2 - self.head, self.thickness / 2 + self.tail
        whole = self.rivet_material.density * area * (high - low)
        replaced = self.spring_material.density * area * self.thickness
        inertia = whole * (self.rivet[1] ** 2 / 16 + (low**2 + low * high + high**2) / 3)
        return whole - replaced, inertia

    def geometry(self, size: float) -> str:
        """Give the geometry for gmsh with elements of about this size (m); gmsh is given millimetres."""
        mm, z = 1e3, -0.5e3 * self.thickness
        half, end = self.width / 2, self.end_width / 2
        outline = [(0, -half), (self.taper_start, -half), (self.length, -end)]
        outline += [(x, -y) for x, y in reversed(outline)]
        lines = ["Mesh.ElementOrder = 2; Mesh.SecondOrderIncomplete = 1; Mesh.RecombineAll = 1;"]
        lines.append("Mesh.ScalingFactor = 0.001;")  # of what it writes
        lines += [f"Point({n}) = {{{mm * x}, {mm * y}, {z}, {mm * size}}};" for n, (x, y) in enumerate(outline, 1)]
        lines += [f"Line({n}) = {{{n}, {n % 6 + 1}}};" for n in range(1, 7)] + ["Curve Loop(1) = {1:6};"]
        loops = [1]
        for first, (x, diameter) in ((100, self.hole), (200, self.rivet)):
            if diameter > 0:
                r = diameter / 2
                ring = [(x, 0.0), (x + r, 0.0), (x, r), (x - r, 0.0), (x, -r)]
                near = mm * min(size, r / 2)
                lines += [f"Point({first + n}) = {{{mm * a}, {mm * b}, {z}, {near}}};" for n, (a, b) in enumerate(ring)]
                lines += [
                    f"Circle({first + n}) = {{{first + 1 + n}, {first}, {first + 1 + (n + 1) % 4}}};" for n in range(4)
                ]
                lines.append(f"Curve Loop({first}) = {{{first}:{first + 3}}};")
                loops.append(first)
        lines += [f"Plane Surface(1) = {{{', '.join(map(str, loops))}}};", "Plane Surface(2) = {200};"]
        lines.append("Point{200} In Surface{2};")
        layers = [("spring", "1", self.thickness, 1), ("shank", "2", self.thickness, 1), ("head", "2", -self.head, 2)]
        for name, surface, height, count in [*layers, ("tail", "shank[0]", self.tail, 1)]:
            extruded = f"Extrude {{0, 0, {mm * height}}} {{ Surface{{{surface}}}; Layers{{{count}}}; Recombine; }}"
            lines.append(f"{name}[] = {extruded};")
        volumes = (("spring", "spring[1]"), ("rivet", "shank[1], head[1], tail[1]"))
        lines += [f'Physical Volume("{name}") = {{{parts}}};' for name, parts in volumes]
        return "\n".join(lines) + "\n"


@dataclass
class Mesh:
    """Nodes, SI units, and elements of a mesh."""

    nodes: dict[int, Array]
    blocks: list[tuple[str, list[list[int]]]]
    """Type of elements; number and nodes of each."""

    @classmethod
    def read(cls, text: str) -> "Mesh":
        """Read what gmsh wrote: sections of numbers; an element with many nodes goes on in a second line."""
        mesh = cls({}, [])
        for keyword, options, rows in re.findall(r"^\*(\w+)(.*)\n((?:[^*\n].*\n)+)", text, re.MULTILINE):
            numbers = np.array(rows.replace(",", " ").split())
            if keyword.upper() == "NODE":
                mesh.nodes |= {int(row[0]): row[1:] for row in numbers.reshape(-1, 4).astype(float)}
            elif keyword.upper() == "ELEMENT":
                (kind,) = re.findall(r"type=(\w+)", options)
                mesh.blocks.append((kind, numbers.reshape(-1, 1 + int(kind[3:])).astype(int).tolist()))
        return mesh

    def deck(self, written: str, drawing: Drawing) -> str:
        """Give what gmsh wrote as all decks need it; thin quadratic bricks have to be integrated at fewer points."""
        lines = [re.sub(r"type=C3D20\b", "type=C3D20R", written)]
        clamped = [node for node, place in self.nodes.items() if abs(place[0]) < 1e-9]
        lines += ["*NSET, NSET=clamp", *(f"{node}," for node in clamped)]
        for name, material in (("spring", drawing.spring_material), ("rivet", drawing.rivet_material)):
            elastic = f"{material.youngs_modulus}, {material.poissons_ratio}"
            lines += [f"*MATERIAL, NAME={name}", "*ELASTIC", elastic, "*DENSITY", f"{material.density}"]
            lines.append(f"*SOLID SECTION, ELSET={name}, MATERIAL={name}")
        return "\n".join([*lines, "*BOUNDARY", "clamp, 1, 3"]) + "\n"

    def top(self, drawing: Drawing) -> list[list[int]]:
        """Give the corners of the elements on the upper face of the spring."""
        height, corners = drawing.thickness / 2, []
        for kind, elements in self.blocks:
            corners += [element[5:9] if kind == "C3D20" else element[4:7] for element in elements]
        return [face for face in corners if all(abs(self.nodes[node][2] - height) < 1e-9 for node in face)]


@dataclass
class Basis:
    """Shapes that are orthogonal in mass and stiffness, of modal masses of 1 kg, frequency ascending."""

    frequencies: Array
    contact: Array
    participation: Array
    shapes: dict[int, Array]
    """Displacement normal to the spring of each node, in every shape."""
    compliance: float

    def closed(self, stiffness: float) -> tuple[Array, Array]:
        """Give the natural frequencies (Hz) with the contact as a linear spring (N/m), and their participation."""
        open_ = np.diag((2 * math.pi * self.frequencies) ** 2)
        squares, vectors = eigh(open_ + stiffness * np.outer(self.contact, self.contact))
        return np.sqrt(squares) / (2 * math.pi), vectors.T @ self.participation

    def spring_file(self, title: str) -> str:
        """Give it in the form that `beam.file` reads."""
        lines = [f'title = "{title}"', f"compliance = {self.compliance:.9e}"]
        for values in zip(self.frequencies, self.contact, self.participation, strict=True):
            named = zip(("frequency", "contact", "participation"), values, strict=True)
            lines += ["", "[[mode]]", *(f"{name} = {value:.12g}" for name, value in named)]
        return "\n".join(lines) + "\n"


class Elements:
    """A drawing in finite elements, in a folder that keeps decks and results."""

    def __init__(self, drawing: Drawing, folder: Path, size: float) -> None:
        """Mesh it with elements of about this size, m."""
        self.drawing, self.folder = drawing, folder
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "spring.geo").write_text(drawing.geometry(size), encoding="utf-8")
        self.call("gmsh", "-3", "-format", "inp", "-o", "gmsh.inp", "spring.geo")
        written = (folder / "gmsh.inp").read_text(encoding="utf-8")
        self.mesh = Mesh.read(written)
        (folder / "mesh.inp").write_text(self.mesh.deck(written, drawing), encoding="utf-8")
        low = -drawing.thickness / 2 - drawing.head
        face = {node: place for node, place in self.mesh.nodes.items() if abs(place[2] - low) < 1e-9}
        away = {node: math.dist(place[:2], (drawing.rivet[0], 0.0)) for node, place in face.items()}
        self.centre = min(away, key=lambda node: away[node])
        # A force at one point would dent the mesh: what the contact does is the mean of the rim of the rivet's head.
        self.rim = [node for node, distance in away.items() if abs(2 * distance - drawing.rivet[1]) < 1e-9]

    def call(self, *command: str) -> None:
        """Run a program in the folder."""
        result = subprocess.run(
            command, cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
        )
        if result.returncode or "*ERROR" in result.stdout:
            raise SystemExit(f"{' '.join(command)}, in {self.folder}:\n{(result.stdout + result.stderr)[-2000:]}")

    def solve(self, name: str, shown: list[int], *steps: str, more: str = "") -> str:
        """Have CalculiX solve the steps, with nodes to show and further elements; give the table that it printed."""
        lines = ["*INCLUDE, INPUT=mesh.inp", "*NSET, NSET=shown", *(f"{node}," for node in shown), *more.splitlines()]
        lines += [f"*STEP\n{step}\n*END STEP" for step in steps]
        (self.folder / f"{name}.inp").write_text("\n".join(lines) + "\n", encoding="utf-8")
        self.call("ccx", name)
        return (self.folder / f"{name}.dat").read_text(encoding="utf-8")

    def printed(self, table: str) -> Iterator[tuple[float, Array]]:
        """Give what was printed of displacements normal to the spring: time or frequency, that of each node."""
        for when, rows in re.findall(r"^ displacements.* time +(\S+)\n\n((?: +\d.*\n)+)", table, re.MULTILINE):
            yield float(when), np.array([float(row.split()[3]) for row in rows.splitlines()])

    @cached_property
    def compliance(self) -> float:
        """Give the deflection of the contact per force there, m/N."""
        loads = "\n".join(f"{node}, 3, {1 / len(self.rim)}" for node in self.rim)
        table = self.solve("static", self.rim, f"*STATIC\n*CLOAD\n{loads}\n{PRINT}")
        return float(next(self.printed(table))[1].mean())

    def frequencies(self, count: int) -> Array:
        """Give the lowest natural frequencies with the contact open, in whichever direction, Hz."""
        return resonances(self.solve("modes", self.rim, f"*FREQUENCY\n{count}"))

    def response(self, stiffness: float, beta: float, band: tuple[float, float], points: int) -> tuple[Array, Array]:
        """Give the natural frequencies with the contact as a linear spring (N/m), Hz, and the harmonic response.

        The response has rows of frequency (Hz) and amplitude of the contact force per base acceleration (N s2/m), in a
        band (Hz) with so many points between resonances; damping is `beta` (s) times the stiffness.
        """
        number = 1 + max(element[0] for _, block in self.mesh.blocks for element in block)
        spring = f"*ELEMENT, TYPE=SPRING1, ELSET=fixed\n{number}, {self.centre}\n*SPRING, ELSET=fixed\n3\n{stiffness}"
        modes = f"*FREQUENCY, STORAGE=YES\n{SUPERPOSED}"
        steady = f"*STEADY STATE DYNAMICS\n{band[0]}, {band[1]}, {points}, 2.\n*MODAL DAMPING, RAYLEIGH\n,, 0., {beta}"
        gravity = "*DLOAD\nspring, GRAV, 1.0, 0, 0, -1\nrivet, GRAV, 1.0, 0, 0, -1"
        table = self.solve("response", [self.centre], modes, f"{steady}\n{gravity}\n{PRINT}", more=spring)
        parts = [(frequency, float(values[0])) for frequency, values in self.printed(table)]
        pairs = zip(parts[0::2], parts[1::2], strict=True)
        rows = np.unique([[frequency, math.hypot(real, other)] for (frequency, real), (_, other) in pairs], axis=0)
        rows[:, 1] *= stiffness * np.hypot(1, 2 * math.pi * rows[:, 0] * beta)
        return resonances(table), rows

    def matrices(self) -> tuple[Any, Any, dict[tuple[int, int], int]]:
        """Give stiffness and mass, SI units, and the row of each node and direction that is free."""
        self.solve("matrices", self.rim, "*FREQUENCY, SOLVER=MATRIXSTORAGE\n1")
        freedoms = (self.folder / "matrices.dof").read_text(encoding="utf-8").split()
        index = {(int(node), int(way)): n for n, (node, way) in enumerate(each.split(".") for each in freedoms)}

        def matrix(ending: str) -> Any:  # noqa: ANN401
            row, column, value = np.loadtxt(self.folder / f"matrices.{ending}").T
            place = (row.astype(int) - 1, column.astype(int) - 1)
            upper = csc_matrix((value, place), shape=(len(index), len(index)))
            diagonal = csc_matrix((upper.diagonal(), (range(len(index)), range(len(index)))))
            return upper + upper.T - diagonal

        return matrix("sti"), matrix("mas"), index

    def basis(self, count: int) -> Basis:
        """Reduce it to so many shapes by the block method of Lanczos.

        They are the static shapes under a force at the contact and under a base acceleration, those under the inertia
        of these, and so on.
        """
        stiffness, mass, index = self.matrices()
        normal, force = np.zeros(len(index)), np.zeros(len(index))
        normal[[n for (_, way), n in index.items() if way == 3]] = 1.0
        force[[index[node, 3] for node in self.rim]] = 1 / len(self.rim)
        loads: Sequence[Array] = [force, mass @ normal]
        solve = splu(stiffness).solve
        found = np.empty((len(index), 0))
        while found.shape[1] < count:
            block = []
            for load in loads:
                shape = solve(load)
                for _ in range(2):  # twice is enough
                    shape -= found @ (found.T @ (mass @ shape))
                shape /= math.sqrt(shape @ (mass @ shape))
                found = np.column_stack([found, shape])
                block.append(mass @ shape)
            loads = block
        squares, vectors = eigh(found.T @ (stiffness @ found))
        shapes = found @ vectors
        compliance = float(force @ solve(force))
        contact, participation = shapes.T @ force, shapes.T @ (mass @ normal)
        held = contact**2 / squares / compliance, participation**2 / (normal @ (mass @ normal))
        used = (held[0] > NEGLIGIBLE[0]) | (held[1] > NEGLIGIBLE[1])
        sign = np.sign(contact[used])
        moved = {node: sign * shapes[n, used] for (node, way), n in index.items() if way == 3}
        frequencies = np.sqrt(squares[used]) / (2 * math.pi)
        return Basis(frequencies, sign * contact[used], sign * participation[used], moved, compliance)


def resonances(table: str) -> Array:
    """Give the natural frequencies that CalculiX printed, Hz."""
    rows = re.findall(r"^ +\d+ +\S+E\S+ +\S+E\S+ +(\S+E\S+) +0\.0000000E\+00$", table, re.MULTILINE)
    return np.array([float(each) for each in rows])


def segments(drawing: Drawing, title: str, slices: int = 6) -> str:
    """Give the spring as a spring file by segments: its edges less the hole, in slices; as stiff as the rivet at it."""
    (x, diameter), (contact, rivet), material = drawing.hole, drawing.rivet, drawing.spring_material
    ring = np.linspace(x - diameter / 2, x + diameter / 2, slices + 1) if diameter > 0 else np.array([])
    edges = [0.0, drawing.taper_start, contact - rivet / 2, contact + rivet / 2, drawing.length, *ring.tolist()]
    lines = [f'title = "{title}"', f"contact_position = {contact:.9g}"]
    for start, end in pairwise(sorted({min(each, drawing.length) for each in edges})):
        width, middle = np.array([drawing.width_at(start), drawing.width_at(end)]), (start + end) / 2
        if abs(middle - x) < diameter / 2:
            # The mean chord of the slice: area between two lines across a circle.
            a, b = (np.clip(2 * (each - x) / diameter, -1, 1) for each in (start, end))
            area = (b * np.sqrt(1 - b**2) + np.arcsin(b) - a * np.sqrt(1 - a**2) - np.arcsin(a)) * diameter**2 / 4
            width -= area / (end - start)
        # The mass of the rivet is that of the contact, so here only that of the spring.
        stacked = drawing.thickness + (drawing.head + drawing.tail if abs(middle - contact) < rivet / 2 else 0.0)
        lines += ["", "[[segment]]", f"length = {end - start:.9g}"]
        lines += [f"width_{at} = {each:.9g}" for at, each in zip(("start", "end"), width, strict=True)]
        lines += [f"thickness = {stacked:.9g}", f"youngs_modulus = {material.youngs_modulus:.9g}"]
        lines.append(f"density = {material.density * drawing.thickness / stacked:.9g}")
    return "\n".join(lines) + "\n"
