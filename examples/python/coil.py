"""Switch a relay by its coil: operate and release time and bounce, with the component's own armature.

    voltage U(t) --- coil R, L(g) --- 0 V          L(g) = L_0 / (1 + g / g_0)

    psi' = U - R i,   psi = L(g) i

The component has magnet, armature, springs and contact (effects.pusher Armature, docs/relay.md). Its magnet is that of
this coil, with g_0 for armature.gapConstant and i_n^2 L_0 / (2 g_0) for armature.holdForce, where i_n is the current at
which coil.relativeCurrent is 1: here U / R.

In a communication step the coil goes first, past an armature that keeps its velocity; then the component, whose input
changes linearly from the current at the start of the step to that at its end. Another circuit, or one of another tool,
takes the place of `Coil`: armature.gap and armature.velocity go to it, the current comes back.

Operate time: from switching on to the first touch. Bounce at make: from there to the last closing before switching off.
Release time: from switching off to the first opening. Bounce at break: from there to the last opening.
"""

import math
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from tqdm import tqdm

from common import parser, read_arguments, save
from relay_contact import Array, Component, Values, write_table
from relay_contact.figures import BLUE, GREEN, ORANGE, PURPLE, RED

ON, OFF, END = 1e-3, 21e-3, 36e-3  # s
OUTPUTS = ["armature.displacement", "pusher.force", "contact.force", "contact.lastOpening", "contact.lastClosing"]
COLUMNS = ["time", "coil.current", *OUTPUTS]

Run = dict[str, Array]  # `COLUMNS`, SI units, at the communication points


@dataclass(frozen=True)
class Coil:
    """Its parameters, in SI units."""

    voltage: float
    resistance: float = 240.0
    inductance: float = 1.92
    constant: float = 3e-4

    def current(self, flux: float, gap: float) -> float:
        """Give the current; a core that gives way changes nothing."""
        return flux * (1 + max(gap, 0.0) / self.constant) / self.inductance

    def after(self, flux: float, voltage: float, gap: float, time: float) -> float:
        """Give the flux linkage after a time at a gap, in closed form."""
        rate = self.resistance * self.current(1.0, gap)
        return voltage / rate + (flux - voltage / rate) * math.exp(-rate * time)

    def magnet(self) -> Values:
        """Give the parameters of the component's magnet."""
        hold = (self.voltage / self.resistance) ** 2 * self.inductance / (2 * self.constant)
        return {"armature.holdForce": hold, "armature.gapConstant": self.constant, "coil.relativeCurrent": 0.0}


def simulate(component: Component, coil: Coil, mass: float, points: Array, bar: "tqdm[None]") -> Run:
    """Switch the coil on and off, by way of communication points (s)."""
    # A contact of clean metal, open without the pusher.
    relay: Values = {"effects.pusher": "Armature", "contact.overtravel": -5e-5, "contact.damping": 1e-6}
    nominal = coil.voltage / coil.resistance
    flux, current, rows = 0.0, 0.0, []
    with component.started({**relay, **coil.magnet(), "armature.mass": mass}) as contact:
        rows.append([points[0], current, *contact.real(*OUTPUTS)])
        for time, after in pairwise(points.tolist()):
            step = after - time
            gap, velocity = contact.real("armature.gap", "armature.velocity")
            voltage = coil.voltage if ON < time + step / 2 < OFF else 0.0
            flux = coil.after(flux, voltage, gap - velocity * step / 2, step)
            before, current = current, coil.current(flux, gap - velocity * step)
            contact.change("coil.relativeCurrent", before / nominal, current / nominal, step)
            contact.step(time, step)
            rows.append([after, current, *contact.real(*OUTPUTS)])
            bar.update()
    return dict(zip(COLUMNS, np.array(rows).T, strict=True))


