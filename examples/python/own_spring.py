"""A spring with taper, hole and rivet in the component: by finite elements, by their modes, and by segments.

gmsh meshes the spring of DRAWING as a solid, and CalculiX solves it (Debian: apt-get install --no-install-recommends
calculix-ccx gmsh). It is reduced to shapes that hold the static shape under a force at the contact, and written as a
spring file; beside it, the same drawing as a spring file by segments. The component runs both:

- compliance at the contact: from the preload at the overtravel;
- natural frequencies, the first with the contact open, three with the contact closed: peaks of the ringing;
- opening level: the sine vibration, raised gently, just above one at which the contact stays closed.

CalculiX gives the same of the whole mesh: static deflection, natural frequencies, and the harmonic response with the
contact as a linear spring, whose force amplitude equals the preload at the opening level.

To simulate your own spring, change DRAWING and VALUES. docs/own-spring.md explains when segments are enough.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from tqdm import tqdm

from common import parser, read_arguments, save
from own_spring_elements import Basis, Drawing, Elements, missing, segments
from relay_contact import Array, Component, Contact, Value
from relay_contact.figures import BLACK, BLUE, GRAVITY, ORANGE
from relay_contact.qualification.level import threshold
from relay_contact.qualification.response import respond
from relay_contact.qualification.standards import Contacts
from relay_contact.qualification.trials import Specimen, vibrated

DRAWING = Drawing(
    length=20e-3, width=4e-3, taper_start=10e-3, end_width=2.4e-3, thickness=0.2e-3,
    hole=(5e-3, 1.5e-3), rivet=(18e-3, 1.6e-3), head=0.6e-3, tail=0.3e-3,
)  # fmt: skip
BETA = 5e-6  # s, damping of spring and contact: 0.45 % of critical for the first mode of the open spring
VALUES: dict[str, Value] = {
    "contact.overtravel": 0.8e-3,
    "contact.curvatureRadius": 3e-3,
    "contact.damping": BETA,  # the program damps all that is elastic alike
    "beam.stiffnessDamping": BETA,
    "effects.axialForce": "None",
}
BAND = (200.0, 2400.0)  # Hz, of the opening level
SHAPES = 24  # of the reduced basis
RING, SAMPLE = 0.2, 1e-5  # s, length and sampling of the ringing
MONITOR = Contacts(opening=0.0, false_make=0.0, voltage=6.0, current=1e-6, clause="", evidence={})
"""Any opening counts: the contact has this resistance once its force is nearly nothing."""
SPAN, LEAST = 0.1, 0.02  # of frequencies around that of the program; participation, as a share of the greatest


@dataclass
class Spring:
    """A spring file in the component."""

    component: Component
    values: dict[str, Value]

    @cached_property
    def specimen(self) -> Specimen:
        """Give it with its contact watched, as a standard's tests do."""
        return Specimen(self.component, self.values, MONITOR, respond(self.component, self.values, MONITOR.threshold))

    def started(self, **changes: Value) -> Contact:
        """Give the contact at rest; names of changes have two underscores for the point."""
        return self.component.started(self.values | {name.replace("__", "."): v for name, v in changes.items()})

    def compliance(self) -> float:
        """Give the deflection of the contact per force, m/N: what the preload leaves of the overtravel."""
        with self.started() as contact:
            force, indentation = contact.real("preload.force", "preload.indentation")
        return (float(self.values["contact.overtravel"]) - indentation) / force

    def open_frequency(self) -> float:
        """Give the lowest natural frequency with the contact open, Hz."""
        with self.started(contact__overtravel=-1e-3) as contact:
            return contact.real("preload.frequency")[0]

    def ringing(self, near: Array) -> Array:
        """Give the natural frequencies near these, with the contact closed: peaks of the ringing after a blow, Hz."""
        blow: dict[str, Value] = {"effects__excitation": "HalfSine", "excitation__duration": 2e-5}
        undamped: dict[str, Value] = {"beam__stiffnessDamping": 0.0, "contact__damping": 0.0}
        time = np.arange(0.0, RING + SAMPLE / 2, SAMPLE)
        with self.started(excitation__amplitude=100.0, **blow, **undamped) as contact:
            force = contact.drive(time, {}, ["contact.force"])["contact.force"]
        spectrum = np.log(np.abs(np.fft.rfft((force - force.mean()) * np.hanning(len(force)))))
        frequency = np.fft.rfftfreq(len(force), SAMPLE)
        found = []
        for each in near:
            inside = np.flatnonzero(np.abs(frequency / each - 1) < SPAN)
            top = int(inside[np.argmax(spectrum[inside])])
            left, middle, right = spectrum[top - 1 : top + 2]
            found.append(frequency[top] + 0.5 * (left - right) / (left - 2 * middle + right) * frequency[1])
        return np.array(found)

    def opening(self, frequency: float) -> float:
        """Give the amplitude of a sine, raised gently, at which the contact opens, m/s2."""
        specimen, response = self.specimen, self.specimen.response
        guess = response.reserve / float(np.interp(frequency, response.frequency, response.gain))
        return threshold(lambda level: vibrated(specimen, frequency, level)[::2], guess)[0]


def deviations(table: pd.DataFrame) -> pd.DataFrame:
    """Give those of modes and segments from the whole mesh, in per cent."""
    parts = table[["modes", "segments"]].div(table["finite_elements"], axis=0) - 1
    return (100 * parts).round(2) + 0.0


def excited(frequencies: Array, participation: Array) -> Array:
    """Give the frequencies of those that the base excites."""
    share = np.abs(participation) / np.abs(participation).max()
    found: Array = frequencies[share > LEAST]
    return found


def draw_shape(axes: Axes, elements: Elements, basis: Basis, index: int) -> None:
    """Draw the spring in one of its modes; the height is that of the largest displacement."""
    place = elements.mesh.nodes
    largest = max(abs(shape[index]) for shape in basis.shapes.values())
    faces, colours = [], []
    for face in elements.mesh.top(elements.drawing):
        moved = [float(basis.shapes[node][index]) / largest if node in basis.shapes else 0.0 for node in face]
        faces.append([(1e3 * place[n][0], 1e3 * place[n][1], z) for n, z in zip(face, moved, strict=True)])
        colours.append(plt.get_cmap("coolwarm")(0.5 + 0.5 * np.mean(moved)))
    space: Any = axes
    space.add_collection3d(Poly3DCollection(faces, facecolors=colours, edgecolors="#444444", linewidths=0.25))
    length, width = 1e3 * elements.drawing.length, 1e3 * elements.drawing.width
    space.set(xlim=(0, length), ylim=(-width / 2, width / 2), zlim=(-1, 1))
    space.set_box_aspect((length, 1.5 * width, 0.3 * length), zoom=1.2)
    space.view_init(elev=24, azim=-62)
    space.set_axis_off()
    axes.set_title(f"{basis.frequencies[index]:.0f} Hz", fontsize="medium", y=0.85)


def draw(path: Path, elements: Elements, basis: Basis, table: pd.DataFrame, response: Array) -> None:
    """Draw modes, deviations and opening levels; the response gives frequency and opening level of the whole mesh."""
    figure = plt.figure(figsize=(12, 7.6), layout="constrained")
    subfigures: Any = figure.subfigures(2, 1, height_ratios=[1, 2])
    top, bottom = subfigures
    for place, frequency in enumerate(excited(basis.frequencies, basis.participation)[:4], 1):
        index = int(np.flatnonzero(basis.frequencies == frequency)[0])
        draw_shape(top.add_subplot(1, 4, place, projection="3d"), elements, basis, index)
    top.suptitle("Modes of the spring with its contact open, rivet not drawn")
    bars, levels = bottom.subplots(1, 2, width_ratios=[1, 1.25])
    where = np.arange(len(table))
    for shift, which, colour in ((-0.2, "modes", BLUE), (0.2, "segments", ORANGE)):
        drawn = bars.barh(where + shift, deviations(table)[which], 0.38, color=colour, label=which)
        bars.bar_label(drawn, fmt="{:+.2f} %", padding=2, fontsize="x-small")
    bars.set_yticks(where, table["quantity"], fontsize="small")
    bars.invert_yaxis()
    bars.margins(x=0.25)
    bars.axvline(0, color=BLACK, linewidth=0.8)
    bars.set(xlabel="deviation from the whole mesh [%]", title="In the component, against CalculiX")
    bars.legend(fontsize="small")
    levels.plot(*response.T, color=BLACK, label="finite elements, linear (CalculiX)")
    opened = table[table["quantity"].str.startswith("opening")]
    places = opened["quantity"].str.split().str[2].replace("resonance", "nan").astype(float)
    for which, marker, colour, label in (("modes", "o", BLUE, "modes in the component"),
                                         ("segments", "x", ORANGE, "segments")):  # fmt: skip
        # That of the resonance is at the first frequency of the closed contact.
        at = places.fillna(table.set_index("quantity")[which]["closed: frequency 1"])
        levels.plot(at, GRAVITY * opened[which], marker, color=colour, markersize=8, fillstyle="none", label=label)
    levels.set(
        yscale="log", xlim=(0, BAND[1]), xlabel="frequency [Hz]", ylabel="base acceleration [m/s²]",
        title="Sine vibration that opens the contact",
    )  # fmt: skip
    scale: Any = (lambda a: a / GRAVITY, lambda a: a * GRAVITY)
    levels.secondary_yaxis("right", functions=scale).set_ylabel("base acceleration [g]")
    levels.legend(fontsize="small")
    for axes in (bars, levels):
        axes.grid(alpha=0.3)
    save(figure, path, dpi=130)