def times(run: Run) -> dict[str, float]:
    """Give operate and release time and the bounce at both, s; without a touch or an opening they are no numbers."""
    spans = (("contact.lastClosing", ON, OFF), ("contact.lastOpening", OFF, END))
    found = [np.unique(run[name][(run[name] > begin) & (run[name] < end)]) for name, begin, end in spans]
    made, left = (each if len(each) else np.array([np.nan]) for each in found)
    return {
        "operate time": made[0] - ON,
        "bounce at make": made[-1] - made[0],
        "release time": left[0] - OFF,
        "bounce at break": left[-1] - left[0],
    }


def draw(run: Run, found: dict[str, float], path: Path) -> None:
    """Draw the make and the break, each beside the other."""
    shown = [
        (1e3 * run["coil.current"], "coil current\n[mA]", PURPLE),
        (1e6 * run["armature.displacement"], "pusher\n[µm]", GREEN),
        (run["pusher.force"], "pusher force\n[N]", RED),
        (run["contact.force"], "contact force\n[N]", BLUE),
    ]
    figure, grid = plt.subplots(len(shown), 2, sharex="col", sharey="row", figsize=(10, 7), layout="constrained")
    spans = (("make", "operate time", ON, "on"), ("break", "release time", OFF, "off"))
    for column, (title, name, switched, way) in zip(grid.T, spans, strict=True):
        bounce = 1e3 * found[f"bounce at {title}"]
        said = f"{name.capitalize()} {1e3 * found[name]:.2f} ms, bounce at {title} {bounce:.2f} ms"
        column[0].set_title(said, fontsize="medium")
        column[-1].set_xlabel(f"time after switching {way} [ms]")
        for axes, (values, label, colour) in zip(column, shown, strict=True):
            axes.plot(1e3 * (run["time"] - switched), values, color=colour, linewidth=1.2)
            axes.axvline(1e3 * found[name], color=ORANGE, linewidth=1, linestyle="--")
            axes.set_xlim(-1, 1e3 * (END - OFF))
            axes.set_ylabel(label if title == "make" else "")
            axes.grid(alpha=0.3)
    # The first touch strikes with many times the force that rests: linear below 1 N, logarithmic above.
    grid[-1, 0].set_yscale("symlog", linthresh=1.0)
    grid[-1, 0].set_yticks([0.0, 0.5, 1.0, 10.0], ["0", "0.5", "1", "10"])
    grid[-1, 0].set_ylim(bottom=-0.1)
    figure.align_ylabels()
    save(figure, path)


def main() -> None:
    """Run it with several steps, compare."""
    voltage, mass = (12.0, 1.0, 100.0, "V", "of the source"), (2e-3, 1e-4, 0.1, "kg", "of the armature")
    quick = "steps of 5 and 10 µs in place of 2, 4 and 8"
    given = read_arguments(parser(__doc__, quick, "some seconds", voltage=voltage, mass=mass))
    component, coil = Component(given.fmu), Coil(given.voltage)
    steps = [5, 10] if given.quick else [2, 4, 8]  # µs
    grids = [np.arange(0, round(1e6 * END) + step, step) / 1e6 for step in steps]
    with tqdm(total=sum(map(len, grids)) - len(grids), unit="step") as bar:
        runs = [simulate(component, coil, given.mass, grid, bar) for grid in grids]
    found = [times(run) for run in runs]
    coil_most, pushed, pressed = (np.max(runs[0][name]) for name in ("coil.current", "pusher.force", "contact.force"))
    print(f"at most {1e3 * coil_most:.1f} mA in the coil, {pushed:.2f} N at the pusher, {pressed:.1f} N at the contact")
    table = pd.DataFrame(found, index=pd.Index([1e-6 * step for step in steps], name="step"))
    print(f"{(1e3 * table).to_string(float_format='{:.4f}'.format)}\nsteps in s, times in ms")
    paths = [given.out / name for name in ("coil.csv", "coil-steps.csv", "coil.png")]
    write_table(paths[0], ",".join(COLUMNS), np.column_stack(list(runs[0].values())), digits=17)
    table.to_csv(paths[1], float_format="%.12g")
    draw(runs[0], found[0], paths[2])
    print(*paths, sep="\n")


if __name__ == "__main__":
    main()