def main() -> None:
    """Solve, reduce, run and compare."""
    given = read_arguments(parser(__doc__, "elements of 1 mm instead of 0.4 mm, fewer frequencies", "a minute or two"))
    if lacking := missing():
        raise SystemExit(lacking)
    bar = tqdm(total=5, unit="stage", bar_format="{desc}: {n_fmt} of {total_fmt} [{elapsed}]")

    def stage(text: str) -> None:
        bar.set_description_str(text)
        bar.update()

    stage("finite elements: mesh, compliance, frequencies")
    elements = Elements(DRAWING, given.out / "own-spring", 1e-3 if given.quick else 0.4e-3)
    compliance, free = elements.compliance, elements.frequencies(16)
    stage("finite elements: reduced basis")
    basis = elements.basis(SHAPES)
    files = [given.out / f"own-spring-{name}.toml" for name in ("modes", "segments")]
    title = "Tapered spring with hole and rivet"
    files[0].write_text(basis.spring_file(f"{title}, reduced from {len(elements.mesh.nodes)} nodes"), encoding="utf-8")
    files[1].write_text(segments(DRAWING, title), encoding="utf-8")
    component = Component(given.fmu)
    mass, inertia = DRAWING.rivet_load
    rivet: dict[str, Value] = {"tip.mass": mass, "tip.rotaryInertia": inertia}
    springs = [Spring(component, VALUES | rivet | {"beam.file": str(path.resolve())}) for path in files]
    with springs[0].started() as contact:
        indentation, stiffness = contact.real("preload.indentation", "preload.contactStiffness")
    stage("finite elements: harmonic response")
    closed, response = elements.response(stiffness, BETA, BAND, 8 if given.quick else 20)
    preload = (float(VALUES["contact.overtravel"]) - indentation) / compliance
    response[:, 1] = preload / response[:, 1]

    stage("component: compliance, frequencies")
    rows = [("compliance", "mm/N", 1e3 * compliance, *(1e3 * each.compliance() for each in springs))]
    lowest = float(free[np.argmin(np.abs(free - basis.frequencies[0]))])
    rows.append(("open: frequency 1", "Hz", lowest, *(each.open_frequency() for each in springs)))
    theirs = np.array([closed[np.argmin(np.abs(closed - each))] for each in excited(*basis.closed(stiffness))[:3]])
    own = [spring.ringing(theirs) for spring in springs]
    rows += [(f"closed: frequency {n}", "Hz", *each) for n, each in enumerate(zip(theirs, *own, strict=True), 1)]
    stage("component: opening levels")
    for frequency in [BAND[0], 1000.0] if given.quick else [BAND[0], 500.0, 1000.0, 1400.0, 2000.0]:
        near, level = response[np.argmin(np.abs(response[:, 0] - frequency))]
        found = (level, *(spring.opening(near) for spring in springs))
        rows.append((f"opening at {near:.0f} Hz", "g", *(each / GRAVITY for each in found)))
    found = (response[:, 1].min(), *(spring.opening(each[0]) for spring, each in zip(springs, own, strict=True)))
    rows.append(("opening at resonance", "g", *(each / GRAVITY for each in found)))
    bar.close()
    table = pd.DataFrame(rows, columns=["quantity", "unit", "finite_elements", "modes", "segments"])
    apart = deviations(table).add_suffix(": deviation [%]")
    print(table.join(apart).to_string(index=False, float_format="{:.4g}".format))
    bending = excited(basis.frequencies, basis.participation)
    others = [f"{each:.0f}" for each in free if np.min(np.abs(bending / each - 1)) > 1e-5]
    print(f"open, across or in torsion, so not excited: {', '.join(others)} Hz")
    paths = [given.out / name for name in ("own-spring.csv", "own-spring.png")]
    table.to_csv(paths[0], index=False, float_format="%.9g", lineterminator="\n")
    draw(paths[1], elements, basis, table, response)
    print(*files, *paths, sep="\n")


if __name__ == "__main__":
    main()
